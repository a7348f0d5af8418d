"""Actions that hold for all nodes that follow: parameters, remappings and namespaces."""

from __future__ import annotations

from os import PathLike
from typing import Any, ClassVar

from launch import Action, LaunchContext
from launch._entities import SomeSubstitutionsType, text_of
from launch._entities import normalize_to_list_of_substitutions as pieces
from launch.frontend import attribute, expose_action
from rclpy.validate_namespace import validate_namespace

from ..parameter_descriptions import ParameterFile
from ._nodes import in_namespace

__all__ = ["PushROSNamespace", "PushRosNamespace", "SetParameter", "SetParametersFromFile", "SetRemap", "SetUseSimTime"]


@expose_action("set_parameter")
class SetParameter(Action):
    """Gives a parameter to every node that is started from here on in the same group."""

    _tag: ClassVar = {"name": attribute("name"), "value": attribute("value", None)}

    def __init__(self, name: SomeSubstitutionsType, value: Any, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.name = pieces(name)
        self.value = value

    def execute(self, context: LaunchContext) -> None:
        """Remember it."""
        _append(context, "global_params", {text_of(context, self.name): self.value})


@expose_action("set_use_sim_time")
class SetUseSimTime(SetParameter):
    """Has every node that is started from here on use simulated time, or not."""

    _tag: ClassVar = {"value": attribute("value", bool)}

    def __init__(self, value: bool | SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__("use_sim_time", value, **kwargs)


@expose_action("set_parameters_from_file")
class SetParametersFromFile(Action):
    """Gives a file of parameters to every node that is started from here on in the same group."""

    _tag: ClassVar = {"filename": attribute("filename"), "node_name": attribute("node", optional=True)}

    def __init__(
        self,
        filename: PathLike[str] | SomeSubstitutionsType,
        node_name: SomeSubstitutionsType | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.__file = ParameterFile(filename)
        self.__node_name = None if node_name is None else pieces(node_name)

    def execute(self, context: LaunchContext) -> None:
        """Remember it."""
        path = self.__file.evaluate(context)
        name = None if self.__node_name is None else text_of(context, self.__node_name)
        _append(context, "global_params", path if name is None else (name, path))


@expose_action("set_remap")
class SetRemap(Action):
    """Gives a remapping to every node that is started from here on in the same group."""

    _tag: ClassVar = {"src": attribute("from"), "dst": attribute("to")}

    def __init__(self, src: SomeSubstitutionsType, dst: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.src, self.dst = pieces(src), pieces(dst)

    def execute(self, context: LaunchContext) -> None:
        """Remember it."""
        _append(context, "ros_remaps", (text_of(context, self.src), text_of(context, self.dst)))


def _append(context: LaunchContext, name: str, entry: Any) -> None:
    """Add to a list among the configurations; a new list, so that the group's end forgets it."""
    context.launch_configurations[name] = [*context.launch_configurations.get(name, []), entry]


@expose_action("push_ros_namespace")
@expose_action("push-ros-namespace")
class PushRosNamespace(Action):
    """Has nodes start in a namespace, to the end of the group that it stands in."""

    _tag: ClassVar = {"namespace": attribute("namespace")}

    def __init__(self, namespace: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.__namespace = pieces(namespace)

    def execute(self, context: LaunchContext) -> None:
        """Push it. Raises InvalidNamespaceException if it is not allowed."""
        namespace = in_namespace(context, text_of(context, self.__namespace))
        if namespace is not None:
            validate_namespace(namespace)
            context.launch_configurations["ros_namespace"] = namespace


PushROSNamespace = PushRosNamespace
