"""Panels that show the running system: status, scan, nodes and services, rates of topics, and the log."""

from __future__ import annotations

import math
from collections import Counter
from operator import itemgetter
from typing import Any

import numpy as np
import traitlets

from ...ros.idl.names import is_hidden
from ..graph import EVERYWHERE
from ..recording import NANOSECONDS, OBSTACLE_TOPIC, SCAN_TOPIC, STATUS_TOPIC, Table
from ..scan import Beams, read_beams
from ..words import listed, number
from .backend import Backend
from .lazy_endpoints import LazySubscriber, servers
from .live_widget import LiveWidget, pack


def why_silent(backend: Backend, topic: str) -> str:
    """A sentence on why nothing came on a topic that the recorder hears, and what to try."""
    if backend.node.count_publishers(topic):
        return f"No message has come on {topic} yet: messages come while robot time passes."
    return backend.recorder.why_silent(topic)


# -- status ---------------------------------------------------------------------------------------------------------

WINDOW = 30.0
"""Seconds of robot time that the curves show."""
MOST = 3000
"""Statuses that are looked at: those of the window at a hundred a second."""
POINTS = 300
"""About so many of them are drawn at most: one every 0.1 s."""
STATUS_IS_LATE = 1.5
"""Seconds without a status after which the panel says so."""


class StatusPanel(LiveWidget):
    """Shows what came on /robot/status."""

    status = traitlets.Bytes().tag(sync=True)
    """A row for each status: its age (s), x, y (m), heading (rad), speed (m/s), battery (%)."""
    status_note = traitlets.Unicode().tag(sync=True)
    """Why there is no status, if there is none."""

    _status_seen: tuple[float, int] | None = None

    def tick(self) -> None:
        """Read the newest statuses."""
        super().tick()
        if not self.due("status", 10):
            return
        recorder, now = self.backend.recorder, self.backend.now
        newest = recorder.statuses.newest(1)
        stamp = int(newest["stamp"][0]) if len(newest) else 0
        if self._status_seen != (now, stamp):
            self._status_seen = (now, stamp)
            self.status = pack(_window(recorder.statuses.newest(MOST), recorder.origin + round(now * NANOSECONDS)))
        if len(newest):
            age = now - float(recorder.seconds(stamp))
            self.status_note = f"No status for {age:.0f} s." if age > STATUS_IS_LATE else ""
        elif self.due("status note", 1):
            self.status_note = why_silent(self.backend, STATUS_TOPIC)


def _window(rows: np.ndarray, now: int) -> np.ndarray:
    """The rows of the window, thinned so that a point that stays does not move while time goes on."""
    ages = (now - rows["stamp"]) / NANOSECONDS
    rows, ages = rows[ages <= WINDOW], ages[ages <= WINDOW]
    if len(rows) > POINTS:
        slots = rows["stamp"] // round(WINDOW / POINTS * NANOSECONDS)
        kept = np.append(slots[1:] != slots[:-1], True)
        rows, ages = rows[kept], ages[kept]
    speed = np.hypot(rows["vel_x"], rows["vel_y"])
    return np.column_stack([ages, rows["x"], rows["y"], rows["theta"], speed, rows["battery"]])


# -- lights ---------------------------------------------------------------------------------------------------------

NODES = ("/turtlesim", "/navigator", "/status_monitor", "/obstacle_detector")
SERVICES = ("/navigate_to",)


class LightsPanel(LiveWidget):
    """Shows the nodes and services that the system needs, as the graph has them."""

    lights = traitlets.List(traitlets.Dict()).tag(sync=True)
    """"name", "kind" ("node" or "service"), "state" ("present", "missing", "several", "extra") and "words" for each."""

    def tick(self) -> None:
        """Look at the graph, now and then."""
        super().tick()
        if self.due("lights", 2):
            self.lights = look(self.backend.node)


def look(node: Any) -> list[dict[str, Any]]:
    """The lights, from the graph that `node` (an rclpy Node) sees."""
    places = node.get_node_names_and_namespaces()
    names = [f"{namespace.rstrip('/')}/{name}" for name, namespace in places]
    found = Counter(name for name in names if not is_hidden(name))
    nodes = [_light(name, "node", found[name]) for name in NODES]
    extra = [{**_light(name, "node", found[name]), "state": "extra"} for name in sorted(found) if name not in NODES]
    offering = {service: servers(node, service) for service in SERVICES}
    services = [_light(name, "service", len(nodes), listed(nodes)) for name, nodes in offering.items()]
    return [*nodes, *services, *extra]


def missing(lights: list[dict[str, Any]]) -> list[str]:
    """The names of what should be there and is not."""
    return [light["name"] for light in lights if light["state"] == "missing"]


def _light(name: str, kind: str, amount: int, by: str = "") -> dict[str, Any]:
    if not amount:
        state, words = "missing", "missing"
    elif amount == 1:
        state, words = "present", f"from {by}" if by else "present"
    else:
        state = "several"
        words = f"offered {amount} times" if by else f"{amount} nodes of this name"
    return {"name": name, "kind": kind, "state": state, "words": words}


# -- log ------------------------------------------------------------------------------------------------------------

KEPT = 500
"""Lines that are kept, about."""
BLOCK = 50
"""New lines are sent again with each newer one until there are so many; the older ones only once a block."""
LEVELS = ("DEBUG", "INFO", "WARN", "ERROR", "FATAL")

Line = list[Any]
"""Number, robot time (s), level, name of the logger, text."""


class LogPanel(LiveWidget):
    """Keeps the newest lines of the log. It is sent in two pieces, so that a new line does not cost the whole log."""

    log_old: Any = traitlets.List().tag(sync=True)
    log_new: Any = traitlets.List().tag(sync=True)
    log_least = traitlets.Unicode("INFO").tag(sync=True)
    """Lines below this level are not shown."""

    def __init__(self, *arguments: Any, **traits: Any) -> None:
        self._log_waiting: list[tuple[int, str, str, str]] = []
        self._log_count = 0
        self._log_newest = self._log_read_until = 0
        self._rosout: Any = None
        super().__init__(*arguments, **traits)

    def opened(self) -> None:
        """Listen to /rosout. What nodes said before comes first: /rosout keeps it for late listeners."""
        super().opened()
        from rcl_interfaces.msg import Log
        from rclpy.qos import DurabilityPolicy, QoSProfile

        self._log_read_until = self._log_newest
        latched = QoSProfile(depth=1000, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        node, loop, hear = self.backend.node, self.backend.loop, self._hear_log
        self._rosout = node.create_subscription(
            Log, "/rosout", lambda message: loop.now_or_soon(hear, message), latched
        )

    def closed(self) -> None:
        """Listen no more."""
        super().closed()
        if self._rosout is not None:
            self.backend.node.destroy_subscription(self._rosout)
            self._rosout = None

    def tick(self) -> None:
        """Take over the lines that have come."""
        super().tick()
        if self._log_waiting and self.due("log", 5):
            waiting, self._log_waiting = self._log_waiting, []
            self._add_lines(sorted(waiting, key=itemgetter(0)))

    def do_log_least(self, level: str) -> None:
        """Show only lines of this level and above."""
        if level not in LEVELS:
            raise ValueError(f"There is no level {level!r}; there are {', '.join(LEVELS)}.")
        self.log_least = level

    def _hear_log(self, message: Any) -> None:
        stamp = message.stamp.sec * NANOSECONDS + message.stamp.nanosec
        if stamp <= self._log_read_until:
            return  # heard before the panel was last closed
        self._log_newest = max(self._log_newest, stamp)
        self._log_waiting.append((stamp, level_name(message.level), message.name, message.msg))
        del self._log_waiting[:-KEPT]

    def _add_lines(self, heard: list[tuple[int, str, str, str]]) -> None:
        lines: list[Line] = []
        for stamp, *what in heard:
            self._log_count += 1
            lines.append([self._log_count, round(float(self.backend.recorder.seconds(stamp)), 3), *what])
        new = [*self.log_new, *lines]
        if len(new) > BLOCK:
            self.log_old = [*self.log_old, *new][-KEPT:]
            new = []
        self.log_new = new


def level_name(level: Any) -> str:
    """The name of a level of rcl_interfaces/msg/Log: 20 is "INFO", and so is what lies between 20 and 30."""
    number = level[0] if isinstance(level, bytes) else int(level)
    return LEVELS[min(max(number // 10 - 1, 0), len(LEVELS) - 1)]


# -- rates ----------------------------------------------------------------------------------------------------------

RATE_WINDOW = 5.0
"""Seconds of robot time over which a rate is measured."""
PAUSE = 1.0
"""Seconds without a message after which a topic that should go on counts as silent."""
TOLERANCE = 0.15
"""By this share a rate may be off and still be as expected."""
MOST_ROWS = 12
"""Topics that are shown; each of those without an expected rate costs a subscription while the panel is seen."""
MOST_MESSAGES = 1000


def frequency(stamps: np.ndarray, now: int, pause: float = RATE_WINDOW) -> float:
    """Messages a second since the last `pause` (s); 0 in silence, not-a-number for a first message that is alone.

    `stamps` and `now` are in ns, `stamps` ascending.
    """
    recent = stamps[stamps > now - round(RATE_WINDOW * NANOSECONDS)]
    if not len(recent):
        return 0.0
    gaps = np.diff(recent, append=max(now, int(recent[-1]))) / NANOSECONDS
    if gaps[-1] > pause:
        return 0.0
    breaks = np.flatnonzero(gaps[:-1] > pause)
    steps = gaps[breaks[-1] + 1 if len(breaks) else 0 : -1]
    if not len(steps):
        return float("nan")
    span = float(steps.sum())
    overdue = max(0.0, float(gaps[-1]) - 2 * span / len(steps))
    return len(steps) / (span + overdue) if span + overdue > 0 else float("nan")


def verdict(hertz: float, expected: float) -> str:
    """ "as expected", "too slow", "too fast", "silent", or "just begun" """
    if np.isnan(hertz):
        return "just begun"
    if hertz == 0:
        return "silent"
    if hertz < (1 - TOLERANCE) * expected:
        return "too slow"
    return "too fast" if hertz > (1 + TOLERANCE) * expected else "as expected"


class RatesPanel(LiveWidget):
    """Measures rates, from what the recorder has heard where it hears a topic, by a subscription of its own elsewhere."""

    rates = traitlets.List(traitlets.Dict()).tag(sync=True)
    """A row a topic: "topic", "hertz", "expected" (0: none), a "state" in words, and a "note"."""
    rates_more = traitlets.Int(0).tag(sync=True)
    """How many topics are not shown."""

    _subscribers: dict[str, LazySubscriber] | None = None

    def opened(self) -> None:
        """Listen to the topics that the recorder does not hear, from the next look at the graph on."""
        super().opened()
        self._subscribers = {}

    def closed(self) -> None:
        """Listen no more."""
        super().closed()
        for subscriber in (self._subscribers or {}).values():
            subscriber.close()
        self._subscribers = None

    def tick(self) -> None:
        """Look which topics there are, now and then, and measure."""
        super().tick()
        if self._subscribers is not None and self.due("topics", 1):
            self._follow_topics(self._subscribers)
        if self.due("rates", 4):
            self.rates = [*self._expected_rows(), *self._other_rows()]

    def _now(self) -> int:
        return self.backend.recorder.origin + round(self.backend.now * NANOSECONDS)

    def _expected_rows(self) -> list[dict[str, Any]]:
        recorder = self.backend.recorder
        known: list[tuple[str, Table, float]] = [
            (recorder.pose_topic, recorder.poses, 62.5),
            (STATUS_TOPIC, recorder.statuses, 10.0),
            (SCAN_TOPIC, recorder.scans, 5.0),
            (recorder.command_topic, recorder.commands, 10.0),
        ]
        now = self._now()
        rows = []
        for topic, table, expected in known:
            hertz = frequency(table.newest(MOST_MESSAGES)["stamp"], now, PAUSE)
            state = verdict(hertz, expected)
            if topic == recorder.command_topic and state == "silent":
                state = "at rest"  # no goal is driven to, so no command is due
            elif state == "silent" and self.backend.now < PAUSE:
                state = "just begun"
            rows.append(_row(topic, hertz, expected, state))
        return rows

    def _other_rows(self) -> list[dict[str, Any]]:
        now, worlds = self._now(), self.backend.recorder.worlds
        subscribers = self._subscribers or {}
        stamps = {topic: subscriber.stamps for topic, subscriber in subscribers.items()}
        if len(worlds):
            stamps[OBSTACLE_TOPIC] = worlds.newest(MOST_MESSAGES)["stamp"]
        rows = []
        for topic in sorted(stamps):
            hertz = frequency(stamps[topic], now)
            trouble = subscribers[topic].trouble if topic in subscribers else ""
            rows.append(_row(topic, hertz, 0.0, "not heard" if trouble else "heard" if hertz else "quiet", trouble))
        return rows

    def _follow_topics(self, subscribers: dict[str, LazySubscriber]) -> None:
        """Subscribe to each topic that a node publishes and the recorder does not hear."""
        node, recorder = self.backend.node, self.backend.recorder
        heard = {recorder.pose_topic, recorder.command_topic, STATUS_TOPIC, SCAN_TOPIC, OBSTACLE_TOPIC}
        found = {
            topic: types[0]
            for topic, types in sorted(node.get_topic_names_and_types())
            if topic not in heard | EVERYWHERE and not is_hidden(topic) and node.count_publishers(topic)
        }
        shown = dict(list(found.items())[: MOST_ROWS - len(heard)])
        self.rates_more = len(found) - len(shown)
        for topic in [topic for topic in subscribers if topic not in shown]:
            subscribers.pop(topic).close()
        for topic, kind in shown.items():
            if topic not in subscribers:
                subscribers[topic] = LazySubscriber(self.backend, topic, kind)


def _row(topic: str, hertz: float, expected: float, state: str, note: str = "") -> dict[str, Any]:
    shown = None if math.isnan(hertz) else float(np.round(hertz, 1))
    return {"topic": topic, "hertz": shown, "expected": expected, "state": state, "note": note}


# -- scan -----------------------------------------------------------------------------------------------------------

SCAN_IS_LATE = 1.5
"""Seconds without a scan after which the panel says so."""


class ScanPanel(LiveWidget):
    """Says what the newest scan means; the scan itself is a trait of the map, whose points it also makes."""

    scan_words = traitlets.Dict().tag(sync=True)
    """"nearest" and "count" in words, the index of the nearest "beam" (-1: none), and a "note" on silence."""

    _scan_read: Any = None

    def tick(self) -> None:
        """Read the newest scan."""
        super().tick()
        if not self.due("scan", 10):
            return
        recorder = self.backend.recorder
        scan = recorder.last_scan
        if scan is None:
            if self.due("scan note", 1):
                note = why_silent(self.backend, SCAN_TOPIC)
                self.scan_words = {"beam": -1, "nearest": "", "count": "", "note": note}
            return
        age = self.backend.now - float(recorder.seconds(recorder.scans.newest(1)["stamp"][0]))
        note = f"No scan for {age:.0f} s." if age > SCAN_IS_LATE else ""
        if scan is not self._scan_read:
            self._scan_read = scan
            self.scan_words = {**in_words(read_beams(scan)), "note": note}
        elif note != self.scan_words["note"]:
            self.scan_words = {**self.scan_words, "note": note}


def in_words(beams: Beams) -> dict[str, Any]:
    """The nearest thing and how many beams see anything: {"beam": …, "nearest": …, "count": …}."""
    beam = beams.nearest()
    counted = f"{int(beams.sees.sum())} of {len(beams)} beams see something"
    if beam is None:
        return {"beam": -1, "nearest": f"nothing within {number(beams.most, 1)} m", "count": counted}
    place = f"{number(beams.ranges[beam])} m, {direction(beams.angles[beam])}"
    return {"beam": beam, "nearest": place, "count": counted}


def direction(radians: float) -> str:
    """Where a beam looks: "ahead", "30° to the left", "behind"."""
    degrees = round(math.degrees(math.remainder(radians, math.tau)))
    if degrees == 0:
        return "straight ahead"
    if abs(degrees) == 180:
        return "straight behind"
    return f"{abs(degrees)}° to the {'left' if degrees > 0 else 'right'}"
