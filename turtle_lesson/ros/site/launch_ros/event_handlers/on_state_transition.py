"""`OnStateTransition`: what to do when a managed node has changed its state."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from launch import Event, EventHandler
from launch.some_types import SomeEntitiesType

from ..events.lifecycle import StateTransition

if TYPE_CHECKING:
    from ..actions import LifecycleNode


class OnStateTransition(EventHandler):
    """Gives its entities when a managed node's transition fits all that is given.

    Args:
        entities: what is visited then.
        target_lifecycle_node: the node, or None for any.
        transition: the transition's name, such as `configure`.
        start_state: the state that it comes from, such as `unconfigured`.
        goal_state: the state that it comes to.
        matcher: a function of the event; if it is given, it alone decides.
    """

    def __init__(
        self,
        *,
        entities: SomeEntitiesType,
        target_lifecycle_node: LifecycleNode | None = None,
        transition: str | None = None,
        start_state: str | None = None,
        goal_state: str | None = None,
        matcher: Callable[[Event], bool] | None = None,
        **kwargs: Any,
    ) -> None:
        from ..actions import LifecycleNode

        if target_lifecycle_node is not None and not isinstance(target_lifecycle_node, LifecycleNode):
            raise RuntimeError(
                'OnStateTransition requires a "LifecycleNode" action as the target, '
                "target_lifecycle_node is not a node type."
            )
        wanted = {"transition": transition, "start_state": start_state, "goal_state": goal_state}

        def fits(event: Event) -> bool:
            return (
                isinstance(event, StateTransition)
                and target_lifecycle_node in (None, event.action)
                and all(value in (None, getattr(event, name)) for name, value in wanted.items())
            )

        super().__init__(matcher=matcher or fits, entities=entities, **kwargs)
