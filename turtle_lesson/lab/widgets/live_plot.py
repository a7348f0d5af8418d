"""Curves that go on: numbers from any topics, drawn as they come."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
import traitlets

from .. import style
from ..picture import Picture
from ..recorder import Channel
from ..recording import NANOSECONDS, OBSTACLE_TOPIC, SCAN_TOPIC, STATUS_TOPIC
from ..status import spread
from ..words import count, enumerated, is_hidden, number
from .backend import Backend
from .curve import Curve, mistyped
from .live_data import Pace, pack
from .live_widget import LiveWidget, script, styles

MOST = 8
"""More curves than this cannot be told apart in one picture."""

COLUMNS = 200
"""Of a curve, the browser gets the lowest and the highest number in each of so many columns."""

ANCHOR = 1000.0
"""Times go to the browser since the last full 1000 s: 32 bits then keep a tenth of a millisecond."""


class LivePlot(LiveWidget):
    """Draws numbers over the last seconds of robot time. It listens from its making until its last view closes."""

    curves = traitlets.List(traitlets.Dict()).tag(sync=True)
    """Of each curve: its "name", its "topic", the "last" number in words, and a "note" if there is nothing to hear."""
    points = traitlets.Bytes().tag(sync=True)
    """Of each curve how many points follow, then time (s since the anchor) and number, time and number, …"""
    now = traitlets.Float(0.0).tag(sync=True)
    """Robot time since the anchor, s."""
    anchor = traitlets.Float(0.0).tag(sync=True)
    seconds = traitlets.Float(30.0).tag(sync=True)
    label = traitlets.Unicode().tag(sync=True)
    """The text, brought up to date now and then, as the picture's description."""

    RATE = 20.0

    def __init__(self, backend: Backend, fields: Iterable[str], seconds: float) -> None:
        self._esm = script("dom", "small", "live_plot")
        self._css = styles("base", "small", "live_plot")
        self._curves = [Curve(asked) for asked in dict.fromkeys(_checked(backend.node, fields))]
        self._channels: dict[str, Channel] = {}
        self._timer: Any = None
        self._looks, self._labels = Pace(2), Pace(0.5)
        if isinstance(seconds, bool) or not isinstance(seconds, (int, float)) or not 0.1 <= seconds <= 3600:
            raise ValueError(f"seconds must be a number of seconds from 0.1 to 3600, got {seconds!r}: try seconds=30.0")
        self._refuse_mistakes(backend)
        super().__init__(backend, seconds=float(seconds))
        self._listen()
        self.tick()

    def _refuse_mistakes(self, backend: Backend) -> None:
        topics = dict(backend.node.get_topic_names_and_types())
        recorder = backend.recorder
        to_come = {STATUS_TOPIC, SCAN_TOPIC, OBSTACLE_TOPIC, recorder.pose_topic, recorder.command_topic}
        visible = [name for name in topics if not is_hidden(name)]
        for curve in self._curves:
            curve.find(topics)
            if not curve.topic and (meant := mistyped(curve.asked, visible, to_come)):
                known = f"The topics: {enumerated(visible)}."
                raise ValueError(f'there is no topic for "{curve.asked}". Did you mean "{meant}"? {known}')

    # -- listening -----------------------------------------------------------------------------------------------------

    def _listen(self) -> None:
        if self._timer is None:
            self._timer = self.backend.node.create_timer(1.0, self._hop)
            self._look()

    def _hop(self) -> None:
        self.backend.loop.now_or_soon(self._look)

    def _look(self) -> None:
        """Find what is there by now, and listen to it."""
        if self._timer is None or self.backend.ended:
            return
        topics = dict(self.backend.node.get_topic_names_and_types())
        for curve in self._curves:
            if curve.topic not in self._channels:
                self._try(curve, topics)
        for channel in self._channels.values():
            channel.glance()

    def _try(self, curve: Curve, topics: dict[str, list[str]]) -> None:
        try:
            curve.find(topics)
        except ValueError as error:  # found out only now, when there is a cell no more in which to say it
            curve.problem = f"{error}"
        if not curve.problem:
            self._channels[curve.topic] = self._channel(curve.topic, curve.type_name)

    def _channel(self, topic: str, type_name: str) -> Channel:
        def hear(message: Any, info: Any) -> None:
            for curve in self._curves:
                if curve.topic == topic and not curve.problem:
                    curve.hear(message, info)

        return Channel(self.backend.node, topic, type_name, lambda _: hear, "It waits until a node does.")

    def opened(self) -> None:
        """Listen, if it does not yet."""
        self._listen()

    def closed(self) -> None:
        """The last view is gone: listen no more; what was heard stays."""
        if not self.backend.ended:
            self.left()

    def left(self) -> None:
        """Listen no more."""
        if self._timer is not None:
            self.backend.node.destroy_timer(self._timer)
        for channel in self._channels.values():
            channel.close()
        self._timer = None
        self._channels.clear()

    def end(self) -> None:
        """The system ends now."""
        super().end()
        self._curves.clear()

    # -- what is shown -------------------------------------------------------------------------------------------------

    def window(self, curve: Curve) -> tuple[np.ndarray, np.ndarray]:
        """Times (s) and numbers of a curve's last `seconds`."""
        rows = curve.table.array()
        since = self.backend.recorder.origin + round((self.backend.now - self.seconds) * NANOSECONDS)
        rows = rows[np.searchsorted(rows["stamp"], since) :]
        return self.backend.recorder.seconds(rows["stamp"]), rows["value"]

    def tick(self) -> None:
        """Bring points and figures up to date."""
        self.anchor = math.floor(self.backend.now / ANCHOR) * ANCHOR
        self.now = self.backend.now - self.anchor
        parts: list[np.ndarray] = []
        for curve in self._curves:
            times, values = thinned(*self.window(curve), self.seconds / COLUMNS)
            parts += [np.array([len(times)]), np.column_stack([times - self.anchor, values]).ravel()]
        self.points = pack(np.concatenate(parts))
        if self._looks.due():
            self._look()
        self.curves = [self._state(curve) for curve in self._curves]
        if self._labels.due():
            self.label = self.text()

    def _state(self, curve: Curve) -> dict[str, Any]:
        rows = curve.table
        last = figure(float(rows.array()["value"][-1])) if len(rows) else ""
        return {"name": curve.name, "topic": curve.topic or curve.asked, "last": last, "note": self._note(curve)}

    def _note(self, curve: Curve) -> str:
        if curve.problem:
            return curve.problem
        if len(curve.table):
            return ""
        channel = self._channels.get(curve.topic)
        return channel.why_silent() if channel is not None else "It no longer listens."

    def text(self) -> str:
        """Each curve in figures: how many messages, the last number, lowest and highest."""
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

    def picture(self) -> Picture | None:
        """The curves as they are now."""
        windows = [(curve.name, *self.window(curve)) for curve in self._curves]
        return draw(self.text(), windows, self.backend.now, self.seconds)


def thinned(times: np.ndarray, values: np.ndarray, width: float) -> tuple[np.ndarray, np.ndarray]:
    """Of numbers over time the lowest and the highest in each column of `width` seconds, in the order of time.

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
    if not math.isfinite(value) or value == 0:
        return number(value)
    return number(value) if 0.1 <= abs(value) < 1e5 else f"{value:.3g}"


def _checked(node: Any, fields: Iterable[str]) -> list[str]:
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


# -- live plot picture --------------------------------------------------------------------------------------------
# A live plot where it cannot live: the picture of one moment.

Window = tuple[str, np.ndarray, np.ndarray]
"""A curve's name, its times (s) and its numbers."""

COLOURS = (style.BLUE, style.VERMILLION, style.GREEN, style.PURPLE, style.ORANGE, style.SKY, "#8a6fd0", style.INK)
DASHES: Sequence[Any] = ("-", (0, (6, 2)), (0, (2, 1.5)), (0, (8, 2, 2, 2)), "-", (0, (6, 2)), (0, (2, 1.5)), "-")
"""Beside the colours, so that curves are told apart without them; the same as in the browser (live_plot.js)."""

LONGEST_NAME = 14
"""Characters of a curve's name that fit beside it; the end of a longer one, which tells most, is kept."""


def draw(text: str, windows: list[Window], now: float, seconds: float) -> Picture:
    """The curves over the last `seconds` before `now`; a text alone where there is nothing to draw."""
    if not any(np.isfinite(values).any() for _, _, values in windows):
        return Picture(text)
    with style.applied():
        figure = style.card(6.4, 3.4)
        begin = max(0.0, now - seconds) if now >= 0 else now - seconds
        style.heading(figure, "Live plot", f"{number(begin, 1)} s to {number(now, 1)} s of robot time")
        axes = style.axes_at(figure, 0.75, 0.5, 3.95, 2.2)
        axes.set_xlabel("robot time in seconds")
        for index, (_, times, values) in enumerate(windows):
            axes.plot(times, values, color=COLOURS[index], linestyle=DASHES[index], linewidth=1.8)
        axes.set_xlim(begin, max(now, begin + 1e-6))
        _set_heights(axes, windows)
        _label(axes, windows)
    return Picture(text, figure)


def _set_heights(axes: Any, windows: list[Window]) -> None:
    every = np.concatenate([values[np.isfinite(values)] for _, _, values in windows])
    low, high = every.min(), every.max()
    spare = 0.08 * (high - low) or max(0.5, 0.05 * abs(high))
    axes.set_ylim(low - spare, high + spare)


def _label(axes: Any, windows: list[Window]) -> None:
    """At the right end of each curve its name and its last number."""
    shown = [(index, *window) for index, window in enumerate(windows) if len(window[1])]
    low, high = axes.get_ylim()
    places = spread([float(values[-1]) for *_, values in shown], 0.085 * (high - low))
    for (index, name, _, values), place in zip(shown, places, strict=True):
        short = name if len(name) <= LONGEST_NAME else f"…{name[1 - LONGEST_NAME :]}"
        label = f"{short}  {number(float(values[-1]))}"
        axes.annotate(
            label,
            (1.0, place),
            xycoords=("axes fraction", "data"),
            xytext=(8, 0),
            textcoords="offset points",
            color=COLOURS[index],
            fontsize=8.5,
            fontweight="bold",
            va="center",
            annotation_clip=False,
        )
