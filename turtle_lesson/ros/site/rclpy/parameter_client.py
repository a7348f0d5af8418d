"""`AsyncParameterClient`: reading and setting the parameters of another node, through its six services."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from ._blocking import wait_until
from .callback_groups import CallbackGroup
from .client import POLL, Client
from .node import Node
from .parameter import Parameter, parameter_dict_from_yaml_file
from .parameter_service import SERVICES
from .qos import QoSProfile, qos_profile_parameter_events, qos_profile_services_default
from .subscription import Subscription
from .task import Future

Told = Callable[[Future], Any] | None


class AsyncParameterClient:
    """Asks `node`'s executor to talk to the parameter services of the node named `remote_node_name`.

    Each method sends a request and returns a future of its response (rcl_interfaces/srv/…); `callback(future)`, if given,
    is called when that is done. Facts: rclpy's parameter_client.py.
    """

    def __init__(
        self,
        node: Node,
        remote_node_name: str,
        qos_profile: QoSProfile = qos_profile_services_default,
        callback_group: CallbackGroup | None = None,
    ) -> None:
        from rcl_interfaces import srv

        self.remote_node_name = remote_node_name
        self.node = node
        self._clients: dict[str, Client] = {
            name: node.create_client(
                getattr(srv, kind), f"{remote_node_name}/{name}", qos_profile=qos_profile, callback_group=callback_group
            )
            for name, kind in SERVICES.items()
        }

    def services_are_ready(self) -> bool:
        """Whether all six services are there."""
        return all(client.service_is_ready() for client in self._clients.values())

    def wait_for_services(self, timeout_sec: float | None = None) -> bool:
        """Wait until all six services are there; False if they are not within the timeout (s). None waits forever."""
        what = f"wait_for_services of {self.remote_node_name}"
        return wait_until(self.services_are_ready, timeout_sec, POLL, self.node.context, what)

    def _ask(self, name: str, callback: Told, **fields: Any) -> Future:
        client = self._clients[name]
        future = client.call_async(client.srv_type.Request(**fields))
        if callback:
            future.add_done_callback(callback)
        return future

    def list_parameters(
        self, prefixes: list[str] | None = None, depth: int | None = None, callback: Told = None
    ) -> Future:
        """The names below some prefixes (None: of all), to some depth (None or 0: to any)."""
        return self._ask("list_parameters", callback, prefixes=prefixes or [], depth=depth or 0)

    def get_parameters(self, names: list[str], callback: Told = None) -> Future:
        """The values of some parameters."""
        return self._ask("get_parameters", callback, names=names)

    def set_parameters(self, parameters: Sequence[Any], callback: Told = None) -> Future:
        """Set parameters (rclpy's, or rcl_interfaces/msg/Parameter), one by one."""
        return self._ask("set_parameters", callback, parameters=_messages(parameters))

    def set_parameters_atomically(self, parameters: Sequence[Any], callback: Told = None) -> Future:
        """Set all parameters or none."""
        return self._ask("set_parameters_atomically", callback, parameters=_messages(parameters))

    def describe_parameters(self, names: list[str], callback: Told = None) -> Future:
        """The descriptors of some parameters."""
        return self._ask("describe_parameters", callback, names=names)

    def get_parameter_types(self, names: list[str], callback: Told = None) -> Future:
        """The numbers of some parameters' types (rcl_interfaces/msg/ParameterType)."""
        return self._ask("get_parameter_types", callback, names=names)

    def delete_parameters(self, names: list[str], callback: Told = None) -> Future:
        """Take parameters away. Only those that are typed dynamically can be."""
        return self.set_parameters([Parameter(name) for name in names], callback)

    def load_parameter_file(self, parameter_file: str, use_wildcard: bool = False, callback: Told = None) -> Future:
        """Set the parameters of a YAML file, one by one. Raises as `parameter_dict_from_yaml_file` does."""
        found = parameter_dict_from_yaml_file(parameter_file, use_wildcard)
        return self.set_parameters(list(found.values()), callback)

    def load_parameter_file_atomically(
        self, parameter_file: str, use_wildcard: bool = False, callback: Told = None
    ) -> Future:
        """Set all parameters of a YAML file, or none."""
        found = parameter_dict_from_yaml_file(parameter_file, use_wildcard)
        return self.set_parameters_atomically(list(found.values()), callback)

    def on_parameter_event(
        self,
        callback: Callable[..., Any],
        qos_profile: QoSProfile = qos_profile_parameter_events,
        *,
        callback_group: CallbackGroup | None = None,
        event_callbacks: Any = None,
        qos_overriding_options: Any = None,
        raw: bool = False,
    ) -> Subscription:
        """Have `callback(event)` called for what becomes of parameters, of any node (rcl_interfaces/msg/ParameterEvent)."""
        from rcl_interfaces.msg import ParameterEvent

        return self.node.create_subscription(
            ParameterEvent,
            "/parameter_events",
            callback,
            qos_profile,
            callback_group=callback_group,
            event_callbacks=event_callbacks,
            qos_overriding_options=qos_overriding_options,
            raw=raw,
        )


def _messages(parameters: Sequence[Any]) -> list[Any]:
    return [each.to_parameter_msg() if isinstance(each, Parameter) else each for each in parameters]
