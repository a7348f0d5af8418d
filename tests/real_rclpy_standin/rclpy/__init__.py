"""A stand-in for a real rclpy (see ../README.md): the functions of the package itself, with its default context."""

from __future__ import annotations

from typing import Any

from rclpy import _network
from rclpy.context import Context, get_default_context


def init(*, args: list[str] | None = None, context: Context | None = None, domain_id: int | None = None) -> None:
    (context or get_default_context()).init(args, domain_id=domain_id)


def ok(*, context: Context | None = None) -> bool:
    return (context or get_default_context()).ok()


def shutdown(*, context: Context | None = None) -> None:
    (context or get_default_context()).shutdown()


def shutdown_by_signal() -> None:
    """Not in the real one: what its signal handler does at Ctrl-C, which is to shut down every context there is."""
    for context in list(_network.contexts):
        context.try_shutdown()


def create_node(name: str, **options: Any) -> Any:
    from rclpy.node import Node

    return Node(name, **options)
