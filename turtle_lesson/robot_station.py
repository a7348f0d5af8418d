"""The lab's station on a robot: its hidden node, spun in a thread of its own, heard in the notebook's event loop."""

from __future__ import annotations

import atexit
import threading
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor

from .lab.obstacle_board import ObstacleBoard
from .lab.recorder import ON_A_ROBOT, Recorder
from .lab.widgets.loop import Loop
from .lab.widgets.station import Clock
from .robot_node import LabNode

if TYPE_CHECKING:
    from .ros.core.keyboard import Keyboard

BREATH = 0.02
"""Seconds of pause after an error, so that one that comes again and again does not take the whole computer."""

PATIENCE = 2.0
"""Seconds that the end of Python waits for the thread at most."""


class RobotStation:
    """A `Station` (see lab/widgets/station.py) on a real ROS 2. To be made in the notebook's event loop.

    The thread does nothing but wait for ROS and hop. All else, from creating a subscription to destroying the node, happens
    in the loop.
    """

    clock: Clock | None = None
    keyboard: Keyboard | None = None

    def __init__(self) -> None:
        self.loop = Loop()
        self.at_close: list[Callable[[], object]] = []
        self._closing = threading.Event()
        self._left = False
        self._last = 0
        self._trouble = ""
        self._context = Context()
        # Signals and logs stay as the notebook's own nodes have them.
        self._context.init(args=[], initialize_logging=False)
        self.node: Any = LabNode(self._context, self._hop)
        self.recorder = Recorder(self.node, advice=ON_A_ROBOT)
        self.board = ObstacleBoard(self.recorder)
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self.node)
        self._thread = threading.Thread(target=self._spin, name="turtle_lesson", daemon=True)
        self._thread.start()
        atexit.register(self._close_and_wait)

    @property
    def now(self) -> float:
        """Seconds since this was made, on the node's clock; when it has ended, until then."""
        now = self._last if self._left else self.node.get_clock().now().nanoseconds
        return float(self.recorder.seconds(now))

    @property
    def ended(self) -> bool:
        """Whether it was closed, or ROS was shut down (by a signal that reached all of this program)."""
        return self._closing.is_set() or not self._context.ok()

    @property
    def state(self) -> str:
        """How it stands, in a few words."""
        if self.ended:
            return "closed"
        return f"connected, but the last error was {self._trouble}" if self._trouble else "connected"

    def close(self) -> None:
        """Leave the system. This waits for nothing: the thread ends, then the loop takes the node away."""
        if not self._closing.is_set():
            self._closing.set()
            self._executor.create_task(_nothing)  # which ends its waiting

    # -- in the thread -----------------------------------------------------------------------------------------------

    def _spin(self) -> None:
        while not self.ended:
            try:
                self._executor.spin_once()
            except Exception as error:
                # The rclpy of Humble says InvalidHandle of a subscription that was destroyed while it waited for it. No
                # callback can be the cause: they happen in the loop.
                self._trouble = "" if type(error).__name__ == "InvalidHandle" else f"{type(error).__name__}: {error}"
                self._closing.wait(BREATH)
        self._to_loop(self._leave)

    def _hop(self, action: Callable[..., object], *arguments: Any) -> None:
        if not self._closing.is_set():
            self._to_loop(self._carry_out, action, arguments)

    def _to_loop(self, action: Callable[..., object], *arguments: Any) -> None:
        try:
            self.loop.soon(action, *arguments)
        except RuntimeError:  # the loop is closed: Python is about to end, and takes care of the rest
            self._closing.set()

    # -- in the loop -------------------------------------------------------------------------------------------------

    def _carry_out(self, action: Callable[..., object], arguments: tuple[Any, ...]) -> None:
        if not self.ended:
            action(*arguments)

    def _leave(self) -> None:
        """Take the node out of the graph. Not while the thread spins it."""
        if self._left:
            return
        self._last = self.node.get_clock().now().nanoseconds
        self._left = True
        self._closing.set()
        for let_go in self.at_close:
            let_go()
        self.recorder.close()
        self._executor.shutdown()
        self.node.destroy_node()
        self._context.try_shutdown()
        atexit.unregister(self._close_and_wait)

    def _close_and_wait(self) -> None:
        """Python ends: a thread that still waits in ROS's own code could bring it down."""
        self.close()
        self._thread.join(PATIENCE)
        if not self._thread.is_alive():
            self._leave()


def _nothing() -> None:
    """A task that only wakes the executor."""
