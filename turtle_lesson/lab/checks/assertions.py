"""Expectations about nodes: their endpoints, parameters and log; about functions that the learner wrote; and about messages and
requests: how often they come, what is in them, and how they are answered."""

from __future__ import annotations

import itertools
import math
import sys
from collections.abc import Callable, Iterable, Sequence
from typing import Any

from rclpy.parameter import Parameter, parameter_value_to_python

from ...learner.workspace import workspace
from ..words import count, did_you_mean, listed, number, shortened
from .probe import Heard, Probe, remembered
from .registry import Expectation, expectation
from .results import NO_ERROR, Advice, CannotLook, Seen, hinted

TOO_MANY = "Stop the extra node: Ctrl-C in a terminal; in a notebook run the set-up cell again, then each cell once."


@expectation("one node {name}")
def node(probe: Probe, name: str, start: str = "") -> Seen:
    """One node of this full name, and not two. `start` is the command that starts it."""
    found = probe.nodes()
    amount = found[name]
    if amount == 1:
        return Seen(True, "it is there")
    if amount > 1:
        return Seen(False, f"{amount} nodes of this name: each message comes {amount} times", TOO_MANY)
    others = [each for each in found if each != "/turtlesim"]
    seen = f"it is not there; there is {listed(others)}" if others else "it is not there"
    if fallen := probe.fallen():
        seen += f"; {' and '.join(fallen)}"
    begin = f"Start it: {start}." if start else "Start it."
    return Seen(False, seen, f"{begin} If it ended by itself, its error is in the output above.")


@expectation("{by} publishes {topic}")
def publishes(probe: Probe, topic: str, type_name: str, by: str) -> Seen:
    """A topic that is published as this type: by this node, and by no other."""
    return _ends(probe, "publisher", topic, type_name, by, probe.publishers(topic), probe.topics())


@expectation("{by} listens to {topic}")
def subscribes(probe: Probe, topic: str, type_name: str, by: str) -> Seen:
    """A topic that is subscribed to as this type by this node; others may listen, too."""
    ends = [end for end in probe.subscriptions(topic) if end[0] == by]
    return _ends(probe, "subscription", topic, type_name, by, ends, probe.subscribed(by))


@expectation("{by} offers {service}")
def offers(probe: Probe, service: str, type_name: str, by: str) -> Seen:
    """A service of this type: offered once, by this node."""
    return _ends(probe, "service", service, type_name, by, probe.servers(service), probe.services())


def _ends(
    probe: Probe, what: str, name: str, type_name: str, by: str, ends: list[tuple[str, str]], known: list[str]
) -> Seen:
    if not ends and by not in probe.nodes():
        raise CannotLook(f"there is no node {by}")
    if not ends:
        step = f"Which line makes the {what}, when is it run, and is the name {name} the same in every letter?"
        return Seen(False, f"no node does{probe.like(name, known)}", step)
    types = sorted({kind for _, kind in ends})
    who = [owner for owner, _ in ends]
    if types != [type_name]:
        return Seen(False, f"{listed(sorted(set(who)))} does, as {listed(types)}", f"The type should be {type_name}.")
    if len(ends) > 1:
        return Seen(False, f"{len(ends)} do: {listed(who)}", TOO_MANY)
    if who != [by]:
        return Seen(False, f"{who[0]} does", f"The node should be {by}: super().__init__({by.split('/')[-1]!r}).")
    return Seen(True, f"as {type_name}")


@expectation("{owner} has a parameter {name} = {value!r}")
def parameter(probe: Probe, owner: str, name: str, value: Any) -> Seen:
    """A parameter that a node has declared, with this value and of its type."""
    found = get_parameter(probe, owner, name)
    if found is None:
        return Seen(False, "it is not declared", f"declare_parameter({name!r}, {value!r}) in the node's __init__.")
    if type(found) is not type(value) or found != value:
        step = f"It should be {value!r}: ros2 param set changes it now, the launch file from the start."
        return Seen(False, f"it is {found!r}", step)
    return Seen(True, f"it is {found!r}")


def get_parameter(probe: Probe, owner: str, name: str) -> Any:
    """The value of a node's parameter, None if it has none. Raises CannotLook where the node does not answer."""
    if owner not in probe.nodes():
        raise CannotLook(f"there is no node {owner}")
    if name not in _ask(probe, owner, "list").result.names:
        return None
    values = _ask(probe, owner, "get", names=[name]).values
    return parameter_value_to_python(values[0]) if values else None


def set_parameter(probe: Probe, owner: str, name: str, value: Any) -> None:
    """Set a parameter, which is put back when the probe is over. Raises CannotLook where there is none, or the node refuses."""
    before = get_parameter(probe, owner, name)
    if before is None:
        raise CannotLook(f"{owner} has not declared a parameter {name}")
    old, new = (Parameter(name, value=each).to_parameter_msg() for each in (before, value))
    result = _ask(probe, owner, "set", parameters=[new]).results[0]
    if not result.successful:
        raise CannotLook(f"{owner} refused {name} = {value!r}: {result.reason}")

    def put_back() -> None:
        probe.ask_soon(*_service(owner, "set"), parameters=[old])
        for _ in range(5):
            probe.target.step(0.01)  # also where the time of the check is over

    probe.clean_up.callback(put_back)


def _ask(probe: Probe, owner: str, what: str, **fields: Any) -> Any:
    """The answer of one of a node's parameter services."""
    answer = probe.ask(*_service(owner, what), 1.0, **fields)
    if answer.response is None:
        raise CannotLook(f"{owner} does not answer: is it busy, or not spun?")
    return answer.response


def _service(owner: str, what: str) -> tuple[str, str]:
    return f"{owner}/{what}_parameters", f"rcl_interfaces/srv/{what.capitalize()}Parameters"


ERROR = 40
"""The level from which on a line of the log is an error (rcl_interfaces/msg/Log)."""


@expectation(NO_ERROR)
def no_errors(probe: Probe) -> Seen:
    """Nothing that goes wrong while the check looks: no error in the log, no callback that raises, no node that ends."""
    if set(probe.nodes_before) <= {"/turtlesim"}:
        raise CannotLook("there was no node that could go wrong")
    if probe.now - probe.began < 1.0:
        probe.wait(1.0)  # in which something may go wrong, where the other expectations took less
    if raised := probe.errors():
        raise raised[0]
    wrong = [f"{name}: {text}" for level, name, text in probe.log if level >= ERROR]
    gone = sorted(probe.nodes_before - probe.nodes())
    if gone:
        wrong.append(f"{listed(gone)} ended")
    if not wrong:
        return Seen(True, "none")
    more = f" (and {count(len(wrong) - 1, 'more', 'more')})" if len(wrong) > 1 else ""
    first = shortened(" ".join(wrong[0].split()), 160)
    return Seen(False, first + more, "Read the log: which callback logs it, and when?")


# -- functions of the learner --------------------------------------------------------------------------------------------

Example = tuple[Sequence[Any], Any]
"""The arguments of a call, and what it should return."""


def learner_function(probe: Probe, name: str, file: str = "") -> Callable[..., Any]:
    """The learner's function of this name: from the notebook's cells, or from a file of the package where one is named.

    Call it by `probe.call(function, …)`, so that it is stopped if it computes without end. `file` is one in the package's
    folder of nodes, such as "navigator_node.py"; a probe reads it once. Raises CannotLook where there is no such function, and
    what the file raises where it cannot be read as Python.
    """
    cells = vars(sys.modules["__main__"])
    names = _names_in(probe, file) if file else cells
    place = f"{file} of your package" if file else "this notebook"
    functions = {each: value for each, value in names.items() if callable(value)}
    if name not in functions:
        raise CannotLook(f"there is no function {name} in {place}. {did_you_mean(name, functions)}".strip(" ."))
    return functions[name]


@expectation("{expected}")
def returns(
    probe: Probe,
    name: str,
    examples: Iterable[Example],
    expected: str,
    advice: str | Advice = "",
    *,
    within: float = 0.0,
) -> Seen:
    """The learner's function returns what these examples say; numbers may be off by `within`.

    The first example that it does not meet is shown, with the value that came. What it raises is shown by its line.
    """
    function = learner_function(probe, name)
    said = ""
    for arguments, wanted in examples:
        came = probe.call(function, *arguments)
        said = f"{name}({', '.join(map(_shown, arguments))}) is {_shown(came)}"
        if not agrees(came, wanted, within):
            return Seen(False, f"{said}, not {_shown(wanted)}", advice)
    return Seen(True, said)


def agrees(came: Any, wanted: Any, within: float) -> bool:
    """Whether a value is the wanted one, of its type; a number may be of either type of numbers, and off by `within`."""
    if isinstance(wanted, bool) or not isinstance(wanted, int | float):
        return bool(type(came) is type(wanted) and came == wanted)
    return isinstance(came, int | float) and not isinstance(came, bool) and abs(came - wanted) <= within


def _shown(value: Any) -> str:
    """A value as it is typed; of a float, four decimals at most."""
    return repr(round(value, 4) if isinstance(value, float) else value)


@remembered
def _names_in(probe: Probe, file: str) -> dict[str, Any]:
    """All names that a file of the package makes when it is read; its `main` is not started."""
    path = workspace().nodes / file
    if not path.is_file():
        raise CannotLook(f"there is no file {path.relative_to(workspace().folder.parent).as_posix()}")
    names = {"__name__": path.stem, "__file__": str(path)}
    probe.call(exec, compile(path.read_text(encoding="utf-8"), str(path), "exec"), names)
    return names


# -- messages ----------------------------------------------------------------------------------------------------------


def rate(
    topic: str, type_name: str, hz: float, within: float = 0.010, seconds: float = 3.0, after: float = 0.001
) -> Expectation:
    """Messages at a rate: every interval (s) between two of them is 1/hz, give or take `within`.

    Robot time, s: they are heard for `seconds`, which begin `after` the expectation does: a timer whose node was not spun for
    a while ticks once, late, and then in step.
    """

    def look(probe: Probe) -> Seen:
        probe.listen(topic, type_name)
        probe.wait(after)
        return judge_rate(probe.hear(topic, type_name, seconds), hz, within, len(probe.publishers(topic)))

    milliseconds = f"{number(1000 / hz, 0)} ms ± {number(1000 * within, 0)} ms"
    return Expectation(f"{topic}: a message every {milliseconds}", look)


def gaps_of(times: Iterable[float]) -> list[float]:
    """The times between these, from each to the next."""
    return [after - before for before, after in itertools.pairwise(times)]


def judge_rate(heard: Sequence[Heard], hz: float, within: float, publishers: int = 1) -> Seen:
    """Whether these messages come at a rate, and what to do if not."""
    gaps = gaps_of(each.at for each in heard)
    if not gaps:
        step = "Is there a timer, with which period (in seconds), and does its callback publish?"
        return Seen(False, f"{count(len(heard), 'message')} in that time", step)
    low, high = min(gaps), max(gaps)
    mean = math.fsum(gaps) / len(gaps)
    decimals = 1 if mean >= 0.001 else 4
    seen = f"every {number(1000 * mean, decimals)} ms ({number(1 / mean, 1) if mean else 'infinite'} Hz)"
    if round(high - low, 4):
        seen += f", from {number(1000 * low, 1)} to {number(1000 * high, 1)} ms"
    for factor in (1_000, 1_000_000, 1_000_000_000):
        if 0.9 * mean < 1 / (hz * factor) < 1.1 * mean:
            seen += f": {factor} times too often. Which unit does the period have, seconds or nanoseconds?"
    good = abs(low - 1 / hz) <= within + 1e-9 and abs(high - 1 / hz) <= within + 1e-9
    if publishers > 1:
        return Seen(False, f"{seen}, from {publishers} publishers", "Only one should publish here: stop the other.")
    return Seen(good, seen, _how_to_pace(low, high, mean, hz, high - low > within))


def _how_to_pace(low: float, high: float, mean: float, hz: float, uneven: bool) -> str:
    if uneven and low < 0.01 / hz:
        return f"Several messages come at once, then none for {number(1000 * high, 0)} ms. Send one each time."
    if abs(mean - hz) < 0.01 * hz and hz != 1:
        return "create_timer takes the seconds from one call to the next, not the number of calls a second."
    if uneven:
        return "Something delays the timer's callback. Make that short, or give it a callback group and a thread of its own."
    return "What is the timer's period, in seconds? Where a parameter sets the rate: what is its value?"


@expectation("{expected}")
def messages(probe: Probe, topic: str, type_name: str, expected: str, judge: Callable[[list[Heard]], Seen]) -> Seen:
    """Whatever a function judges of the messages that come in a second (at least one, or they are not looked at)."""
    return judge(some(probe, topic, type_name, 1.0))


def some(probe: Probe, topic: str, type_name: str, seconds: float) -> list[Heard]:
    """The messages of some seconds. Raises CannotLook where none comes."""
    heard = probe.hear(topic, type_name, seconds)
    if not heard:
        raise CannotLook(f"no message came on {topic} in {number(seconds, 1)} s")
    return heard


@expectation("{heard_on} is answered on {said_on}")
def relays(
    probe: Probe,
    heard_on: str,
    heard_type: str,
    said_on: str,
    said_type: str,
    pairs: Sequence[tuple[dict[str, Any], Callable[[Any], bool], str]],
    next_step: str | Advice = "",
) -> Seen:
    """Each message that is put on one topic is answered on another within a second.

    `pairs`: the fields to send, whether a message is the right answer, and both in words ("21 → 42").
    """
    if not probe.subscriptions(heard_on):
        raise CannotLook(f"no node listens to {heard_on}")
    answers = probe.listen(said_on, said_type)
    for fields, right, words in pairs:
        before = len(answers)
        probe.publish(heard_on, heard_type, **fields)
        if not probe.wait_for(lambda: any(right(each.message) for each in answers[before:]), 1.0):  # noqa: B023
            probe.raise_error()
            if len(answers) > before:
                return Seen(False, f"{words}: {brief(answers[-1].message)} came", next_step)
            why = filter(None, (f"{words}: nothing came within 1 s", probe.unreturned()))
            return Seen(False, "; ".join(why), next_step)
    return Seen(True, ", ".join(words for _, _, words in pairs))


def brief(message: Any) -> str:
    """A message in a few words, 120 characters at most: the value of its field where it has but one."""
    names = list(message.get_fields_and_field_types())
    return shortened(repr(getattr(message, names[0])) if len(names) == 1 else str(message), 120)


# -- services, and parameters that change what a node does ----------------------------------------------------------------


@expectation("{expected}")
def answers(
    probe: Probe,
    service: str,
    type_name: str,
    request: dict[str, Any],
    right: Callable[[Any], bool],
    expected: str,
    next_step: str | Advice = "",
) -> Seen:
    """A service answers a request rightly within 2 s. `expected` says both in words: "2 + 3 is 5"."""
    answer = probe.ask(service, type_name, 2.0, **request)
    if answer.response is None:
        return probe.no_answer("no answer within 2 s")
    return Seen(bool(right(answer.response)), brief(answer.response), next_step)


FLOOD = 100
"""Messages in a tenth of a second that no rate of a lesson asks for."""


@expectation("{parameter} set to {value!r}: {topic} at {value:g} Hz")
def rate_follows(probe: Probe, owner: str, parameter: str, value: int | float, topic: str, type_name: str) -> Seen:
    """A rate (Hz) that is really read from a parameter: set it, and the messages come at that rate."""
    probe.listen(topic, type_name)
    set_parameter(probe, owner, parameter, value)
    probe.raise_error()
    if len(probe.hear(topic, type_name, 0.1)) > FLOOD:
        nanoseconds = Advice(
            "The timer's period is next to nothing.",
            "timer_period_ns counts nanoseconds: one second is 1 000 000 000 of them.",
        )
        return Seen(False, f"then more than {FLOOD / 0.1:g} Hz", nanoseconds)
    probe.wait(0.9)  # one interval may still be of the old rate
    heard = probe.hear(topic, type_name, max(1.0, 10.0 / value))
    good, seen, _ = judge_rate(heard, value, 0.1 / value, len(probe.publishers(topic)))
    follow = hinted(
        "When does the node read the parameter, and what happens to the timer's period then?",
        "Open Hints 2 and 3 under the exercise.",
    )
    return Seen(good, f"then {seen}", follow)
