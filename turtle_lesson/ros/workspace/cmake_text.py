"""Messages as CMake prints them: a head that says where, wrapped paragraphs, the call stack.

The wrapping is CMake's: lines of at most 77 columns, indented by two, two spaces after a full stop, and lines that begin
with a space left as they are.
"""

from __future__ import annotations

from collections.abc import Sequence

_WIDTH = 75
_INDENT = "  "
SHARE = "/opt/ros/humble/share"
"""Where the real build's own files are; named in the call stacks of its messages."""


def cmake_message(text: str, where: str, stack: Sequence[str] = (), kind: str = "Error") -> str:
    """`CMake Error at <where>:` and the text; the paragraphs of the text are separated by empty lines."""
    lines = [f"CMake {kind} at {where}:" if where else f"CMake {kind}:", *map(_paragraph, text.split("\n"))]
    if stack:
        lines += ["Call Stack (most recent call first):", *(f"{_INDENT}{call}" for call in stack)]
    return "\n".join(lines) + "\n\n"


def _paragraph(line: str) -> str:
    if not line:
        return ""
    if line.startswith(" "):
        return f"{_INDENT}{line}"
    return "\n".join(_INDENT + part for part in _wrapped(line))


def _wrapped(text: str) -> list[str]:
    lines: list[str] = []
    current = ""
    for word in text.split():
        new_sentence = current.endswith(".")
        if current and len(word) >= _WIDTH - len(current) - new_sentence:
            lines.append(current)
            current = word
        else:
            current += ("  " if new_sentence else " " if current else "") + word
    return [*lines, current]
