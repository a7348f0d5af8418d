"""The timeline: what happened when, a row a topic (a mark a message) and a row a callback (a bar while it lasts)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from . import style
from .lanes import Lane, Window, lanes_of, window_of
from .picture import Picture
from .recording import NANOSECONDS
from .words import count

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

WIDTH, LEFT, RIGHT = 6.4, 1.95, 0.25
"""The card and what is left and right of the axes, in inches."""

LANE, TOP, BOTTOM = 0.40, 0.70, 0.78

MOST = 24
"""A picture with more lanes than that cannot be read."""

PALE_ORANGE = style.ORANGE + "40"


def plot_timeline(trace: Any, node: Any, *rows: str, since: float | None = None, until: float | None = None) -> Picture:
    """Return what happened from `since` to `until` (s since the lesson's start), in a lane for each topic and callback.

    Args:
        trace: the world's trace.
        node: an rclpy Node that sees the graph.
        rows: names of topics ("/robot/status"), of nodes ("/navigator": all its callbacks) or of single callbacks
            ("/navigator.on_pose"); without any, the callbacks of all nodes.
        since, until: what to show; from the start until now unless told.

    Raises TypeError or ValueError for what is neither, with the names that are perhaps meant.
    """
    window = window_of(trace.now, since, until)
    topics = [name for name, _ in node.get_topic_names_and_types()]
    alive = [f"{namespace.rstrip('/')}/{name}" for name, namespace in node.get_node_names_and_namespaces()]
    lanes = lanes_of(trace, rows, topics, alive, window)
    if not lanes:
        return Picture("No callback has run yet. Start a node, and let robot time pass: lesson.run(1.0).")
    if window.begin == window.end:
        return Picture("No robot time has passed yet, so a timeline would have no width. Try lesson.run(1.0).")
    text = f"Timeline from {window.seconds}. {' '.join(lane.text for lane in lanes)}"
    if len(lanes) > MOST:
        return Picture(f"{text} These are {len(lanes)} rows, too many for a picture: name some, at most {MOST}.")
    with style.applied():
        return Picture(text, _draw(lanes, window))


def _draw(lanes: list[Lane], window: Window) -> Figure:
    height = TOP + LANE * len(lanes) + BOTTOM
    figure = style.card(WIDTH, height)
    callbacks = sum(lane.callback for lane in lanes)
    parts = [count(len(lanes) - callbacks, "topic"), count(callbacks, "callback")]
    shown = [part for part in parts if not part.startswith("no ")]
    style.heading(figure, "Timeline", f"{window.seconds}  ·  {', '.join(shown)}")
    axes = style.axes_at(figure, LEFT, BOTTOM, WIDTH - LEFT - RIGHT, LANE * len(lanes))
    axes.set_ylim(len(lanes) - 0.5, -0.5)
    axes.set_yticks([])
    axes.spines["left"].set_visible(False)
    span = (window.end - window.begin) / NANOSECONDS
    axes.set_xlim(window.begin / NANOSECONDS - 0.008 * span, window.end / NANOSECONDS + 0.008 * span)
    axes.set_xlabel("robot time in seconds")
    for place, lane in enumerate(lanes):
        _draw_lane(axes, place, lane)
        _label(figure, place, lane, height)
    _legend(figure, lanes)
    return figure


def _draw_lane(axes: Axes, place: int, lane: Lane) -> None:
    axes.axhline(place, color=style.LINE, linewidth=0.8, zorder=0.5)
    for begin, end in lane.waits / NANOSECONDS:  # beneath the bars, for it may be another run that lasts meanwhile
        line: dict[str, Any] = {"color": style.VERMILLION, "linewidth": 1.6, "linestyle": (0, (1.2, 1.2)), "zorder": 2}
        axes.plot([begin, end], [place + 0.37] * 2, **line)
        axes.plot([begin], [place + 0.37], color=style.VERMILLION, marker="o", markersize=3.0, zorder=2)
    if len(lane.bars):
        _draw_bars(axes, place, lane)
    if len(lane.marks):
        colour = style.GREEN if lane.callback else style.BLUE
        marks = lane.marks / NANOSECONDS
        axes.vlines(marks, place - 0.27, place + 0.27, color=colour, linewidth=_mark_width(axes, marks), zorder=3)


def _draw_bars(axes: Axes, place: int, lane: Lane) -> None:
    spans = [(begin, end - begin) for begin, end in lane.bars / NANOSECONDS]
    look: dict[str, Any] = {"facecolors": style.GREEN, "edgecolors": style.DARK_GREEN}
    if lane.awaits:
        look = {"facecolors": PALE_ORANGE, "edgecolors": style.DARK_ORANGE, "hatch": "////"}
    axes.broken_barh(spans, (place - 0.27, 0.54), linewidth=0.8, zorder=2.5, **look)


def _mark_width(axes: Axes, marks: np.ndarray) -> float:
    """Points: as wide as the gaps between the marks allow, so that single ones stay apart for as long as possible."""
    if len(marks) < 2:
        return 1.5
    low, high = axes.get_xlim()
    gap = float(np.median(np.diff(marks))) / (high - low) * (WIDTH - LEFT - RIGHT) * 72
    return min(1.5, max(0.3, 0.5 * gap))


def _label(figure: Figure, place: int, lane: Lane, height: float) -> None:
    middle = 1 - (TOP + LANE * (place + 0.5)) / height
    left, line = 0.2 / WIDTH, 0.075 / height
    figure.text(left, middle + line, _cut(lane.name, 26), fontsize=8.8, va="center")
    figure.text(left, middle - line, _cut(lane.about, 30), fontsize=7.4, color=style.INK, va="center")


def _cut(text: str, most: int) -> str:
    return text if len(text) <= most else f"{text[: most - 1]}…"


def _legend(figure: Figure, lanes: list[Lane]) -> None:
    """What the signs mean, of those that are there, beneath the axes."""
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    tick: dict[str, Any] = {"linestyle": "none", "marker": "|", "markersize": 9, "markeredgewidth": 1.5}
    wait: dict[str, Any] = {"marker": "o", "markersize": 3, "linestyle": (0, (1.2, 1.2)), "linewidth": 1.6}
    topics = [lane for lane in lanes if not lane.callback]
    calls = [lane for lane in lanes if lane.callback]
    signs: list[Any] = []
    if any(len(lane.marks) for lane in topics):
        signs.append(Line2D([], [], color=style.BLUE, label="a message", **tick))
    if any(len(lane.marks) for lane in calls):
        signs.append(Line2D([], [], color=style.GREEN, label="a short call", **tick))
    if any(len(lane.bars) for lane in calls if not lane.awaits):
        signs.append(Patch(facecolor=style.GREEN, edgecolor=style.DARK_GREEN, label="holds its thread"))
    if any(len(lane.bars) for lane in calls if lane.awaits):
        signs.append(
            Patch(facecolor=PALE_ORANGE, edgecolor=style.DARK_ORANGE, hatch="////", label="awaits, thread free")
        )
    if any(len(lane.waits) for lane in lanes):
        signs.append(Line2D([], [], color=style.VERMILLION, label="ready, had to wait", **wait))
    if signs:
        look: dict[str, Any] = {"frameon": False, "fontsize": 8.0, "handlelength": 1.6, "columnspacing": 1.3}
        figure.legend(handles=signs, loc="lower left", bbox_to_anchor=(0.02, 0.0), ncols=len(signs), **look)
