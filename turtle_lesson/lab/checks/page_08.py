"""Page 08: a node that goes on living while it works."""

from __future__ import annotations

import itertools

from ..words import number
from .exam import Exam, Heard
from .parts import get_parameter, no_errors, node, offers, publishes
from .registry import Expectation, check
from .rows import CannotLook, Seen
from .streams import rate

PAGE = "08_executors"
WORK, WORK_TYPE = "/work", "std_srvs/srv/Trigger"
BEAT, BEAT_TYPE = "/heartbeat", "std_msgs/msg/Int32"

LEAST = 1.0
"""Robot time, s, that the work takes at least."""

LONGEST = 20.0
"""Robot time, s, within which it should be done."""


@check("awake", page=PAGE, points=5, limit=40)
def awake() -> list[Expectation]:
    """A worker whose heart beats on while it works, and that still answers."""
    return [
        node("/worker"),
        offers(WORK, WORK_TYPE, by="/worker"),
        publishes(BEAT, BEAT_TYPE, by="/worker"),
        rate(BEAT, BEAT_TYPE, hz=10),
        Expectation(f"{WORK} takes {LEAST:g} s or more, and is answered", _works),
        Expectation(f"{BEAT} goes on meanwhile", _beats),
        Expectation("a parameter call is answered meanwhile", _answers),
        no_errors(),
    ]


_STEP = (
    "One thread runs one callback at a time: await instead of sleeping, with the service in a callback group of its own; "
    "or a MultiThreadedExecutor."
)


def _shift(exam: Exam) -> tuple[float | None, list[Heard], bool]:
    """One request to work: how long until the answer (s), the beats by then, and whether the node answered meanwhile."""
    return exam.once("shift", lambda: _work(exam))


def _work(exam: Exam) -> tuple[float | None, list[Heard], bool]:
    beats = exam.listen(BEAT, BEAT_TYPE)
    exam.wait(0.3)
    first, began = len(beats), exam.now
    answer = exam.ask_soon(WORK, WORK_TYPE)
    exam.wait(0.2)
    try:
        get_parameter(exam, "/worker", "use_sim_time")
        responsive = answer() is None
    except CannotLook:
        responsive = False
    exam.wait_for(answer, LONGEST)
    done = answer()
    ended = done.answered if done else exam.now
    return (
        done.seconds if done else None,
        [beat for beat in beats[first - 1 :] if began - 0.2 <= beat.at <= ended],
        responsive,
    )


def _works(exam: Exam) -> Seen:
    seconds, _, _ = _shift(exam)
    if seconds is None:
        return Seen(False, f"no answer in {LONGEST:g} s", "Does the callback end with `return response`?")
    return Seen(seconds >= LEAST - 0.01, f"answered after {number(seconds)} s", "The work should take its time.")


def _beats(exam: Exam) -> Seen:
    seconds, beats, _ = _shift(exam)
    if seconds is not None and seconds < LEAST - 0.01:
        raise CannotLook("the work is over at once")
    gaps = [after.at - before.at for before, after in itertools.pairwise(beats)]
    silent = max(gaps, default=LONGEST)
    return Seen(silent <= 0.15, f"the longest pause was {number(silent)} s", _STEP)


def _answers(exam: Exam) -> Seen:
    seconds, _, responsive = _shift(exam)
    if seconds is not None and seconds < LEAST - 0.01:
        raise CannotLook("the work is over at once")
    return Seen(responsive, "it was" if responsive else "only when the work was done", _STEP)
