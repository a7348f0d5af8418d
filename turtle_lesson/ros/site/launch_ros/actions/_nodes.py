"""`Node`, which starts a ROS node, what holds for all nodes that follow, and composable nodes, which a launch leaves out."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, ClassVar, NoReturn

import yaml
from launch import Action, Condition, LaunchContext, logging
from launch._entities import SomeSubstitutionsType, explained, text_of
from launch._entities import normalize_to_list_of_substitutions as pieces
from launch.actions import ExecuteProcess
from launch.actions._processes import Program, command_line, listed
from launch.frontend import Entity, attribute, expose_action, pair, tags
from launch.substitutions import SubstitutionFailure
from rclpy.validate_namespace import validate_namespace
from rclpy.validate_node_name import validate_node_name

from turtle_lesson.ros.ament.package import NotHereError
from turtle_lesson.ros.sim.errors import shown_path

from ..parameter_descriptions import ParameterFile, as_argument, file_for_this_launch, parameters, parameters_in
from ..substitutions import ExecutableInPackage

__all__ = [
    "ComposableNodeContainer", "LoadComposableNodes", "Node", "PushROSNamespace", "PushRosNamespace", "SetParameter",
    "SetRemap", "SetUseSimTime",
]  # fmt: skip


def in_namespace(context: LaunchContext, namespace: str | None) -> str | None:
    """A node's full namespace: its own, within what was pushed; None if there is neither."""
    pushed = context.launch_configurations.get("ros_namespace")
    if namespace is None or (pushed is not None and not namespace):
        return pushed
    outer = "" if pushed is None or namespace.startswith("/") else pushed
    return "/" + f"{outer}/{namespace}".strip("/")


Remapping = tuple[SomeSubstitutionsType, SomeSubstitutionsType]
_FITS_A_RULE = re.compile(r"[A-Za-z_]\w*(\.\w+)*", re.ASCII)


@expose_action("node")
class Node(ExecuteProcess):
    """Starts an executable of a package, with its name, namespace, parameters and remappings.

    Args:
        executable: the program; without a package, the path of a Python file.
        name: the node's name, or None for the one that the program chooses.
        namespace: its namespace; a relative one goes within what PushRosNamespace set.
        exec_name: what the process is called in the output; the executable's name if it is not given.
        parameters: a list of dictionaries, paths of YAML files, or both; a later one counts more.
        ros_arguments: further words behind `--ros-args`.
        arguments: further words before it, for the program itself.
    """

    UNSPECIFIED_NODE_NAME = "<node_name_unspecified>"
    UNSPECIFIED_NODE_NAMESPACE = "<node_namespace_unspecified>"
    _tag: ClassVar = {
        **{name: read for name, read in ExecuteProcess._tag.items() if name != "cmd"},
        "arguments": command_line("args", optional=True),
        "ros_arguments": command_line("ros_args", optional=True),
        "executable": attribute("exec"),
        "package": attribute("pkg", optional=True),
        "namespace": attribute("namespace", optional=True),
        "exec_name": attribute("exec_name", optional=True),
        "remappings": tags("remap", pair("from", "to")),
        "parameters": parameters,
    }

    def __init__(
        self,
        *,
        executable: SomeSubstitutionsType,
        package: SomeSubstitutionsType | None = None,
        name: SomeSubstitutionsType | None = None,
        namespace: SomeSubstitutionsType | None = None,
        exec_name: SomeSubstitutionsType | None = None,
        parameters: Sequence[Any] | None = None,
        remappings: Iterable[Remapping] | None = None,
        ros_arguments: Iterable[SomeSubstitutionsType] | None = None,
        arguments: Iterable[SomeSubstitutionsType] | None = None,
        **kwargs: Any,
    ) -> None:
        if not isinstance(parameters, list | None):
            what = "'Node' expected 'parameters' to be one of [<class 'list'>]"
            what += f", but got '{parameters}' of type '{type(parameters)}'"
            raise explained(TypeError(what), "Put it into a list: parameters=[{…}]")
        self.__in_package = None if package is None else ExecutableInPackage(executable, package)
        words = [*listed("arguments", arguments), "--ros-args", *listed("ros_arguments", ros_arguments)]
        super().__init__(cmd=[self.__in_package or executable, *words], name=exec_name, **kwargs)
        self.node_package = package
        self.node_executable = executable
        self.__node_name = name
        self.__namespace = namespace
        self.__parameters = parameters or []
        self.__remappings = list(remappings or [])
        for rule in self.__remappings:
            if isinstance(rule, str) or not isinstance(rule, Sequence) or len(rule) != 2:
                raise TypeError(
                    f"Node expected 'remappings' to be a list of pairs, got {rule!r} in it; "
                    "write remappings=[('/from', '/to')]"
                )
        self.expanded_node_name = self.UNSPECIFIED_NODE_NAME
        self.expanded_node_namespace = self.UNSPECIFIED_NODE_NAMESPACE

    @property
    def node_name(self) -> str:
        """The node's full name, as far as the launch file decides it."""
        return f"{self.expanded_node_namespace.rstrip('/')}/{self.expanded_node_name}"

    def _name_words(self, context: LaunchContext) -> list[str]:
        words = []
        try:
            if self.__node_name is not None:
                self.expanded_node_name = text_of(context, self.__node_name)
                validate_node_name(self.expanded_node_name)
                words += ["-r", f"__node:={self.expanded_node_name}"]
            own = None if self.__namespace is None else text_of(context, self.__namespace)
            namespace = in_namespace(context, own)
            if namespace is not None:
                self.expanded_node_namespace = namespace
                validate_namespace(namespace)
                words += ["-r", f"__ns:={namespace}"]
        except Exception:
            what = f"package={self.node_package}, executable={self.node_executable}, name={self.__node_name}"
            logging.get_logger("launch_ros.actions.node").error(
                f"Error while expanding or validating node name or namespace for '{what}, "
                f"namespace={self.__namespace}':"
            )
            raise
        return words

    def _parameter_words(self, context: LaunchContext) -> list[str]:
        words = []
        for entry in [context.launch_configurations.get("global_params", {}), *self.__parameters]:
            if isinstance(entry, Mapping):
                for name, value in parameters_in(context, entry):
                    words += self._words_for(name, value)
            else:
                path = (entry if isinstance(entry, ParameterFile) else ParameterFile(entry)).evaluate(context)
                if not path.is_file():
                    text = f"Parameter file path is not a file: {shown_path(str(path))}"
                    logging.get_logger("launch_ros.actions.node").warning(text)
                words += ["--params-file", str(path)]
        return words

    def _words_for(self, name: str, value: Any) -> list[str]:
        """What gives a parameter: a rule that one can read, or for a name that none can hold, as `~speed`, a file."""
        if _FITS_A_RULE.fullmatch(name):
            return ["-p", f"{name}:={as_argument(value)}"]
        text = yaml.safe_dump({"/**": {"ros__parameters": {name: value}}}, allow_unicode=True)
        return ["--params-file", str(file_for_this_launch(self, "parameter.yaml", text))]

    def _find_program(self, context: LaunchContext) -> Program:
        argv = [*self.cmd, *self._name_words(context), *self._parameter_words(context)]
        own = [(text_of(context, source), text_of(context, target)) for source, target in self.__remappings]
        for source, target in [*context.launch_configurations.get("ros_remaps", []), *own]:
            argv += ["-r", f"{source}:={target}"]
        # a file made for this launch lies elsewhere in every run
        words = [re.sub(r".*/launch_params_\w+/", "launch_params/", word) for word in argv[1:] if word.strip()]
        shown = " ".join([shown_path(argv[0]), *words])
        if self.__in_package is not None:
            return Program(self.__in_package.target(context), argv, shown)
        path = Path(argv[0])
        if not path.is_file():
            error = SubstitutionFailure(f"executable '{argv[0]}' is not a file")
            raise explained(error, "Did you leave package='…' out?")
        return Program(path.resolve(), argv, shown)


# -- what holds for all nodes that follow: parameters, remappings and namespaces. It is a launch configuration, since the end of
# a group forgets those.


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
        before = context.launch_configurations.get("global_params", {})
        context.launch_configurations["global_params"] = {**before, text_of(context, self.name): self.value}


@expose_action("set_use_sim_time")
class SetUseSimTime(SetParameter):
    """Has every node that is started from here on use simulated time, or not."""

    _tag: ClassVar = {"value": attribute("value", bool)}

    def __init__(self, value: bool | SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__("use_sim_time", value, **kwargs)


@expose_action("set_remap")
class SetRemap(Action):
    """Gives a remapping to every node that is started from here on in the same group."""

    _tag: ClassVar = {"src": attribute("from"), "dst": attribute("to")}

    def __init__(self, src: SomeSubstitutionsType, dst: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.src, self.dst = pieces(src), pieces(dst)

    def execute(self, context: LaunchContext) -> None:
        """Remember it."""
        before = context.launch_configurations.get("ros_remaps", [])
        rule = (text_of(context, self.src), text_of(context, self.dst))
        context.launch_configurations["ros_remaps"] = [*before, rule]


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


# -- composable nodes ------------------------------------------------------------------------------------------------------


class _ComposableAction(Action):
    """Base of the actions for composable nodes: it accepts any arguments, and a launch leaves it out with a warning."""

    _tag: ClassVar = {"described": Entity.ignore_rest}

    def __init__(self, *, condition: Condition | None = None, **described: Any) -> None:
        super().__init__(condition=condition)

    def execute(self, context: LaunchContext) -> NoReturn:
        """Have it left out. Always raises NotHereError."""
        why = "composable nodes are C++ libraries, and only Python nodes run here"
        raise NotHereError(type(self).__name__, why)


@expose_action("node_container")
class ComposableNodeContainer(_ComposableAction):
    """A process that loads C++ nodes."""


@expose_action("load_composable_node")
class LoadComposableNodes(_ComposableAction):
    """Loads C++ nodes into a container."""
