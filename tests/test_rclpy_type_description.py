"""What a type looks like, told by a service, and its hash, as ROS 2 publishes it since Iron."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable
from typing import Any

import pytest
import rclpy
from example_interfaces.action import Fibonacci
from example_interfaces.srv import AddTwoInts
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.topic_endpoint_info import TopicEndpointInfo
from rclpy.type_description_service import START_TYPE_DESCRIPTION_SERVICE_PARAM, TypeDescriptionService
from rclpy.type_hash import TypeHash
from rosbags.typesys import Stores, get_typestore
from std_msgs.msg import Header, String
from type_description_interfaces.msg import FieldType
from type_description_interfaces.srv import GetTypeDescription

from turtle_lesson.ros.interfaces import registry
from turtle_lesson.ros.interfaces.definition import parse_message
from turtle_lesson.ros.interfaces.description import hash_of, sources_of, type_description
from turtle_lesson.ros.interfaces.generator import make_module

Run = Callable[..., list[Any]]

KNOWN = {
    "std_msgs/msg/Empty": "20b625256f32d5dbc0d04fee44f43c41e51c70d3502f84b4a08e7a9c26a96312",
    "std_msgs/msg/Bool": "feb91e995ff9ebd09c0cb3d2aed18b11077585839fb5db80193b62d74528f6c9",
    "std_msgs/msg/Byte": "41e1a3345f73fe93ede006da826a6ee274af23dd4653976ff249b0f44e3e798f",
    "std_msgs/msg/Char": "3ad2d04dd29ba19d04b16659afa3ccaedd691914b02a64e82e252f2fa6a586a9",
    "std_msgs/msg/Float32": "7170d3d8f841f7be3172ce5f4f59f3a4d7f63b0447e8b33327601ad64d83d6e2",
    "std_msgs/msg/String": "df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18",
    "std_msgs/msg/Header": "f49fb3ae2cf070f793645ff749683ac6b06203e41c891e17701b1cb597ce6a01",
    "geometry_msgs/msg/Twist": "9c45bf16fe0983d80e3cfe750d6835843d265a9a6c46bd2e609fcddde6fb8d2a",
    "geometry_msgs/msg/PoseWithCovariance": "9a7c0fd234b7f45c6098745ecccd773ca1085670e64107135397aee31c02e1bb",
    "sensor_msgs/msg/CameraInfo": "b3dfd68ff46c9d56c80fd3bd4ed22c7a4ddce8c8348f2f59c299e73118e7e275",
    "sensor_msgs/msg/PointCloud2": "9198cabf7da3796ae6fe19c4cb3bdd3525492988c70522628af5daa124bae2b5",
    "nav_msgs/msg/Odometry": "3cc97dc7fb7502f8714462c526d369e35b603cfc34d946e3f2eda2766dfec6e0",
    "tf2_msgs/msg/TFMessage": "e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087",
    "rosgraph_msgs/msg/Clock": "692f7a66e93a3c83e71765d033b60349ba68023a8c689a79e48078bcb5c58564",
    "example_interfaces/srv/AddTwoInts": "e118de6bf5eeb66a2491b5bda11202e7b68f198d6f67922cf30364858239c81a",
    "std_srvs/srv/SetBool_Event": "3c4c20015afb4303eafd347b1d6a786f171a89c814726961a9593ef10df878cf",
    "std_srvs/srv/Trigger_Request": "d010825374ce8918e72bfd826c82603e60f45419e932ea976f807b74a863a199",
    "rcl_interfaces/srv/DescribeParameters": "845b484d71eb0673dae682f2e3ba3c4851a65a3dcfb97bddd82c5b57e91e4cff",
    "example_interfaces/action/Fibonacci": "9508051da1ea4658de144b09bd0690ff3de52104683d847aed764d2915906f51",
    "example_interfaces/action/Fibonacci_SendGoal": "d1a57fb2a4afe8c21e34fb10db206f16ce6729b28531141472df92277c55b557",
    "example_interfaces/action/Fibonacci_FeedbackMessage": "c1de71afd52e49a89c53d8262366884185bc0a02f78ce051c4e46b0a7fe59bb2",
}
"""Hashes as real releases publish them."""


@pytest.mark.parametrize("name", KNOWN)
def test_a_hash_is_what_a_real_release_has(name: str) -> None:
    assert hash_of(registry.get(name)).hex() == KNOWN[name]


def test_another_implementation_finds_the_same_hashes() -> None:
    """But where a file says char, which is an uint8 in ROS 2 (see std_msgs/msg/Char above)."""
    store = get_typestore(Stores.ROS2_HUMBLE)
    different, compared = set(), 0
    for name in store.types:
        package, folder, kind = name.split("/")
        if folder == "msg" and registry.knows(package) and f"msg/{kind}" in registry.interface_names(package):
            compared += 1
            if store.hash_rihs01(name) != f"RIHS01_{hash_of(registry.get(name)).hex()}":
                different.add(name)
    assert compared > 100
    with_gid = {f"rmw_dds_common/msg/{name}" for name in ("Gid", "NodeEntitiesInfo", "ParticipantEntitiesInfo")}
    assert different == {"std_msgs/msg/Char", *with_gid}


def test_every_interface_here_can_be_described() -> None:
    for package in registry.packages():
        for name in registry.interface_names(package):
            described = type_description(registry.get(f"{package}/{name}"))
            parts = [described["type_description"], *described["referenced_type_descriptions"]]
            named = {each["type_name"] for each in parts}
            for part in parts:
                for field in part["fields"]:
                    nested = field["type"]["nested_type_name"]
                    assert nested == "" or nested in named
                    assert 0 < field["type"]["type_id"] <= 166


def test_the_kinds_of_fields_have_the_numbers_of_the_message_for_them() -> None:
    text = "bool[2] a\nstring<=5 b\nwstring<=5[] c\nfloat32[<=3] d\nchar e\nstd_msgs/Header[] f\nint8 g 5\n"
    module = make_module(parse_message("tests_only", "Kinds", text), registry.resolve)
    fields = type_description(module.Kinds)["type_description"]["fields"]
    assert [
        (each["type"]["type_id"], each["type"]["capacity"], each["type"]["string_capacity"]) for each in fields
    ] == [
        (FieldType.FIELD_TYPE_BOOLEAN_ARRAY, 2, 0),
        (FieldType.FIELD_TYPE_BOUNDED_STRING, 0, 5),
        (FieldType.FIELD_TYPE_BOUNDED_WSTRING_UNBOUNDED_SEQUENCE, 0, 5),
        (FieldType.FIELD_TYPE_FLOAT_BOUNDED_SEQUENCE, 3, 0),
        (FieldType.FIELD_TYPE_UINT8, 0, 0),
        (FieldType.FIELD_TYPE_NESTED_TYPE_UNBOUNDED_SEQUENCE, 0, 0),
        (FieldType.FIELD_TYPE_INT8, 0, 0),
    ]
    assert (fields[-1]["default_value"], fields[0]["default_value"]) == ("5", "")


def test_a_hash_as_text() -> None:
    assert str(TypeHash()) == str(TypeHash(1, b"short")) == "INVALID"
    assert str(TypeHash(1, bytes(range(32)))).startswith("RIHS01_000102")
    assert TypeHash(1, bytes(32)) == TypeHash(version=1, value=bytes(32)) != TypeHash()
    with pytest.raises(AssertionError, match="value must be of type bytes, got 'x'"):
        TypeHash(1, "x")  # type: ignore[arg-type]


def test_an_endpoint_knows_the_hash_of_its_type(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("n")
        node.create_publisher(String, "t", 10)
        (info,) = node.get_publishers_info_by_topic("t")
        found += [str(info.topic_type_hash), "hash" in str(info)]

    assert run(program) == ["RIHS01_" + KNOWN["std_msgs/msg/String"], False]
    assert str(TopicEndpointInfo().topic_type_hash) == "INVALID"
    assert str(TopicEndpointInfo(topic_type="no_such/msg/Type").topic_type_hash) == "INVALID"
    given = TypeHash(1, bytes(32))
    assert TopicEndpointInfo(topic_type="std_msgs/msg/String", topic_type_hash=given).topic_type_hash is given


# -- the service -------------------------------------------------------------------------------------------------------


def ask(node: Node, of: str, hash_text: str, with_sources: bool = True) -> Any:
    client = node.create_client(GetTypeDescription, f"{of}/get_type_description")
    assert client.wait_for_service(timeout_sec=1.0)
    request = GetTypeDescription.Request(type_hash=hash_text, include_type_sources=with_sources)
    future = client.call_async(request)
    rclpy.spin_until_future_complete(node, future, timeout_sec=1.0)
    return future.result()


def talker(_: list[Any]) -> None:
    rclpy.init()
    node = rclpy.create_node("talker")
    node.create_publisher(Header, "headers", 10)
    node.create_service(AddTwoInts, "add", lambda request, response: response)
    TypeDescriptionService(node)
    rclpy.spin(node)


def test_a_node_tells_what_its_types_look_like(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init()
        found.append(ask(rclpy.create_node("n"), "talker", "RIHS01_" + KNOWN["std_msgs/msg/Header"]))

    (response,) = run(talker, program)
    assert (response.successful, response.failure_reason) == (True, "")
    own, (time,) = response.type_description.type_description, response.type_description.referenced_type_descriptions
    assert (own.type_name, [field.name for field in own.fields]) == ("std_msgs/msg/Header", ["stamp", "frame_id"])
    assert (time.type_name, [field.name for field in time.fields]) == (
        "builtin_interfaces/msg/Time",
        ["sec", "nanosec"],
    )
    assert [(each.type_name, each.encoding) for each in response.type_sources] == [
        ("std_msgs/msg/Header", "msg"),
        ("builtin_interfaces/msg/Time", "msg"),
    ]
    assert "string frame_id" in response.type_sources[0].raw_file_contents
    again = {  # whoever gets a description can check that it is the one that was asked for
        "type_description": as_data(own),
        "referenced_type_descriptions": [as_data(time)],
    }
    digest = hashlib.sha256(json.dumps(again, separators=(", ", ": ")).encode()).hexdigest()
    assert digest == KNOWN["std_msgs/msg/Header"]


def as_data(part: Any) -> dict[str, Any]:
    names = ("type_id", "capacity", "string_capacity", "nested_type_name")
    fields = [{"name": each.name, "type": {name: getattr(each.type, name) for name in names}} for each in part.fields]
    return {"type_name": part.type_name, "fields": fields}


def test_of_a_service_too_but_not_of_what_the_node_does_not_use(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("n")
        for wanted in (
            "RIHS01_" + KNOWN["example_interfaces/srv/AddTwoInts"],
            str(TypeHash(1, bytes(32))),
            "AddTwoInts",
        ):
            response = ask(node, "talker", wanted, with_sources=False)
            name = response.type_description.type_description.type_name
            found.append((response.successful, response.failure_reason, name, len(response.type_sources)))

    assert run(talker, program) == [
        (True, "", "example_interfaces/srv/AddTwoInts", 0),
        (False, "Type not currently in use by this node", "", 0),
        (False, "Failed to parse type hash", "", 0),
    ]


def test_a_parameter_says_whether_there_is_the_service(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init()
        off = Parameter(START_TYPE_DESCRIPTION_SERVICE_PARAM, value=False)
        for overrides in ([], [off]):
            node = Node("n", parameter_overrides=overrides)
            service = TypeDescriptionService(node)
            names = [name for name, _ in node.get_service_names_and_types()]
            found.append((service.enabled, f"/{service.service_name}" in names))
            service.destroy()
            found.append(len([name for name, _ in node.get_service_names_and_types() if name.endswith("description")]))
            node.destroy_node()

    assert run(program) == [(True, True), 0, (False, False), 0]


def test_sources_of_what_is_made_of_a_file_are_implicit() -> None:
    assert [(name, encoding) for name, encoding, _ in sources_of(AddTwoInts)][:3] == [
        ("example_interfaces/srv/AddTwoInts", "srv"),
        ("example_interfaces/srv/AddTwoInts_Request", "implicit"),
        ("example_interfaces/srv/AddTwoInts_Response", "implicit"),
    ]
    (name, encoding, text), *rest = sources_of(Fibonacci)
    assert (name, encoding, "int32 order" in text) == ("example_interfaces/action/Fibonacci", "action", True)
    assert {each[1] for each in rest} == {"implicit", "msg"}
