"""A live plot: numbers from any topics, drawn as they come, and how each is found in its messages."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

import numpy as np
import traitlets
from rclpy.node import Node
from rclpy.timer import Timer

from ...ros.idl.names import is_hidden, nearest
from .. import drawing
from ..drawing import BLUE, GREEN, INK, ORANGE, PURPLE, SKY, VERMILLION, Picture
from ..recorder import Channel, find_class
from ..recording import NANOSECONDS, Table
from ..status_and_scan import label_beside, spread
from ..words import count, enumerated, number, suggestion, within
from .backend import Link
from .live_widget import LiveWidget, pack
from .message_fields import FLOATS, WHOLE, Kind, kinds_of

KEPT = 20_000
"""Numbers that are kept of a curve: more than five minutes of a turtle's pose."""

SLIP = 0.8
"""A topic that is not there, but this much like one that is, was perhaps mistyped; less like one, it is yet to come."""

_STEP = re.compile(r"[/.]?([A-Za-z_]\w*)|\[(\d+)\]")

Step = str | int


class Curve:
    """What was asked for, where it is found, and the numbers that came. Times are the messages' own, in ns."""

    def __init__(self, asked: str) -> None:
        self.asked = asked
        self.topic = ""
        self.type_name = ""
        self.path = ""
        self.problem = "The topic has not been looked for yet."
        """Why it cannot be heard now, as a sentence; "" if it can."""
        self.table = Table("value", limit=KEPT)
        self.read: Callable[[Any], float] = lambda message: math.nan

    @property
    def name(self) -> str:
        """The field alone, as a label: "battery", "ranges[90]", "linear/x"."""
        return self.path or self.asked.rpartition("/")[2]

    def find(self, topics: Mapping[str, list[str]]) -> None:
        """Find topic and field in the graph. Raises ValueError where the type has no such number."""
        self.topic, rest = split(self.asked, topics)
        if not self.topic:
            visible = [name for name in topics if not is_hidden(name)]
            meant = nearest(self.asked, visible, SLIP)
            hint = f' Did you mean "{meant}"?' if meant else ""
            self.problem = f"There is no such topic yet; now there are {enumerated(visible)}.{hint}"
            return
        self.type_name = topics[self.topic][0]
        steps = steps_to_number(self.topic, self.type_name, rest)
        self.path = rest.lstrip("/.").replace(".", "/") or str(steps[0])
        self.read = reader(steps)
        self.problem = ""


def split(asked: str, topics: Iterable[str]) -> tuple[str, str]:
    """The longest topic with which this begins, and what follows; "" for both where none does."""
    for topic in sorted(topics, key=len, reverse=True):
        if asked == topic or (asked.startswith(topic) and asked[len(topic)] in "/.["):
            return topic, asked[len(topic) :]
    return "", ""


def steps_to_number(topic: str, type_name: str, rest: str) -> list[Step]:
    """The steps to a number in a topic's messages: for "/linear/x" ["linear", "x"], for "/ranges[90]" ["ranges", 90].

    Without any, a message whose one field is a number (std_msgs/Float64) stands for it. Raises ValueError where they lead
    to no number, with what to try.
    """
    if _STEP.sub("", rest):
        raise ValueError(f'"{rest}" is not a path to a field: try /linear/x or /ranges[90]')
    steps: list[Step] = [name or int(index) for name, index in _STEP.findall(rest)]
    kind, walked = Kind(type_name), topic
    if not steps and len(only := _below(kind)) == 1:
        steps = [*only]
    for step in steps:
        name, below = "[0]" if isinstance(step, int) else step, _below(kind)
        if name not in below:
            raise ValueError(f'{kind} has no field "{step}". {suggestion(str(step), below)}')
        kind, walked = below[name], f"{walked}[{step}]" if isinstance(step, int) else f"{walked}/{step}"
    if kind.array or kind.base not in FLOATS | WHOLE | {"boolean"}:
        ways = enumerated(f"{walked}/{name}".replace("/[", "[") for name in _below(kind))
        hint = f": try {ways}" if _below(kind) else ", which cannot be drawn as a curve"
        raise ValueError(f"{walked} is not a number but a {kind}{hint}")
    return steps


def _below(kind: Kind) -> dict[str, Kind]:
    """What a step leads to: from an array to its elements, from a message to its fields, from a number nowhere."""
    if kind.array:
        return {"[0]": Kind(kind.base)}
    return kinds_of(find_class(kind.base)) if kind.is_message else {}


def reader(steps: list[Step]) -> Callable[[Any], float]:
    """A function from a message to the number at the end of the steps; not-a-number where an array is too short."""

    def read(message: Any) -> float:
        try:
            for step in steps:
                message = message[step] if isinstance(step, int) else getattr(message, step)
        except IndexError:
            return float("nan")
        return float(message[0] if isinstance(message, bytes) else message)

    return read


MOST = 8
"""More curves than this cannot be told apart in one picture."""

COLUMNS = 200
"""The browser gets the lowest and the highest number of a curve in each of so many columns."""

ANCHOR = 1000.0
"""Times go to the browser since the last full 1000 s: 32 bits then keep a tenth of a millisecond."""


class LivePlot(LiveWidget):
    """Draws numbers over the last seconds of robot time. It listens from its making until its last view closes."""

    SCRIPTS = ("dom", "small", "live_plot")
    STYLES = ("base", "small", "live_plot")

    curves = traitlets.List(traitlets.Dict()).tag(sync=True)
    """The "name" of each curve, its "topic", the "last" number in words, and a "note" if there is nothing to hear."""
    points = traitlets.Bytes().tag(sync=True)
    """For each curve the number of points that follow, then time (s since the anchor) and number, time and number, …"""
    now = traitlets.Float(0.0).tag(sync=True)
    """Robot time since the anchor, s."""
    anchor = traitlets.Float(0.0).tag(sync=True)
    seconds = traitlets.Float(30.0).tag(sync=True)
    label = traitlets.Unicode().tag(sync=True)
    """The text, brought up to date now and then, as the picture's description."""

    RATE = 10.0

    def __init__(self, backend: Link, fields: Iterable[str], seconds: float) -> None:
        self._curves = [Curve(asked) for asked in dict.fromkeys(_checked(backend.node, fields))]
        self._channels: dict[str, Channel] = {}
        self._timer: Timer | None = None
        seconds = within("seconds of a live plot", seconds, 0.1, 3600)
        for curve in self._curves:
            curve.find(dict(backend.node.get_topic_names_and_types()))
        super().__init__(backend, seconds=seconds)
        self.opened()
        self.tick()

    def opened(self) -> None:
        if self._timer is None:
            self._timer = self.backend.node.create_timer(1.0, self._look)
            self._look()

    def _look(self) -> None:
        """Find what is there by now, and listen to it."""
        if self._timer is None or self.backend.ended:
            return
        topics = dict(self.backend.node.get_topic_names_and_types())
        for curve in self._curves:
            if curve.topic in self._channels:
                continue
            try:
                curve.find(topics)
            except ValueError as error:  # found out only now, when there is a cell no more in which to say it
                curve.problem = f"{error}"
            if not curve.problem:
                self._channels[curve.topic] = self._channel(curve.topic, curve.type_name)
        for channel in self._channels.values():
            channel.glance()

    def _channel(self, topic: str, type_name: str) -> Channel:
        def hear(message: Any, info: Any) -> None:
            for curve in self._curves:
                if curve.topic == topic and not curve.problem:
                    curve.table.append(info["source_timestamp"], curve.read(message))

        return Channel(self.backend.node, topic, type_name, lambda _: hear, "It waits until a node does.")

    def left(self) -> None:
        if self._timer is not None:
            self.backend.node.destroy_timer(self._timer)
        for channel in self._channels.values():
            channel.close()
        self._timer = None
        self._channels.clear()

    def _let_go(self) -> None:
        super()._let_go()
        self._curves.clear()

    def window(self, curve: Curve) -> tuple[np.ndarray, np.ndarray]:
        """Times (s) and numbers of a curve's last `seconds`."""
        recorder = self.backend.recorder
        rows = curve.table.after(recorder.origin + round((self.backend.now - self.seconds) * NANOSECONDS) - 1)
        return recorder.seconds(rows["stamp"]), rows["value"]

    def tick(self) -> None:
        """Bring points and figures up to date."""
        self.anchor = math.floor(self.backend.now / ANCHOR) * ANCHOR
        self.now = self.backend.now - self.anchor
        parts: list[np.ndarray] = []
        for curve in self._curves:
            times, values = thinned(*self.window(curve), self.seconds / COLUMNS)
            parts += [np.array([len(times)]), np.column_stack([times - self.anchor, values]).ravel()]
        self.points = pack(np.concatenate(parts))
        if self.due("topics", 2):
            self._look()
        self.curves = [
            {
                "name": curve.name,
                "topic": curve.topic or curve.asked,
                "last": figure(curve.table.last()[1]) if len(curve.table) else "",
                "note": self._note(curve),
            }
            for curve in self._curves
        ]
        if self.due("label", 0.5):
            self.label = self.text()

    def _note(self, curve: Curve) -> str:
        if curve.problem:
            return curve.problem
        if len(curve.table):
            return ""
        channel = self._channels.get(curve.topic)
        return channel.why_silent() if channel is not None else "It no longer listens."

    def _text(self) -> str:
        self._look()
        begin = f"Live plot of the last {self.seconds:g} s at {number(self.backend.now)} s of robot time."
        return " ".join([begin, *map(self._sentence, self._curves)])

    def _sentence(self, curve: Curve) -> str:
        times, values = self.window(curve)
        if not len(times):
            return f"{curve.asked}: nothing heard. {self._note(curve)}".strip()
        finite = values[np.isfinite(values)]
        span = f", from {figure(finite.min())} to {figure(finite.max())}" if len(finite) else ""
        return f"{curve.asked}: {count(len(times), 'message')}, last {figure(values[-1])}{span}."

    def _picture(self) -> Picture | None:
        windows = [(curve.name, *self.window(curve)) for curve in self._curves]
        return draw(self.text(), windows, self.backend.now, self.seconds)


def thinned(times: np.ndarray, values: np.ndarray, width: float) -> tuple[np.ndarray, np.ndarray]:
    """The lowest and the highest of numbers over time in each column of `width` seconds, in the order of time.

    Columns begin at multiples of their width, so that points do not jump while time goes on.
    """
    if len(times) < 3:
        return times, values
    column = np.floor(times / width).astype(np.int64)
    order = np.lexsort((values, column))
    first = np.flatnonzero(np.diff(column[order], prepend=column[order[0]] - 1))
    last = np.append(first[1:], len(order)) - 1
    kept = np.unique(np.concatenate([order[first], order[last], [len(times) - 1]]))
    return times[kept], values[kept]


def figure(value: float) -> str:
    """A number of any size, in five digits at most: "5.54", "0.0012", "1.2e+09"."""
    fits = not math.isfinite(value) or value == 0 or 0.1 <= abs(value) < 1e5
    return number(value) if fits else f"{value:.3g}"


def _checked(node: Node, fields: Iterable[str]) -> list[str]:
    wanted = list(fields)
    if not wanted:
        raise ValueError('name a topic and a field to draw: try live_plot("/turtle1/pose/x")')
    if len(wanted) > MOST:
        raise ValueError(f"{len(wanted)} curves cannot be told apart: {MOST} at most, and make a second plot")
    for each in wanted:
        if not isinstance(each, str) or not each.strip("/ "):
            raise ValueError(f'a curve is a topic and a field such as "/turtle1/pose/x", got {each!r}')
    space = node.get_namespace().rstrip("/")
    return [each if each.startswith("/") else f"{space}/{each}" for each in wanted]


COLOURS = (BLUE, VERMILLION, GREEN, PURPLE, ORANGE, SKY, "#8a6fd0", INK)
DASHES: Sequence[Any] = ("-", (0, (6, 2)), (0, (2, 1.5)), (0, (8, 2, 2, 2)), "-", (0, (6, 2)), (0, (2, 1.5)), "-")
"""Dashes tell curves apart without colours, too; they are those of live_plot.js."""

LONGEST_NAME = 14
"""Characters of a curve's name that fit beside it; the end of a longer one, which tells most, is kept."""


def draw(text: str, windows: list[tuple[str, np.ndarray, np.ndarray]], now: float, seconds: float) -> Picture:
    """The curves over the last `seconds` before `now`, each its name, times (s) and numbers; a text alone where none is."""
    if not any(np.isfinite(values).any() for _, _, values in windows):
        return Picture(text)
    with drawing.applied():
        figure = drawing.card(6.4, 3.4)
        begin = max(0.0, now - seconds) if now >= 0 else now - seconds
        drawing.heading(figure, "Live plot", f"{number(begin, 1)} s to {number(now, 1)} s of robot time")
        axes = drawing.axes_at(figure, 0.75, 0.5, 3.95, 2.2)
        axes.set_xlabel("robot time in seconds")
        for index, (_, times, values) in enumerate(windows):
            axes.plot(times, values, color=COLOURS[index], linestyle=DASHES[index], linewidth=1.8)
        axes.set_xlim(begin, max(now, begin + 1e-6))
        every = np.concatenate([values[np.isfinite(values)] for _, _, values in windows])
        low, high = every.min(), every.max()
        spare = 0.08 * (high - low) or max(0.5, 0.05 * abs(high))
        axes.set_ylim(low - spare, high + spare)
        shown = [(index, *window) for index, window in enumerate(windows) if len(window[1])]
        places = spread([float(values[-1]) for *_, values in shown], 0.085 * (high - low + 2 * spare))
        for (index, name, _, values), place in zip(shown, places, strict=True):
            short = name if len(name) <= LONGEST_NAME else f"…{name[1 - LONGEST_NAME :]}"
            words = f"{short}  {number(float(values[-1]))}"
            label_beside(axes, words, place, 8, color=COLOURS[index], fontsize=8.5, fontweight="bold")
    return Picture(text, figure)
