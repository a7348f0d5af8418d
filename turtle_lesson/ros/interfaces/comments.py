"""What the fields of the built-in interfaces mean: the comments that `ros2 interface show` prints.

The definitions in `share/` hold next to no comments, so that they are read fast and fill no bags. A file `comments.txt`
beside a package's definitions has what is to be said, in our own words: a section `[msg/Twist]` for an interface, in it
lines `# …` about the whole and `field: meaning`, and `---` between the parts of a service or an action.
"""

from __future__ import annotations

import re
from itertools import zip_longest
from pathlib import Path

_MEMBER = re.compile(r"\S+\s+(\w+)[^#]*$")
"""A line of a definition that declares a member and has no comment of its own."""


def with_comments(directory: Path, interface: str, text: str) -> str:
    """The text of a definition with the comments that the package in a folder has for it, if any.

    Args:
        directory: folder of the package: that of `msg/`, `srv/` and `action/`.
        interface: such as `msg/Twist`.
        text: what the definition's file says.
    """
    section = _section(directory / "comments.txt", interface)
    lines: list[str] = []
    none: list[str] = []
    for number, (definition, comments) in enumerate(zip_longest(_parts(text), _parts(section), fillvalue=none)):
        lines += ["---"] if number else []
        lines += _commented(definition, comments)
    return "\n".join(lines)


def _section(file: Path, interface: str) -> str:
    found = file.read_text(encoding="utf-8") if file.is_file() else ""
    _, _, rest = f"\n{found}".partition(f"\n[{interface}]\n")
    return rest.partition("\n[")[0].strip()


def _parts(text: str) -> list[list[str]]:
    return [part.splitlines() for part in re.split(r"^---$\n?", text, flags=re.MULTILINE)]


def _commented(definition: list[str], comments: list[str]) -> list[str]:
    """The lines of one part: what it is, then each member, with their meanings below each other."""
    about = [line for line in comments if line.startswith("#")]
    meanings = dict(line.split(": ", 1) for line in comments if line and not line.startswith("#"))
    members = [(line, _MEMBER.match(line)) for line in definition]
    pairs = [(line, meanings.get(member[1]) if member else None) for line, member in members]
    width = max((len(line) for line, meaning in pairs if meaning), default=0)
    shown = [f"{line:<{width}}  # {meaning}" if meaning else line for line, meaning in pairs]
    return [*about, *([""] if about and shown else []), *shown]
