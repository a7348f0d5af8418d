"""Expectations about nodes: publishers, subscriptions, services and their answers, parameters, a log without errors."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ..words import count, listed, number
from .failures import shortened
from .probe import Probe
from .registry import Expectation
from .results import Advice, CannotLook, Seen, hinted
from .streams import brief, judge_rate

TOO_MANY = "Stop the extra node: Ctrl-C in a terminal; in a notebook run the set-up cell again, then each cell once."
ANSWER_TIME = 1.0
"""Robot time, s, within which a node should say what parameters it has."""


def node(name: str, start: str = "") -> Expectation:
    """One node of this full name, and not two. `start` is the command that starts it."""

    def look(probe: Probe) -> Seen:
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

    return Expectation(f"one node {name}", look)


def publishes(topic: str, type_name: str, by: str) -> Expectation:
    """A topic that is published as this type: by this node, and by no other."""
    step = f"Which line makes the publisher, when is it run, and is the name {topic} the same in every letter?"
    return Expectation(
        f"{by} publishes {topic}",
        lambda probe: _ends(probe, topic, type_name, by, probe.publishers(topic), probe.topics(), step),
    )


def subscribes(topic: str, type_name: str, by: str) -> Expectation:
    """A topic that is subscribed to as this type by this node; others may listen, too."""
    step = f"Which line makes the subscription, when is it run, and is the name {topic} the same in every letter?"

    def look(probe: Probe) -> Seen:
        ends = [end for end in probe.subscriptions(topic) if end[0] == by]
        return _ends(probe, topic, type_name, by, ends, probe.subscribed(by), step)

    return Expectation(f"{by} listens to {topic}", look)


def offers(service: str, type_name: str, by: str) -> Expectation:
    """A service of this type: offered once, by this node."""
    step = f"Which line makes the service, when is it run, and is the name {service} the same in every letter?"
    return Expectation(
        f"{by} offers {service}",
        lambda probe: _ends(probe, service, type_name, by, probe.servers(service), probe.services(), step),
    )


def _ends(
    probe: Probe, name: str, type_name: str, by: str, ends: list[tuple[str, str]], known: list[str], step: str
) -> Seen:
    if not ends and by not in probe.nodes():
        raise CannotLook(f"there is no node {by}")
    if not ends:
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


# -- parameters --------------------------------------------------------------------------------------------------------


def parameter(owner: str, name: str, value: Any) -> Expectation:
    """A parameter that a node has declared, with this value and of its type."""

    def look(probe: Probe) -> Seen:
        found = get_parameter(probe, owner, name)
        if found is None:
            return Seen(False, "it is not declared", f"declare_parameter({name!r}, {value!r}) in the node's __init__.")
        if type(found) is not type(value) or found != value:
            step = f"It should be {value!r}: ros2 param set changes it now, the launch file from the start."
            return Seen(False, f"it is {found!r}", step)
        return Seen(True, f"it is {found!r}")

    return Expectation(f"{owner} has a parameter {name} = {value!r}", look)


def get_parameter(probe: Probe, owner: str, name: str) -> Any:
    """The value of a node's parameter, None if it has none. Raises CannotLook where the node does not answer."""
    from ..widgets.parameters import to_python

    if owner not in probe.nodes():
        raise CannotLook(f"there is no node {owner}")
    if name not in _ask(probe, owner, "list").result.names:
        return None
    values = _ask(probe, owner, "get", names=[name]).values
    return to_python(values[0]) if values else None


def set_parameter(probe: Probe, owner: str, name: str, value: Any) -> str:
    """Set a parameter; returns why the node refused, or "". It is put back when the probe is over."""
    from rclpy.parameter import Parameter

    before = get_parameter(probe, owner, name)
    if before is None:
        raise CannotLook(f"{owner} has not declared a parameter {name}")
    old, new = (Parameter(name, value=each).to_parameter_msg() for each in (before, value))
    results = _ask(probe, owner, "set", parameters=[new]).results
    if not (results and results[0].successful):
        return (results[0].reason if results else "") or "it gave no reason"

    def put_back() -> None:
        probe.ask_soon(*_service(owner, "set"), parameters=[old])
        for _ in range(5):
            probe.target.step(0.01)  # also where the time of the check is over

    probe.at_the_end(put_back)
    return ""


def _ask(probe: Probe, owner: str, what: str, **fields: Any) -> Any:
    """The answer of one of a node's parameter services."""
    answer = probe.ask(*_service(owner, what), ANSWER_TIME, **fields)
    if answer.response is None:
        raise CannotLook(f"{owner} does not answer: is it busy, or not spun?")
    return answer.response


def _service(owner: str, what: str) -> tuple[str, str]:
    return f"{owner}/{what}_parameters", f"rcl_interfaces/srv/{what.capitalize()}Parameters"


# -- the log -----------------------------------------------------------------------------------------------------------

NO_ERROR = "no error meanwhile"
"""What is expected of every learner's code, whatever else a check expects."""

A_WHILE = 1.0
"""Robot time, s, in which something may go wrong, where the other expectations took less."""

ERROR = 40
"""The level from which on a line of the log is an error (rcl_interfaces/msg/Log)."""


def no_errors() -> Expectation:
    """Nothing that goes wrong while the check looks: no error in the log, no callback that raises, no node that ends."""

    def look(probe: Probe) -> Seen:
        if set(probe.nodes_before) <= {"/turtlesim"}:
            raise CannotLook("there was no node that could go wrong")
        if probe.now - probe.began < A_WHILE:
            probe.wait(A_WHILE)
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

    return Expectation(NO_ERROR, look)


# -- services, and parameters that change what a node does ----------------------------------------------------------------


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

    def look(probe: Probe) -> Seen:
        answer = probe.ask(service, type_name, timeout, **request)
        if answer.response is None:
            return no_answer(probe, f"no answer within {timeout:g} s")
        return Seen(bool(right(answer.response)), brief(answer.response), next_step)

    return Expectation(expected, look)


def no_answer(probe: Probe, words: str) -> Seen:
    """What is said where a request was not answered: the learner's error comes first, or where its callback still is."""
    probe.raise_error()
    waiting = probe.unreturned()
    direction = "Does the callback end with `return response`?" if not waiting else "What does the callback wait for?"
    return Seen(False, f"{words}; {waiting}" if waiting else words, direction)


def rate_follows(owner: str, parameter: str, value: int | float, topic: str, type_name: str) -> Expectation:
    """A rate (Hz) that is really read from a parameter: set it, and the messages come at that rate."""

    def look(probe: Probe) -> Seen:
        probe.listen(topic, type_name)
        reason = set_parameter(probe, owner, parameter, value)
        if reason:
            return Seen(False, f"it refused: {reason}", f"{value!r} should be allowed for {parameter}.")
        probe.raise_error()
        if len(probe.hear(topic, type_name, 0.1)) > FLOOD:
            return Seen(False, f"then more than {FLOOD / 0.1:g} Hz", NANOSECONDS)
        probe.wait(0.9)  # one interval may still be of the old rate
        heard = probe.hear(topic, type_name, max(1.0, 10.0 / value))
        good, seen, _ = judge_rate(heard, value, 0.1 / value, len(probe.publishers(topic)))
        return Seen(good, f"then {seen}", FOLLOW)

    return Expectation(f"{parameter} set to {value!r}: {topic} at {value:g} Hz", look)


FLOOD = 100
"""Messages in a tenth of a second that no rate of a lesson asks for."""

NANOSECONDS = Advice(
    "The timer's period is next to nothing.",
    "timer_period_ns counts nanoseconds: one second is 1 000 000 000 of them.",
)
FOLLOW = hinted(
    "When does the node read the parameter, and what happens to the timer's period then?",
    "Open Hints 2 and 3 under the exercise.",
)


def gives_up(owner: str, parameter: str, seconds: float, ask: Callable[[Probe], Any]) -> Expectation:
    """A timeout (s) that is really read: a request that needs longer is answered with success False at that time."""

    def look(probe: Probe) -> Seen:
        reason = set_parameter(probe, owner, parameter, seconds)
        if reason:
            return Seen(False, f"it refused: {reason}", f"{seconds!r} should be allowed for {parameter}.")
        answer = ask(probe)
        if answer.response is None:
            return no_answer(probe, "the goal was never answered")
        good = not answer.response.success and abs(answer.seconds - seconds) <= LATEST
        seen = f"success is {answer.response.success} after {number(answer.seconds)} s"
        step = (
            f"At each step: how long has this goal been under way, and how long may it take, according to {parameter}?"
        )
        return Seen(good, seen, hinted(step, 2))

    return Expectation(f"{parameter} set to {seconds!r}: gives up on a far goal", look)


LATEST = 0.25
"""How far from its time (s) a goal may be given up: two steps of a navigator at 10 Hz, and a little."""
