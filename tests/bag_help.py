"""What the tests of bags share: plain values of messages, whoever's class they are of, and small bags."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any

import pytest

from turtle_lesson.ros.bags.writer import BagWriter
from turtle_lesson.ros.idl.registry import registry


@pytest.fixture(scope="module", autouse=True)
def no_package_is_left() -> Iterator[None]:
    """`start()` makes the finished package importable; the next test file shall not find it."""
    yield
    if "robot_controller" in registry.packages():
        registry.remove("robot_controller")


SECOND = 1_000_000_000
BEGIN = 1_800_000_000 * SECOND


def plain(value: Any) -> Any:
    """A message of ours, of rosbags or of mcap as plain lists and dictionaries, so that they can be compared."""
    if hasattr(value, "get_fields_and_field_types"):
        return {name: plain(getattr(value, name)) for name in value.get_fields_and_field_types()}
    if is_dataclass(value):
        names = [field.name for field in fields(value)]  # rosbags has the constants among them, and a mark of its own
        return {name: plain(getattr(value, name)) for name in names if name[0].islower()}
    if type(value).__mro__[1].__name__ == "SimpleNamespace":
        return {name: plain(getattr(value, name)) for name in value.__slots__}
    if hasattr(value, "tolist"):
        return plain(value.tolist())
    if isinstance(value, (list, tuple, bytes, memoryview)):
        return [plain(each) for each in value]
    return value


def write_bag(folder: Path, count: int = 100, storage: str = "mcap", size: int = 1000) -> list[tuple[str, int, bytes]]:
    """Write a bag of `count` texts on /chatter and as many numbers on /count; returns topic, time and bytes of each."""
    from rclpy.qos import QoSProfile
    from rclpy.serialization import serialize_message
    from std_msgs.msg import Int32, String

    bag = BagWriter(folder, storage)
    bag.add_topic("/chatter", String, [QoSProfile(depth=7)])
    bag.add_topic("/count", Int32, [])
    written = []
    for number in range(count):
        time = BEGIN + number * 10_000_000
        for topic, message in (("/chatter", String(data=f"{number} " + "x" * size)), ("/count", Int32(data=number))):
            data = serialize_message(message)
            bag.write(topic, message._TYPE_NAME, time, data)
            written.append((topic, time, data))
    bag.close()
    return written
