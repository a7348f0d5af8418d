"""What belongs to a managed node, and goes through its transitions with it."""

from __future__ import annotations

from collections.abc import Callable
from enum import Enum
from functools import wraps
from typing import Any, NamedTuple


class LifecycleState(NamedTuple):
    """A state, as a transition's callback is told it: the one that the transition begins in."""

    label: str
    state_id: int


class TransitionCallbackReturnType(Enum):
    """What a transition's callback returns: `rclpy.lifecycle.TransitionCallbackReturn`."""

    SUCCESS = 97
    FAILURE = 98
    ERROR = 99

    def to_label(self) -> str:
        """The label of the transition that follows."""
        return f"transition_{self.name.lower()}"


TransitionCallbackReturn = TransitionCallbackReturnType


class ManagedEntity:
    """Base class. Each method is called in a transition, with the state it begins in, and returns how that went.

    By default a transition succeeds; that of a node asks all its managed entities, up to the first that does not succeed.
    """

    def _ros_go_along(self, name: str, state: LifecycleState) -> TransitionCallbackReturn:
        """What the method of a name does by default."""
        return TransitionCallbackReturn.SUCCESS

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """The node is being configured."""
        return self._ros_go_along("on_configure", state)

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """The node is being cleaned up."""
        return self._ros_go_along("on_cleanup", state)

    def on_shutdown(self, state: LifecycleState) -> TransitionCallbackReturn:
        """The node is being shut down."""
        return self._ros_go_along("on_shutdown", state)

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """The node is being activated."""
        return self._ros_go_along("on_activate", state)

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """The node is being deactivated."""
        return self._ros_go_along("on_deactivate", state)

    def on_error(self, state: LifecycleState) -> TransitionCallbackReturn:
        """An error is being dealt with."""
        return self._ros_go_along("on_error", state)


class SimpleManagedEntity(ManagedEntity):
    """An entity that is enabled while its node is active."""

    def __init__(self) -> None:
        self._enabled = False

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """From now on it is enabled."""
        self._enabled = True
        return TransitionCallbackReturn.SUCCESS

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """From now on it is not enabled."""
        self._enabled = False
        return TransitionCallbackReturn.SUCCESS

    @property
    def is_activated(self) -> bool:
        """Whether it is enabled."""
        return self._enabled

    @staticmethod
    def when_enabled(
        wrapped: Callable[..., None] | None = None, *, when_not_enabled: Callable[[], Any] | None = None
    ) -> Any:
        """Decorator for a method that does nothing, or calls `when_not_enabled()`, while the entity is not enabled."""

        def decorate(method: Callable[..., None]) -> Callable[..., None]:
            @wraps(method)
            def only_when_enabled(self: SimpleManagedEntity, *args: Any, **kwargs: Any) -> None:
                if self._enabled:
                    method(self, *args, **kwargs)
                elif when_not_enabled is not None:
                    when_not_enabled()

            return only_when_enabled

        return decorate if wrapped is None else decorate(wrapped)
