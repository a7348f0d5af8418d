"""A Mermaid sequence diagram of service calls. The language: https://mermaid.js.org/syntax/sequenceDiagram.html."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import NamedTuple

from .call_steps import Step, after, clock, fields, waits_of
from .lanes import SHORT
from .mermaid import THEME

SETTINGS = (
    f'%%{{init: {{{THEME}, "sequence": {{"actorMargin": 60, "width": 150, "height": 44, "boxMargin": 6, "noteMargin": 8, '
    '"messageMargin": 34, "mirrorActors": false, "wrap": true}}}%%'
)
"""Closer together than Mermaid's own, so that two or three programs fit beside one another on a narrow page."""


ARROWS = {"call": "{0}->>{1}: {2}", "answer": "{0}-->>{1}: {2}", "lost": "{0}-x{0}: {2}", "note": "Note over {0}: {2}"}
"""How each kind of event is written, besides "activate" and "deactivate"."""


class Event(NamedTuple):
    """One line of the diagram. `kind` is "call", "answer", "lost", "note", "activate" or "deactivate".

    <br/> separates the lines of `text`.
    """

    kind: str
    of: str
    to: str = ""
    text: str = ""


def sequence_diagram(steps: Sequence[Step], title: str, description: str) -> str:
    """Return the Mermaid text: a lifeline for each program, an arrow for each message. `title` and `description` are for
    readers who cannot see it.
    """
    letters = {name: f"p{number}" for number, name in enumerate(programs_of(steps))}
    lines = [SETTINGS, "sequenceDiagram", f"accTitle: {_plain(title)}", f"accDescr: {_plain(description)}"]
    lines += [f"participant {letters[name]} as {_escaped(name)}" for name in letters]
    for kind, of, to, text in events_of(steps):
        form = ARROWS.get(kind, f"{kind} {{0}}")
        lines.append(form.format(letters[of], letters.get(to), _label(text)))
    return "\n".join([*lines, ""])


def programs_of(steps: Sequence[Step]) -> list[str]:
    """The names of the programs that take part, in the order in which they first do."""
    return list(dict.fromkeys(name for step in steps for name in (step.call.caller, step.call.server) if name))


def events_of(steps: Sequence[Step]) -> list[Event]:
    """All events in the order of their times; those of one call at the same time stay together."""
    timed = [each for step in steps for each in _events(step)]
    return [event for _, event in sorted(timed, key=lambda each: each[0])]


def _events(step: Step) -> list[tuple[int, Event]]:
    """The events of one call with their times (ns)."""
    call = step.call
    asked = f"{clock(call.asked)}: {call.service}<br/>{fields(call.request)}"
    if not call.server:
        lost = Event("lost", call.caller, text=asked)
        return [(call.asked, lost), (call.asked, Event("note", call.caller, text="no node received it"))]
    events = [(call.asked, Event("call", call.caller, call.server, asked))]
    if step.began is None:
        return [*events, (call.asked, Event("note", call.server, text="waits: no callback has begun yet"))]
    events.append((step.began, Event("activate", call.server)))
    events.append((step.began, Event("note", call.server, text=_begin(step))))
    return events + _end(step)


def _begin(step: Step) -> str:
    waited = (step.began or 0) - step.call.received
    return f"{step.callback} begins" + (f", after a wait of {after(0, waited)}" if waited >= SHORT else "")


def _end(step: Step) -> list[tuple[int, Event]]:
    call = step.call
    end = call.answered if call.answered is not None else 2**62
    events = [
        Event("note", call.server, text=f"{name} waits {times}, at most {after(0, longest)}")
        for name, (times, longest) in waits_of(step)
    ]
    if call.answered is None:
        events.append(Event("note", call.server, text="no answer yet"))
    else:
        answer = f"{clock(call.answered)}: answer after {after(call.asked, call.answered)}<br/>{fields(call.response)}"
        events.append(Event("answer", call.server, call.caller, answer))
    return [(end, event) for event in [*events, Event("deactivate", call.server)]]


def _label(text: str) -> str:
    """Text of a message or a note: line breaks stay, what has a meaning in Mermaid becomes a code."""
    return "<br/>".join(_escaped(line) for line in text.split("<br/>"))


def _escaped(text: str) -> str:
    """Text in which what has a meaning in Mermaid is a code: signs, and the first letter of the word `end`."""
    return re.sub(r"[^A-Za-z0-9/ _.,:()-]|\be(?=nd\b)", lambda match: f"#{ord(match.group())};", text)


def _plain(text: str) -> str:
    """Text for a line of its own, in which `#` and `;` would have a meaning."""
    return re.sub(r"[#;{}<>\n]+", ",", text)
