"""Composable nodes, which are C++ libraries: the real actions' names and arguments; a launch leaves them out."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, NoReturn

from launch import Action, LaunchContext
from launch.frontend import Entity, Parser, expose_action
from launch.some_types import SomeSubstitutionsType

from turtle_lesson.ros.workspace.errors import NotHereError

from .._parsing import nested_parameters, remap_rules
from ..descriptions import COMPOSABLE, ComposableNode
from .node import Node


@expose_action("node_container")
class ComposableNodeContainer(Node):
    """A process that loads C++ nodes; a launch leaves it out."""

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

    @classmethod
    def parse(cls, entity: Entity, parser: Parser, ignore: list[str] | None = None) -> tuple[type, dict[str, Any]]:
        """Its arguments: a node's, and nested `composable_node` tags."""
        _, kwargs = super().parse(entity, parser, ignore)
        return cls, kwargs | {"composable_node_descriptions": _nested(entity, parser)}

    def execute(self, context: LaunchContext) -> NoReturn:
        """Have it left out.

        Raises:
            NotHereError: always.
        """
        raise NotHereError("ComposableNodeContainer", COMPOSABLE)


@expose_action("load_composable_node")
class LoadComposableNodes(Action):
    """Loads C++ nodes into a container; a launch leaves it out."""

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

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type, dict[str, Any]]:
        """Its arguments: `target`, and nested `composable_node` tags."""
        _, kwargs = super().parse(entity, parser)
        kwargs["target_container"] = parser.parse_substitution(entity.get_attr("target"))
        return cls, kwargs | {"composable_node_descriptions": _nested(entity, parser)}

    def execute(self, context: LaunchContext) -> NoReturn:
        """Have it left out.

        Raises:
            NotHereError: always.
        """
        raise NotHereError("LoadComposableNodes", COMPOSABLE)


def _nested(entity: Entity, parser: Parser) -> list[ComposableNode]:
    """The C++ nodes of `composable_node` tags."""
    nodes = []
    for tag in _tags(entity, "composable_node"):
        texts = {"package": "pkg", "plugin": "plugin", "name": "name", "namespace": "namespace"}
        given = {name: tag.get_attr(attribute, optional=True) for name, attribute in texts.items()}
        for conditions in ("if", "unless"):
            tag.get_attr(conditions, optional=True)
        kwargs: dict[str, Any] = {k: parser.parse_substitution(v) for k, v in given.items() if v is not None}
        kwargs["parameters"] = nested_parameters(_tags(tag, "param"), parser)
        kwargs["remappings"] = remap_rules(_tags(tag, "remap"), parser)
        kwargs["extra_arguments"] = nested_parameters(_tags(tag, "extra_arg"), parser)
        tag.assert_entity_completely_parsed()
        nodes.append(ComposableNode(**kwargs))
    return nodes


def _tags(entity: Entity, name: str) -> list[Entity]:
    return entity.get_attr(name, data_type=list[Entity], optional=True) or []
