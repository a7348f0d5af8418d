"""What launched commands need of the terminal: how a shell takes a text apart, and what `ros2 run` is told.

`turtle_lesson/ros/launching/commands.py` asks for it by `hooks`.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ..launching.commands import ForeignCommand, UnknownCommand
from .parser import Stop, parse
from .script import ShellSyntaxError, UnfinishedError, expand, pipelines, tokens


def commands_of_text(text: str) -> list[tuple[str, list[str]]]:
    """The commands of a shell's text, each with the sign before it.

    Raises:
        UnknownCommand: if there is none, or one that uses more of a shell than `&&`, `||` and `;`.
    """
    try:
        plan = list(pipelines(list(tokens(text))))
    except (UnfinishedError, ShellSyntaxError) as mistake:
        raise UnknownCommand(f"syntax error in the command {text!r}: {mistake}") from None
    found = []
    for sign, pipeline in plan:
        command = pipeline[0]
        if len(pipeline) > 1 or command.stdout or command.stderr or command.given or command.background:
            raise ForeignCommand(
                f"the command {text!r}",
                "it uses '|', '>' or '&', which launched commands cannot use here",
                "Only one command, or several with '&&' or ';' between them, can be run.",
            )
        found.append((sign, [part for word in command.words for part in expand(word, home=Path.home(), exit_code=0)]))
    if not found:
        raise UnknownCommand("there is no command in cmd=[…]")
    return found


def run_arguments(words: list[str]) -> Any:
    """The arguments of `ros2 run …`. UnknownCommand if it would complain about them."""
    try:
        return parse(words).arguments
    except Stop as stop:
        raise UnknownCommand(stop.text) from None
