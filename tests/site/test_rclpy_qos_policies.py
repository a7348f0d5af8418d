"""Profiles, policies and presets by their public names, and whether two profiles go together.

What is expected is recorded, or stands in rclpy's qos.py and rmw_dds_common's qos.cpp.
"""

from __future__ import annotations

from typing import Any

import pytest
import rclpy
from rclpy import qos
from rclpy.duration import Duration, Infinite
from rclpy.exceptions import RCLError
from rclpy.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    LivelinessPolicy,
    QoSPolicyKind,
    QoSPresetProfiles,
    QoSProfile,
    ReliabilityPolicy,
)
from std_msgs.msg import Int32

from turtle_lesson.ros.runtime.world import World

SECOND, TWO_SECONDS = Duration(seconds=1), Duration(seconds=2)


def profile(**policies: Any) -> QoSProfile:
    """A profile in which nothing is left open."""
    return QoSProfile(**{"depth": 10, "liveliness": LivelinessPolicy.AUTOMATIC, **policies})


# ---------------------------------------------------------------- names and numbers


def test_policies_are_known_by_number_and_by_short_key() -> None:
    assert HistoryPolicy.short_keys() == ["system_default", "keep_last", "keep_all", "unknown"]
    assert ReliabilityPolicy.short_keys()[:4] == ["system_default", "reliable", "best_effort", "unknown"]
    assert DurabilityPolicy.get_from_short_key("Transient_LOCAL") == 1
    assert LivelinessPolicy.MANUAL_BY_TOPIC == 3
    assert HistoryPolicy.KEEP_ALL.short_key == "keep_all"
    assert [kind.value for kind in QoSPolicyKind] == [1, 2, 4, 8, 16, 32, 64, 128, 256, 512]
    assert qos.qos_policy_name_from_kind(16) == "RELIABILITY"
    assert qos.QoSHistoryPolicy is HistoryPolicy


def test_names_of_old_releases_work() -> None:
    old = ReliabilityPolicy.RMW_QOS_POLICY_RELIABILITY_RELIABLE  # type: ignore[attr-defined]
    assert old is ReliabilityPolicy.RELIABLE


def test_presets_are_found_by_short_key() -> None:
    assert QoSPresetProfiles.get_from_short_key("sensor_data") is qos.qos_profile_sensor_data
    assert "action_status_default" in QoSPresetProfiles.short_keys()
    assert QoSPresetProfiles.ACTION_STATUS_DEFAULT.value.durability == DurabilityPolicy.TRANSIENT_LOCAL
    assert qos.qos_profile_rosout_default.lifespan == Duration(seconds=10)
    assert QoSPresetProfiles.ROSOUT_DEFAULT.value is qos.qos_profile_rosout_default
    assert QoSProfile(history=HistoryPolicy.KEEP_ALL).depth == 10


# ---------------------------------------------------------------- do they go together?


@pytest.mark.parametrize(
    ("offered", "requested", "together"),
    [
        ({"reliability": ReliabilityPolicy.BEST_EFFORT}, {}, False),
        ({}, {"durability": DurabilityPolicy.TRANSIENT_LOCAL}, False),
        ({}, {"deadline": SECOND}, False),
        ({"deadline": TWO_SECONDS}, {"deadline": SECOND}, False),
        ({}, {"liveliness": LivelinessPolicy.MANUAL_BY_TOPIC}, False),
        ({}, {"liveliness_lease_duration": SECOND}, False),
        ({"liveliness_lease_duration": TWO_SECONDS}, {"liveliness_lease_duration": SECOND}, False),
        ({}, {"reliability": ReliabilityPolicy.BEST_EFFORT}, True),
        ({"deadline": SECOND}, {"deadline": TWO_SECONDS}, True),
        ({"durability": DurabilityPolicy.TRANSIENT_LOCAL}, {}, True),
    ],
)
def test_which_profiles_the_graph_connects(offered: dict[str, Any], requested: dict[str, Any], together: bool) -> None:
    refusal = profile(**offered).quality("publisher").refusal(profile(**requested).quality("subscription"))
    assert (refusal is None) == together


def test_the_check_of_two_profiles_is_not_here() -> None:
    with pytest.raises(AttributeError, match=r"'rclpy\.qos' has no 'qos_check_compatible'; a real ROS 2 may have it"):
        qos.qos_check_compatible  # noqa: B018


# ---------------------------------------------------------------- refused


@pytest.mark.parametrize(
    ("policies", "reason"),
    [
        (
            {"reliability": ReliabilityPolicy.UNKNOWN},
            "the reliability of its QoS profile cannot be <ReliabilityPolicy.UNKNOWN",
        ),
        ({"deadline": Duration(seconds=-1)}, r"the deadline of its QoS profile cannot be Duration\(nanoseconds=-1"),
    ],
)
def test_what_stands_for_no_policy_makes_no_publisher(world: World, policies: dict[str, Any], reason: str) -> None:
    rclpy.init()
    node = rclpy.create_node("n")
    with pytest.raises(RCLError, match=f"Failed to create publisher: {reason}"):
        node.create_publisher(Int32, "x", QoSProfile(depth=1, **policies))
    with pytest.raises(RCLError, match=f"Failed to create subscription: {reason}"):
        node.create_subscription(Int32, "x", print, QoSProfile(depth=1, **policies))
    assert node.count_publishers("x") == node.count_subscribers("x") == 0


# ---------------------------------------------------------------- what the graph says


def test_the_graph_shows_policies_as_they_are_used(world: World) -> None:
    rclpy.init()
    node = rclpy.create_node("n", namespace="/deep")
    offered = QoSProfile(
        history=HistoryPolicy.SYSTEM_DEFAULT, deadline=SECOND, liveliness=LivelinessPolicy.MANUAL_BY_TOPIC
    )
    node.create_publisher(Int32, "/x", offered)
    node.create_subscription(Int32, "/x", print, QoSProfile(history=HistoryPolicy.KEEP_ALL, deadline=Infinite))
    (publisher,) = node.get_publishers_info_by_topic("/x")
    (subscription,) = node.get_subscriptions_info_by_topic("/x")
    assert publisher.qos_profile.lifespan == Infinite
    lines = str(publisher).splitlines()
    assert lines[:4] == [
        "Node name: n",
        "Node namespace: /deep",
        "Topic type: std_msgs/msg/Int32",
        "Endpoint type: PUBLISHER",
    ]
    assert len(lines[4].partition("GID: ")[2].split(".")) == 24
    assert lines[5:] == [
        "QoS profile:",
        "  Reliability: RELIABLE",
        "  History (Depth): KEEP_LAST (10)",
        "  Durability: VOLATILE",
        "  Lifespan: Infinite",
        "  Deadline: 1000000000 nanoseconds",
        "  Liveliness: MANUAL_BY_TOPIC",
        "  Liveliness lease duration: Infinite",
    ]
    assert "  History (Depth): KEEP_ALL\n" in str(subscription)


def test_an_endpoint_can_be_described_by_hand() -> None:
    from rclpy.topic_endpoint_info import TopicEndpointInfo, TopicEndpointTypeEnum

    empty = TopicEndpointInfo()
    assert str(empty).splitlines()[3:7] == ["Endpoint type: INVALID", "GID: ", "QoS profile:", "  Reliability: UNKNOWN"]
    named = TopicEndpointInfo(
        node_name="n", endpoint_type=TopicEndpointTypeEnum.PUBLISHER, qos_profile=QoSProfile(depth=3)
    )
    assert named != empty
    empty.node_name, empty.endpoint_type, empty.qos_profile = "n", TopicEndpointTypeEnum(1), QoSProfile(depth=3)
    assert named == empty
