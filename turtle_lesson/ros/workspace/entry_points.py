"""The entry points that a setup.py gives: groups of lines such as `talk = package.module:main`."""

from __future__ import annotations

from typing import Any

PROGRAMS = ("console_scripts", "gui_scripts")


def entry_groups(given: Any) -> dict[str, list[str]] | None:
    """The lines of each group; None if this is neither a dictionary nor a text with a `[group]` above its lines."""
    groups = _sections(given) if isinstance(given, str) else given
    if not isinstance(groups, dict):
        return None
    return {str(group): _lines(lines or []) for group, lines in groups.items()}


def program_lines(groups: dict[str, list[str]]) -> list[str]:
    """The lines that become programs."""
    return [line for group in PROGRAMS for line in groups.get(group, [])]


def entry_text(groups: dict[str, list[str]]) -> str:
    """What an installed package's entry_points.txt says, where `importlib.metadata` finds plugins of all packages."""
    return "\n".join(f"[{group}]\n" + "".join(f"{line.strip()}\n" for line in lines) for group, lines in groups.items())


def _lines(given: Any) -> list[str]:
    if isinstance(given, str):
        return [line for line in given.splitlines() if line.strip()]
    return [str(line) for line in given] if isinstance(given, list) else [str(given)]


def _sections(text: str) -> dict[str, list[str]]:
    groups: dict[str, list[str]] = {}
    for line in filter(None, map(str.strip, text.splitlines())):
        if line.startswith("[") and line.endswith("]"):
            groups[line[1:-1].strip()] = []
        elif groups and not line.startswith(("#", ";")):
            groups[list(groups)[-1]].append(line)
    return groups
