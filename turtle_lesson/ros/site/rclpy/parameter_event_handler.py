"""`ParameterEventHandler`: being told when parameters change, of this node or others (rclpy of Jazzy and newer)."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from itertools import chain
from typing import Any

from .callback_groups import CallbackGroup
from .node import Node
from .qos import QoSProfile, qos_profile_parameter_events

GONE = "Callback doesn't exist"


@dataclass(eq=False)
class ParameterCallbackHandle:
    """What `add_parameter_callback` returns, and `remove_parameter_callback` takes."""

    parameter_name: str
    node_name: str
    callback: Callable[[Any], Any]


@dataclass(eq=False)
class ParameterEventCallbackHandle:
    """What `add_parameter_event_callback` returns, and `remove_parameter_event_callback` takes."""

    callback: Callable[[Any], Any]


class ParameterEventHandler:
    """Listens on /parameter_events with a node that is spun. Its callbacks run in that subscription's callback group.

    The newest callback is called first; those for one parameter go before those for whole events.
    """

    def __init__(
        self,
        node: Node,
        qos_profile: QoSProfile = qos_profile_parameter_events,
        callback_group: CallbackGroup | None = None,
        event_callbacks: Any = None,
        qos_overriding_options: Any = None,
        raw: bool = False,
    ) -> None:
        from rcl_interfaces.msg import ParameterEvent

        self.node = node
        self.qos_profile = qos_profile
        self._parameter_callbacks: list[ParameterCallbackHandle] = []
        self._event_callbacks: list[ParameterEventCallbackHandle] = []
        self.parameter_event_subscription = node.create_subscription(
            ParameterEvent,
            "/parameter_events",
            self._on_event,
            qos_profile,
            callback_group=callback_group,
            event_callbacks=event_callbacks,
            qos_overriding_options=qos_overriding_options,
            raw=raw,
        )

    def _on_event(self, event: Any) -> None:
        for handle in list(self._parameter_callbacks):
            parameter = self.get_parameter_from_event(event, handle.parameter_name, handle.node_name)
            if parameter is not None:
                handle.callback(parameter)
        for each in list(self._event_callbacks):
            each.callback(event)

    def destroy(self) -> None:
        """Listen no more."""
        self.node.destroy_subscription(self.parameter_event_subscription)

    @staticmethod
    def get_parameter_from_event(event: Any, parameter_name: str, node_name: str) -> Any:
        """The rcl_interfaces/msg/Parameter of a name in an event, if it is new or changed and of this node; or None."""
        found = (each for each in chain(event.new_parameters, event.changed_parameters) if each.name == parameter_name)
        return next(found, None) if event.node == node_name else None

    @staticmethod
    def get_parameters_from_event(event: Any) -> Iterable[Any]:
        """The parameters in an event that are new or changed."""
        yield from chain(event.new_parameters, event.changed_parameters)

    def add_parameter_callback(
        self, parameter_name: str, node_name: str, callback: Callable[[Any], Any]
    ) -> ParameterCallbackHandle:
        """Have `callback(parameter)` called when a parameter of a node is new or changed.

        A relative `node_name` is in this node's namespace; '' is this node.
        """
        if not node_name:
            node_name = self.node.get_fully_qualified_name()
        elif not node_name.startswith("/"):
            node_name = f"{self.node.get_namespace().rstrip('/')}/{node_name}"
        handle = ParameterCallbackHandle(parameter_name, node_name, callback)
        self._parameter_callbacks.insert(0, handle)
        return handle

    def remove_parameter_callback(self, handle: ParameterCallbackHandle) -> None:
        """No longer call a callback. Raises RuntimeError if it is not (or no longer) called."""
        if handle not in self._parameter_callbacks:
            raise RuntimeError(GONE)
        self._parameter_callbacks.remove(handle)

    def add_parameter_event_callback(self, callback: Callable[[Any], Any]) -> ParameterEventCallbackHandle:
        """Have `callback(event)` called for each rcl_interfaces/msg/ParameterEvent."""
        handle = ParameterEventCallbackHandle(callback)
        self._event_callbacks.insert(0, handle)
        return handle

    def remove_parameter_event_callback(self, handle: ParameterEventCallbackHandle) -> None:
        """No longer call a callback. Raises RuntimeError if it is not (or no longer) called."""
        if handle not in self._event_callbacks:
            raise RuntimeError(GONE)
        self._event_callbacks.remove(handle)
