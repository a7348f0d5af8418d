"""`LogInfo`: print a line."""

from __future__ import annotations

from typing import Any

from .. import logging
from ..action import Action
from ..launch_context import LaunchContext
from ..launch_description_entity import LaunchDescriptionEntity
from ..some_types import SomeSubstitutionsType
from ..substitution import Substitution
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions


class LogInfo(Action):
    """Prints `[INFO] [launch.user]: …`."""

    def __init__(self, *, msg: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.__msg = normalize_to_list_of_substitutions(msg)

    @property
    def msg(self) -> list[Substitution]:
        """The text's pieces."""
        return self.__msg

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Print it."""
        logging.get_logger("launch.user").info(perform_substitutions(context, self.msg))
        return None
