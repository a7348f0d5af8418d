"""The six services through which others read and set a node's parameters."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from .exceptions import ParameterNotDeclaredException, ParameterUninitializedException
from .parameter import PARAMETER_SEPARATOR_STRING, Parameter
from .qos import qos_profile_parameters

if TYPE_CHECKING:
    from .node import Node

SERVICES = {
    "describe_parameters": "DescribeParameters",
    "get_parameters": "GetParameters",
    "get_parameter_types": "GetParameterTypes",
    "list_parameters": "ListParameters",
    "set_parameters": "SetParameters",
    "set_parameters_atomically": "SetParametersAtomically",
}
"""The services' names and types (rcl_interfaces/srv/…)."""


class ParameterService:
    """Made by every node for itself."""

    def __init__(self, node: Node) -> None:
        from rcl_interfaces import srv

        self._node = node
        for name, kind in SERVICES.items():
            callback = getattr(self, f"_{name}")
            node.create_service(getattr(srv, kind), f"~/{name}", callback, qos_profile=qos_profile_parameters)

    def _describe_parameters(self, request: Any, response: Any) -> Any:
        if all(map(self._node.has_parameter, request.names)):
            response.descriptors = self._node.describe_parameters(request.names)
        return response

    def _get_parameters(self, request: Any, response: Any) -> Any:
        try:
            parameters = self._node.get_parameters(request.names)
        except (ParameterNotDeclaredException, ParameterUninitializedException):
            return response
        response.values = [parameter.get_parameter_value() for parameter in parameters]
        return response

    def _get_parameter_types(self, request: Any, response: Any) -> Any:
        if all(map(self._node.has_parameter, request.names)):
            response.types = self._node.get_parameter_types(request.names)
        return response

    def _list_parameters(self, request: Any, response: Any) -> Any:
        """List names below prefixes. In Humble (parameter_service.py) a name without dots need only begin with one."""
        prefixes = list(request.prefixes)
        response.result = result = self._node.list_parameters(prefixes, request.depth)
        below = set(result.names)
        result.names = [
            name
            for name in self._node._ros_parameters
            if name in below or (PARAMETER_SEPARATOR_STRING not in name and name.startswith(tuple(prefixes)))
        ]
        return response

    def _set_parameters(self, request: Any, response: Any) -> Any:
        response.results = [self._try_to_set([message]) for message in request.parameters]
        return response

    def _set_parameters_atomically(self, request: Any, response: Any) -> Any:
        response.result = self._try_to_set(request.parameters)
        return response

    def _try_to_set(self, messages: Any) -> Any:
        from rcl_interfaces.msg import SetParametersResult

        try:
            parameters = [Parameter.from_parameter_msg(message) for message in messages]
            return self._node.set_parameters_atomically(parameters)
        except ParameterNotDeclaredException as error:
            return SetParametersResult(successful=False, reason=str(error))
