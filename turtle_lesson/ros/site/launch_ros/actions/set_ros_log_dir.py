"""`SetROSLogDir`: where a real launch is to keep its log files."""

from __future__ import annotations

from typing import Any

from launch import Action, LaunchContext, LaunchDescriptionEntity, logging
from launch.some_types import SomeSubstitutionsType
from launch.substitution import Substitution
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions


class SetROSLogDir(Action):
    """Names the folder of log files. It is named, too, in this classroom, and nothing is written there."""

    def __init__(self, new_log_dir: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.__log_dir = normalize_to_list_of_substitutions(new_log_dir)

    @property
    def log_dir(self) -> list[Substitution]:
        """The folder."""
        return self.__log_dir

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Name it, and say that nothing is written there."""
        folder = perform_substitutions(context, self.__log_dir)
        context.environment["ROS_LOG_DIR"] = folder
        logging.get_logger("launch_ros.actions.set_ros_log_dir").info(
            f"there are no log files in this classroom: nothing is written to '{folder}'"
        )
        return None
