"""`ExecuteProcess`: run a command. Nodes are one kind of command, and the only one that runs here yet."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from ..descriptions import Environment, Executable
from ..some_types import SomeSubstitutionsType
from ..substitution import Substitution
from .execute_local import ExecuteLocal


class ExecuteProcess(ExecuteLocal):
    """Runs the words of a command."""

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
