"""The timeline: what happened when, a row a topic (a mark a message) and a row a callback (a bar while it lasts)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from rclpy.node import Node

from ..ros.idl.names import is_hidden
from ..ros.rmw.trace import TOPICS, Callback, Trace
from . import drawing
from .drawing import Picture
from .graph import EVERYWHERE, PARAMETER_SERVICES, node_names
from .recording import NANOSECONDS, nanoseconds
from .words import count, listed, number, rate, shortened, suggestion

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


WIDTH, LEFT, RIGHT = 6.4, 1.95, 0.25
"""The card and what is left and right of the axes, in inches."""

LANE, TOP, BOTTOM = 0.40, 0.70, 0.78

HOLDS: dict[str, Any] = {"facecolor": drawing.GREEN, "edgecolor": drawing.DARK_GREEN}
AWAITS: dict[str, Any] = {"facecolor": drawing.ORANGE + "40", "edgecolor": drawing.DARK_ORANGE, "hatch": "////"}
"""The bars of a callback that holds its thread, and of one that leaves it to others."""


def plot_timeline(
    trace: Trace, node: Node, *rows: str, since: float | None = None, until: float | None = None
) -> Picture:
    """What `Lesson.plot_timeline` returns; `node` is an rclpy Node that sees the graph.

    Raises TypeError or ValueError for what is neither a topic nor a node, with the names that are perhaps meant.
    """
    window = window_of(trace.now, since, until)
    lanes = _lanes_of(trace, node, rows, window)
    if not lanes:
        return Picture("No callback has run yet. Start a node, and let robot time pass: lesson.run(1.0).")
    if window.begin == window.end:
        return Picture("No robot time has passed yet, so a timeline would have no width. Try lesson.run(1.0).")
    text = f"Timeline from {window.seconds}. {' '.join(lane.text for lane in lanes)}"
    with drawing.applied():
        return Picture(text, _draw(lanes, window))


def _draw(lanes: list[Lane], window: Window) -> Figure:
    height = TOP + LANE * len(lanes) + BOTTOM
    figure = drawing.card(WIDTH, height)
    callbacks = sum(lane.callback for lane in lanes)
    amounts = {"topic": len(lanes) - callbacks, "callback": callbacks}
    shown = [count(amount, noun) for noun, amount in amounts.items() if amount]
    drawing.heading(figure, "Timeline", f"{window.seconds}  ·  {', '.join(shown)}")
    axes = drawing.axes_at(figure, LEFT, BOTTOM, WIDTH - LEFT - RIGHT, LANE * len(lanes))
    axes.set_ylim(len(lanes) - 0.5, -0.5)
    axes.set_yticks([])
    axes.spines["left"].set_visible(False)
    span = (window.end - window.begin) / NANOSECONDS
    axes.set_xlim(window.begin / NANOSECONDS - 0.008 * span, window.end / NANOSECONDS + 0.008 * span)
    axes.set_xlabel("robot time in seconds")
    for place, lane in enumerate(lanes):
        _draw_lane(axes, place, lane)
        middle = 1 - (TOP + LANE * (place + 0.5)) / height
        left, line = 0.2 / WIDTH, 0.075 / height
        figure.text(left, middle + line, shortened(lane.name, 26), fontsize=8.8, va="center")
        figure.text(left, middle - line, shortened(lane.about, 30), fontsize=7.4, color=drawing.INK, va="center")
    # what the signs mean, of those that are there, beneath the axes
    signs = {label: sign for sign, label in zip(*axes.get_legend_handles_labels(), strict=True)}
    look: dict[str, Any] = {"frameon": False, "fontsize": 8.0, "handlelength": 1.6, "columnspacing": 1.3}
    corner: dict[str, Any] = {"loc": "lower left", "bbox_to_anchor": (0.02, 0.0), "ncols": max(len(signs), 1)}
    figure.legend(signs.values(), signs.keys(), **corner, **look, markerscale=0.6)
    return figure


def _draw_lane(axes: Axes, place: int, lane: Lane) -> None:
    axes.axhline(place, color=drawing.LINE, linewidth=0.8, zorder=0.5)
    colour = drawing.GREEN if lane.callback else drawing.BLUE
    if len(lane.marks):
        marks = lane.marks / NANOSECONDS
        # points: as wide as the gaps between the marks allow, so that single ones stay apart for as long as possible
        low, high = axes.get_xlim()
        gap = np.median(np.diff(marks)) / (high - low) if len(marks) > 1 else 1.0
        thick = np.clip(36 * (WIDTH - LEFT - RIGHT) * gap, 0.3, 1.5)
        tick: dict[str, Any] = {"marker": "|", "markersize": 15.5, "markeredgewidth": thick}
        label = "a short call" if lane.callback else "a message"
        axes.plot(marks, [place] * len(marks), color=colour, linestyle="none", zorder=3, label=label, **tick)
    if len(lane.bars):
        spans = [(begin, end - begin) for begin, end in lane.bars / NANOSECONDS]
        label = "awaits, thread free" if lane.awaits else "holds its thread"
        look = AWAITS if lane.awaits else HOLDS
        axes.broken_barh(spans, (place - 0.27, 0.54), linewidth=0.8, zorder=2.5, label=label, **look)
    line: dict[str, Any] = {"color": drawing.VERMILLION, "linewidth": 1.6, "linestyle": (0, (1.2, 1.2))}
    begin: dict[str, Any] = {"marker": "o", "markersize": 3.0, "markevery": [0]}
    for wait in lane.waits / NANOSECONDS:  # beneath the bars, for it may be another run that lasts meanwhile
        axes.plot(wait, [place + 0.37] * 2, zorder=2, label="ready, had to wait", **line, **begin)


SHORT = 1_000_000
"""What lasts less (ns) is told as no time: looking at a clock costs a microsecond, a message under way a tenth of this."""


@dataclass(frozen=True)
class Window:
    """The stretch of robot time that is shown, both ends included: ns since the lesson's start."""

    begin: int
    end: int

    @property
    def seconds(self) -> str:
        """In words: "0.00 s to 5.00 s of robot time"."""
        return f"{number(self.begin / NANOSECONDS)} s to {number(self.end / NANOSECONDS)} s of robot time"

    def holds(self, times: np.ndarray) -> np.ndarray:
        """Which of these times (ns) are within it."""
        return (times >= self.begin) & (times <= self.end)


@dataclass(frozen=True)
class Lane:
    """One row of a timeline, for a topic or a callback."""

    name: str
    about: str
    """What stands beneath the name, smaller."""
    text: str
    """What it shows, as a sentence."""
    marks: np.ndarray
    """When something happened that took no time, ns."""
    bars: np.ndarray = field(default_factory=lambda: np.empty((0, 2), np.int64))
    """Begin and end, ns, of what lasted, one a row."""
    waits: np.ndarray = field(default_factory=lambda: np.empty((0, 2), np.int64))
    """Begin and end, ns, of each wait of what was ready, one a row."""
    awaits: bool = False
    """Whether the bars are those of an `async def`, which leaves its thread to others."""
    callback: bool = False


def window_of(now: int, since: float | None, until: float | None) -> Window:
    """The stretch from `since` to `until` (s). Raises ValueError for what is no time, or no stretch."""
    begin = 0 if since is None else max(0, nanoseconds("since", since))
    end = now if until is None else min(now, nanoseconds("until", until))
    if begin > end:
        raise ValueError(
            f"there is nothing to show from {begin / NANOSECONDS:g} s to {end / NANOSECONDS:g} s: "
            f"robot time is {now / NANOSECONDS:g} s now, and since must come before until"
        )
    return Window(begin, end)


def _lanes_of(trace: Trace, node: Node, names: Sequence[str], window: Window) -> list[Lane]:
    """The lanes for some names of topics, nodes and callbacks ("/navigator.on_pose"); for none, of all nodes."""
    nodes, here = list(dict.fromkeys(callback.node for callback in trace.callbacks)), node_names(node)
    topics = {name for name, _ in node.get_topic_names_and_types() if not is_hidden(name)} - EVERYWHERE
    topics |= trace.not_noted.union(topic for topic, _ in trace.published)
    lanes: list[Lane] = []
    for name in names or nodes:
        if not isinstance(name, str) or not name.strip("/ "):
            rows = 'the name of a topic or of a node, such as "/robot/status" or "/navigator"'
            raise TypeError(f"a row is {rows}, got {name!r}")
        full = f"/{name.strip().lstrip('/')}"
        of_node, _, function = full.partition(".")
        if of_node in nodes:
            lanes += _callback_lanes(trace, of_node, function, window, of_node in here)
        elif full in topics:
            lanes.append(_topic_lane(trace, full, window))
        else:
            hint = suggestion(full, [*nodes, *sorted(each for each in topics if not is_hidden(each))])
            raise ValueError(f"{full} is neither a topic nor a node that has run here. {hint}")
    return lanes


def _topic_lane(trace: Trace, topic: str, window: Window) -> Lane:
    if topic in trace.not_noted:
        raise ValueError(
            f"{topic} is not recorded: only the first {TOPICS} topics of each node are. `ros2 topic hz {topic}` "
            "measures any."
        )
    by_node = {
        node: times[window.holds(times)]
        for (name, node), stamps in sorted(trace.published.items())
        if name == topic and len(times := np.array(stamps, np.int64))
    }
    times = np.sort(np.concatenate([*by_node.values(), np.empty(0, np.int64)]))
    publishers = [node for node, some in by_node.items() if len(some)]
    text = f"{topic}: {rate(times)}"
    if len(publishers) > 1:
        text += f"; {listed([f'{len(by_node[node])} from {node}' for node in publishers])}"
    about = count(len(times), "message")
    if len(times):
        silent = window.end - int(times[-1])
        usual = max(3 * float(np.median(np.diff(times))), SHORT) if len(times) > 2 else NANOSECONDS
        text += f"; the last at {number(times[-1] / NANOSECONDS)} s"
        text += f", then nothing for {number(silent / NANOSECONDS)} s" if silent > usual else ""
        if times[-1] != times[0]:
            about += f", {number((len(times) - 1) / (times[-1] - times[0]) * NANOSECONDS, 1)} Hz"
    return Lane(topic, about, f"{text}.", times)


def _callback_lanes(trace: Trace, node: str, function: str, window: Window, alive: bool) -> list[Lane]:
    """One lane for each callback of a node that ran or waited; those of a twin or an earlier start of it join in."""
    groups: dict[tuple[str, str], list[Callback]] = {}
    for callback in trace.callbacks:
        if callback.node == node and function in ("", callback.name):
            called_by = callback.source or f"every {callback.period / NANOSECONDS:g} s"
            groups.setdefault((callback.name, called_by), []).append(callback)
    if function and not groups:
        own = [each for each in trace.callbacks if each.source.split("/")[-1] not in PARAMETER_SERVICES]
        names = sorted({each.name for each in own if each.node == node})
        raise ValueError(f"{node} has no callback {function}. It has: {listed(names)}.")
    lanes = []
    for (name, called_by), callbacks in groups.items():
        runs = np.concatenate([callback.runs(trace.now) for callback in callbacks])
        shown = runs[(runs["ended"] >= window.begin) & (runs["ready"] <= window.end)]
        # messages and requests that no callback has taken yet
        arrived = [time for callback in callbacks for time in callback.arrivals or () if alive and time <= window.end]
        waits = [(time, trace.now) for time in arrived if trace.now - time >= SHORT]
        waiting = np.array(waits, np.int64).reshape(-1, 2)
        # a node has many services that no node calls
        if len(shown) or len(waiting) or function or callbacks[0].kind != "service":
            lanes.append(_callback_lane(name, called_by, callbacks, shown, waiting, window))
    return lanes


def _callback_lane(
    name: str, called_by: str, callbacks: list[Callback], runs: np.ndarray, waiting: np.ndarray, window: Window
) -> Lane:
    node, began = callbacks[0].node, runs["began"]
    lasted, waited = runs["ended"] - began, began - runs["ready"]
    within, begun = window.holds(began), began <= window.end
    long, late = (lasted >= SHORT) & begun, waited >= SHORT
    inside = np.minimum(runs["ended"], window.end) - np.maximum(began, window.begin)
    kept_waiting = waited[late & within]
    verb = "awaited" if callbacks[0].awaits else "lasted"
    text = f"{node}.{name} ({called_by}): {_calls(began[within])}"
    if long.any():
        longest, total = (number(float(each) / NANOSECONDS) for each in (lasted[long].max(), inside[long].sum()))
        text += f"; it {verb} {total} s" if len(runs) == 1 else f"; {verb} at most {longest} s, {total} s in all"
    elif begun.any():
        text += "; none took any robot time"
    if len(kept_waiting):
        text += f"; {len(kept_waiting)} had to wait, at most {number(float(kept_waiting.max()) / NANOSECONDS)} s"
    # a timer leaves out the ticks that were due before the one that waited began
    period = callbacks[0].period
    if missed := int(((waited[within] - 1) // period).clip(0).sum()) if period else 0:
        text += f"; {count(missed, 'tick')} {'was' if missed == 1 else 'were'} skipped"
    if going_on := sum(len(callback.open) for callback in callbacks):
        text += f"; {going_on} continues" if going_on == 1 else f"; {going_on} continue"
    if len(waiting):
        first = number(waiting[0, 0] / NANOSECONDS)
        text += f"; {len(waiting)} {'waits' if len(waiting) == 1 else 'wait'} now, the first since {first} s"
    bars = np.column_stack([began, runs["ended"]])[long].clip(window.begin, window.end)
    waits = np.column_stack([runs["ready"], began])[late]
    waits = np.concatenate([waits, waiting]).clip(window.begin, window.end)
    about = f"{node.rpartition('/')[2]} · {called_by}"
    return Lane(name, about, f"{text}.", began[within & (lasted < SHORT)], bars, waits, callbacks[0].awaits, True)


def _calls(began: np.ndarray) -> str:
    if len(began) < 2:
        return count(len(began), "call")
    gaps = np.diff(began) / 1e6
    mean, longest = number(float(gaps.mean()), 1), number(float(gaps.max()), 1)
    return f"{count(len(began), 'call')}, one every {mean} ms on average, the longest gap {longest} ms"
