"""Service calls, each with what the trace of callbacks knows of it, and their figures in words."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from .lanes import SHORT
from .recording import NANOSECONDS
from .words import count, number


@dataclass(frozen=True)
class Step:
    """One call, with what the trace of callbacks knows of it. Times are in ns since the lesson's start.

    Attributes:
        call: the call itself.
        callback: the function that served it, if it has begun.
        began, ended: when that ran; None for what has not happened.
        waited: of the same program's other callbacks those that were ready meanwhile and had to wait: how many runs, and
            the longest wait.
    """

    call: Any
    callback: str
    began: int | None
    ended: int | None
    waited: dict[str, tuple[int, int]]


def step_of(trace: Any, call: Any) -> Step:
    """What the trace tells of a call: of those that a server received at one instant, the first was served first."""
    same = [each for each in trace.calls if _received(each) == _received(call)]
    place = same.index(call)
    for callback in trace.callbacks:
        if (callback.process, callback.node, callback.source) != (call.process, call.server, call.service):
            continue
        runs = [*callback.ended, *((*run, None) for run in callback.open)]
        mine = sorted(
            ((began, ended) for ready, began, ended in runs if ready == call.received), key=lambda run: run[0]
        )
        if place < len(mine):
            began, ended = mine[place]
            return Step(call, callback.name, began, ended, _waited(trace, callback, began, ended or trace.now))
    return Step(call, "", None, None, {})


def _received(call: Any) -> tuple[Any, ...]:
    return call.process, call.server, call.service, call.received


def _waited(trace: Any, server: Any, began: int, ended: int) -> dict[str, tuple[int, int]]:
    """The callbacks of the same program that became ready while this one ran, and had to wait for a while."""
    found: dict[str, tuple[int, int]] = {}
    for callback in trace.callbacks:
        if callback.process != server.process:
            continue
        waits = [begin - ready for ready, begin, _ in callback.ended if began <= ready <= ended]
        waits += [trace.now - ready for ready in callback.arrivals or () if began <= ready <= ended]
        if late := [wait for wait in waits if wait >= SHORT]:
            source = callback.source or f"every {callback.period / NANOSECONDS:g} s"
            found[f"{callback.name} ({source})"] = (len(late), max(late))
    return found


def waits_of(step: Step) -> list[tuple[str, tuple[str, int]]]:
    """What had to wait meanwhile: a callback, how often in words, and the longest wait in ns."""
    return [(name, (count(runs, "time"), longest)) for name, (runs, longest) in step.waited.items()]


def clock(time: int) -> str:
    """A time in s of robot time, to the millisecond: "1.000 s"."""
    return f"{number(time / NANOSECONDS, 3)} s"


def after(begin: int, end: int) -> str:
    """How long, in the unit that suits: "0.11 ms", "35.36 s"."""
    lasted = end - begin
    return f"{number(lasted / 1e6)} ms" if lasted < NANOSECONDS // 10 else f"{number(lasted / NANOSECONDS)} s"


def fields(message: Any) -> str:
    """A message's fields and values: "x 5.0, y 5.0, theta 0.0"."""
    values = [f"{name} {_value(getattr(message, name))}" for name in message.get_fields_and_field_types()]
    text = ", ".join(values) or "empty"
    return text if len(text) <= 90 else f"{text[:89]}…"


def _value(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, str):
        return f'"{value}"'
    if hasattr(value, "get_fields_and_field_types"):
        return f"({fields(value)})"
    if hasattr(value, "__len__"):
        return f"[{count(len(value), 'value')}]"
    return str(value)
