"""`PushRosNamespace`: put the nodes that follow into a namespace."""

from __future__ import annotations

from typing import Any

from launch import Action, LaunchContext, LaunchDescriptionEntity
from launch.frontend import Entity, Parser, expose_action
from launch.some_types import SomeSubstitutionsType
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions

from .._names import check_namespace, in_namespace


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
