"""Quality of service that whoever starts a node may override by parameters (rclpy's qos_overriding_options.py)."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
import rclpy
from rclpy.duration import Duration
from rclpy.parameter import Parameter
from rclpy.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    LivelinessPolicy,
    QoSPolicyKind,
    QoSProfile,
    ReliabilityPolicy,
    qos_profile_sensor_data,
)
from rclpy.qos_overriding_options import InvalidQosOverridesError, QosCallbackResult, QoSOverridingOptions
from std_msgs.msg import String

from turtle_lesson.ros.world import World

USUAL = QoSOverridingOptions.with_default_policies()
EVERYTHING = QoSOverridingOptions([kind for kind in QoSPolicyKind if kind != QoSPolicyKind.INVALID])


def at_most_ten(qos: QoSProfile) -> Any:
    """A check as a program has it."""
    return QosCallbackResult(successful=qos.depth <= 10, reason="expected qos depth less than 10")


def test_what_may_be_overridden_is_declared_read_only(world: World) -> None:
    rclpy.init()
    node = rclpy.create_node("talker")
    node.create_publisher(String, "chatter", 10, qos_overriding_options=USUAL)
    declared = node.get_parameters_by_prefix("qos_overrides")
    assert {name: parameter.value for name, parameter in declared.items()} == {
        "/chatter.publisher.history": "keep_last",
        "/chatter.publisher.depth": 10,
        "/chatter.publisher.reliability": "reliable",
    }
    name = "qos_overrides./chatter.publisher.depth"
    assert node.describe_parameter(name).description == "depth for publisher `/chatter` with id `None`"
    (refused,) = node.set_parameters([Parameter(name, value=5)])
    assert not refused.successful and "read-only" in refused.reason


def test_overrides_come_from_the_command_line(world: World) -> None:
    rclpy.init(args=["--ros-args", "-p", "qos_overrides./chatter.publisher.reliability:=best_effort"])
    node = rclpy.create_node("talker")
    publisher = node.create_publisher(String, "chatter", 10, qos_overriding_options=USUAL)
    assert publisher.qos_profile.reliability == ReliabilityPolicy.BEST_EFFORT
    assert node.create_subscription(String, "chatter", print, 10).get_publisher_count() == 0
    hearing = node.create_subscription(String, "chatter", print, qos_profile_sensor_data)
    assert hearing.get_publisher_count() == 1


FILE = """
talker:
  ros__parameters:
    qos_overrides:
      /chatter:
        publisher:
          history: keep_all
          durability: transient_local
          liveliness: manual_by_topic
          deadline: 100000000
          lifespan: 2000000000
          liveliness_lease_duration: 3000000000
          avoid_ros_namespace_conventions: true
        subscription_radio:
          depth: 3
          deadline: 500000000
"""


def test_overrides_come_from_a_file(world: World, tmp_path: Path) -> None:
    (tmp_path / "qos.yaml").write_text(FILE)
    rclpy.init(args=["--ros-args", "--params-file", str(tmp_path / "qos.yaml")])
    node = rclpy.create_node("talker")
    publisher = node.create_publisher(String, "chatter", 10, qos_overriding_options=EVERYTHING)
    assert publisher.qos_profile == QoSProfile(
        history=HistoryPolicy.KEEP_ALL,
        depth=10,
        durability=DurabilityPolicy.TRANSIENT_LOCAL,
        liveliness=LivelinessPolicy.MANUAL_BY_TOPIC,
        deadline=Duration(seconds=0.1),
        lifespan=Duration(seconds=2),
        liveliness_lease_duration=Duration(seconds=3),
        avoid_ros_namespace_conventions=True,
    )
    radio = QoSOverridingOptions(
        [QoSPolicyKind.DEPTH, QoSPolicyKind.DEADLINE, QoSPolicyKind.LIFESPAN], entity_id="radio"
    )
    subscription = node.create_subscription(String, "chatter", print, 10, qos_overriding_options=radio)
    assert subscription.qos_profile == QoSProfile(depth=3, deadline=Duration(seconds=0.5))
    assert not node.has_parameter("qos_overrides./chatter.subscription_radio.lifespan")  # only publishers have one


def test_a_profile_that_others_use_stays_as_it_is(world: World) -> None:
    rclpy.init(args=["--ros-args", "-p", "qos_overrides./x.subscription.depth:=99"])
    node = rclpy.create_node("n")
    subscription = node.create_subscription(String, "x", print, qos_profile_sensor_data, qos_overriding_options=USUAL)
    assert (subscription.qos_profile.depth, qos_profile_sensor_data.depth) == (99, 5)


def test_the_topics_name_is_the_one_after_remapping(world: World) -> None:
    rclpy.init(args=["--ros-args", "-r", "chatter:=/news", "-p", "qos_overrides./news.publisher.depth:=7"])
    node = rclpy.create_node("n")
    assert node.create_publisher(String, "chatter", 1, qos_overriding_options=USUAL).qos_profile.depth == 7
    again = node.create_publisher(String, "chatter", 1, qos_overriding_options=USUAL)
    assert again.qos_profile.depth == 7  # declared already


def test_the_program_has_the_last_word(world: World) -> None:
    rclpy.init()
    overrides = [Parameter("qos_overrides./x.publisher.depth", value=11)]
    node = rclpy.create_node("n", parameter_overrides=overrides)
    careful = QoSOverridingOptions.with_default_policies(callback=at_most_ten)
    with pytest.raises(InvalidQosOverridesError) as caught:
        node.create_publisher(String, "x", 10, qos_overriding_options=careful)
    assert str(caught.value) == (
        "Provided QoS overrides for publisher `/x` with id `None`, are not valid: expected qos depth less than 10"
    )
    assert node.create_publisher(String, "y", 10, qos_overriding_options=careful).qos_profile.depth == 10
    assert node.count_publishers("x") == 0


def test_a_word_that_is_no_policy_is_refused(world: World) -> None:
    rclpy.init(args=["--ros-args", "-p", "qos_overrides./x.publisher.reliability:=best_efort"])
    node = rclpy.create_node("n")
    with pytest.raises(RuntimeError, match="Unexpected QoS override for policy `reliability`: `best_efort`") as caught:
        node.create_publisher(String, "x", 10, qos_overriding_options=USUAL)
    assert "did you mean 'best_effort'" in caught.value.__notes__[0]


def test_a_number_where_a_word_belongs_is_refused(world: World) -> None:
    rclpy.init(args=["--ros-args", "-p", "qos_overrides./x.publisher.depth:=many"])
    node = rclpy.create_node("n")
    with pytest.raises(Exception, match=r"depth.*'many'.*expecting type 'INTEGER'"):
        node.create_publisher(String, "x", 10, qos_overriding_options=USUAL)
