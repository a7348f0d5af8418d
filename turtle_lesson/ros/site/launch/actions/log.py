"""`Log` and its kin: print a line."""

from __future__ import annotations

from typing import Any

from .. import logging
from ..action import Action
from ..frontend import Entity, Parser, expose_action
from ..launch_context import LaunchContext
from ..launch_description_entity import LaunchDescriptionEntity
from ..some_types import SomeSubstitutionsType
from ..substitution import Substitution
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions

LEVELS = {
    "CRITICAL": "critical",
    "FATAL": "critical",
    "ERROR": "error",
    "WARNING": "warning",
    "WARN": "warning",
    "INFO": "info",
    "DEBUG": "debug",
}
"""The names of levels, and the logger's method for each."""


@expose_action("log")
class Log(Action):
    """Prints `[LEVEL] [launch.user]: …`. Debug lines are dropped, as at launch's default verbosity."""

    def __init__(
        self,
        *,
        msg: SomeSubstitutionsType,
        level: SomeSubstitutionsType,
        logger_name: str = "launch.user",
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.__msg = normalize_to_list_of_substitutions(msg)
        self.__level = normalize_to_list_of_substitutions(level)
        self.__logger_name = logger_name

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type, dict[str, Any]]:
        """Its arguments from `message` (and `level`, where it has no level of its own)."""
        _, kwargs = super().parse(entity, parser)
        kwargs["msg"] = parser.parse_substitution(entity.get_attr("message"))
        level = entity.get_attr("level", optional=True)
        if cls is Log:
            kwargs["level"] = parser.parse_substitution(level or "INFO")
        return cls, kwargs

    @property
    def msg(self) -> list[Substitution]:
        """The text's pieces."""
        return self.__msg

    @property
    def level(self) -> list[Substitution]:
        """The level's pieces."""
        return self.__level

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Print it.

        Raises:
            KeyError: if there is no such level.
        """
        level = perform_substitutions(context, self.level).upper()
        if level not in LEVELS:
            raise KeyError(f"Invalid log level '{level}', expected: {LEVELS.keys()}")
        method = getattr(logging.get_logger(self.__logger_name), LEVELS[level])
        method(perform_substitutions(context, self.msg))
        return None


@expose_action("log_info")
class LogInfo(Log):
    """Prints `[INFO] [launch.user]: …`."""

    def __init__(self, *, msg: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(msg=msg, level="INFO", **kwargs)


@expose_action("log_warning")
class LogWarning(Log):
    """Prints `[WARNING] [launch.user]: …`."""

    def __init__(self, *, msg: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(msg=msg, level="WARNING", **kwargs)


@expose_action("log_error")
class LogError(Log):
    """Prints `[ERROR] [launch.user]: …`."""

    def __init__(self, *, msg: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(msg=msg, level="ERROR", **kwargs)


@expose_action("log_debug")
class LogDebug(Log):
    """Prints nothing, as a debug line at launch's default verbosity."""

    def __init__(self, *, msg: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(msg=msg, level="DEBUG", **kwargs)
