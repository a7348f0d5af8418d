"""The services with which others read and set a node's parameters: here all are numbers from 0 to 10."""

from __future__ import annotations

from typing import Any

from rcl_interfaces.msg import (
    FloatingPointRange,
    Parameter,
    ParameterDescriptor,
    ParameterEvent,
    ParameterValue,
    SetParametersResult,
)
from rcl_interfaces.srv import DescribeParameters, GetParameters, ListParameters, SetParameters


class ParameterService:
    def __init__(self, node: Any) -> None:
        self._node = node
        for kind, what, answer in (
            (ListParameters, "list", self._list),
            (DescribeParameters, "describe", self._describe),
            (GetParameters, "get", self._get),
            (SetParameters, "set", self._set),
        ):
            node.create_service(kind, f"/{node.get_name()}/{what}_parameters", answer)

    def _list(self, request: Any, response: Any) -> Any:
        response.result.names = list(self._node._parameters)
        return response

    def _describe(self, request: Any, response: Any) -> Any:
        limits = [FloatingPointRange(from_value=0.0, to_value=10.0, step=0.5)]
        response.descriptors = [
            ParameterDescriptor(name=name, type=3, floating_point_range=limits) for name in request.names
        ]
        return response

    def _get(self, request: Any, response: Any) -> Any:
        response.values = [ParameterValue(type=3, double_value=self._node._parameters[name]) for name in request.names]
        return response

    def _set(self, request: Any, response: Any) -> Any:
        for parameter in request.parameters:
            fits = 0.0 <= parameter.value.double_value <= 10.0
            response.results = [SetParametersResult(successful=fits, reason="" if fits else "from 0 to 10")]
            if fits:
                self._node._parameters[parameter.name] = parameter.value.double_value
                changed = [Parameter(name=parameter.name, value=parameter.value)]
                self._node._events.publish(ParameterEvent(node=f"/{self._node.get_name()}", changed_parameters=changed))
        return response
