"""Actions that run programs: `ExecuteLocal` and `ExecuteProcess`."""

from __future__ import annotations

import shlex
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import PurePath
from typing import Any, ClassVar

from turtle_lesson.ros import hooks

from .._context import LaunchContext, Reaction
from .._entities import Action, LaunchDescriptionEntity, SomeSubstitutionsType, Substitution
from .._tags import Reader, pair, tags, text, typed
from ..conditions import evaluate_condition_expression
from ..descriptions import Environment, Executable
from ..event_handlers import OnProcessExit
from ..frontend import Entity, Parser, expose_action
from ..substitutions import LaunchConfiguration, TextSubstitution
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions

__all__ = ["ExecuteLocal", "ExecuteProcess"]

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


class ExecuteLocal(Action):
    """Base of the actions that run a program: here a node, a `ros2` command or a Python file."""

    _completes_later = True

    def __init__(
        self,
        *,
        process_description: Executable,
        shell: bool = False,
        sigterm_timeout: SomeSubstitutionsType = LaunchConfiguration("sigterm_timeout", default=5),  # noqa: B008
        sigkill_timeout: SomeSubstitutionsType = LaunchConfiguration("sigkill_timeout", default=5),  # noqa: B008
        emulate_tty: bool = False,
        output: SomeSubstitutionsType | Mapping[str, str | Iterable[str]] = "log",
        output_format: str = "[{this.process_description.final_name}] {line}",
        cached_output: bool = False,
        log_cmd: bool = False,
        on_exit: Reaction = None,
        respawn: bool | SomeSubstitutionsType = False,
        respawn_delay: float | None = None,
        respawn_max_retries: int = -1,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.process_description = process_description
        self.shell = shell
        self.sigterm_timeout = normalize_to_list_of_substitutions(sigterm_timeout)
        self.sigkill_timeout = normalize_to_list_of_substitutions(sigkill_timeout)
        self.emulate_tty = emulate_tty
        self.output = output if isinstance(output, Mapping) else normalize_to_list_of_substitutions(output)
        self.output_format = output_format
        self.__on_exit = on_exit
        self.__respawn = normalize_to_list_of_substitutions(str(respawn) if isinstance(respawn, bool) else respawn)
        self.respawn_delay = respawn_delay
        self.respawn_max_retries = respawn_max_retries
        self.process_details: dict[str, Any] | None = None
        self.return_code: int | None = None
        self.prefix_left_out = ""
        self._program: Program | None = None
        self._respawns = False
        self._on_screen: set[str] = set()

    def prepare(self, context: LaunchContext) -> None:
        """Make everything text that was not yet."""
        description = self.process_description
        before = perform_substitutions(context, description.prefix or []).split()
        self.prefix_left_out = PurePath(before[0]).name if before else ""  # such as a terminal or a debugger
        description.prepare(context, self)
        self._program = self._find_program(context)
        self._respawns = evaluate_condition_expression(context, self.__respawn)
        override = context._output_override or context.environment.get("OVERRIDE_LAUNCH_PROCESS_OUTPUT")
        self._on_screen = _on_screen(context, [TextSubstitution(text=override)] if override else self.output)
        self.process_details = {
            "action": self,
            "name": description.final_name,
            "cmd": self._program.argv,
            "cwd": description.final_cwd,
            "env": description.final_env,
        }

    def _find_program(self, context: LaunchContext) -> Program:
        """What to run: a command of the simulation, unless a subclass knows better.

        Raises UnknownCommand if there is none of this name here.
        """
        return hooks.program_of_command(self.process_description.final_cmd, shell=self.shell)

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Have the process started."""
        self.prepare(context)
        if context.is_shutdown or context._host is None:
            return None
        if self.__on_exit is not None:
            context.register_event_handler(OnProcessExit(target_action=self, on_exit=self.__on_exit))
        context._host.start_process(self)
        return None

    def describe_conditional_sub_entities(self) -> list[tuple[str, Iterable[LaunchDescriptionEntity]]]:
        """What it gives when its process ends."""
        if self.__on_exit is None or callable(self.__on_exit):
            return []
        return [OnProcessExit(target_action=self, on_exit=self.__on_exit).describe()]


def _on_screen(context: LaunchContext, output: Any) -> set[str]:
    """Which of `stdout` and `stderr` reach the screen. Raises ValueError for an unknown value of `output`."""
    if isinstance(output, Mapping):
        shown: set[str] = set()
        for name, where in output.items():
            if name not in {"stdout", "stderr", "both"}:
                raise ValueError(f'{name} is not a valid output source i.e. "stdout", "stderr" or "both"')
            if "screen" in ({where} if isinstance(where, str) else set(where)):
                shown |= {"stdout", "stderr"} if name == "both" else {name}
        return shown
    value = perform_substitutions(context, output)
    if value not in SCREEN:
        raise ValueError(f'{value} is not a valid standard output config i.e. "screen", "log" or "both"')
    return SCREEN[value]


def words_in(pieces: Iterable[Substitution]) -> list[list[Substitution]]:
    """The words of a text; a substitution belongs to the text that it touches, and is never taken apart."""
    words: list[list[Substitution]] = []
    word: list[Substitution] = []
    for piece in pieces:
        if not isinstance(piece, TextSubstitution):
            word.append(piece)
            continue
        text = piece.text
        if text[:1].isspace() and word:
            words.append(word)
            word = []
        for number, token in enumerate(shlex.split(text)):
            if number > 0:
                words.append(word)
                word = []
            word.append(TextSubstitution(text=token))
        if text[-1:].isspace() and word:
            words.append(word)
            word = []
    return [*words, word] if word else words


def command_line(name: str, *, optional: bool = False) -> Reader:
    """An attribute that is the words of a command, written as one text."""
    read_text = text(name, optional=optional)

    def read(entity: Entity, parser: Parser) -> list[list[Substitution]] | None:
        pieces = read_text(entity, parser)
        return None if pieces is None else words_in(pieces)

    return read


def _delay(entity: Entity, parser: Parser) -> float | None:
    delay = entity.get_attr("respawn_delay", data_type=float, optional=True, can_be_str=False)
    if delay is not None and delay < 0.0:
        raise ValueError(
            f"Attribute respawn_delay of Entity node expected to be a non-negative value but got `{delay}`"
        )
    return delay


@expose_action("executable")
class ExecuteProcess(ExecuteLocal):
    """Runs the words of a command."""

    _tag: ClassVar = {
        "cmd": command_line("cmd"),
        "cwd": text("cwd", optional=True),
        "name": text("name", optional=True),
        "prefix": text("launch-prefix", optional=True),
        "output": text("output", optional=True),
        "sigkill_timeout": text("sigkill_timeout", optional=True),
        "sigterm_timeout": text("sigterm_timeout", optional=True),
        "respawn": typed("respawn", bool),
        "respawn_delay": _delay,
        "respawn_max_retries": typed("respawn_max_retries", int, can_be_str=False),
        "shell": typed("shell", bool, can_be_str=False),
        "emulate_tty": typed("emulate_tty", bool, can_be_str=False),
        "cached_output": typed("cached_output", bool, can_be_str=False),
        "log_cmd": typed("log_cmd", bool, can_be_str=False),
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
        **kwargs: Any,
    ) -> None:
        executable = Executable(cmd=cmd, prefix=prefix, name=name, cwd=cwd, env=env, additional_env=additional_env)
        super().__init__(process_description=executable, **kwargs)

    @property
    def cmd(self) -> list[list[Substitution]] | list[str]:
        """The command's words; text once it is being run."""
        return self.process_description.final_cmd or self.process_description.cmd

    @property
    def name(self) -> str | list[Substitution] | None:
        """The process's name; text once it is being run."""
        return self.process_description.final_name or self.process_description.name
