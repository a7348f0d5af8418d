"""A context: one life of ROS in a process, from init to shutdown."""

from __future__ import annotations

import inspect
import os
import weakref
from collections.abc import Callable
from contextlib import suppress
from typing import TYPE_CHECKING, Any

from turtle_lesson.ros.runtime.world import current_process

from ._entity import Handle
from ._ros_args import Arguments, parse_arguments
from ._state import RclpyState
from .exceptions import RCLError, RCLInvalidROSArgsError
from .impl.rcutils_logger import RcutilsLogger

if TYPE_CHECKING:
    from .node import Node


class Context:
    """States: made, initialized (`ok()` is True), shut down. Each simulated process has a default one."""

    def __init__(self) -> None:
        self._process = current_process()
        self._state = self._process.state(RclpyState)
        self.initialized = False
        self.ended = False
        """Whether it was shut down."""
        self.ended_by_signal = False
        self._callbacks: list[Callable[[], Callable[[], Any] | None]] = []
        self._waiting: list[Callable[[], Callable[[], Any] | None]] = []
        self._nodes: list[Node] = []
        self.arguments = Arguments()
        self._domain_id = 0

    def init(
        self, args: list[str] | None = None, *, initialize_logging: bool = True, domain_id: int | None = None
    ) -> None:
        """Begin; `args` defaults to the process's arguments.

        Raises RuntimeError the second time or for a negative domain, RCLError and UnknownROSArgsError for ROS arguments
        that cannot be read.
        """
        if domain_id is not None and domain_id < 0:
            raise RuntimeError(f"Domain id ({domain_id}) should not be lower than zero.")
        if self.initialized:
            raise RuntimeError("Context.init() must only be called once")
        try:
            self.arguments = parse_arguments(self._process.argv if args is None else args)
        except RCLInvalidROSArgsError as error:
            RcutilsLogger("rcl").error("Failed to parse global arguments")
            raise RCLError(f"failed to initialize rcl: {error}") from None
        self._domain_id = domain_id or 0
        self.initialized = True
        self._state.contexts.append(self)
        if initialize_logging:
            self._set_up_logging()
        self._process.at_exit.append(self._end)  # what the process leaves behind disappears

    def _set_up_logging(self) -> None:
        for name, level in self.arguments.log_levels.items():
            RcutilsLogger(name).set_level(level)
        own = self._state
        own.log_to = self.arguments.switches
        own.log_format = os.environ.get("RCUTILS_CONSOLE_OUTPUT_FORMAT")
        own.log_colorized = os.environ.get("RCUTILS_COLORIZED_OUTPUT") == "1"

    @property
    def handle(self) -> Handle | None:
        """What stands for the C object of the real one; None before `init`."""
        return Handle(self) if self.initialized else None

    def ok(self) -> bool:
        """Whether the context is initialized and not shut down."""
        return self.initialized and not self.ended

    def get_domain_id(self) -> int:
        """The ROS domain, which is only a number here: all processes of a world see each other.

        Raises RuntimeError before `init`, RCLError after the shutdown.
        """
        if not self.initialized:
            raise RuntimeError("Context must be initialized before it can have a domain id")
        if self.ended:
            raise RCLError("Failed to get domain id: the context has been shut down")
        return self._domain_id

    def shutdown(self) -> None:
        """End it. Raises RuntimeError if it is not initialized, RCLError if it has ended, perhaps by a signal."""
        if self.ended:
            self._forget_as_default()
            error = RCLError("failed to shutdown: rcl_shutdown already called on the given context")
            cause = "Ctrl-C has already shut it down, as on a robot. " if self.ended_by_signal else ""
            error.add_note(f"{cause}rclpy.try_shutdown() does it only if it is still necessary.")
            raise error
        if not self.initialized:
            raise RuntimeError("Context must be initialized before it can be shutdown")
        self.try_shutdown()

    def try_shutdown(self) -> None:
        """End it, if it has not ended yet."""
        if self.ok():
            self.ended = True
            self._leave()
        self._forget_as_default()

    def _forget_as_default(self) -> None:
        """Let a later init have a new default context."""
        if self.shared_default and self.ended:
            self._state.context = None

    def shut_down_by_signal(self) -> None:
        """A signal ends it, at once. What was given to `on_shutdown` is not called, as on a robot."""
        self.ended_by_signal = True
        self._end()

    def _end(self) -> None:
        self.ended = True
        self._callbacks.clear()
        self._leave()

    def _leave(self) -> None:
        """Take the nodes out of the graph, since they can do nothing any more, and call what was registered for the end."""
        if self in self._state.contexts:
            self._state.contexts.remove(self)
        for node in list(self._nodes):
            node._ros_shut()
        for callbacks in (self._waiting, self._callbacks):
            for reference in list(callbacks):
                callback = reference()
                if callback is not None:
                    callback()
            callbacks.clear()

    def destroy(self) -> None:
        """Let go of it; in the real one this frees the C object. A context that is still up is shut down."""
        self.try_shutdown()

    @property
    def shared_default(self) -> bool:
        """Whether this is its process's default context, which a later init replaces by a new one."""
        return self._state.context is self

    def on_shutdown(self, callback: Callable[[], Any]) -> None:
        """Have `callback()` called at the shutdown (at once if it has been). A method is only called if its object is
        still there then.

        Raises TypeError for what cannot be called.
        """
        if not callable(callback):
            raise TypeError(f"callback should be a callable, got {type(callback)}")
        if self.ended:
            callback()
        else:
            self._callbacks.append(_reference(callback))

    def wake_on_shutdown(self, callback: Callable[[], Any]) -> None:
        """As `on_shutdown`, for rclpy's own: it is called when a signal ends the context, too."""
        if self.ended:
            callback()
        else:
            self._waiting.append(_reference(callback))

    def forget_wake(self, callback: Callable[[], Any]) -> None:
        """No longer call what was given to `wake_on_shutdown`."""
        with suppress(ValueError):  # the context has ended
            self._waiting.remove(_reference(callback))

    def track_node(self, node: Node) -> None:
        """Remember a node, so that it leaves the graph when the process ends."""
        self._nodes.append(node)

    def untrack_node(self, node: Node) -> None:
        """Forget a node that was destroyed."""
        if node in self._nodes:
            self._nodes.remove(node)

    def __enter__(self) -> Context:
        if not self.initialized:
            raise RuntimeError("init() must be called on this Context before using it with a context manager")
        return self

    def __exit__(self, *error: object) -> None:
        self.try_shutdown()


def _reference(callback: Callable[[], Any]) -> Callable[[], Callable[[], Any] | None]:
    if inspect.ismethod(callback):
        return weakref.WeakMethod(callback)
    return lambda: callback
