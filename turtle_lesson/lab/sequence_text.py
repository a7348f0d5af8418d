"""A Mermaid sequence diagram of service calls. The language: https://mermaid.js.org/syntax/sequenceDiagram.html."""

from __future__ import annotations

import re
from collections.abc import Sequence

from .call_steps import Step, after, clock, fields, waits_of
from .lanes import SHORT

SETTINGS = (
    '%%{init: {"sequence": {"actorMargin": 60, "width": 150, "height": 44, "boxMargin": 6, "noteMargin": 8, '
    '"messageMargin": 34, "mirrorActors": false, "wrap": true}}}%%'
)
"""Closer together than Mermaid's own, so that two or three programs fit beside one another on a narrow page."""


def sequence_diagram(steps: Sequence[Step], title: str, description: str) -> str:
    """Return the Mermaid text: a lifeline a program, an arrow a message; `title` and `description` for who cannot see."""
    names = list(dict.fromkeys(name for step in steps for name in (step.call.caller, step.call.server) if name))
    letters = {name: f"p{number}" for number, name in enumerate(names)}
    lines = [SETTINGS, "sequenceDiagram", f"accTitle: {_plain(title)}", f"accDescr: {_plain(description)}"]
    lines += [f"participant {letters[name]} as {_escaped(name)}" for name in names]
    lines += [line for _, _, line in sorted(_events(steps, letters))]
    return "\n".join([*lines, ""])


Event = tuple[int, int, str]


def _events(steps: Sequence[Step], letters: dict[str, str]) -> list[Event]:
    """All lines with their times (ns) and an order for those of one time; nothing of a later call comes in between."""
    events: list[tuple[int, str]] = []
    for step in steps:
        call = step.call
        caller, server = letters[call.caller], letters.get(call.server)
        asked = f"{clock(call.asked)}: {call.service}<br/>{fields(call.request)}"
        if server is None:
            events.append((call.asked, f"{caller}-x{caller}: {_label(asked)}"))
            events.append((call.asked, f"Note over {caller}: {_label('nobody received it')}"))
            continue
        events.append((call.asked, f"{caller}->>{server}: {_label(asked)}"))
        if step.began is None:
            events.append((call.asked, f"Note over {server}: {_label('waits: no callback has begun yet')}"))
            continue
        events.append((step.began, f"activate {server}"))
        events.append((step.began, f"Note over {server}: {_label(_begin(step))}"))
        events += _end(step, caller, server)
    return [(time, order, line) for order, (time, line) in enumerate(events)]


def _begin(step: Step) -> str:
    waited = (step.began or 0) - step.call.received
    return f"{step.callback} begins" + (f", after a wait of {after(0, waited)}" if waited >= SHORT else "")


def _end(step: Step, caller: str, server: str) -> list[tuple[int, str]]:
    call = step.call
    end = call.answered if call.answered is not None else 2**62
    events = [
        (end, f"Note over {server}: {_label(f'{name} waits {times}, at most {after(0, longest)}')}")
        for name, (times, longest) in waits_of(step)
    ]
    if call.answered is None:
        return [*events, (end, f"Note over {server}: {_label('no answer yet')}"), (end, f"deactivate {server}")]
    answer = f"{clock(call.answered)}: answer after {after(call.asked, call.answered)}<br/>{fields(call.response)}"
    return [*events, (end, f"{server}-->>{caller}: {_label(answer)}"), (end, f"deactivate {server}")]


def _label(text: str) -> str:
    """Text of a message or a note: line breaks stay, what has a meaning in Mermaid becomes a code."""
    return "<br/>".join(_escaped(line) for line in text.split("<br/>"))


def _escaped(text: str) -> str:
    """Text in which what has a meaning in Mermaid is a code: signs, and the first letter of the word `end`."""
    return re.sub(r"[^A-Za-z0-9/ _.,:()-]|\be(?=nd\b)", lambda match: f"#{ord(match.group())};", text)


def _plain(text: str) -> str:
    """Text for a line of its own, in which `#` and `;` would have a meaning."""
    return re.sub(r"[#;{}<>\n]+", ",", text)
