"""The six services through which others read and set a node's parameters."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from .exceptions import ParameterNotDeclaredException, ParameterUninitializedException
from .parameter import PARAMETER_SEPARATOR_STRING, Parameter
from .qos import qos_profile_parameters

if TYPE_CHECKING:
    from .node import Node


class ParameterService:
    """Made by every node for itself."""

    def __init__(self, node: Node) -> None:
        from rcl_interfaces import srv

        self._node = node
        for name, callback in {
            "DescribeParameters": self._describe,
            "GetParameters": self._get,
            "GetParameterTypes": self._get_types,
            "ListParameters": self._list,
            "SetParameters": self._set,
            "SetParametersAtomically": self._set_atomically,
        }.items():
            words = "".join(f"_{letter.lower()}" if letter.isupper() else letter for letter in name)
            service = f"~/{words.lstrip('_')}"
            node.create_service(getattr(srv, name), service, callback, qos_profile=qos_profile_parameters)

    def _describe(self, request: Any, response: Any) -> Any:
        from rcl_interfaces.msg import ParameterDescriptor

        for name in request.names:
            known = self._node.has_parameter(name)
            descriptor = self._node.describe_parameter(name) if known else ParameterDescriptor(name=name)
            response.descriptors.append(descriptor)
        return response

    def _get(self, request: Any, response: Any) -> Any:
        for name in request.names:
            try:
                response.values.append(self._node.get_parameter(name).get_parameter_value())
            except (ParameterNotDeclaredException, ParameterUninitializedException):
                response.values.clear()
                return response
        return response

    def _get_types(self, request: Any, response: Any) -> Any:
        types = []
        for name in request.names:
            if not self._node.has_parameter(name):
                return response
            types.append(self._node.get_parameter(name).type_.value)
        response.types = types
        return response

    def _list(self, request: Any, response: Any) -> Any:
        prefixes = set()
        for name in self._node._parameters:
            if not _wanted(name, list(request.prefixes), request.depth):
                continue
            response.result.names.append(name)
            if PARAMETER_SEPARATOR_STRING in name:
                prefixes.add(name.rpartition(PARAMETER_SEPARATOR_STRING)[0])
        response.result.prefixes = sorted(prefixes)
        return response

    def _set(self, request: Any, response: Any) -> Any:
        for message in request.parameters:
            response.results.append(self._try_to_set([message]))
        return response

    def _set_atomically(self, request: Any, response: Any) -> Any:
        response.result = self._try_to_set(request.parameters)
        return response

    def _try_to_set(self, messages: Any) -> Any:
        from rcl_interfaces.msg import SetParametersResult

        try:
            parameters = [Parameter.from_parameter_msg(message) for message in messages]
            return self._node.set_parameters_atomically(parameters)
        except ParameterNotDeclaredException as error:
            return SetParametersResult(successful=False, reason=str(error))


def _wanted(name: str, prefixes: list[str], depth: int) -> bool:
    separator = PARAMETER_SEPARATOR_STRING
    if not prefixes:
        return depth == 0 or name.count(separator) < depth
    for prefix in prefixes:
        if name == prefix:
            return True
        if name.startswith(prefix + separator) and (depth == 0 or name[len(prefix) + 1 :].count(separator) < depth):
            return True
    return False
