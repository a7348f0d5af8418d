"""A service call as a sequence diagram, from what really happened: which node asked, when it was received, when answered."""

from __future__ import annotations

import difflib
from collections.abc import Sequence
from typing import Any

from .call_steps import Step, after, clock, fields, step_of, waits_of
from .graph import GraphPicture
from .lanes import SHORT, Window, window_of
from .recording import NANOSECONDS
from .sequence_drawing import draw_sequence
from .sequence_text import sequence_diagram
from .system import PARAMETER_SERVICES
from .words import count, listed, number

MOST = 8
"""How many calls one diagram shows, the newest."""


def plot_sequence(trace: Any, *services: str, since: float | None = None, until: float | None = None) -> GraphPicture:
    """Return the newest calls of some services (of all but the parameters' if none is named) as a diagram and in words.

    `since` and `until` are in seconds since the lesson's start: when a call was asked.

    Raises TypeError or ValueError for what is no service, or none that was called, with those that were.
    """
    window = window_of(trace.now, since, until)
    names = [_full_name(name) for name in services]
    called = [call for call in trace.calls if _wanted(call, names)]
    calls = [call for call in called if window.begin <= call.asked <= window.end]
    if not calls:
        return GraphPicture(_nothing(trace, names, called, window))
    steps = [step_of(trace, call) for call in calls[-MOST:]]
    text = _describe(steps, len(calls))
    title = f"Calls of {listed(_services(steps))}"
    return GraphPicture(text, sequence_diagram(steps, title, text), draw_sequence(steps, title, text))


def _full_name(name: Any) -> str:
    if not isinstance(name, str) or not name.strip("/ "):
        raise TypeError(f'a service is named as in `ros2 service list`, such as "/navigate_to", got {name!r}')
    return f"/{name.strip().lstrip('/')}"


def _wanted(call: Any, names: Sequence[str]) -> bool:
    return call.service in names if names else call.service.split("/")[-1] not in PARAMETER_SERVICES


def _services(steps: Sequence[Step]) -> list[str]:
    return list(dict.fromkeys(step.call.service for step in steps))


def _nothing(trace: Any, names: list[str], called: Sequence[Any], window: Window) -> str:
    what = listed(names) if names else "a service"
    if called:
        when = f"{number(called[0].asked / NANOSECONDS)} s and {number(called[-1].asked / NANOSECONDS)} s"
        return f"No node called {what} from {window.seconds}: the calls were between {when}."
    others = sorted({call.service for call in trace.calls})
    close = difflib.get_close_matches(names[0], others, 1, 0.6) if names else []
    meant = f" Did you mean {close[0]}?" if close else ""
    return f"No node has called {what} yet.{meant} Try: ros2 service call {names[0] if names else '/navigate_to'} …"


# -- in words ----------------------------------------------------------------------------------------------------------


def _describe(steps: Sequence[Step], calls: int) -> str:
    shown = count(calls, "call") if calls == len(steps) else f"The last {len(steps)} of {count(calls, 'call')}"
    return " ".join([f"{shown} of {listed(_services(steps))}.", *map(_sentence, steps)])


def _sentence(step: Step) -> str:
    call = step.call
    parts = [f"At {clock(call.asked)} {call.caller} asked {call.service} ({fields(call.request)})"]
    if call.received is None:
        parts.append("no node received it" if not call.server else "")
    else:
        parts.append(f"{call.server} received it {after(call.asked, call.received)} later")
        if step.began is None:
            parts.append("no callback has begun yet")
        elif step.began - call.received >= SHORT:
            parts.append(f"{step.callback} began after a wait of {after(call.received, step.began)}")
    if call.answered is not None:
        parts.append(f"answered after {after(call.asked, call.answered)} ({fields(call.response)})")
    elif call.received is not None:
        parts.append("has not answered yet")
    meanwhile = [f"{name} {times}, at most {after(0, longest)}" for name, (times, longest) in waits_of(step)]
    if meanwhile:
        parts.append(f"had to wait meanwhile: {listed(meanwhile)}")
    return f"{'; '.join(filter(None, parts))}."
