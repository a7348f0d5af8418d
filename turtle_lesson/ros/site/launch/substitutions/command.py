"""`Command`: what a command prints."""

from __future__ import annotations

from typing import Any

from ..frontend.expose import expose_substitution
from ..launch_context import LaunchContext
from ..some_types import SomeSubstitutionsType
from ..substitution import Substitution
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions
from ._parsing import arguments
from .substitution_failure import SubstitutionFailure


@expose_substitution("command")
class Command(Substitution):
    """Stands for the output of a command. Here these are `cat FILE`, `echo …` and `xacro FILE`.

    Args:
        command: the command, as one text.
        on_stderr: what to do if it prints to stderr: fail, ignore, warn or capture.
    """

    def __init__(self, command: SomeSubstitutionsType, *, on_stderr: SomeSubstitutionsType = "fail") -> None:
        self.__command = normalize_to_list_of_substitutions(command)
        self.__on_stderr = normalize_to_list_of_substitutions(on_stderr)

    @classmethod
    def parse(cls, data: Any) -> tuple[type, dict[str, Any]]:
        """Its arguments as they stand behind `$(command `."""
        return cls, arguments("command", data, ["command", "on_stderr"], 1)

    @property
    def command(self) -> list[Substitution]:
        """The pieces of the command."""
        return self.__command

    @property
    def on_stderr(self) -> list[Substitution]:
        """What to do if it prints to stderr."""
        return self.__on_stderr

    def describe(self) -> str:
        """As in `Command('cat robot.urdf')`."""
        return f"Command({' + '.join(piece.describe() for piece in self.command)})"

    def perform(self, context: LaunchContext) -> str:
        """What it prints.

        Raises:
            SubstitutionFailure: if it fails, or the simulation does not have it.
            NotHereError: if it needs a Python package that is not installed; then the launch goes on without the action.
        """
        from turtle_lesson.ros.launching.small_commands import CommandFailure, output_of

        text = perform_substitutions(context, self.command)
        if perform_substitutions(context, self.on_stderr) not in ("fail", "ignore", "warn", "capture"):
            raise SubstitutionFailure("expected 'on_stderr' to be one of: 'fail', 'ignore', 'warn' or 'capture'")
        try:
            return output_of(text)
        except CommandFailure as error:
            raise SubstitutionFailure(
                f"executed command failed. Command: {text}\nCaptured stderr output: {error}", error.hint
            ) from error
