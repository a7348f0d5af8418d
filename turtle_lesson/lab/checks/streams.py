"""Expectations about messages: how often they come, what is in them, and whether one answers another."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence
from typing import Any

from ..words import count, number
from .failures import shortened
from .probe import Heard, Probe
from .registry import Expectation
from .results import Advice, CannotLook, Seen

Judge = Callable[[list[Heard]], Seen]

CATCH_UP = 0.001
"""Robot time, s, before a rate is measured: a timer whose node was not spun for a while ticks once, late, then in step."""


def rate(
    topic: str, type_name: str, hz: float, within: float = 0.010, seconds: float = 3.0, after: float = CATCH_UP
) -> Expectation:
    """Messages at a rate: every interval (s) between two of them is 1/hz, give or take `within`.

    Robot time, s: they are heard for `seconds`, which begin `after` the expectation does.
    """

    def look(probe: Probe) -> Seen:
        probe.listen(topic, type_name)
        probe.wait(after)
        return judge_rate(probe.hear(topic, type_name, seconds), hz, within, len(probe.publishers(topic)))

    milliseconds = f"{number(1000 / hz, 0)} ms ± {number(1000 * within, 0)} ms"
    return Expectation(f"{topic}: a message every {milliseconds}", look)


def judge_rate(heard: Sequence[Heard], hz: float, within: float, publishers: int = 1) -> Seen:
    """Whether these messages come at a rate, and what to do if not."""
    gaps = [after.at - before.at for before, after in itertools.pairwise(heard)]
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


def messages(topic: str, type_name: str, expected: str, judge: Judge, seconds: float = 2.0) -> Expectation:
    """Whatever a function judges of the messages that come in some seconds (at least one, or they are not looked at)."""

    def look(probe: Probe) -> Seen:
        return judge(some(probe, topic, type_name, seconds))

    return Expectation(expected, look)


def some(probe: Probe, topic: str, type_name: str, seconds: float) -> list[Heard]:
    """The messages of some seconds. Raises CannotLook where none comes."""
    heard = probe.hear(topic, type_name, seconds)
    if not heard:
        raise CannotLook(f"no message came on {topic} in {number(seconds, 1)} s")
    return heard


def relays(
    heard_on: str,
    heard_type: str,
    said_on: str,
    said_type: str,
    pairs: Sequence[tuple[dict[str, Any], Callable[[Any], bool], str]],
    next_step: str | Advice = "",
    timeout: float = 1.0,
) -> Expectation:
    """Each message that is put on one topic is answered on another within the timeout (s).

    `pairs`: the fields to send, whether a message is the right answer, and both in words ("21 → 42").
    """

    def look(probe: Probe) -> Seen:
        if not probe.subscriptions(heard_on):
            raise CannotLook(f"no node listens to {heard_on}")
        answers = probe.listen(said_on, said_type)
        for fields, right, words in pairs:
            before = len(answers)
            probe.publish(heard_on, heard_type, **fields)
            if not probe.wait_for(_any_since(answers, before, right), timeout):
                return _instead(probe, words, [each.message for each in answers[before:]], timeout, next_step)
        return Seen(True, ", ".join(words for _, _, words in pairs))

    return Expectation(f"{heard_on} is answered on {said_on}", look)


def _instead(probe: Probe, words: str, came: list[Any], timeout: float, advice: str | Advice) -> Seen:
    """What is said where the right message did not come: the learner's error, or what came instead."""
    probe.raise_error()
    if came:
        return Seen(False, f"{words}: {brief(came[-1])} came", advice)
    waiting = probe.unreturned()
    nothing = f"{words}: nothing came within {timeout:g} s"
    return Seen(False, f"{nothing}; {waiting}" if waiting else nothing, advice)


MOST_WORDS = 120
"""Characters of a message that are shown."""


def brief(message: Any) -> str:
    """A message in a few words: the value of its field where it has but one."""
    names = list(message.get_fields_and_field_types())
    return shortened(repr(getattr(message, names[0])) if len(names) == 1 else str(message), MOST_WORDS)


def _any_since(answers: list[Heard], before: int, right: Callable[[Any], bool]) -> Callable[[], bool]:
    return lambda: any(right(each.message) for each in answers[before:])
