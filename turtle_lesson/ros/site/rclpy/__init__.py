"""rclpy for the simulation: the client library's own names and signatures, on a virtual clock in one process.

A program that uses this package runs unmodified on a real ROS 2. Facts about names, signatures and behaviour come from
rclpy of Humble (https://docs.ros.org/en/humble/p/rclpy/) and from recordings of it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from turtle_lesson.ros.runtime.world import current_process
from turtle_lesson.ros.sim.strand import running_strand

from ._blocking import drive, drives_the_simulation, spin_live
from ._hints import explain_missing
from ._state import RclpyState
from .context import Context
from .parameter import Parameter
from .qos import qos_profile_rosout_default
from .signals import SignalHandlerOptions, install_signal_handlers, uninstall_signal_handlers
from .task import Future
from .utilities import get_default_context, get_rmw_implementation_identifier, ok, shutdown, try_shutdown

if TYPE_CHECKING:
    from .executors import Executor
    from .node import Node
    from .qos import QoSProfile

__all__ = [
    "Context",
    "Future",
    "Parameter",
    "SignalHandlerOptions",
    "create_node",
    "get_default_context",
    "get_global_executor",
    "get_rmw_implementation_identifier",
    "init",
    "install_signal_handlers",
    "ok",
    "shutdown",
    "spin",
    "spin_once",
    "spin_until_future_complete",
    "try_shutdown",
    "uninstall_signal_handlers",
]


class InitContextManager:
    """What `init` returns, so that `with rclpy.init(): …` shuts down at its end (rclpy of Jazzy and newer)."""

    def __init__(self, context: Context) -> None:
        self.context = context

    def _ipython_display_(self) -> None:
        """In a notebook nothing is shown, as with Humble, whose `init` returns None."""

    def __enter__(self) -> InitContextManager:
        return self

    def __exit__(self, *error: object) -> None:
        self.context.try_shutdown()


def init(
    *,
    args: list[str] | None = None,
    context: Context | None = None,
    domain_id: int | None = None,
    signal_handler_options: SignalHandlerOptions | None = None,
) -> InitContextManager:
    """Begin to use ROS in this process. `args` defaults to the process's sys.argv.

    Signals are handled as `rclpy.signals` says, unless told otherwise or the context is not the default one.

    Raises RuntimeError if it was called before without a shutdown, RCLError for ROS arguments that cannot be read.
    """
    default = get_default_context()
    context = default if context is None else context
    if signal_handler_options is None:
        signal_handler_options = SignalHandlerOptions.ALL if context is default else SignalHandlerOptions.NO
    context.init(args, domain_id=domain_id)
    if signal_handler_options is not SignalHandlerOptions.NO:
        install_signal_handlers(signal_handler_options)
    return InitContextManager(context)


def get_global_executor() -> Executor:
    """The executor that this process's `spin` functions use unless they are given another one.

    `rclpy.shutdown()` shuts it down, too: so `rclpy.spin` in another thread returns in silence (rclpy's __init__.py).
    """
    own = current_process().state(RclpyState)
    executor = own.executor
    if executor is None or executor._context.ended or not executor._context.initialized:
        from .executors import SingleThreadedExecutor

        executor = own.executor = SingleThreadedExecutor()
        if executor._context.ok():
            executor.context.on_shutdown(executor.shutdown)
    return executor


def create_node(
    node_name: str,
    *,
    context: Context | None = None,
    cli_args: list[str] | None = None,
    namespace: str | None = None,
    use_global_arguments: bool = True,
    enable_rosout: bool = True,
    rosout_qos_profile: QoSProfile | int = qos_profile_rosout_default,
    start_parameter_services: bool = True,
    parameter_overrides: list[Parameter] | None = None,
    allow_undeclared_parameters: bool = False,
    automatically_declare_parameters_from_overrides: bool = False,
    enable_logger_service: bool = False,
) -> Node:
    """Make a `Node`; the keywords are its constructor's."""
    arguments = locals().copy()
    from .node import Node

    return Node(**arguments)


@drives_the_simulation
def spin_once(node: Node, *, executor: Executor | None = None, timeout_sec: float | None = None) -> None:
    """Run one callback of the node, or wait until the timeout (s) for one to become ready; None waits forever."""
    executor = get_global_executor() if executor is None else executor
    try:
        executor.add_node(node)
        executor.spin_once(timeout_sec=timeout_sec)
    finally:
        executor.remove_node(node)


def spin(node: Node, executor: Executor | None = None) -> None:
    """Run the node's callbacks until the context is shut down.

    In a plain notebook cell this is live, at the pace of the wall clock, until the cell is interrupted.
    """
    executor = get_global_executor() if executor is None else executor
    if running_strand() is None:
        spin_live(lambda: _spin(node, executor))
    else:
        _spin(node, executor)


def _spin(node: Node, executor: Executor) -> None:
    try:
        executor.add_node(node)
        executor._spin()
    finally:
        executor.remove_node(node)


def spin_until_future_complete(
    node: Node, future: Future, executor: Executor | None = None, timeout_sec: float | None = None
) -> None:
    """Run the node's callbacks until the future is done, or the timeout (s) has passed; None waits forever."""
    if running_strand() is None:
        drive(spin_until_future_complete, node, future, executor, timeout_sec)
        return
    executor = get_global_executor() if executor is None else executor
    try:
        executor.add_node(node)
        executor.spin_until_future_complete(future, timeout_sec)
    finally:
        executor.remove_node(node)


__getattr__ = explain_missing(__name__)
