"""Actions that hold for all nodes that follow: parameters, remappings, namespaces; and `RosTimer`."""

from __future__ import annotations

from os import PathLike
from typing import Any

from launch import Action, LaunchContext, LaunchDescriptionEntity
from launch._entities import SomeSubstitutionsType
from launch.actions import TimerAction
from launch.frontend import Entity, Parser, expose_action
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions

from ..parameter_descriptions import ParameterFile, typed_value
from ._nodes import check_namespace, in_namespace


@expose_action("set_parameter")
class SetParameter(Action):
    """Gives a parameter to every node that is started from here on in the same group."""

    def __init__(self, name: SomeSubstitutionsType, value: Any, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.__name = name
        self.__value = value

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type, dict[str, Any]]:
        """Its arguments from `name` and `value`."""
        _, kwargs = super().parse(entity, parser)
        kwargs["name"] = parser.parse_substitution(entity.get_attr("name"))
        kwargs["value"] = typed_value(entity.get_attr("value", data_type=None), parser)
        return cls, kwargs

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


@expose_action("set_parameters_from_file")
class SetParametersFromFile(Action):
    """Gives a file of parameters to every node that is started from here on in the same group."""

    def __init__(
        self,
        filename: PathLike[str] | SomeSubstitutionsType,
        node_name: SomeSubstitutionsType | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.__file = ParameterFile(filename)
        self.__node_name = None if node_name is None else normalize_to_list_of_substitutions(node_name)

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type, dict[str, Any]]:
        """Its arguments from `filename` and `node`."""
        _, kwargs = super().parse(entity, parser)
        kwargs["filename"] = parser.parse_substitution(entity.get_attr("filename"))
        node_name = entity.get_attr("node", optional=True)
        if node_name is not None:
            kwargs["node_name"] = parser.parse_substitution(node_name)
        return cls, kwargs

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Remember it."""
        path = self.__file.evaluate(context)
        name = None if self.__node_name is None else perform_substitutions(context, self.__node_name)
        _append(context, "global_params", path if name is None else (name, path))
        return None


@expose_action("set_use_sim_time")
class SetUseSimTime(SetParameter):
    """Has every node that is started from here on use simulated time, or not."""

    def __init__(self, value: bool | SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__("use_sim_time", value, **kwargs)

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type, dict[str, Any]]:
        """Its argument from `value`."""
        _, kwargs = super(SetParameter, cls).parse(entity, parser)
        kwargs["value"] = typed_value(entity.get_attr("value", data_type=bool), parser)
        return cls, kwargs


@expose_action("set_remap")
class SetRemap(Action):
    """Gives a remapping to every node that is started from here on in the same group."""

    def __init__(self, src: SomeSubstitutionsType, dst: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.src = normalize_to_list_of_substitutions(src)
        self.dst = normalize_to_list_of_substitutions(dst)

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type, dict[str, Any]]:
        """Its arguments from `from` and `to`."""
        _, kwargs = super().parse(entity, parser)
        kwargs["src"] = parser.parse_substitution(entity.get_attr("from"))
        kwargs["dst"] = parser.parse_substitution(entity.get_attr("to"))
        return cls, kwargs

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


@expose_action("push_ros_namespace")
@expose_action("push-ros-namespace")
class PushRosNamespace(Action):
    """Has nodes start in a namespace, to the end of the group that it stands in."""

    def __init__(self, namespace: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.__namespace = normalize_to_list_of_substitutions(namespace)

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type, dict[str, Any]]:
        """Its argument from `namespace`."""
        _, kwargs = super().parse(entity, parser)
        kwargs["namespace"] = parser.parse_substitution(entity.get_attr("namespace"))
        return cls, kwargs

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Push it.

        Raises:
            InvalidNamespaceException: if it is not allowed.
        """
        namespace = in_namespace(context, perform_substitutions(context, self.__namespace))
        if namespace is not None:
            check_namespace(namespace)
            context.launch_configurations["ros_namespace"] = namespace
        return None


PushROSNamespace = PushRosNamespace


@expose_action("ros_timer")
class RosTimer(TimerAction):
    """As `TimerAction`: here both go by robot time, also where a node publishes `/clock`."""


ROSTimer = RosTimer
