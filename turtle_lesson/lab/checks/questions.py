"""Expectations about asking: a service that gives the right answer in time, a parameter that changes what a node does."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ..words import number
from .exam import Exam
from .parts import set_parameter
from .registry import Expectation
from .rows import Advice, Seen
from .streams import brief, judge_rate


def answers(
    service: str,
    type_name: str,
    request: dict[str, Any],
    right: Callable[[Any], bool],
    expected: str,
    next_step: str | Advice = "",
    timeout: float = 2.0,
) -> Expectation:
    """A service answers a request rightly within the timeout (s). `expected` says both in words: "2 + 3 is 5"."""

    def look(exam: Exam) -> Seen:
        answer = exam.ask(service, type_name, timeout, **request)
        if answer.response is None:
            return no_answer(exam, f"no answer within {timeout:g} s")
        return Seen(bool(right(answer.response)), brief(answer.response), next_step)

    return Expectation(expected, look)


def no_answer(exam: Exam, words: str) -> Seen:
    """What is said where a request was not answered: the learner's error comes first, or where its callback still is."""
    exam.raise_error()
    waiting = exam.unreturned()
    direction = "Does the callback end with `return response`?" if not waiting else "What does the callback wait for?"
    return Seen(False, f"{words}; {waiting}" if waiting else words, direction)


def rate_follows(owner: str, parameter: str, value: int | float, topic: str, type_name: str) -> Expectation:
    """A rate (Hz) that is really read from a parameter: set it, and the messages come at that rate."""

    def look(exam: Exam) -> Seen:
        exam.listen(topic, type_name)
        reason = set_parameter(exam, owner, parameter, value)
        if reason:
            return Seen(False, f"it refused: {reason}", f"{value!r} should be allowed for {parameter}.")
        exam.raise_error()
        if len(exam.hear(topic, type_name, 0.1)) > FLOOD:
            return Seen(False, f"then more than {FLOOD / 0.1:g} Hz", NANOSECONDS)
        exam.wait(0.9)  # one interval may still be of the old rate
        heard = exam.hear(topic, type_name, max(1.0, 10.0 / value))
        good, seen, _ = judge_rate(heard, value, 0.1 / value, len(exam.publishers(topic)))
        return Seen(good, f"then {seen}", FOLLOW)

    return Expectation(f"{parameter} set to {value!r}: {topic} at {value:g} Hz", look)


FLOOD = 100
"""Messages in a tenth of a second that no rate of a lesson asks for."""

NANOSECONDS = Advice(
    "The timer's period is next to nothing.",
    "timer_period_ns counts nanoseconds: one second is 1 000 000 000 of them.",
)
FOLLOW = Advice(
    direction="When does the node read the parameter, and what happens to the timer's period then?",
    hint="Open Hints 2 and 3 under the exercise.",
)


def gives_up(owner: str, parameter: str, seconds: float, ask: Callable[[Exam], Any]) -> Expectation:
    """A timeout (s) that is really read: a request that needs longer is answered with success False at that time."""

    def look(exam: Exam) -> Seen:
        reason = set_parameter(exam, owner, parameter, seconds)
        if reason:
            return Seen(False, f"it refused: {reason}", f"{seconds!r} should be allowed for {parameter}.")
        answer = ask(exam)
        if answer.response is None:
            return no_answer(exam, "the goal was never answered")
        good = not answer.response.success and abs(answer.seconds - seconds) <= LATEST
        seen = f"success is {answer.response.success} after {number(answer.seconds)} s"
        step = (
            f"At each step: how long has this goal been under way, and how long may it take, according to {parameter}?"
        )
        return Seen(good, seen, Advice(direction=step, hint="Open Hint 2 under the exercise."))

    return Expectation(f"{parameter} set to {seconds!r}: gives up on a far goal", look)


LATEST = 0.25
"""How far from its time (s) a goal may be given up: two steps of a navigator at 10 Hz, and a little."""
