"""Endpoints of widgets, made when they are first used: publisher, client, and a view of a server."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from contextlib import suppress
from typing import TYPE_CHECKING, Any

from ..graph import others, owner, servers
from ..words import enumerated, listed, number
from .backend import Backend
from .message_types import plain

if TYPE_CHECKING:
    from rclpy.qos import QoSProfile
    from rclpy.subscription import Subscription
    from rclpy.task import Future
    from rclpy.topic_endpoint_info import TopicEndpointInfo

PATIENCE = 1.0
"""Robot time, s, for which a message waits until a publisher that was just made has found its listeners."""

DISCOVERY = 2.0
"""Seconds for which a question is held back on a real network, until a new client has found its server."""

LONGEST_LIST = 50
"""How many elements of an array are shown of an answer."""

WARNING = 30
"""rcl_interfaces/msg/Log: this level and those above it."""

SLACK = 0.1
"""Robot time, s, by which a warning may be older than its call, or newer than the answer to it."""


class LazyPublisher:
    """Publishes messages of one class on one topic. Until the first message the graph shows nothing of it."""

    def __init__(self, backend: Backend, topic: str, message_class: Any, type_name: str) -> None:
        self._backend = backend
        self.topic, self.message_class, self.type_name = topic, message_class, type_name
        self._publisher: Any = None
        self._waiting: list[tuple[float, Any]] = []

    def publish(self, message: Any) -> None:
        """Publish; on a real network the very first messages wait until the listeners were found."""
        if self._publisher is None:
            self._publisher = self._backend.node.create_publisher(self.message_class, self.topic, self._quality())
        self._waiting.append((self._backend.now, message))
        self.flush()

    def flush(self) -> None:
        """Publish what waits, if the listeners are found by now."""
        while self._waiting and self._is_ready(self._waiting[0][0]):
            self._publisher.publish(self._waiting.pop(0)[1])

    def close(self) -> None:
        """Leave the topic."""
        self._waiting.clear()
        if self._publisher is not None:
            self._backend.node.destroy_publisher(self._publisher)
            self._publisher = None

    def why_unheard(self) -> str:
        """A sentence that says why no node gets what is published; "" if one does."""
        if self._is_heard_on(self.topic):
            return ""
        if there := self._others(self.topic):
            types = listed(sorted({end.topic_type for end in there}))
            return f"The nodes that listen on {self.topic} expect {types}, not {self.type_name}."
        topics = self._backend.node.get_topic_names_and_types()
        elsewhere = [name for name, types in topics if self.type_name in types and self._is_heard_on(name)]
        hint = f" There are listeners on {enumerated(elsewhere)}." if elsewhere else ""
        return f"No node listens on {self.topic}.{hint}"

    def _others(self, topic: str) -> list[TopicEndpointInfo]:
        return others(self._backend.node, self._backend.node.get_subscriptions_info_by_topic(topic))

    def _is_heard_on(self, topic: str) -> bool:
        return any(end.topic_type == self.type_name for end in self._others(topic))

    def _is_ready(self, since: float) -> bool:
        if not self._is_heard_on(self.topic) or self._backend.now - since >= PATIENCE:
            return True
        own = len(self._backend.node.get_subscriptions_info_by_topic(self.topic)) - len(self._others(self.topic))
        return self._publisher.get_subscription_count() > own  # the recorder's, which is found at once

    def _quality(self) -> QoSProfile:
        """Reliable; and latched where a listener wants to be told of what was said before it came."""
        from rclpy.qos import DurabilityPolicy, QoSProfile

        wanted = {end.qos_profile.durability for end in self._others(self.topic)}
        latched, volatile = DurabilityPolicy.TRANSIENT_LOCAL, DurabilityPolicy.VOLATILE
        return QoSProfile(depth=10, durability=latched if latched in wanted else volatile)


def let_time_go_on(backend: Backend) -> None:
    """Start robot time if it stands still and can be turned, so that what was just asked for is seen to happen."""
    if backend.clock is not None and not backend.clock.playing:
        with suppress(RuntimeError):  # a plain script has no event loop; there time is run by hand
            backend.clock.play(backend.clock.rate)


def in_a_moment(backend: Backend, has_come: Callable[[], bool]) -> None:
    """Where robot time stands still, let a moment of it pass (0.05 s at most), so that an answer can come."""
    for _ in range(10):
        if backend.clock is None or backend.clock.playing or has_come():
            return
        backend.clock.step(0.005)


Answered = Callable[[str, str], object]
"""Called with what became of a question: in words, and the answer in YAML ("" where none came)."""


class LazyClient:
    """Calls one service, one request at a time. Until the first request the graph shows nothing of it."""

    def __init__(self, backend: Backend, service_class: Any, name: str) -> None:
        self._backend, self._class, self._name = backend, service_class, name
        self._client: Any = None
        self._future: Future | None = None
        self._held: Any = None
        self._deadline = self._asked = 0.0
        self._answered: Answered = lambda words, answer: None

    @property
    def asking(self) -> bool:
        """Whether it waits for an answer."""
        return self._future is not None or self._held is not None

    def ask(self, request: Any, timeout: float, answered: Answered) -> None:
        """Ask; `answered` hears what came, at the latest after `timeout` s of robot time."""
        if self.asking:
            raise ValueError(f"{self._name} has not answered the last request yet: wait, or stop waiting.")
        self._answered = answered
        if self._client is None:
            self._client = self._backend.node.create_client(self._class, self._name)
        self._asked, self._deadline = self._backend.now, self._backend.now + timeout
        self._held = request
        self.look()

    def look(self) -> None:
        """See whether the answer is overdue, or can never come."""
        now, request = self._backend.now, self._held
        if request is not None:
            # a real network, where a client finds no server in its first moments
            may_come = self._backend.clock is None and now - self._asked <= DISCOVERY
            if self._client.service_is_ready():
                self._held = None
                self._future = future = self._client.call_async(request)
                future.add_done_callback(self._done)
            elif not may_come:
                self._held = None
                self._end(f"Not asked: {self.why_unheard()}")
        elif self._future is not None and now > self._deadline:
            waited = number(self._deadline - self._asked, 1)
            self._end(f"No answer from {self._name} within {waited} s of robot time.")
        elif self._future is not None and not self._is_offered():
            self._end(f"No answer: the node that offered {self._name} is gone.")

    def give_up(self) -> None:
        """Wait no more."""
        future, self._future, self._held = self._future, None, None
        if future is not None and self._client is not None:
            self._client.remove_pending_request(future)

    def close(self) -> None:
        """Ask no more."""
        self.give_up()
        if self._client is not None:
            self._backend.node.destroy_client(self._client)
            self._client = None

    def why_unheard(self) -> str:
        """A sentence that says why no node would answer; "" if one would."""
        return "" if self._is_offered() else f"No node offers {self._name} now."

    def _is_offered(self) -> bool:
        """Looks at the graph alone where nothing was asked yet, so that looking leaves no client there."""
        if self._client is not None and self._held is None:
            return self._client.service_is_ready()
        return any(self._name == name for name, _ in self._backend.node.get_service_names_and_types())

    def _done(self, future: Future) -> None:
        if future is not self._future:
            return
        try:
            response = future.result()
        except Exception as error:
            self._end(f"The call failed: {error}")
            return
        seconds = number(self._backend.now - self._asked)
        self._end(f"{self._name} answered after {seconds} s of robot time.", in_yaml(response))

    def _end(self, words: str, answer: str = "") -> None:
        self.give_up()
        self._answered(words, answer)


def in_yaml(message: Any) -> str:
    """A message in lines as `ros2 topic echo` shows it; of a long array the first elements."""
    import yaml

    fields = _shortened(plain(message))
    if not fields:
        return "(the answer has no fields)"
    return yaml.safe_dump(fields, sort_keys=False, allow_unicode=True, default_flow_style=False).strip()


def _shortened(value: Any) -> Any:
    if isinstance(value, dict):
        return {name: _shortened(each) for name, each in value.items()}
    if isinstance(value, list):
        rest = [f"… and {len(value) - LONGEST_LIST} more"] if len(value) > LONGEST_LIST else []
        return [*map(_shortened, value[:LONGEST_LIST]), *rest]
    return value


class ServerWatcher:
    """Watches the node that offers one service: whether it is still there, and its warnings; `said()` is called at each."""

    def __init__(self, backend: Backend, service: str, said: Callable[[], None]) -> None:
        self._backend, self._service, self._said = backend, service, said
        self._subscription: Subscription | None = None
        self._names: list[str] = []
        self._ends: set[tuple[int, ...]] = set()
        self._warnings: deque[tuple[float, str]] = deque(maxlen=1000)

    def listen(self) -> None:
        """Notice which node offers the service now, and listen to its warnings."""
        self._names = [name for name, _ in servers(self._backend.node, self._service)]
        self._ends = self._rosout_ends()
        if self._subscription is None:
            from rcl_interfaces.msg import Log

            self._subscription = self._backend.node.create_subscription(Log, "/rosout", self._hear, 1000)

    def close(self) -> None:
        """Listen no more."""
        if self._subscription is not None:
            self._backend.node.destroy_subscription(self._subscription)
            self._subscription = None

    def is_there(self) -> bool:
        """Whether it is the one that was there when `listen` was called: started again, it has forgotten all calls."""
        return bool(servers(self._backend.node, self._service)) and self._ends <= self._rosout_ends()

    def why(self, called: float, answered: float, *, last: bool) -> str:
        """What it warned of between a call and its answer (robot time, s), or "". A warning is given out once.

        Of several, one about a goal is preferred; then the first, or the `last`.
        """
        found = [each for each in self._warnings if called - SLACK <= each[0] <= answered + SLACK]
        found = [each for each in found if "goal" in each[1].lower()] or found
        if not found:
            return ""
        chosen = found[-1 if last else 0]
        self._warnings.remove(chosen)
        # without "Goal refused:" in front, since the state says that already; with a capital and a full stop
        head, colon, rest = chosen[1].partition(": ")
        text = rest if colon and head.lower().startswith("goal") else chosen[1]
        return f"{text[:1].upper()}{text[1:]}".rstrip(".") + "."

    def _hear(self, message: Any) -> None:
        names = [name.strip("/").replace("/", ".") for name in self._names]
        if message.level >= WARNING and any(f"{message.name}.".startswith(f"{name}.") for name in names):
            stamp = message.stamp.sec * 1_000_000_000 + message.stamp.nanosec
            self._warnings.append((self._backend.recorder.seconds(stamp), message.msg))
            self._said()

    def _rosout_ends(self) -> set[tuple[int, ...]]:
        """What tells this very node from the next one of its name: the end with which it publishes its log."""
        return {
            tuple(end.endpoint_gid)
            for end in self._backend.node.get_publishers_info_by_topic("/rosout")
            if owner(end) in self._names
        }
