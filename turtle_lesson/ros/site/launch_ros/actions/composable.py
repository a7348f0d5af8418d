"""Composable nodes, which are C++ libraries: the real actions' names and arguments, and what to do without them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, NoReturn

from launch import Action, LaunchContext
from launch.frontend import Entity, Parser, expose_action
from launch.some_types import SomeSubstitutionsType

from ..descriptions import COMPOSABLE, ComposableNode
from .node import Node


class CompositionNotHere(NotImplementedError):
    """A container of composable nodes was to be started."""

    hint = "Start the same node by itself, with Node(package=…, executable=…), if it has an executable in Python."


class ComposableNodeContainer(Node):
    """A process that loads C++ nodes; to carry it out is refused with a sentence."""

    def __init__(
        self,
        *,
        name: SomeSubstitutionsType,
        namespace: SomeSubstitutionsType,
        composable_node_descriptions: Iterable[ComposableNode] | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(name=name, namespace=namespace, **kwargs)
        self.composable_node_descriptions = list(composable_node_descriptions or [])

    def execute(self, context: LaunchContext) -> NoReturn:
        """Refuse.

        Raises:
            CompositionNotHere: always.
        """
        raise CompositionNotHere(f"ComposableNodeContainer: {COMPOSABLE}")


class LoadComposableNodes(Action):
    """Loads C++ nodes into a container; to carry it out is refused with a sentence."""

    def __init__(
        self,
        *,
        composable_node_descriptions: Iterable[ComposableNode],
        target_container: SomeSubstitutionsType | ComposableNodeContainer,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.composable_node_descriptions = list(composable_node_descriptions)
        self.target_container = target_container

    def execute(self, context: LaunchContext) -> NoReturn:
        """Refuse.

        Raises:
            CompositionNotHere: always.
        """
        raise CompositionNotHere(f"LoadComposableNodes: {COMPOSABLE}")


@expose_action("node_container")
@expose_action("load_composable_node")
@expose_action("composable_node")
def _refuse(entity: Entity, parser: Parser) -> NoReturn:
    raise CompositionNotHere(f"{entity.type_name}: {COMPOSABLE}")
