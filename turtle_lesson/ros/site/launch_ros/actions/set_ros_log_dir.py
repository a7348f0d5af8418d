"""`SetROSLogDir`: where a real launch is to keep its log files."""

from __future__ import annotations

import os
from typing import Any

from launch import Action, LaunchContext, LaunchDescriptionEntity, logging
from launch.frontend import Entity, Parser, expose_action
from launch.some_types import SomeSubstitutionsType
from launch.substitution import Substitution
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions


@expose_action("set_ros_log_dir")
class SetROSLogDir(Action):
    """Names the folder of log files. Here nothing is written there.

    Args:
        new_log_dir: the folder; a relative one lies in the present one.
    """

    def __init__(self, new_log_dir: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.__log_dir = normalize_to_list_of_substitutions(new_log_dir)

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type, dict[str, Any]]:
        """Its argument from `new_log_dir`."""
        _, kwargs = super().parse(entity, parser)
        kwargs["new_log_dir"] = parser.parse_substitution(entity.get_attr("new_log_dir"))
        return cls, kwargs

    @property
    def log_dir(self) -> list[Substitution]:
        """The folder."""
        return self.__log_dir

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Name it, and say that nothing is written there."""
        present = context.environment.get("ROS_LOG_DIR") or logging.launch_config.log_dir
        folder = os.path.join(present, perform_substitutions(context, self.__log_dir))
        context.environment["ROS_LOG_DIR"] = folder
        logging.get_logger("launch_ros.actions.set_ros_log_dir").info(
            f"there are no log files here: nothing is written to '{folder}'"
        )
        return None
