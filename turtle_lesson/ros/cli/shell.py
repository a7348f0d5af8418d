r"""A small terminal: a line or a script becomes commands, which run one after the other.

Quotes, `\` at a line's end, comments, `&&`, `||`, `;`, a trailing `&`, `| grep`, `< file`, `> file` and patterns such as
`*.msg` work as in bash. The current folder is the notebook's; `~` is the folder in which the
notebook began. Which files a command may change, `files.check` decides.
"""

from __future__ import annotations

import io
import os
import re
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from ..idl.names import did_you_mean
from ..runtime import files
from ..runtime.files import FileOutput
from ..runtime.world import World
from . import terminal
from .arguments import cut
from .cells import advice
from .jobs import CellErrors, Terminal, before_a_command, export, set_for_now
from .run_command import run as run_ros2
from .script import Command, ShellSyntaxError, Word, expand, pipelines, run_script, script_of, tokens
from .verb import INTERRUPTED

NOT_FOUND = 127
SYNTAX = 2
STOPPED = 130
"""The exit code that a shell gives to what Ctrl-C has ended; `ros2` itself answers with another."""

PROGRAMS = ("ros2", "colcon", "source", ".")


class CommandInterrupted(KeyboardInterrupt):
    """The user has stopped a command: what comes after it is not carried out."""


class Shell:
    """The terminal of a world: it runs scripts, and knows the exit code of its last command."""

    def __init__(self, world: World) -> None:
        self.world = world
        self.exit_code = 0

    def run(self, script: str, out: Any, error: Any) -> int:
        """Run a script of one line or several; a failing command prints and does not raise.

        Raises CommandInterrupted if the user stops a command.
        """
        try:
            plan = list(pipelines(tokens(script)))
        except ShellSyntaxError as mistake:
            print(f"syntax error: {cut(str(mistake), 300)}", file=error)
            self.exit_code = SYNTAX
            return SYNTAX
        for condition, pipeline in plan:
            if condition and (condition == "||") != bool(self.exit_code):
                continue
            given, code = None, 0
            for command in pipeline:
                target = out if command is pipeline[-1] else io.StringIO()
                code = self._one(command, given, target, error)
                given = target.getvalue() if target is not out else None
            self.exit_code = code
        return self.exit_code

    def _one(self, command: Command, given: str | None, out: Any, error: Any) -> int:
        words = [text for word in command.words for text in self._expand(word)]
        try:
            for sign, word in command.redirections:
                if sign == "<":
                    given = Path(self._file_name(word)).read_text(encoding="utf-8")
                elif sign == "2>":
                    error = _file(self._file_name(word), "w", error)
                elif sign != "2>&1":
                    out = _file(self._file_name(word), "a" if sign == ">>" else "w", out)
                if sign in {"2>&1", "&>"}:
                    error = out
            return self._call(words, given, out, error, command.background) if words else 0
        except (OSError, ValueError, re.error) as mistake:  # said without Python's numbers
            text = str(mistake)
            if isinstance(mistake, OSError) and mistake.strerror:
                text = f"{mistake.filename}: {mistake.strerror}" if mistake.filename else mistake.strerror
            print(f"{cut(words[0] if words else 'bash', 40)}: {cut(text, 300)}", file=error)
            return NOT_FOUND if isinstance(mistake, FileNotFoundError) and not mistake.filename else 1  # no ./FILE
        except KeyboardInterrupt:
            self.exit_code = INTERRUPTED if words[0] == "ros2" else STOPPED
            stopped = f"{cut(' '.join(words), 100)} was stopped, and no command after it was run"
            raise CommandInterrupted(stopped) from None

    def _expand(self, word: Word) -> list[str]:
        return expand(word, home=files.home(), exit_code=self.exit_code)

    def _file_name(self, word: Word) -> str:
        """What a `<` or `>` is followed by. Raises ValueError if that is no name or several."""
        names = self._expand(word)
        if len(names) != 1:
            raise ValueError(f"{word.text}: ambiguous redirect: it stands for {len(names)} names, and one is needed")
        return names[0]

    def _call(self, words: Sequence[str], given: str | None, out: Any, error: Any, background: bool) -> int:
        if "=" in words[0] and (variables := before_a_command(words)):
            rest = words[len(variables) :]
            if not rest:
                return export(Terminal(self.world, out, error), list(words))
            with set_for_now(variables):
                return self._call(rest, given, out, error, background)
        name = words[0]
        if name == "ros2":
            return run_ros2(self.world, words, stdin=given, stdout=out, stderr=error, background=background)
        if name in {"colcon", "source", "."}:
            from ..ament import source
            from . import colcon

            run = colcon.run if name == "colcon" else source.source
            return run(self.world, list(words[1:]), stdout=out, stderr=error, cwd=Path.cwd())
        if "/" in name and (program := self.world.packages.program_at(name)):
            return self._call(["ros2", "run", *program, *words[1:]], given, out, error, background)
        if (argv := script_of(words)) is not None:
            return run_script(self.world, words, argv, given, out, error)
        if name in terminal.BUILTINS:
            return terminal.BUILTINS[name](Terminal(self.world, out, error, given), list(words[1:]))
        print(_not_found(words), file=error)
        return NOT_FOUND


def _not_found(words: Sequence[str]) -> str:
    """What to say of a command that there is none of."""
    name = words[0]
    if other := advice(words):
        return f"{name.lstrip('!')}: {cut(other, 300)}."
    hint = did_you_mean(name[:100], [*PROGRAMS, *terminal.BUILTINS])
    if re.match(r"\w+[(=\[.]", name):
        hint = "If it is Python, write it on a line of its own: everything after a command belongs to the terminal."
    computer = "This simulated terminal has ros2, colcon, source and a few more; !command runs on your computer."
    return f"{cut(name, 60)}: command not found. {hint or computer}"


def _file(name: str, mode: str, instead_of: Any) -> FileOutput:
    path = Path(name)
    if path != Path(os.devnull):
        files.check(path)
    path.open(mode).close()
    return FileOutput(path, instead_of)


def shell_of(world: World) -> Shell:
    """The terminal of a world."""
    return world.notebook.state(Shell, world)


def run_line(world: World, script: str) -> int:
    """Run a script in a world, in the running cell, and return the exit code of its last command."""
    sys.stdout.flush()
    return shell_of(world).run(script, sys.stdout, CellErrors(sys.stderr, sys.stdout))
