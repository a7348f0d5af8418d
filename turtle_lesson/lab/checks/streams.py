"""Expectations about messages and requests: how often they come, what is in them, and how they are answered."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterable, Sequence
from typing import Any

from ..words import count, number
from .assertions import set_parameter
from .probe import Answer, Heard, Probe
from .registry import Expectation, expectation
from .results import Advice, CannotLook, Seen, hinted, shortened


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
    if wrong := _wrong_unit(mean, hz):
        seen += f": {wrong}"
    good = abs(low - 1 / hz) <= within + 1e-9 and abs(high - 1 / hz) <= within + 1e-9
    if publishers > 1:
        return Seen(False, f"{seen}, from {publishers} publishers", "Only one should publish here: stop the other.")
    return Seen(good, seen, _how_to_pace(low, high, mean, hz, high - low > within))


def _wrong_unit(mean: float, hz: float) -> str:
    """What a rate (messages come every `mean` s) that is wrong by thousands may come from; "" for any other rate."""
    ratio = 1 / (mean * hz) if mean else math.inf
    for factor in (1_000, 1_000_000, 1_000_000_000):
        if 0.9 < ratio / factor < 1.1:
            return f"{factor} times too often. Which unit does the period have, seconds or nanoseconds?"
    return ""


def _how_to_pace(low: float, high: float, mean: float, hz: float, uneven: bool) -> str:
    if uneven and low < 0.01 / hz:
        return f"Several messages come at once, then none for {number(1000 * high, 0)} ms. Send one each time."
    if abs(mean - hz) < 0.01 * hz and hz != 1:
        return "create_timer takes the seconds from one call to the next, not the number of calls a second."
    if uneven:
        return "Something delays the timer's callback. Make that short, or give it a callback group and a thread of its own."
    return "What is the timer's period, in seconds? Where a parameter sets the rate: what is its value?"


@expectation("{expected}")
def messages(
    probe: Probe, topic: str, type_name: str, expected: str, judge: Callable[[list[Heard]], Seen], seconds: float = 2.0
) -> Seen:
    """Whatever a function judges of the messages that come in some seconds (at least one, or they are not looked at)."""
    return judge(some(probe, topic, type_name, seconds))


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
        if not probe.wait_for(_any_since(answers, before, right), 1.0):
            return _instead(probe, words, [each.message for each in answers[before:]], next_step)
    return Seen(True, ", ".join(words for _, _, words in pairs))


def _any_since(answers: list[Heard], before: int, right: Callable[[Any], bool]) -> Callable[[], bool]:
    return lambda: any(right(each.message) for each in answers[before:])


def _instead(probe: Probe, words: str, came: list[Any], advice: str | Advice) -> Seen:
    """What is said where the right message did not come: the learner's error, or what came instead."""
    probe.raise_error()
    if came:
        return Seen(False, f"{words}: {brief(came[-1])} came", advice)
    return Seen(False, "; ".join(filter(None, (f"{words}: nothing came within 1 s", probe.unreturned()))), advice)


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
        return no_answer(probe, "no answer within 2 s")
    return Seen(bool(right(answer.response)), brief(answer.response), next_step)


def no_answer(probe: Probe, words: str) -> Seen:
    """What is said where a request was not answered: the learner's error comes first, or where its callback still is."""
    probe.raise_error()
    if waiting := probe.unreturned():
        return Seen(False, f"{words}; {waiting}", "What does the callback wait for?")
    return Seen(False, words, "Does the callback end with `return response`?")


def told(answer: Answer) -> str:
    """What an answer says of its success, and when it came."""
    return f"success is {answer.response.success} after {number(answer.seconds)} s"


FLOOD = 100
"""Messages in a tenth of a second that no rate of a lesson asks for."""


@expectation("{parameter} set to {value!r}: {topic} at {value:g} Hz")
def rate_follows(probe: Probe, owner: str, parameter: str, value: int | float, topic: str, type_name: str) -> Seen:
    """A rate (Hz) that is really read from a parameter: set it, and the messages come at that rate."""
    probe.listen(topic, type_name)
    reason = set_parameter(probe, owner, parameter, value)
    if reason:
        return Seen(False, f"it refused: {reason}", f"{value!r} should be allowed for {parameter}.")
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
