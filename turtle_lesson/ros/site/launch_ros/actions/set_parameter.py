"""`SetParameter`, `SetParametersFromFile`, `SetUseSimTime` and `SetRemap`: for all nodes that follow."""

from __future__ import annotations

from os import PathLike
from typing import Any

from launch import Action, LaunchContext, LaunchDescriptionEntity
from launch.some_types import SomeSubstitutionsType
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions

from ..parameter_descriptions import ParameterFile


class SetParameter(Action):
    """Gives a parameter to every node that is started from here on in the same group."""

    def __init__(self, name: SomeSubstitutionsType, value: Any, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.__name = name
        self.__value = value

    @property
    def name(self) -> SomeSubstitutionsType:
        """The parameter's name."""
        return self.__name

    @property
    def value(self) -> Any:
        """Its value."""
        return self.__value

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Remember it."""
        _append(context, "global_params", {_key(self.__name): self.__value})
        return None


class SetParametersFromFile(Action):
    """Gives a file of parameters to every node that is started from here on in the same group."""

    def __init__(self, filename: PathLike[str] | SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.__file = ParameterFile(filename)

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Remember it."""
        _append(context, "global_params", self.__file.evaluate(context))
        return None


class SetUseSimTime(SetParameter):
    """Has every node that is started from here on use simulated time, or not."""

    def __init__(self, value: bool | SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__("use_sim_time", value, **kwargs)


class SetRemap(Action):
    """Gives a remapping to every node that is started from here on in the same group."""

    def __init__(self, src: SomeSubstitutionsType, dst: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.src = normalize_to_list_of_substitutions(src)
        self.dst = normalize_to_list_of_substitutions(dst)

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Remember it."""
        pair = (perform_substitutions(context, self.src), perform_substitutions(context, self.dst))
        _append(context, "ros_remaps", pair)
        return None


def _append(context: LaunchContext, name: str, entry: Any) -> None:
    """Add to a list among the configurations; a new list, so that the group's end forgets it."""
    context.launch_configurations[name] = [*context.launch_configurations.get(name, []), entry]


def _key(name: SomeSubstitutionsType) -> Any:
    """A name that can be a key of a dictionary."""
    return name if isinstance(name, str) else tuple(normalize_to_list_of_substitutions(name))
