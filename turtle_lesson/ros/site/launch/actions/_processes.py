"""`ExecuteProcess`, which runs a program."""

from __future__ import annotations

import os
import shlex
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import PurePath
from typing import Any, ClassVar

from turtle_lesson.ros import hooks

from .._context import LaunchContext, Reaction
from .._entities import (
    Action,
    LaunchDescriptionEntity,
    SomeSubstitutionsType,
    Substitution,
    TextSubstitution,
    explained,
    text_of,
)
from .._entities import normalize_to_list_of_substitutions as pieces
from ..conditions import evaluate_condition_expression
from ..event_handlers import OnProcessExit
from ..frontend import Entity, Reader, attribute, expose_action, pair, tags
from ..substitutions import LaunchConfiguration

__all__ = ["ExecuteProcess"]

OUTPUT_OVERRIDE = "OVERRIDE_LAUNCH_PROCESS_OUTPUT"
"""The environment variable that counts instead of each action's `output`; `ros2 launch -a` sets it."""

SCREEN = {
    "screen": {"stdout", "stderr"},
    "both": {"stdout", "stderr"},
    "full": {"stdout", "stderr"},
    "log": {"stderr"},
    "own_log": set(),
    "none": set(),
}
"""What of a process's output reaches the screen, for each value of `output`."""


@dataclass(frozen=True)
class Program:
    """What is to be run: a file or a `main()`, its arguments, and how the command reads on a robot."""

    target: Any
    argv: list[str]
    shown: str


def words_in(text: Sequence[Substitution]) -> list[list[Substitution]]:
    """The words of a text, as a shell takes it apart; a substitution is part of the word in which it stands."""
    marked = "".join(
        piece.text if isinstance(piece, TextSubstitution) else f"\0{number}\0" for number, piece in enumerate(text)
    )
    return [
        [text[int(part)] if number % 2 else TextSubstitution(text=part) for number, part in enumerate(word.split("\0"))]
        for word in shlex.split(marked)
    ]


def command_line(name: str, *, optional: bool = False) -> Reader:
    """An attribute that is the words of a command, written as one text."""
    read_text = attribute(name, optional=optional)

    def read(entity: Entity) -> list[list[Substitution]] | None:
        text = read_text(entity)
        return None if text is None else words_in(pieces(text))

    return read


def listed(name: str, words: Iterable[SomeSubstitutionsType] | None) -> list[SomeSubstitutionsType]:
    """The words of the argument of a name, which is a list. Raises TypeError if it is a text."""
    if isinstance(words, str | Substitution):
        hint = f"Write {name}=['one', 'two'], a text for each word; for cmd=['ros2 topic list'] add shell=True."
        raise explained(TypeError(f"expected a list for '{name}', got {words!r}"), hint)
    return list(words or [])


Environment = (
    Mapping[SomeSubstitutionsType, SomeSubstitutionsType]
    | Iterable[tuple[SomeSubstitutionsType, SomeSubstitutionsType]]
)


def _variables(context: LaunchContext, given: Environment) -> dict[str, str]:
    pairs = given.items() if isinstance(given, Mapping) else given
    return {text_of(context, name): text_of(context, value) for name, value in pairs}


@expose_action("executable")
class ExecuteProcess(Action):
    """Runs the words of a command: here a `ros2` command, a Python file, or a small one such as `echo`."""

    _completes_later = True
    _tag: ClassVar = {
        "cmd": command_line("cmd"),
        **{
            name: attribute(name, optional=True)
            for name in ("cwd", "name", "output", "sigkill_timeout", "sigterm_timeout")
        },
        "prefix": attribute("launch-prefix", optional=True),
        "respawn": attribute("respawn", bool, optional=True),
        "respawn_delay": attribute("respawn_delay", float, optional=True, can_be_str=False),
        "respawn_max_retries": attribute("respawn_max_retries", int, optional=True, can_be_str=False),
        **{name: attribute(name, bool, optional=True, can_be_str=False) for name in ("shell", "emulate_tty")},
        "additional_env": tags("env", pair()),
    }

    def __init__(
        self,
        *,
        cmd: Iterable[SomeSubstitutionsType],
        prefix: SomeSubstitutionsType | None = None,
        name: SomeSubstitutionsType | None = None,
        cwd: SomeSubstitutionsType | None = None,
        env: Environment | None = None,
        additional_env: Environment | None = None,
        shell: bool = False,
        sigterm_timeout: SomeSubstitutionsType = LaunchConfiguration("sigterm_timeout", default=5),  # noqa: B008
        sigkill_timeout: SomeSubstitutionsType = LaunchConfiguration("sigkill_timeout", default=5),  # noqa: B008
        emulate_tty: bool = False,
        output: SomeSubstitutionsType | Mapping[str, str | Iterable[str]] = "log",
        output_format: str = "[{this.name}] {line}",
        log_cmd: bool = False,
        on_exit: Reaction = None,
        respawn: bool | SomeSubstitutionsType = False,
        respawn_delay: float | None = None,
        respawn_max_retries: int = -1,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self._words = [pieces(word) for word in listed("cmd", cmd)]
        self._prefix = pieces(prefix or "")
        self._name = pieces(name or "")
        self._env = env
        self._additional_env = additional_env or {}
        self.cwd = cwd
        self.shell = shell
        self.sigterm_timeout = pieces(sigterm_timeout)
        self.output = output if isinstance(output, Mapping) else pieces(output)
        self.__on_exit = on_exit
        self.__respawn = pieces(str(respawn) if isinstance(respawn, bool) else respawn)
        self.respawn_delay = respawn_delay
        self.respawn_max_retries = respawn_max_retries
        self.cmd: list[str] = []
        """The command's words; known when it is run."""
        self.name = ""
        """What the process is called in the output, such as `navigator-1`; known when it is run."""
        self.process_details: dict[str, Any] = {}
        self.return_code: int | None = None
        self._program: Program
        self._respawns: bool
        self._on_screen: set[str]

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Make everything text that was not yet; have the process started, named after its program, with a number."""
        if not self._words:
            error = ValueError("ExecuteProcess expected a command in 'cmd', got none")
            raise explained(error, "Write its words in a list, as in cmd=['ros2', 'topic', 'list'].")
        self.cmd = [text_of(context, word) for word in self._words]
        self.name = f"{text_of(context, self._name) or os.path.basename(self.cmd[0])}-{next(context._host.numbers)}"
        alone = context.environment if self._env is None else _variables(context, self._env)
        self._program = self._find_program(context)
        self._respawns = evaluate_condition_expression(context, self.__respawn)
        self._on_screen = _on_screen(context, context.environment.get(OUTPUT_OVERRIDE) or self.output)
        self.process_details = {
            "action": self,
            "name": self.name,
            "cmd": self._program.argv,
            "cwd": None if self.cwd is None else text_of(context, self.cwd),
            "env": {**alone, **_variables(context, self._additional_env)},
        }
        for before in text_of(context, self._prefix).split()[:1]:  # such as a terminal or a debugger
            context._host.warn_once(f"{PurePath(before).name} is left out: programs run here without a prefix")
        if self.cwd:
            context._host.warn_once("here all programs work in the notebook's folder, whatever cwd= says")
        if not context.is_shutdown:
            if self.__on_exit is not None:
                context.register_event_handler(OnProcessExit(target_action=self, on_exit=self.__on_exit))
            context._host.start_process(self)
        return None

    def _find_program(self, context: LaunchContext) -> Program:
        """What to run: a command of the simulation, unless a subclass knows better.

        Raises UnknownCommand if there is none of this name here.
        """
        return hooks.program_of_command(self.cmd, shell=self.shell)

    def describe_conditional_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """What it gives when its process ends."""
        return OnProcessExit(target_action=self, on_exit=self.__on_exit).entities


def _on_screen(context: LaunchContext, output: SomeSubstitutionsType | Mapping[str, str | Iterable[str]]) -> set[str]:
    """Which of `stdout` and `stderr` reach the screen. Raises ValueError for an unknown value of `output`."""
    if isinstance(output, Mapping):
        shown: set[str] = set()
        for name, where in output.items():
            if name not in {"stdout", "stderr", "both"}:
                raise ValueError(f'{name} is not a valid output source i.e. "stdout", "stderr" or "both"')
            if "screen" in ({where} if isinstance(where, str) else set(where)):
                shown |= {"stdout", "stderr"} if name == "both" else {name}
        return shown
    value = text_of(context, output)
    if value not in SCREEN:
        raise ValueError(f'{value} is not a valid standard output config i.e. "screen", "log" or "both"')
    return SCREEN[value]
