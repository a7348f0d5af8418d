"""What the substitution `Command` can run: commands that give a file's text, or their own words."""

from __future__ import annotations

import re
import shlex
from collections.abc import Sequence
from pathlib import Path, PurePath


class CommandFailure(RuntimeError):
    """A command has failed, or the simulation does not have it. `hint` says what to do instead."""

    def __init__(self, message: str, hint: str = "") -> None:
        super().__init__(message)
        self.hint = hint


def output_of(text: str) -> str:
    """What a command prints.

    Raises:
        CommandFailure: if it fails, or the simulation does not have it.
    """
    try:
        words = shlex.split(text)
    except ValueError as error:
        raise CommandFailure(str(error)) from None
    if not words:
        raise CommandFailure("there is no command")
    name = PurePath(words[0]).name
    if name == "echo":
        return " ".join(words[1:]) + "\n"
    if name == "cat":
        return "".join(_read(word) for word in words[1:])
    if name == "xacro":
        return _xacro(words[1:])
    raise CommandFailure(
        f"'{name}' is a program of the operating system, which launch files cannot run here",
        "Command(…) can run cat FILE, echo TEXT, and xacro of a file without macros.",
    )


def _read(name: str) -> str:
    try:
        return Path(name).read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise CommandFailure(f"cat: {name}: {reason}") from None


def _xacro(words: Sequence[str]) -> str:
    """A robot description that has no macros in it is what xacro would make of it."""
    files = [word for word in words if not word.startswith("-") and ":=" not in word]
    if len(files) != 1:
        raise CommandFailure("xacro needs the name of one file")
    text = _read(files[0])
    if re.search(r"<xacro:|\$\{|\$\(", text):
        raise CommandFailure(
            f"{files[0]} has macros in it, and xacro itself is not available here",
            "On a robot, xacro FILE > robot.urdf writes the plain description: use that file with cat.",
        )
    return text
