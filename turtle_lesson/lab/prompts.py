"""Texts to paste into a chat with an assistant: for debugging, and for a code review. Nothing is sent anywhere."""

from __future__ import annotations

import html
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from .specification import SPECIFICATION

KINDS = ("debugging", "code review")

_OPENING = {
    "debugging": "I am learning ROS 2 (Humble, rclpy) and my system does not do what it should. Please help me find the "
    "cause.",
    "code review": "I am learning ROS 2 (Humble, rclpy). Please review my code against the specification below.",
}
_QUESTIONS = {
    "debugging": (
        "Say in one or two sentences what you think is wrong, and which lines of the error, graph or log say so.",
        "Name the one command (ros2 …) or the one print that would prove or disprove it, and what I should see.",
        "Only then propose a change, the smallest one. Keep to the specification; do not rewrite everything.",
        "If what you need is not here, ask me for it.",
    ),
    "code review": (
        "Go through the specification line by line: is it met? Quote the line of code that shows it, or say that none does.",
        "Does any callback sleep, wait or compute for long? What would it hold up?",
        "What happens if the simulator is not running, a second request comes, or a goal makes no sense?",
        "Are angles wrapped, units right (m, rad, s), and does the turtle stop however a drive ends?",
        "List what you would change, the most important first; nothing that the specification does not ask for.",
    ),
}


@dataclass(frozen=True)
class Prompt:
    """A text to copy. `print(prompt)` and `str(prompt)` give it; `prompt.text`, too."""

    kind: str
    text: str

    def __repr__(self) -> str:
        return self.text

    def _repr_mimebundle_(self, include: Any = None, exclude: Any = None) -> dict[str, str]:
        """What Jupyter shows: a field in which one click and Ctrl+A choose all of it."""
        return {"text/plain": self.text, "text/html": self._as_html()}

    def _as_html(self) -> str:
        lines = min(24, self.text.count("\n") + 2)
        label = f"A prompt for {self.kind}: click into it, then Ctrl+A and Ctrl+C (⌘A and ⌘C on a Mac) copy it."
        look = (
            "width: 100%; box-sizing: border-box; font-family: monospace; font-size: 0.9em; color: inherit; "
            "background: transparent"
        )
        return (
            f'<label>{label}<textarea readonly rows="{lines}" spellcheck="false" style="{look}">'
            f"\n{html.escape(self.text)}</textarea></label>"
        )


def compose(kind: str, code: Mapping[str, str], error: str, graph: str, log: Sequence[str], now: float) -> Prompt:
    """Put a prompt together: specification, code (texts by name), error, graph, and the last lines of the log.

    Raises ValueError for an unknown kind.
    """
    if kind not in KINDS:
        raise ValueError(f'there are prompts for "debugging" and for "code review", got {kind!r}')
    parts = [
        _OPENING[kind],
        f"## Specification\n\n{SPECIFICATION.strip()}",
        f"## Code\n\n{_code(code)}",
        f"## Error\n\n{_fenced(error) if error else 'None: nothing has raised an error.'}",
        f"## The running system, after {now:.1f} s\n\n{graph}",
        f"## The last lines of the log\n\n{_fenced(chr(10).join(log)) if log else 'Nothing was logged.'}",
        "## What I ask\n\n" + "\n".join(f"{number}. {text}" for number, text in enumerate(_QUESTIONS[kind], 1)),
    ]
    return Prompt(kind, re.sub(r"\b0x[0-9a-f]{6,}\b", "0x…", "\n\n".join(parts)))


def _code(code: Mapping[str, str]) -> str:
    if not code:
        return "(none chosen)"
    return "\n\n".join(f"{name}:\n\n{_fenced(text, _language(name))}" for name, text in code.items())


def _language(name: str) -> str:
    known = {"xml": "xml", "txt": "cmake", "msg": "", "srv": "", "yaml": "yaml"}
    return known.get(name.rpartition(".")[2], "python") if "." in name else "python"


def _fenced(text: str, language: str = "") -> str:
    """Text in a fence that is longer than any fence in it."""
    longest = max((len(fence) for fence in re.findall(r"^\s*(`{3,})", text, re.MULTILINE)), default=2)
    fence = "`" * (longest + 1)
    return f"{fence}{language}\n{text.rstrip()}\n{fence}"
