"""Composable nodes, as launch files describe them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from launch._entities import SomeSubstitutionsType
from launch.utilities import normalize_to_list_of_substitutions as pieces

from .parameter_descriptions import Parameter, ParameterFile, ParameterValue

__all__ = ["ComposableLifecycleNode", "ComposableNode", "Parameter", "ParameterFile", "ParameterValue"]


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
        self.package, self.node_plugin = pieces(package), pieces(plugin)
        self.node_name = None if name is None else pieces(name)
        self.node_namespace = None if namespace is None else pieces(namespace)
        self.parameters = None if parameters is None else list(parameters)
        self.remappings = None if remappings is None else list(remappings)
        self.extra_arguments = None if extra_arguments is None else list(extra_arguments)
        self.condition = condition


class ComposableLifecycleNode(ComposableNode):
    """The same for a managed node."""

    def __init__(self, *, autostart: bool = False, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.autostart = autostart
