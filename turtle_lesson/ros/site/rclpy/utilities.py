"""Small helpers of rclpy."""

from __future__ import annotations

import sys

from turtle_lesson.ros.runtime.world import current_process
from turtle_lesson.ros.stdlib.deadlock import looked_in_vain

from ._ros_args import parse_arguments
from ._state import RclpyState
from .constants import S_TO_NS
from .context import Context
from .signals import uninstall_signal_handlers


def get_default_context(*, shutting_down: bool = False) -> Context:
    """The context of this process that is used where none is named."""
    own = current_process().state(RclpyState)
    if own.context is None:
        own.context = Context()
    return own.context


def ok(*, context: Context | None = None) -> bool:
    """Whether ROS is initialized and not shut down in this process."""
    if not (get_default_context() if context is None else context).ok():
        return False
    looked_in_vain()  # it will most often be the condition of a loop
    return True


def shutdown(*, context: Context | None = None, uninstall_handlers: bool | None = None) -> None:
    """End ROS in this process, and by default leave signals to Python again, if it is the default context that ends.

    Raises RuntimeError if there is nothing to end, RCLError if a signal (Ctrl-C) has ended it.
    """
    wanted = context is None or context.shared_default if uninstall_handlers is None else uninstall_handlers
    try:
        (get_default_context() if context is None else context).shutdown()
    finally:
        if wanted:
            uninstall_signal_handlers()


def try_shutdown(*, context: Context | None = None, uninstall_handlers: bool | None = None) -> None:
    """As `shutdown`, if ROS has not ended yet."""
    wanted = context is None or context.shared_default if uninstall_handlers is None else uninstall_handlers
    (get_default_context() if context is None else context).try_shutdown()
    if wanted:
        uninstall_signal_handlers()


def remove_ros_args(args: list[str] | None = None) -> list[str]:
    """The arguments without those between `--ros-args` and `--`.

    Raises RCLInvalidROSArgsError or UnknownROSArgsError if those cannot be read.
    """
    return parse_arguments(sys.argv if args is None else list(args)).others


def timeout_sec_to_nsec(timeout_sec: float | None) -> int:
    """Seconds to ns; None and negative numbers mean "wait forever", which is -1."""
    return -1 if timeout_sec is None or timeout_sec < 0 else int(timeout_sec * S_TO_NS)


def get_rmw_implementation_identifier() -> str:
    """The name of what carries messages: here nothing but memory."""
    return "rmw_turtle_lesson"


def get_available_rmw_implementations() -> set[str]:
    """The names of all that can carry messages."""
    return {get_rmw_implementation_identifier()}
