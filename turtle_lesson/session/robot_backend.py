"""The lab's backend on a robot: its hidden node, spun in a thread of its own, heard in the notebook's event loop."""

from __future__ import annotations

import atexit
import inspect
import threading
from collections.abc import Callable
from contextlib import suppress
from functools import partial, wraps
from itertools import islice
from typing import TYPE_CHECKING, Any

from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.subscription import Subscription

from ..lab.recorder import DEPTH, ON_A_ROBOT, ObstacleBoard, Recorder
from ..lab.widgets.backend import FRAME, Loop

if TYPE_CHECKING:
    from rclpy.client import Client
    from rclpy.timer import Timer

BREATH = 0.02
"""Seconds of pause after an error, so that one that comes again and again does not take the whole computer."""

PATIENCE = 2.0
"""Seconds that the end of Python waits for the thread at most."""


Action = Callable[..., object]


class RobotBackend:
    """What the widgets see (`Link` in lab/widgets/backend.py) of a real ROS 2. To be made in the notebook's event loop.

    The thread does nothing but wait for ROS and hop. All else, from creating a subscription to destroying the node, happens
    in the loop.
    """

    clock = None
    keyboard = None

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
        self.node: Node = LabNode(self._context, self._hop)
        self.recorder = Recorder(self.node, origin=self.node.get_clock().now().nanoseconds, advice=ON_A_ROBOT)
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
            self._executor.create_task(lambda: None)  # which ends its waiting

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

    def _hop(self, action: Action, *arguments: Any) -> None:
        def carry_out() -> None:
            if not self.ended:
                action(*arguments)

        if not self._closing.is_set():
            self._to_loop(carry_out)

    def _to_loop(self, action: Callable[[], object]) -> None:
        try:
            self.loop.soon(action)
        except RuntimeError:  # the loop is closed: Python is about to end, and takes care of the rest
            self._closing.set()

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


# -- the node: all its callbacks happen in one event loop, whichever thread it is spun in --------------------------------


class LabNode(Node):
    """The lab's hidden node, `/_lab`: it offers no parameters and writes no log.

    Callbacks with two arguments are told a message's time, whatever the rclpy (that of Humble tells none).
    Nothing is called after it was destroyed, although its thread may have taken it already: the code that destroys and
    creates in the loop sees what a node that is spun in the loop would show.
    """

    def __init__(self, context: Context, hop: Action) -> None:
        self._lab_hop = hop  # called with an action and its arguments, has the loop call that action
        self._lab_unawaited = Unawaited()
        super().__init__(
            "_lab", context=context, use_global_arguments=False, enable_rosout=False, start_parameter_services=False
        )
        super().create_timer(FRAME, self._take)

    def create_subscription(
        self, msg_type: Any, topic: str, callback: Action, qos_profile: Any, *more: Any, **options: Any
    ) -> Subscription:
        """As every node's, but `callback(message, info)` works everywhere; info has at least `source_timestamp` (ns).

        Nothing is called when a message comes, but all that have come are taken at each frame.
        """
        hear: Action = lambda message, info=None: callback(message, info)  # noqa: E731  # one argument is enough for Humble
        with suppress(TypeError):
            inspect.signature(callback).bind(object())
            hear = lambda message, info=None: callback(message)  # noqa: E731
        options["callback_group"] = self._lab_unawaited
        return super().create_subscription(msg_type, topic, hear, qos_profile, *more, **options)

    def _take(self) -> None:
        """Take what has come since the last frame, in the spinning thread; the loop hears it, a topic in one go."""
        for subscription in list(self.subscriptions):
            handle: Any = subscription.handle  # of the real rclpy
            take = partial(handle.take_message, subscription.msg_type, subscription.raw)
            with handle:  # raises where the loop has just destroyed it, which `_spin` knows
                taken = list(islice(iter(take, None), DEPTH))
            if taken:
                self._lab_hop(self._hear, subscription, taken)

    def _hear(self, subscription: Subscription, taken: list[tuple[Any, Any]]) -> None:
        for message, info in taken:
            if subscription in self.subscriptions:
                subscription.callback(message, info)

    def create_timer(self, timer_period_sec: float, callback: Action, *more: Any, **options: Any) -> Timer:
        """As every node's. Ticks for which the loop had no time are left out, as an executor leaves them out."""
        waiting = False

        @wraps(callback)  # newer rclpy looks whether the callback wants a TimerInfo, which it passes by keyword
        def beat(**info: Any) -> None:
            nonlocal waiting
            if not waiting:
                waiting = True
                self._lab_hop(call, info)

        def call(info: dict[str, Any]) -> None:
            nonlocal waiting
            waiting = False
            if timer in self.timers:
                callback(**info)

        timer = super().create_timer(timer_period_sec, beat, *more, **options)
        return timer

    def create_client(self, srv_type: Any, srv_name: str, *more: Any, **options: Any) -> Client:
        """As every node's; its futures, too, call back in the loop."""
        client = super().create_client(srv_type, srv_name, *more, **options)
        ask: Callable[..., Any] = client.call_async

        def call_async(request: Any) -> Any:
            future = ask(request)
            add = future.add_done_callback
            future.add_done_callback = lambda action: add(lambda done: self._lab_hop(answered, action, done))
            return future

        def answered(action: Action, future: Any) -> None:
            if client in self.clients:
                action(future)

        client.call_async = call_async  # type: ignore[method-assign]
        return client

    def destroy_node(self) -> None:
        """As every node's. A later query of the graph, such as that of an old widget that is shown again, finds no nodes."""
        super().destroy_node()
        for name in dir(Node):
            if name.startswith("count_"):
                setattr(self, name, lambda *arguments, **options: 0)
            if name.startswith("get_") and name.endswith(("_and_namespaces", "_and_types", "_by_topic", "_by_node")):
                setattr(self, name, lambda *arguments, **options: [])


class Unawaited(ReentrantCallbackGroup):
    """The executor does not wait for its members: on a busy topic, waking for each message is what costs most."""

    def can_execute(self, entity: object) -> bool:
        """Never."""
        return False
