"""`LaunchDescriptionSource`: where a launch description comes from, mostly a file."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .launch_description import LaunchDescription
from .some_types import SomeSubstitutionsType
from .utilities import normalize_to_list_of_substitutions, perform_substitutions

if TYPE_CHECKING:
    from .launch_context import LaunchContext


class LaunchDescriptionSource:
    """A launch description, or a location from which a subclass gets one when it is needed."""

    def __init__(
        self,
        launch_description: LaunchDescription | None = None,
        location: SomeSubstitutionsType = "",
        method: str = "unspecified mechanism from a script",
    ) -> None:
        self.__launch_description = launch_description
        self.__location = normalize_to_list_of_substitutions(location)
        self.__expanded_location: str | None = None
        self.__method = method

    @property
    def location(self) -> str:
        """Where it comes from, as far as that is known yet."""
        if self.__expanded_location is not None:
            return self.__expanded_location
        return " + ".join(part.describe() for part in self.__location)

    @property
    def method(self) -> str:
        """How it is got, in words."""
        return self.__method

    def get_launch_description(self, context: LaunchContext) -> LaunchDescription:
        """The description; the file is read when it is first asked for."""
        if self.__expanded_location is None:
            self.__expanded_location = perform_substitutions(context, self.__location)
        if self.__launch_description is None:
            self.__launch_description = self._get_launch_description(self.__expanded_location)
        return self.__launch_description

    def try_get_launch_description_without_context(self) -> LaunchDescription | None:
        """The description if it can be had before the launch runs, otherwise None."""
        from .launch_context import LaunchContext

        if self.__launch_description is not None:
            return self.__launch_description
        try:
            return self.get_launch_description(LaunchContext())
        except Exception:
            self.__expanded_location = None
            return None

    def _get_launch_description(self, location: str) -> LaunchDescription:
        raise NotImplementedError(f"{type(self).__name__} does not say how to get a launch description")
