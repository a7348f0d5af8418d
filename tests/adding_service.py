"""A program that offers /add, for tests of calls and of waiting."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import rclpy
from example_interfaces.srv import AddTwoInts

Run = Callable[..., list[Any]]
Request, Response = AddTwoInts.Request, AddTwoInts.Response


def add(request: Any, response: Any) -> Any:
    """The callback of a service that adds."""
    response.sum = request.a + request.b
    return response


def server(found: list[Any]) -> None:
    """A program that offers /add."""
    rclpy.init()
    node = rclpy.create_node("server")
    node.create_service(AddTwoInts, "add", add)
    rclpy.spin(node)
