"""The service by which a node tells what its types look like (rclpy of Jazzy and newer).

There every node has it. Where the world behaves as an older release, a node has it if the program makes one:
`TypeDescriptionService(node)`.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any
from weakref import ref

from turtle_lesson.ros.interfaces.description import Description, hash_of, sources_of, type_description

from .parameter import Parameter
from .qos import qos_profile_services_default

if TYPE_CHECKING:
    from .node import Node
    from .service import Service

START_TYPE_DESCRIPTION_SERVICE_PARAM = "start_type_description_service"
HASH = re.compile(r"RIHS01_[0-9a-f]{64}")


class TypeDescriptionService:
    """Offers `~/get_type_description`, unless the parameter `start_type_description_service` is false."""

    def __init__(self, node: Node) -> None:
        from rcl_interfaces.msg import ParameterDescriptor

        self._node = ref(node)
        self.service_name = f"{node.get_name()}/get_type_description"
        self.enabled = False
        self._service: Service | None = None
        name = START_TYPE_DESCRIPTION_SERVICE_PARAM
        if not node.has_parameter(name):
            words = "If enabled, start the ~/get_type_description service."
            node.declare_parameter(name, True, ParameterDescriptor(name=name, description=words, read_only=True))
        parameter = node.get_parameter(name)
        if parameter.type_ == Parameter.Type.BOOL:
            self.enabled = parameter.value
        elif parameter.type_ != Parameter.Type.NOT_SET:
            node.get_logger().error(f"Invalid type for parameter '{name}' {parameter.type_!r} should be bool")
        if self.enabled:
            self._start(node)

    def _start(self, node: Node) -> None:
        from type_description_interfaces.srv import GetTypeDescription

        self._service = node.create_service(
            GetTypeDescription, self.service_name, self._answer, qos_profile=qos_profile_services_default
        )

    def destroy(self) -> None:
        """Offer the service no longer."""
        node = self._node()
        if self._service is not None and node is not None:
            node.destroy_service(self._service)
        self._service = None

    def _answer(self, request: Any, response: Any) -> Any:
        if not HASH.fullmatch(request.type_hash):
            response.failure_reason = "Failed to parse type hash"
            return response
        wanted = bytes.fromhex(request.type_hash[len("RIHS01_") :])
        interface = next((each for each in self._types_in_use() if hash_of(each) == wanted), None)
        if interface is None:
            response.failure_reason = "Type not currently in use by this node"
            return response
        _fill(response, interface, request.include_type_sources)
        return response

    def _types_in_use(self) -> list[Any]:
        node = self._node()
        if node is None:
            return []
        found = [end.msg_type for ends in (node.publishers, node.subscriptions) for end in ends]
        found += [end.srv_type for ends in (node.services, node.clients) for end in ends]
        return found


def _fill(response: Any, interface: Any, with_sources: bool) -> None:
    from type_description_interfaces.msg import TypeDescription, TypeSource

    description = type_description(interface)
    response.type_description = TypeDescription(
        type_description=_individual(description["type_description"]),
        referenced_type_descriptions=[_individual(each) for each in description["referenced_type_descriptions"]],
    )
    if with_sources:
        response.type_sources = [
            TypeSource(type_name=name, encoding=encoding, raw_file_contents=text)
            for name, encoding, text in sources_of(interface)
        ]
    response.successful = True


def _individual(part: Description) -> Any:
    from type_description_interfaces.msg import Field, FieldType, IndividualTypeDescription

    fields = [
        Field(name=each["name"], type=FieldType(**each["type"]), default_value=each["default_value"])
        for each in part["fields"]
    ]
    return IndividualTypeDescription(type_name=part["type_name"], fields=fields)
