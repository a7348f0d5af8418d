'''Exercises are checked by looking at the running system, as any node could: at the graph, messages, answers, parameters.

A page asks for a check by its name, `lesson.check("status_monitor")`, and shows the table that comes back. A check is a
list of *expectations*. Each has a text and a function that looks, and becomes a row: ✓, or ✗ with what was seen and some
advice, or – where it cannot be looked at, with the reason. Every ✓ together earns the check's points.

**To write one**, add it to the module of its page (`page_04.py`; a new page is named in `story.PAGES`):

    @check("talker", points=3, limit=15, learnt="A timer makes a steady stream.")
    def talker() -> list[Expectation]:
        """A node that says hello twice a second."""
        return [
            node("/talker"),
            publishes("/chatter", "std_msgs/msg/String", by="/talker"),
            rate("/chatter", "std_msgs/msg/String", hz=2),
            Expectation("it is polite", is_polite),
            no_errors(),
        ]

    def is_polite(probe: Probe) -> Seen:
        heard = probe.hear("/chatter", "std_msgs/msg/String", seconds=2.0)
        if not heard:
            raise CannotLook("no message came on /chatter")
        text = field(heard[-1].message, "data")
        return Seen("please" in text, f'it said "{text}"', "Which word makes a request polite?")

The docstring's first line is the title. `limit` is the most robot time (s) that it may take. What an expectation raises
becomes a row of its own: CannotLook a –, anything else a ✗. What the learner's code raises meanwhile becomes the first row,
with its line. Code that computes without end is stopped after a measure of CPU time, and a ■ says where; no verdict depends
on the wall clock. So a check never fails itself, and never hangs.

**Advice** (`results.Advice`) comes in three steps: at the first failure of a check the symptom, at the second the
direction (which is what a plain text gives), from the third on also a pointer to a hint (`hinted`). It says where to look,
not what to write.

**Answers**, wrong ones that must fail and right ones that must pass, are in `tests/answers`.

**Ready-made expectations**

| module | expectations |
|---|---|
| `assertions` | `node`, `publishes`, `subscribes`, `offers`, `parameter`, `no_errors`, `answers`, `rate_follows`, `gives_up` |
| `streams` | `rate`, `relays`, and `messages` for whatever a function judges |
| `functions` | `returns` |
| `navigation` | one drive: `answered`, `arrived`, `facing`, `honest_time`, `stopped`, `steady_commands`, `refuses` |

**What a function that looks may do** is in `probe.Probe`: `wait`, `wait_for`, `listen`, `hear`, `publish`, `ask`, `ask_soon`,
`nodes`, `publishers`, `subscriptions`, `servers`, `obstacles`, `errors`, `unreturned`, `call`, and `once`, which remembers
what several rows are about; the decorator `remembered` does so for a function. A function of the learner's is called by
`probe.call` and in no other way.
All that it subscribes to and offers is taken away when the check is over, and parameters and obstacles are put back.

Texts are for learners and are compared by nbval: figures with fixed decimals (`lab.words`), nothing of the machine. A row's
`expected` is short (50 characters at most fit its column), `seen` says what was measured, beside what was expected.
Nodes that live in a notebook cell, and that no executor spins, are spun while a check lets time pass.
'''

from .graph_view import field, interface
from .probe import Answer, Heard, Probe, remembered
from .registry import Check, Expectation, all_checks, check, checks_of, find
from .results import METADATA, Advice, CannotLook, CheckResult, OutOfTime, Row, Seen, Stopped
from .runner import run

__all__ = [
    "METADATA",
    "Advice",
    "Answer",
    "CannotLook",
    "Check",
    "CheckResult",
    "Expectation",
    "Heard",
    "OutOfTime",
    "Probe",
    "Row",
    "Seen",
    "Stopped",
    "all_checks",
    "check",
    "checks_of",
    "field",
    "find",
    "interface",
    "remembered",
    "run",
]
