"""A service call as a sequence diagram, from what really happened: which node asked, when it was received, when answered."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Sequence
from itertools import chain
from operator import attrgetter, itemgetter
from typing import Any, NamedTuple

from ..ros.rmw.trace import Call, Callback, Trace
from . import drawing
from .graph import LOOKS, PARAMETER_SERVICES, THEME, GraphPicture, plain_line
from .recording import NANOSECONDS
from .timeline import SHORT, Window, window_of
from .words import count, did_you_mean, listed, number, shortened

MOST = 8
"""How many calls one diagram shows, the newest."""


def plot_sequence(trace: Trace, *services: str, since: float | None = None, until: float | None = None) -> GraphPicture:
    """What `Lesson.plot_sequence` returns: the newest calls as a diagram and in words.

    Raises TypeError or ValueError for what is no service, or none that was called, with those that were.
    """
    window = window_of(trace.now, since, until)
    for name in services:
        if not isinstance(name, str) or not name.strip("/ "):
            raise TypeError(f'a service is named as in `ros2 service list`, such as "/navigate_to", got {name!r}')
    names = [f"/{name.strip().lstrip('/')}" for name in services]
    wanted = names or {call.service for call in trace.calls if call.service.split("/")[-1] not in PARAMETER_SERVICES}
    called = [call for call in trace.calls if call.service in wanted]
    calls = [call for call in called if window.begin <= call.asked <= window.end]
    if not calls:
        return GraphPicture(_nothing(trace, names, called, window))
    steps = [step_of(trace, call) for call in calls[-MOST:]]
    what = listed(list(dict.fromkeys(step.call.service for step in steps)))
    shown = count(len(calls), "call")
    if len(calls) > len(steps):
        shown = f"The last {len(steps)} of {shown}"
    text = " ".join([f"{shown} of {what}.", *map(_sentence, steps)])
    programs = list(dict.fromkeys(name for step in steps for name in (step.call.caller, step.call.server) if name))
    events = [event for _, event in sorted(chain(*map(_events, steps)), key=itemgetter(0))]
    shown_as = programs, events, f"Calls of {what}", text
    return GraphPicture(text, sequence_diagram(*shown_as), draw_sequence(*shown_as))


def _nothing(trace: Trace, names: list[str], called: Sequence[Call], window: Window) -> str:
    what = listed(names) if names else "a service"
    if called:
        when = f"{number(called[0].asked / NANOSECONDS)} s and {number(called[-1].asked / NANOSECONDS)} s"
        return f"No node called {what} from {window.seconds}: the calls were between {when}."
    others = sorted({call.service for call in trace.calls})
    meant = did_you_mean(names[0], others) if names else ""
    hint = f"Try: ros2 service call {names[0] if names else '/navigate_to'} …"
    return " ".join(filter(None, [f"No node has called {what} yet.", meant, hint]))


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
    if step.waited:
        meanwhile = listed([f"{name} {how}" for name, how in step.waited])
        parts.append(f"had to wait meanwhile: {meanwhile}")
    return f"{'; '.join(filter(None, parts))}."


class Step(NamedTuple):
    """One call, with what the trace of callbacks knows of it. Times are in ns since the lesson's start."""

    call: Call
    callback: str = ""
    """The function that served it, if it has begun."""
    began: int | None = None
    waited: Sequence[tuple[str, str]] = ()
    """Of the same program's other callbacks those that were ready meanwhile and had to wait: how often and how long."""


def step_of(trace: Trace, call: Call) -> Step:
    """What the trace tells of a call: of those that a server received at one instant, the first was served first."""
    received = attrgetter("process", "server", "service", "received")
    place = [each for each in trace.calls if received(each) == received(call)].index(call)
    for callback in trace.callbacks:
        if (callback.process, callback.node, callback.source) != (call.process, call.server, call.service):
            continue
        runs = [*callback.ended, *((*run, None) for run in callback.open)]
        mine = sorted(((began, ended) for ready, began, ended in runs if ready == call.received), key=itemgetter(0))
        if place < len(mine):
            began, ended = mine[place]
            return Step(call, callback.name, began, _waited(trace, callback, began, ended or trace.now))
    return Step(call)


def _waited(trace: Trace, server: Callback, began: int, ended: int) -> list[tuple[str, str]]:
    """The callbacks of the same program that became ready while this one ran, and had to wait for a while."""
    found: dict[str, str] = {}
    for callback in trace.callbacks:
        if callback.process != server.process:
            continue
        waits = [begin - ready for ready, begin, _ in callback.ended if began <= ready <= ended]
        waits += [trace.now - ready for ready in callback.arrivals or () if began <= ready <= ended]
        if late := [wait for wait in waits if wait >= SHORT]:
            source = callback.source or f"every {callback.period / NANOSECONDS:g} s"
            found[f"{callback.name} ({source})"] = f"{count(len(late), 'time')}, at most {after(0, max(late))}"
    return list(found.items())


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
    return shortened(", ".join(values) or "empty", 90)


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


class Event(NamedTuple):
    """One line of the diagram. `kind` is "call", "answer", "note", "activate" or "deactivate".

    <br/> separates the lines of `text`.
    """

    kind: str
    of: str
    to: str = ""
    text: str = ""


def _events(step: Step) -> list[tuple[int, Event]]:
    """The events of one call with their times (ns), in the order in which those of one time stay."""
    call, server = step.call, step.call.server
    asked = f"{clock(call.asked)}: {call.service}<br/>{fields(call.request)}"
    if not server:
        return [(call.asked, Event("note", call.caller, text=f"{asked}<br/>no node received it"))]
    question = call.asked, Event("call", call.caller, server, asked)
    if step.began is None or call.received is None:
        return [question, (call.asked, Event("note", server, text="waits: no callback has begun yet"))]
    waited = step.began - call.received
    begins = f"{step.callback} begins" + (f", after a wait of {after(0, waited)}" if waited >= SHORT else "")
    first = [Event("activate", server), Event("note", server, text=begins)]
    last = [Event("note", server, text=f"{name} waits {how}") for name, how in step.waited]
    if (end := call.answered) is None:
        end = 2**62
        last.append(Event("note", server, text="no answer yet"))
    else:
        answer = f"{clock(end)}: answer after {after(call.asked, end)}<br/>{fields(call.response)}"
        last.append(Event("answer", server, call.caller, answer))
    last.append(Event("deactivate", server))
    return [question, *((step.began, event) for event in first), *((end, event) for event in last)]


SIZE, LINE = 12.0, 15.0
"""Pixels of a text, and from line to line."""
APART, EDGE, TOP = 290.0, 120.0, 44.0
"""Pixels between two programs, beside the outer ones, and above the first event."""
LONGEST = 38
"""Characters of a line."""


def draw_sequence(programs: Sequence[str], events: Sequence[Event], title: str, description: str) -> str:
    """Return the drawing of these events as SVG; its title and description are for readers who cannot see it."""
    places = {name: EDGE + APART * at for at, name in enumerate(programs)}
    busy: dict[str, list[float]] = {}
    parts, bars, y = [], [], TOP
    for event in events:
        x = places[event.of]
        if event.kind == "activate":
            busy.setdefault(event.of, []).append(y)
        elif event.kind == "deactivate":  # while a callback runs, or waits, there is a bar
            begin = busy[event.of].pop()
            size = f'y="{number(begin, 1)}" width="8" height="{number(y - begin, 1)}"'
            bars.append(f'<rect x="{x - 4:g}" {size} fill="{drawing.GREEN}" opacity="0.7"/>')
        else:
            lines = [line for part in event.text.split("<br/>") for line in textwrap.wrap(part, LONGEST)]
            y += LINE * len(lines) + 14
            parts.append(_draw(event, x, places.get(event.to, x), y, lines))
            y += 6
    y += 12
    look = f'stroke="{drawing.EDGE}" stroke-width="1.2"'
    columns = [f'<path d="M{x:g},30V{number(y, 1)}" {look}/>' for x in places.values()]
    heads = [_box(x, 6, drawing.text_width(name, 12.5) + 24, 24, [name], "nodes") for name, x in places.items()]
    width = 2 * EDGE + APART * (len(programs) - 1)
    return drawing.document(round(width), round(y + 4), title, description, [*columns, *bars, *parts, *heads])


def _draw(event: Event, x: float, to: float, y: float, lines: list[str]) -> str:
    """One event; `y` is where its arrow is, or where its note ends."""
    if event.kind == "note":
        width = max(drawing.text_width(line, SIZE) for line in lines) + 16
        top = y - LINE * len(lines) - 4
        return _box(x, top, width, LINE * len(lines) + 8, lines, "services")
    side = 1 if to > x else -1
    dash = ' stroke-dasharray="5 4"' if event.kind == "answer" else ""
    stop = to - 12 * side
    head = f"M{to - 4 * side:g},{number(y, 1)}l{-9 * side},-4.5v9Z"
    arrow = (
        f'<path d="M{x + 4 * side:g},{number(y, 1)}H{stop:g}" stroke="{drawing.INK}" stroke-width="1.5"{dash}/>'
        f'<path d="{head}" fill="{drawing.INK}"/>'
    )
    first = y - 6 - LINE * (len(lines) - 1)
    return arrow + "".join(drawing.text((x + to) / 2, first + LINE * at, line, SIZE) for at, line in enumerate(lines))


def _box(x: float, top: float, width: float, height: float, lines: list[str], kind: str) -> str:
    """Lines of text in a box that looks like those of this kind in the graph, with the same dark text in both kinds."""
    fill, edge, _ = LOOKS[kind]
    ink = LOOKS["nodes"][2]
    frame = drawing.sizes(x=x - width / 2, y=top, width=width, height=height)
    first = top + height / 2 + 4.5 - LINE * (len(lines) - 1) / 2
    written = "".join(drawing.text(x, first + LINE * at, line, SIZE, fill=ink) for at, line in enumerate(lines))
    return f'<rect {frame} rx="4" fill="{fill}" stroke="{edge}"/>{written}'


SETTINGS = (
    f'%%{{init: {{{THEME}, "sequence": {{"actorMargin": 60, "width": 150, "height": 44, "boxMargin": 6, "noteMargin": 8, '
    '"messageMargin": 34, "mirrorActors": false, "wrap": true}}}%%'
)
"""Closer together than Mermaid's own, so that two or three programs fit beside one another on a narrow page."""


ARROWS = {"call": "{0}->>{1}: {2}", "answer": "{0}-->>{1}: {2}", "note": "Note over {0}: {2}"}
"""How each kind of event is written, besides "activate" and "deactivate"."""


def sequence_diagram(programs: Sequence[str], events: Sequence[Event], title: str, description: str) -> str:
    """Return the same in Mermaid's language (https://mermaid.js.org/syntax/sequenceDiagram.html)."""
    letters = {name: f"p{place}" for place, name in enumerate(programs)}
    lines = [SETTINGS, "sequenceDiagram", f"accTitle: {plain_line(title)}", f"accDescr: {plain_line(description)}"]
    lines += [f"participant {letters[name]} as {_escaped(name)}" for name in letters]
    for kind, of, to, text in events:
        form = ARROWS.get(kind, f"{kind} {{0}}")
        label = "<br/>".join(_escaped(line) for line in text.split("<br/>"))
        lines.append(form.format(letters[of], letters.get(to), label))
    return "\n".join([*lines, ""])


def _escaped(text: str) -> str:
    """Text in which what has a meaning in Mermaid is a code: signs, and the first letter of the word `end`."""
    return re.sub(r"[^A-Za-z0-9/ _.,:()-]|\be(?=nd\b)", lambda match: f"#{ord(match.group())};", text)
