"""`ExecuteProcess`: run a command, such as `ros2 service call …`; nodes are one kind of command."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from ..descriptions import Environment, Executable
from ..frontend import Entity, Parser, expose_action
from ..some_types import SomeSubstitutionsType
from ..substitution import Substitution
from ._command_line import words_in
from .execute_local import ExecuteLocal

_TEXTS = {
    "cwd": "cwd",
    "name": "name",
    "prefix": "launch-prefix",
    "output": "output",
    "sigkill_timeout": "sigkill_timeout",
    "sigterm_timeout": "sigterm_timeout",
}
"""Arguments that are text, and what they are called in XML and YAML."""

_TYPED: dict[str, tuple[type, bool]] = {
    "respawn": (bool, True),
    "respawn_delay": (float, False),
    "respawn_max_retries": (int, False),
    "shell": (bool, False),
    "emulate_tty": (bool, False),
    "cached_output": (bool, False),
    "log_cmd": (bool, False),
}
"""Arguments of other types, and whether a substitution may stand for them."""


@expose_action("executable")
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

    @classmethod
    def _parse_cmdline(cls, cmd: str, parser: Parser) -> list[list[Substitution]]:
        """The words of a command that is written as one text."""
        return words_in(parser.parse_substitution(cmd))

    @classmethod
    def parse(cls, entity: Entity, parser: Parser, ignore: list[str] | None = None) -> tuple[type, dict[str, Any]]:
        """Its arguments from the attributes of a tag, without those whose names are in `ignore`."""
        _, kwargs = super().parse(entity, parser)
        ignore = ignore or []
        if "cmd" not in ignore:
            kwargs["cmd"] = cls._parse_cmdline(entity.get_attr("cmd"), parser)
        for name, attribute in _TEXTS.items():
            value = None if name in ignore else entity.get_attr(attribute, optional=True)
            if value is not None:
                kwargs[name] = parser.parse_substitution(value)
        for name, (kind, can_be_str) in _TYPED.items():
            value = (
                None if name in ignore else entity.get_attr(name, data_type=kind, optional=True, can_be_str=can_be_str)
            )
            if value is not None:
                kwargs[name] = parser.parse_if_substitutions(value)
        if (delay := kwargs.get("respawn_delay")) is not None and delay < 0.0:
            raise ValueError(
                f"Attribute respawn_delay of Entity node expected to be a non-negative value but got `{delay}`"
            )
        variables = [] if "env" in ignore else entity.get_attr("env", data_type=list[Entity], optional=True)
        if variables:
            kwargs["additional_env"] = dict(_variable(variable, parser) for variable in variables)
        return cls, kwargs

    @property
    def cmd(self) -> list[list[Substitution]] | list[str]:
        """The command's words; text once it is being run."""
        return self.process_description.final_cmd or self.process_description.cmd

    @property
    def name(self) -> str | list[Substitution] | None:
        """The process's name; text once it is being run."""
        return self.process_description.final_name or self.process_description.name


def _variable(entity: Entity, parser: Parser) -> tuple[tuple[Substitution, ...], list[Substitution]]:
    name = tuple(parser.parse_substitution(entity.get_attr("name")))
    value = parser.parse_substitution(entity.get_attr("value"))
    entity.assert_entity_completely_parsed()
    return name, value
