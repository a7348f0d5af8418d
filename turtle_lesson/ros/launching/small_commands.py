"""What the substitution `Command` can run: commands that give a file's text, or their own words."""

from __future__ import annotations

import contextlib
import importlib
import io
import re
import shlex
import sys
from collections.abc import Sequence
from pathlib import Path, PurePath

from ..workspace.catalog import why_not_here
from ..workspace.errors import NotHereError


class CommandFailure(RuntimeError):
    """A command has failed, or the simulation does not have it. `hint` says what to do instead."""

    def __init__(self, message: str, hint: str = "") -> None:
        super().__init__(message)
        self.hint = hint


def output_of(text: str) -> str:
    """What a command prints.

    Raises:
        CommandFailure: if it fails, or the simulation does not have it.
        NotHereError: if it needs a Python package that is not installed.
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
        "Command(…) can run cat FILE, echo TEXT and xacro FILE.",
    )


def _read(name: str) -> str:
    try:
        return Path(name).read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise CommandFailure(f"cat: {name}: {reason}") from None


def _xacro(words: Sequence[str]) -> str:
    """What xacro makes of a robot description. One without macros stays as it is; for others the package xacro is needed."""
    files = [word for word in words if not word.startswith("-") and ":=" not in word]
    if len(files) != 1:
        raise CommandFailure("xacro needs the name of one file")
    text = _read(files[0])
    return _processed(words) if re.search(r"<xacro:|\$\{|\$\(", text) else text


def _processed(words: Sequence[str]) -> str:
    """What the program xacro prints, which is installed from PyPI (https://github.com/ros/xacro)."""
    try:
        main = importlib.import_module("xacro").main
    except (ImportError, AttributeError):  # not installed, or a mere folder of this name
        raise NotHereError(f"an action that needs `xacro {' '.join(words)}`", why_not_here("xacro")) from None
    out, errors, argv = io.StringIO(), io.StringIO(), sys.argv
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(errors):
        sys.argv = ["xacro", *words]
        try:
            main()
        except SystemExit as end:
            if end.code:
                raise CommandFailure(
                    _COLOURS.sub("", errors.getvalue()).strip() or f"xacro: exit code {end.code}"
                ) from None
        finally:
            sys.argv = argv
    return out.getvalue()


_COLOURS = re.compile(r"\x1b\[[0-9;]*m")
