"""Composable nodes, as launch files describe them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from launch._entities import SomeSubstitutionsType
from launch._package import explain_missing
from launch.utilities import normalize_to_list_of_substitutions

from .parameter_descriptions import Parameter, ParameterFile, ParameterValue

__all__ = ["ComposableLifecycleNode", "ComposableNode", "Parameter", "ParameterFile", "ParameterValue"]


COMPOSABLE = "composable nodes are C++ libraries, and only Python nodes run here"


class ComposableNode:
    """What is to be loaded into a container, as it was given; containers cannot be started here."""

    def __init__(
        self,
        *,
        package: SomeSubstitutionsType,
        plugin: SomeSubstitutionsType,
        name: SomeSubstitutionsType | None = None,
        namespace: SomeSubstitutionsType | None = None,
        parameters: Iterable[Any] | None = None,
        remappings: Iterable[Any] | None = None,
        extra_arguments: Iterable[Any] | None = None,
        condition: Any = None,
    ) -> None:
        self.package = normalize_to_list_of_substitutions(package)
        self.node_plugin = normalize_to_list_of_substitutions(plugin)
        self.node_name = None if name is None else normalize_to_list_of_substitutions(name)
        self.node_namespace = None if namespace is None else normalize_to_list_of_substitutions(namespace)
        self.parameters = None if parameters is None else list(parameters)
        self.remappings = None if remappings is None else list(remappings)
        self.extra_arguments = None if extra_arguments is None else list(extra_arguments)
        self.condition = condition


class ComposableLifecycleNode(ComposableNode):
    """The same for a managed node."""

    def __init__(self, *, autostart: bool = False, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.autostart = autostart


__getattr__ = explain_missing(__name__, {"RosExecutable": "use Node", "Node": "use launch_ros.actions.Node"})
