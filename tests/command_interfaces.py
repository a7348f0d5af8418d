"""The fixture by which `robot_controller.msg` and `.srv` can be imported while commands are tested."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from node_files import PACKAGE

from turtle_lesson.ros.idl.registry import registry


@pytest.fixture
def interfaces() -> Iterator[None]:
    """Make the interfaces of robot_controller known, as a sourced workspace does."""
    if "robot_controller" in registry.packages():
        registry.remove("robot_controller")
    registry.add("robot_controller", PACKAGE)
    yield
    if "robot_controller" in registry.packages():
        registry.remove("robot_controller")
