"""The dashboard: the goal pad, and beside it status, scan, nodes and services, rates of topics, and the log."""

from __future__ import annotations

import math
from collections import Counter
from operator import itemgetter
from typing import TYPE_CHECKING, Any

import numpy as np
import traitlets
from rcl_interfaces.msg import Log
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.subscription import Subscription

from ...ros.idl.names import is_hidden
from .. import drawing
from ..drawing import SHARPNESS, Picture
from ..graph import EVERYWHERE, node_names, servers
from ..recorder import Channel
from ..recording import COMMAND_TOPIC, NANOSECONDS, OBSTACLE_TOPIC, POSE_TOPIC, SCAN_TOPIC, STATUS_TOPIC, Table
from ..status_and_scan import Beams, plot_status, read_beams
from ..words import count, listed, number
from .backend import Link
from .goal_client import SERVICE
from .goal_pad import STALE, GoalPad
from .live_widget import pack

if TYPE_CHECKING:
    from matplotlib.figure import Figure

WINDOW = 30.0
"""Seconds of robot time that the curves show."""
POINTS = 300
"""About so many statuses are drawn at most: one every 0.1 s."""
STATUS_TIP = 30
"""All are sent again once so many are new."""

NODES = ("/turtlesim", "/navigator", "/status_monitor", "/obstacle_detector")
"""What the system needs, beside the navigator's service."""

KEPT = 500
"""Lines of the log that are kept, about."""
BLOCK = 50
"""New lines are sent again with each newer one until there are so many; the older ones only once a block."""
LEVELS = ("DEBUG", "INFO", "WARN", "ERROR", "FATAL")

RATE_WINDOW = 5.0
"""Seconds of robot time over which a rate is measured."""
PAUSE = 1.0
"""Seconds without a message after which a topic that should go on counts as silent."""
TOLERANCE = 0.15
"""A rate that is off by at most this share is as expected."""
MOST_ROWS = 12
"""Topics that are shown; each of those without an expected rate costs a subscription while the panel is seen."""
MOST_MESSAGES = 1000
"""Messages of a topic whose times are kept: five seconds of 200 a second."""


class Dashboard(GoalPad):
    """Everything about a running system at once. While a page shows it, it also hears /rosout and every topic."""

    PANELS = (*GoalPad.PANELS, "status", "log", "scan", "rates", "lights")

    status = traitlets.Bytes().tag(sync=True)
    """A row for each status: its time (s since `status_from`), x, y (m), heading (rad), speed (m/s), battery (%)."""
    status_tip = traitlets.Bytes().tag(sync=True)
    """The newest rows, which follow on those: they are sent in two pieces, as the trail is."""
    status_from = traitlets.Float(0.0).tag(sync=True)
    """Robot time, s."""
    status_note = traitlets.Unicode().tag(sync=True)
    """Why there is no status, if there is none."""
    scan_words = traitlets.Dict().tag(sync=True)
    """"nearest" and "count" in words, the index of the nearest "beam" (-1: none), and a "note" on silence."""
    lights = traitlets.List(traitlets.Dict()).tag(sync=True)
    """"name", "kind" ("node" or "service"), "state" ("present", "missing", "several", "extra") and "words" for each."""
    rates = traitlets.List(traitlets.Dict()).tag(sync=True)
    """A row a topic: "topic", "hertz", "expected" (0: none), a "state" in words, and a "note"."""
    rates_more = traitlets.Int(0).tag(sync=True)
    """How many topics are not shown."""
    log_old: Any = traitlets.List().tag(sync=True)
    """The newest lines of the log: number, robot time (s), level, name of the logger and text. They are sent in two pieces,
    so that a new line does not cost the whole log."""
    log_new: Any = traitlets.List().tag(sync=True)
    log_least = traitlets.Unicode("INFO").tag(sync=True)
    """Lines below this level are not shown."""

    def __init__(self, backend: Link) -> None:
        self._status_sent = -1  # stamp, ns
        self._heard: dict[str, tuple[Channel, Table]] = {}
        self._rosout: Subscription | None = None
        self._log_waiting: list[tuple[int, str, str, str]] = []
        self._log_count = self._log_newest = self._log_read_until = 0
        super().__init__(backend, title="Dashboard")

    def opened(self) -> None:
        super().opened()
        self._log_read_until = self._log_newest
        # what was said before comes first
        latched = QoSProfile(depth=1000, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self._rosout = self.backend.node.create_subscription(Log, "/rosout", self._hear_log, latched)

    def closed(self) -> None:
        super().closed()
        if self._rosout is not None:
            self.backend.node.destroy_subscription(self._rosout)
            self._rosout = None
        while self._heard:
            self._heard.popitem()[1][0].close()

    def tick(self) -> None:
        super().tick()
        if self.due("status", 10):
            self._show_status()
        if self.due("scan", 10):
            self._show_scan_in_words()
        if self.due("lights", 2):
            self.lights = look(self.backend.node)
        if self._rosout is not None and self.due("topics", 1):
            self._follow_topics()
        if self.due("rates", 4):
            self._show_rates()
        if self._log_waiting and self.due("log", 5):
            self._add_lines()

    def _text(self) -> str:
        scan = self.backend.recorder.last_scan
        lost = [light["name"] for light in look(self.backend.node) if light["state"] == "missing"]
        facts = [
            self._place(),
            "no scan heard yet" if scan is None else f"nearest in the scan: {in_words(read_beams(scan))['nearest']}",
            f"missing: {listed(lost)}" if lost else "all expected nodes and services are there",
            f"{count(len(self.desk.goals), 'goal')} sent",
        ]
        return f"Dashboard at {number(self.backend.now)} s of robot time: {'; '.join(facts)}."

    def _picture(self) -> Picture | None:
        cards = super()._picture(), plot_status(self.backend.recorder)
        drawn = [card.pixels() for card in cards if card is not None and card.figure is not None]
        return Picture(self.text(), _side_by_side(drawn) if drawn else None)

    def _place(self) -> str:
        recorder = self.backend.recorder
        statuses = recorder.statuses.newest(1)
        battery = f", battery {number(statuses[0]['battery'], 1)} %" if len(statuses) and len(recorder.poses) else ""
        return super()._place() + battery

    # -- status and scan -----------------------------------------------------------------------------------------------

    def _silence(self, what: str, topic: str, table: Table) -> str:
        """A sentence on why nothing comes on a topic that the recorder hears, and what to try; "" if something does."""
        if last := table.last():
            age = self.backend.now - self.backend.recorder.seconds(last[0])
            return f"No {what} for {age:.0f} s." if age > STALE else ""
        if self.backend.node.count_publishers(topic):
            return f"No message has come on {topic} yet: messages come while robot time passes."
        return self.backend.recorder.why_silent(topic)

    def _show_status(self) -> None:
        statuses = self.backend.recorder.statuses
        newest = statuses.last()
        if newest and self.is_new("status", newest):
            self._send_statuses()
        if newest or self.due("status note", 1):
            self.status_note = self._silence("status", STATUS_TOPIC, statuses)

    def _send_statuses(self) -> None:
        """Send those of the window, thinned so that a point that stays does not move while time goes on."""
        rows = self.backend.recorder.statuses.after(self._now() - round(WINDOW * NANOSECONDS) - 1)
        if len(rows) > POINTS:
            slots = rows["stamp"] // round(WINDOW / POINTS * NANOSECONDS)
            rows = rows[np.append(slots[1:] != slots[:-1], True)]
        if not len(rows):  # all are older than the window
            return
        new = rows[rows["stamp"] > self._status_sent]
        if self._status_sent < 0 or len(new) > STATUS_TIP:
            self._status_sent = int(rows["stamp"][-1])
            self.status_from = float(self.backend.recorder.seconds(self._status_sent))
            self.status = _packed(rows, self._status_sent)
            new = rows[:0]
        self.status_tip = _packed(new, self._status_sent)

    def _show_scan_in_words(self) -> None:
        recorder = self.backend.recorder
        scanned = recorder.scans.last()
        if scanned or self.due("scan note", 1):
            note = self._silence("scan", SCAN_TOPIC, recorder.scans)
            if self.is_new("scan in words", (scanned, note)):
                seen = in_words(read_beams(recorder.last_scan)) if scanned else {"beam": -1, "nearest": "", "count": ""}
                self.scan_words = {**seen, "note": note}

    # -- rates ---------------------------------------------------------------------------------------------------------

    def _now(self) -> int:
        """Robot time as the recorder's tables have it, ns."""
        return self.backend.recorder.origin + round(self.backend.now * NANOSECONDS)

    def _show_rates(self) -> None:
        recorder = self.backend.recorder
        others = {
            topic: (table, "" if end.listens else end.why_silent()) for topic, (end, table) in self._heard.items()
        }
        if len(recorder.worlds):
            others[OBSTACLE_TOPIC] = recorder.worlds, ""
        self.rates = [
            self._rate(POSE_TOPIC, recorder.poses, 62.5),
            self._rate(STATUS_TOPIC, recorder.statuses, 10.0),
            self._rate(SCAN_TOPIC, recorder.scans, 5.0),
            self._rate(COMMAND_TOPIC, recorder.commands, 10.0),
            *(self._rate(topic, table, 0.0, trouble) for topic, (table, trouble) in sorted(others.items())),
        ]

    def _rate(self, topic: str, table: Table, expected: float, trouble: str = "") -> dict[str, Any]:
        stamps = table.newest(MOST_MESSAGES)["stamp"]
        hertz = frequency(stamps, self._now(), PAUSE if expected else RATE_WINDOW)
        state = verdict(hertz, expected)
        if not expected:
            state = "not heard" if trouble else "heard" if hertz else "quiet"
        elif state == "silent" and topic == COMMAND_TOPIC:
            state = "at rest"  # no goal is driven to, so no command is due
        elif state == "silent" and self.backend.now < PAUSE:
            state = "just begun"
        shown = None if math.isnan(hertz) else round(10 * hertz) / 10
        return {"topic": topic, "hertz": shown, "expected": expected, "state": state, "note": trouble}

    def _follow_topics(self) -> None:
        """Listen to each topic that a node publishes and the recorder does not hear."""
        node = self.backend.node
        known = {POSE_TOPIC, COMMAND_TOPIC, STATUS_TOPIC, SCAN_TOPIC, OBSTACLE_TOPIC}
        found = {
            topic: types[0]
            for topic, types in sorted(node.get_topic_names_and_types())
            if topic not in known | EVERYWHERE and not is_hidden(topic) and node.count_publishers(topic)
        }
        shown = dict(list(found.items())[: MOST_ROWS - len(known)])
        self.rates_more = len(found) - len(shown)
        for topic in [topic for topic in self._heard if topic not in shown]:
            self._heard.pop(topic)[0].close()
        for topic, type_name in shown.items():
            if topic not in self._heard:
                self._heard[topic] = self._listen(topic, type_name)

    def _listen(self, topic: str, type_name: str) -> tuple[Channel, Table]:
        table = Table(limit=MOST_MESSAGES)
        raw = self.backend.clock is None  # on a robot, where it may be images: never made into Python objects
        channel = Channel(self.backend.node, topic, type_name, lambda _: table.listener(), "", raw=raw)
        channel.follow()
        return channel, table

    # -- log -----------------------------------------------------------------------------------------------------------

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
        self._log_waiting.append((stamp, LEVELS[min(max(message.level // 10 - 1, 0), 4)], message.name, message.msg))
        del self._log_waiting[:-KEPT]

    def _add_lines(self) -> None:
        new = list(self.log_new)
        for stamp, *what in sorted(self._log_waiting, key=itemgetter(0)):
            self._log_count += 1
            new.append([self._log_count, round(float(self.backend.recorder.seconds(stamp)), 3), *what])
        self._log_waiting.clear()
        if len(new) > BLOCK:
            self.log_old = [*self.log_old, *new][-KEPT:]
            new = []
        self.log_new = new


def look(node: Node) -> list[dict[str, Any]]:
    """What the system needs, and the other nodes, from the graph that `node` (an rclpy Node) sees."""
    found = Counter(name for name in node_names(node) if not is_hidden(name))
    nodes = [_light(name, "node", found[name]) for name in NODES]
    extra = [{**_light(name, "node", found[name]), "state": "extra"} for name in sorted(found) if name not in NODES]
    offering = [name for name, _ in servers(node, SERVICE)]
    return [*nodes, _light(SERVICE, "service", len(offering), listed(offering)), *extra]


def _light(name: str, kind: str, amount: int, by: str = "") -> dict[str, Any]:
    if not amount:
        state, words = "missing", "missing"
    elif amount == 1:
        state, words = "present", f"from {by}" if by else "present"
    else:
        state = "several"
        words = f"offered {amount} times" if by else f"{amount} nodes of this name"
    return {"name": name, "kind": kind, "state": state, "words": words}


def _packed(rows: np.ndarray, begin: int) -> bytes:
    """What the browser gets of statuses, their times since `begin` (ns)."""
    seconds, speed = (rows["stamp"] - begin) / NANOSECONDS, np.hypot(rows["vel_x"], rows["vel_y"])
    return pack(np.column_stack([seconds, rows["x"], rows["y"], rows["theta"], speed, rows["battery"]]))


def frequency(stamps: np.ndarray, now: int, pause: float = RATE_WINDOW) -> float:
    """Messages a second since the last `pause` (s); 0 in silence, not-a-number for a first message that is alone.

    `stamps` and `now` are in ns, `stamps` ascending.
    """
    recent = stamps[stamps > now - round(RATE_WINDOW * NANOSECONDS)]
    silence = (now - int(recent[-1])) / NANOSECONDS if len(recent) else math.inf
    if silence > pause:
        return 0.0
    breaks = np.flatnonzero(recent[1:] - recent[:-1] > pause * NANOSECONDS)
    recent = recent[breaks[-1] + 1 if len(breaks) else 0 :]
    steps = len(recent) - 1
    if not steps:
        return math.nan
    span = int(recent[-1] - recent[0]) / NANOSECONDS
    return steps / span if span > 0 else math.nan


def verdict(hertz: float, expected: float) -> str:
    """ "as expected", "too slow", "too fast", "silent", or "just begun" """
    if math.isnan(hertz):
        return "just begun"
    if hertz == 0:
        return "silent"
    if hertz < (1 - TOLERANCE) * expected:
        return "too slow"
    return "too fast" if hertz > (1 + TOLERANCE) * expected else "as expected"


def in_words(beams: Beams) -> dict[str, Any]:
    """The nearest thing and how many beams see anything: {"beam": …, "nearest": …, "count": …}."""
    beam = beams.nearest()
    counted = f"{int(beams.sees.sum())} of {len(beams)} beams see something"
    if beam is None:
        return {"beam": -1, "nearest": f"nothing within {number(beams.most, 1)} m", "count": counted}
    degrees = round(math.degrees(math.remainder(beams.angles[beam], math.tau)))
    there = f"{abs(degrees)}° to the {'left' if degrees > 0 else 'right'}"
    there = {0: "straight ahead", 180: "straight behind", -180: "straight behind"}.get(degrees, there)
    return {"beam": beam, "nearest": f"{number(beams.ranges[beam])} m, {there}", "count": counted}


def _side_by_side(cards: list[np.ndarray]) -> Figure:
    """A figure on which pictures (rows of pixels) stand side by side, pixel for pixel, their tops in line."""
    from matplotlib.figure import Figure

    gap, sharp, tall = 12 * SHARPNESS, drawing.DPI * SHARPNESS, max(map(len, cards))
    padded = [np.pad(card, ((0, tall - len(card)), (0, gap), (0, 0))) for card in cards]
    whole = np.hstack(padded)[:, :-gap]
    figure = Figure((whole.shape[1] / sharp, tall / sharp), dpi=drawing.DPI, facecolor="none")
    figure.figimage(whole, origin="upper")
    return figure
