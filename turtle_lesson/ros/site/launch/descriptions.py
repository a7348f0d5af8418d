"""`Executable`: a command to run, with what belongs to it."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

from ._entities import SomeSubstitutionsType, Substitution
from .utilities import normalize_to_list_of_substitutions, perform_substitutions, text_of

if TYPE_CHECKING:
    from ._context import LaunchContext
    from ._entities import Action


Environment = Mapping[SomeSubstitutionsType, SomeSubstitutionsType]


class Executable:
    """The words of a command; `prepare` makes them text and gives the process its name."""

    def __init__(
        self,
        *,
        cmd: Iterable[SomeSubstitutionsType],
        prefix: SomeSubstitutionsType | None = None,
        name: SomeSubstitutionsType | None = None,
        cwd: SomeSubstitutionsType | None = None,
        env: Environment | None = None,
        additional_env: Environment | None = None,
        arguments: Iterable[SomeSubstitutionsType] | None = None,
    ) -> None:
        if isinstance(cmd, str):
            error = TypeError(f"ExecuteProcess expected a list for 'cmd', got {cmd!r}")
            error.add_note("Write cmd=['ros2', 'topic', 'list'], or cmd=['ros2 topic list'] with shell=True.")
            raise error
        words = [*cmd, *(arguments or [])]
        self.cmd = [normalize_to_list_of_substitutions(word) for word in words]
        self.prefix = _pieces(prefix)
        self.name = _pieces(name)
        self.cwd = _pieces(cwd)
        self.env = env
        self.additional_env = additional_env
        self.final_cmd: list[str] = []
        self.final_name = ""
        self.final_cwd: str | None = None
        self.final_env: dict[str, str] = {}

    def prepare(self, context: LaunchContext, action: Action) -> None:
        """Perform the substitutions; name the process after its program, with a number."""
        if not self.cmd:
            error = ValueError("ExecuteProcess expected a command in 'cmd', got none")
            error.add_note("Write its words in a list, as in cmd=['ros2', 'topic', 'list'].")
            raise error
        self.final_cmd = [perform_substitutions(context, word) for word in self.cmd]
        base = perform_substitutions(context, self.name) if self.name else os.path.basename(self.final_cmd[0])
        host = context._host
        number = next(host.numbers) if host is not None else 1
        self.final_name = f"{base}-{number}"
        self.final_cwd = perform_substitutions(context, self.cwd) if self.cwd else None
        alone = context.environment if self.env is None else _variables(context, self.env)
        self.final_env = {**alone, **_variables(context, self.additional_env or {})}


def _variables(context: LaunchContext, given: Environment) -> dict[str, str]:
    pairs = given.items() if isinstance(given, Mapping) else given
    return {text_of(context, name): text_of(context, value) for name, value in pairs}


def _pieces(text: SomeSubstitutionsType | None) -> list[Substitution] | None:
    return None if text is None else normalize_to_list_of_substitutions(text)
