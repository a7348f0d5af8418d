"""The ROS graph as a drawing: nodes in the middle, services to their left, topics to their right, arrows where data goes."""

from __future__ import annotations

import math
import statistics
from collections.abc import Sequence
from dataclasses import dataclass, field

from . import style, svg
from .system import NodeView, services_of, topics_of
from .words import number

NAME, TYPE = 12.5, 10.5
"""Sizes of the texts in a box, in pixels."""
LINE, PADDING, GAP, LANE, TOP = 16.0, 9.0, 16.0, 76.0, 34.0
"""Pixels: a line of text, around the text in a box, between two boxes, between two columns, and above all boxes."""

LOOKS = {
    "services": ("#fbe6bd", "#a86f00", "#2e2410"),
    "nodes": ("#cfe6f5", "#0072b2", "#10222e"),
    "topics": ("#f4f4f0", "#8a8f96", "#24292f"),
}
"""Fill, edge and text of each column's boxes, all three given: they are the same on a light and on a dark page."""


@dataclass(eq=False)
class Box:
    """Names, and smaller below them what type they are of; `middle` is the height of its middle in the drawing."""

    names: Sequence[str]
    types: Sequence[str] = ()
    arrows: list[Arrow] = field(default_factory=list)
    middle: float = 0.0

    @property
    def height(self) -> float:
        """Pixels."""
        return LINE * (len(self.names) + len(self.types)) + 2 * PADDING - 4

    @property
    def width(self) -> float:
        """Pixels that its texts need."""
        sizes = [svg.text_width(each, NAME) for each in self.names] + [
            svg.text_width(each, TYPE) for each in self.types
        ]
        return max(sizes) + 2 * PADDING


@dataclass(eq=False)
class Arrow:
    """Between a node and what it uses, a service if it is `dashed`, or else a topic; `inward` if it ends at the node."""

    node: Box
    used: Box
    inward: bool
    dashed: bool = False

    def other(self, box: Box) -> Box:
        """The box at its other end."""
        return self.node if box is self.used else self.used


def draw_graph(nodes: list[NodeView], title: str, description: str) -> str:
    """Return the drawing of these nodes as SVG; its title and description are for readers who cannot see it."""
    columns, arrows = _boxes(nodes)
    _arrange(columns)
    widths = {name: max(box.width for box in boxes) for name, boxes in columns.items()}
    lefts: dict[str, float] = {}
    left = 4.0
    for name in columns:
        lefts[name] = left
        left += widths[name] + LANE
    everything = [box for boxes in columns.values() for box in boxes]
    parts = [svg.text(lefts[name] + widths[name] / 2, 18, name) for name in columns]
    parts += [_draw_arrow(arrow, lefts, widths) for arrow in arrows]
    for name, boxes in columns.items():
        parts += [_draw_box(box, lefts[name], widths[name], name) for box in boxes]
    height = max(box.middle + box.height / 2 for box in everything) + 6
    return svg.document(round(left - LANE + 4), round(height), title, description, parts)


# -- what is drawn -----------------------------------------------------------------------------------------------------


def _boxes(nodes: list[NodeView]) -> tuple[dict[str, list[Box]], list[Arrow]]:
    """The columns that have boxes, and all arrows. Services of a node that nobody calls share one box."""
    topics = {name: Box([name], types) for name, types in topics_of(nodes).items()}
    called = {service for node in nodes for service in node.calls}
    services = {name: Box([name], types) for name, types in services_of(nodes).items() if name in called}
    columns: dict[str, list[Box]] = {"services": list(services.values()), "nodes": [], "topics": list(topics.values())}
    arrows: list[Arrow] = []
    for view in nodes:
        box = Box([view.name], [f"{view.copies} nodes of this name"] if view.copies > 1 else [])
        columns["nodes"].append(box)
        arrows += [Arrow(box, topics[name], inward=False) for name in view.publishes]
        arrows += [Arrow(box, topics[name], inward=True) for name in view.hears]
        arrows += [Arrow(box, services[name], inward=False, dashed=True) for name in view.calls]
        arrows += [Arrow(box, services[name], inward=True, dashed=True) for name in view.offers if name in called]
        if waiting := [name for name in view.offers if name not in called]:
            shared = Box(waiting, view.offers[waiting[0]] if len(waiting) == 1 else [])
            columns["services"].append(shared)
            arrows.append(Arrow(box, shared, inward=True, dashed=True))
    for arrow in arrows:
        arrow.node.arrows.append(arrow)
        arrow.used.arrows.append(arrow)
    return {name: boxes for name, boxes in columns.items() if boxes}, arrows


def _arrange(columns: dict[str, list[Box]]) -> None:
    """Give each box its height in its column: near what it is connected with, so that few arrows cross."""
    for boxes in columns.values():
        _stack(boxes, [0.0] * len(boxes))
    for _ in range(8):
        for boxes in columns.values():
            wanted = [
                statistics.fmean(arrow.other(box).middle for arrow in box.arrows) if box.arrows else box.middle
                for box in boxes
            ]
            order = sorted(range(len(boxes)), key=lambda at: wanted[at])
            wanted = [wanted[at] for at in order]
            boxes[:] = [boxes[at] for at in order]
            _stack(boxes, wanted)
    bottom, up = TOP - GAP, -math.inf  # what is connected with nothing else may lie far off: no empty band is left
    everything = [box for boxes in columns.values() for box in boxes]
    for box in sorted(everything, key=lambda box: box.middle - box.height / 2):
        up = max(up, box.middle - box.height / 2 - bottom - GAP)
        box.middle -= up
        bottom = max(bottom, box.middle + box.height / 2)


def _stack(boxes: list[Box], wanted: list[float]) -> None:
    """Put boxes below one another, none upon another, on average where they are wanted."""
    bottom = -math.inf
    for box, middle in zip(boxes, wanted, strict=True):
        box.middle = max(middle, bottom + GAP + box.height / 2)
        bottom = box.middle + box.height / 2
    off = statistics.fmean(box.middle - middle for box, middle in zip(boxes, wanted, strict=True))
    for box in boxes:
        box.middle -= off


# -- how it is drawn -----------------------------------------------------------------------------------------------------


def _draw_box(box: Box, left: float, width: float, column: str) -> str:
    fill, edge, ink = LOOKS[column]
    top = box.middle - box.height / 2
    round_ends = min(box.height / 2, 14.0) if column == "nodes" else 3.0
    frame = f'x="{number(left, 1)}" y="{number(top, 1)}" width="{number(width, 1)}" height="{number(box.height, 1)}"'
    parts = [f'<rect {frame} rx="{round_ends:g}" fill="{fill}" stroke="{edge}" stroke-width="1.3"/>']
    if column == "services":
        for x in (left + 4, left + width - 4):
            line = f"M{number(x, 1)},{number(top, 1)}v{number(box.height, 1)}"
            parts.append(f'<path d="{line}" stroke="{edge}" stroke-width="1"/>')
    lines = [(each, NAME) for each in box.names] + [(each, TYPE) for each in box.types]
    for row, (words, size) in enumerate(lines):
        parts.append(svg.text(left + width / 2, top + PADDING + LINE * row + 10, words, size, fill=ink))
    return "".join(parts)


def _draw_arrow(arrow: Arrow, lefts: dict[str, float], widths: dict[str, float]) -> str:
    """A curve between the sides of two boxes that face each other, with a head at the end to which the data goes."""
    if arrow.dashed:
        near, far = lefts["nodes"], lefts["services"] + widths["services"]
    else:
        near, far = lefts["nodes"] + widths["nodes"], lefts["topics"]
    begin, end = (near, _port(arrow.node, arrow)), (far, _port(arrow.used, arrow))
    if arrow.inward:
        begin, end = end, begin
    side = 1 if end[0] > begin[0] else -1
    stop = end[0] - 7 * side
    bend = begin[0] + (stop - begin[0]) / 2
    x, y, stop_x, stop_y, middle = (number(each, 1) for each in (*begin, stop, end[1], bend))
    dash = ' stroke-dasharray="5 4"' if arrow.dashed else ""
    tip, up, down = number(end[0], 1), number(end[1] - 4, 1), number(end[1] + 4, 1)
    return (
        f'<path d="M{x},{y}C{middle},{y} {middle},{stop_y} {stop_x},{stop_y}" fill="none" stroke="{style.INK}" '
        f'stroke-width="1.4"{dash}/><path d="M{tip},{stop_y}L{stop_x},{up}V{down}Z" fill="{style.INK}"/>'
    )


def _port(box: Box, arrow: Arrow) -> float:
    """Where an arrow touches a box: the arrows of one side are spread over it, in the order of what they lead to."""
    beside = [each for each in box.arrows if each.dashed == arrow.dashed]
    beside.sort(key=lambda each: (each.other(box).middle, each.inward))
    return box.middle + box.height * 0.8 * ((beside.index(arrow) + 0.5) / len(beside) - 0.5)
