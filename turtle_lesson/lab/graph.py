"""The ROS graph as ROS's own tools show it, as a diagram and in words: nodes, topics, services and their clients."""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field

from rclpy.node import Node, NodeNameNonExistentError
from rclpy.topic_endpoint_info import TopicEndpointInfo

from ..ros.idl.names import is_hidden
from . import drawing
from .words import count, listed, number

EVERYWHERE = frozenset({"/rosout", "/parameter_events"})
"""Topics that every node has: they say nothing about how a system is built."""

PARAMETER_SERVICES = {f"{verb}_parameters" for verb in ("describe", "get", "list", "set")} | {
    "get_parameter_types",
    "set_parameters_atomically",
    "get_type_description",
}
"""Services that every node offers below its own name; the last one since ROS 2 Iron."""

Ends = dict[str, list[str]]
"""Names of topics or services, with the types that are in use there."""


USES = {"publishes": "publisher", "hears": "subscriber", "offers": "service", "calls": "client"}
"""How a node uses topics and services, and what rclpy's questions about each use are called by."""


@dataclass
class NodeView:
    """One node, and what it uses, by the names in USES. `copies` nodes have this very name."""

    name: str
    uses: dict[str, Ends]
    copies: int = 1


def read_system(node: Node) -> list[NodeView]:
    """Return the visible nodes that `node` (an rclpy Node) sees in the graph, sorted by name."""
    copies = Counter(name for name in node_names(node) if not is_hidden(name))
    return [
        NodeView(name, {use: _visible(of_node(node, kind, name)) for use, kind in USES.items()}, amount)
        for name, amount in copies.items()
    ]


def full_name(name: str, namespace: str) -> str:
    """The full name of a node: "/turtlesim" in the namespace "/"."""
    return f"{namespace.rstrip('/')}/{name}"


def node_names(node: Node) -> list[str]:
    """The full names of all nodes that `node` sees in the graph, sorted; those of twins several times."""
    return sorted(full_name(*each) for each in node.get_node_names_and_namespaces())


def owner(end: TopicEndpointInfo) -> str:
    """The full name of the node that has a publisher or subscription."""
    return full_name(end.node_name, end.node_namespace)


def others(node: Node, ends: list[TopicEndpointInfo]) -> list[TopicEndpointInfo]:
    """The publishers or subscriptions of a topic without those of `node` itself."""
    me = full_name(node.get_name(), node.get_namespace())
    return [end for end in ends if owner(end) != me]


def of_node(node: Node, kind: str, name: str) -> list[tuple[str, list[str]]]:
    """The topics or services with their types that a node has a "publisher", "subscriber", "service" or "client" of.

    Nothing if it has just gone.
    """
    namespace, _, base = name.rpartition("/")
    try:
        return list(getattr(node, f"get_{kind}_names_and_types_by_node")(base, namespace or "/"))
    except NodeNameNonExistentError:
        return []


def servers(node: Node, service: str) -> list[tuple[str, list[str]]]:
    """The nodes that offer a service, with its types: of twins each one, since from outside they look the same.

    A list of all services would also name those that are only asked for.
    """
    offered = ((name, dict(of_node(node, "service", name))) for name in node_names(node))
    return [(name, types[service]) for name, types in offered if service in types]


def _visible(names_and_types: list[tuple[str, list[str]]]) -> Ends:
    return {
        name: sorted(types)
        for name, types in sorted(names_and_types)
        if name not in EVERYWHERE and not is_hidden(name) and name.split("/")[-1] not in PARAMETER_SERVICES
    }


def ends_of(nodes: list[NodeView], *uses: str) -> Ends:
    """What these nodes use in these ways, sorted, with all types in use there."""
    found: dict[str, set[str]] = {}
    for name, types in (end for node in nodes for use in uses for end in node.uses[use].items()):
        found.setdefault(name, set()).update(types)
    return {name: sorted(types) for name, types in sorted(found.items())}


@dataclass(eq=False, repr=False)
class GraphPicture:
    """A diagram, and the same in words.

    `text` is one paragraph, `svg` the drawing, `mermaid` the diagram in Mermaid's language, for a README or a page of
    your own ("" when there is nothing to show).
    """

    text: str
    mermaid: str = ""
    svg: str = ""

    def __repr__(self) -> str:
        return self.text

    def _repr_mimebundle_(self, **options: object) -> dict[str, str]:
        """What Jupyter shows: the drawing with its alternative text, with or without a kernel."""
        if not self.svg:
            return {"text/plain": self.text}
        shown = drawing.image(self.svg, self.text)
        return {"text/html": shown, "text/vnd.mermaid": self.mermaid, "text/plain": self.text}


def plot_graph(node: Node) -> GraphPicture:
    """Return the ROS graph that `node` (an rclpy Node) sees, as a diagram and in words.

    Left out, as by ROS's own tools: hidden names, and the topics and services that every node has.
    """
    nodes = read_system(node)
    if not nodes:
        return GraphPicture("No node is running. Start some: ros2 run turtlesim turtlesim_node, or lesson.launch(…).")
    topics, services = ends_of(nodes, "publishes", "hears"), ends_of(nodes, "offers", "calls")
    amount = sum(node.copies for node in nodes)
    summary = listed([count(amount, "node"), count(len(topics), "topic"), count(len(services), "service")])
    sentences = [f"The ROS graph has {summary}.", *map(_node_sentence, nodes)]
    if types := [f"{name} {listed(kinds)}" for name, kinds in (topics | services).items()]:
        sentences.append(f"Types: {', '.join(types)}.")
    text, title = " ".join(sentences), f"ROS graph: {summary}"
    columns, arrows = _boxes(nodes)
    mermaid = flowchart(columns, arrows, title, text)
    return GraphPicture(text, mermaid, draw_graph(columns, arrows, title, text))


def _node_sentence(node: NodeView) -> str:
    parts = [f"{use} {listed(list(ends))}" for use, ends in node.uses.items() if ends]
    name = node.name if node.copies == 1 else f"{node.name} ({node.copies} nodes of this name)"
    return f"{name} {'; '.join(parts) or 'uses no topic and no service'}."


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
    """Names, and smaller below them what type they are of; `middle` is the height of its middle in the drawing.

    Nodes stand in the middle, services to their left, topics to their right; arrows point where data goes.
    """

    id: str
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
        sizes = [drawing.text_width(each, NAME) for each in self.names]
        sizes += [drawing.text_width(each, TYPE) for each in self.types]
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


def draw_graph(columns: dict[str, list[Box]], arrows: list[Arrow], title: str, description: str) -> str:
    """Return the drawing as SVG; its title and description are for readers who cannot see it."""
    _arrange(columns)
    widths = {name: max(box.width for box in boxes) for name, boxes in columns.items()}
    lefts: dict[str, float] = {}
    left = 4.0
    for name in columns:
        lefts[name] = left
        left += widths[name] + LANE
    everything = [box for boxes in columns.values() for box in boxes]
    parts = [drawing.text(lefts[name] + widths[name] / 2, 18, name) for name in columns]
    parts += [_draw_arrow(arrow, lefts, widths) for arrow in arrows]
    for name, boxes in columns.items():
        parts += [_draw_box(box, lefts[name], widths[name], name) for box in boxes]
    height = max(box.middle + box.height / 2 for box in everything) + 6
    return drawing.document(round(left - LANE + 4), round(height), title, description, parts)


def _boxes(nodes: list[NodeView]) -> tuple[dict[str, list[Box]], list[Arrow]]:
    """The columns that have boxes, and all arrows. The services of a node that no node calls share one box."""
    called = {service for node in nodes for service in node.uses["calls"]}
    topics, services = (
        {name: Box(f"{letter}{at}", [name], types) for at, (name, types) in enumerate(ends_of(nodes, *uses).items())}
        for letter, uses in (("t", ("publishes", "hears")), ("s", ("offers", "calls")))
    )
    services = {name: box for name, box in services.items() if name in called}
    columns: dict[str, list[Box]] = {"services": list(services.values()), "nodes": [], "topics": list(topics.values())}
    arrows: list[Arrow] = []
    for at, view in enumerate(nodes):
        box = Box(f"n{at}", [view.name], [f"{view.copies} nodes of this name"] if view.copies > 1 else [])
        columns["nodes"].append(box)
        for use, used in {"publishes": topics, "hears": topics, "calls": services, "offers": services}.items():
            inward, dashed = use in ("hears", "offers"), used is services
            arrows += [Arrow(box, used[name], inward, dashed) for name in view.uses[use] if name in used]
        offers = view.uses["offers"]
        if waiting := [name for name in offers if name not in called]:
            shared = Box(f"w{at}", waiting, offers[waiting[0]] if len(waiting) == 1 else [])
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
            wanted = {box: box.middle for box in boxes}
            for box in boxes:
                if box.arrows:
                    wanted[box] = math.fsum(arrow.other(box).middle for arrow in box.arrows) / len(box.arrows)
            boxes.sort(key=wanted.__getitem__)
            _stack(boxes, [wanted[box] for box in boxes])
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
    off = math.fsum(box.middle - middle for box, middle in zip(boxes, wanted, strict=True)) / len(boxes)
    for box in boxes:
        box.middle -= off


def _draw_box(box: Box, left: float, width: float, column: str) -> str:
    fill, edge, ink = LOOKS[column]
    top = box.middle - box.height / 2
    round_ends = min(box.height / 2, 14.0) if column == "nodes" else 3.0
    frame = drawing.sizes(x=left, y=top, width=width, height=box.height)
    parts = [f'<rect {frame} rx="{round_ends:g}" fill="{fill}" stroke="{edge}" stroke-width="1.3"/>']
    if column == "services":
        for x in (left + 4, left + width - 4):
            line = f"M{number(x, 1)},{number(top, 1)}v{number(box.height, 1)}"
            parts.append(f'<path d="{line}" stroke="{edge}" stroke-width="1"/>')
    lines = [(each, NAME) for each in box.names] + [(each, TYPE) for each in box.types]
    for row, (words, size) in enumerate(lines):
        parts.append(drawing.text(left + width / 2, top + PADDING + LINE * row + 10, words, size, fill=ink))
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
        f'<path d="M{x},{y}C{middle},{y} {middle},{stop_y} {stop_x},{stop_y}" fill="none" stroke="{drawing.INK}" '
        f'stroke-width="1.4"{dash}/><path d="M{tip},{stop_y}L{stop_x},{up}V{down}Z" fill="{drawing.INK}"/>'
    )


def _port(box: Box, arrow: Arrow) -> float:
    """The height at which an arrow touches a box: a side's arrows are spread over it, in the order of what they lead to."""
    beside = [each for each in box.arrows if each.dashed == arrow.dashed]
    beside.sort(key=lambda each: (each.other(box).middle, each.inward))
    return box.middle + box.height * 0.8 * ((beside.index(arrow) + 0.5) / len(beside) - 0.5)


THEME = '"theme": "base", "themeVariables": {"lineColor": "#767b82", "signalColor": "#767b82", "signalTextColor": "#767b82"}'
"""Lines and their texts that are seen on a light and on a dark page, also when Mermaid's theme is changed later on."""

SETTINGS = f'%%{{init: {{{THEME}, "flowchart": {{"nodeSpacing": 22, "rankSpacing": 32, "padding": 9}}}}}}%%'
"""Closer together than Mermaid's own 50 and 50, so that four nodes are legible in a narrow window."""

COLOURS = (
    "classDef rosnode fill:#cfe6f5,stroke:#0072B2,stroke-width:1.5px,color:#10222e,font-size:14px",
    "classDef rostopic fill:#fcfcfa,stroke:#8a8f96,color:#24292f,font-size:14px",
    "classDef rosservice fill:#fbe6bd,stroke:#a86f00,color:#2e2410,font-size:14px",
)
"""Fill, edge and text of each kind, all three given, so that a dark page shows them as a light one does."""


def flowchart(columns: dict[str, list[Box]], arrows: list[Arrow], title: str, description: str) -> str:
    """Return the same in Mermaid's language (https://mermaid.js.org/syntax/flowchart.html).

    Names are quoted, and everything but plain letters becomes a character code, so that no name is taken for one of
    Mermaid's words.
    """

    def shape(box: Box, before: str, after: str, kind: str) -> str:
        label = [*map(_escaped, box.names), *(f"<small>{_escaped(each)}</small>" for each in box.types)]
        return f'{box.id}{before}"{"<br/>".join(label)}"{after}:::{kind}'

    def line(arrow: Arrow) -> str:
        begin, end = (arrow.used, arrow.node) if arrow.inward else (arrow.node, arrow.used)
        return f"{begin.id} {'-.->' if arrow.dashed else '-->'} {end.id}"

    lines = [SETTINGS, "flowchart TD", f"accTitle: {plain_line(title)}", f"accDescr: {plain_line(description)}"]
    lines += [shape(box, "([", "])", "rosnode") for box in columns["nodes"]]
    lines += [shape(box, "[", "]", "rostopic") for box in columns.get("topics", [])]
    lines += [line(arrow) for arrow in arrows if not arrow.dashed]
    services = {box.id: shape(box, "[[", "]]", "rosservice") for box in columns.get("services", [])}
    lines += [services.pop(name) for name in list(services) if name.startswith("s")]
    for arrow in arrows:
        if arrow.dashed:  # the box of services that no node calls comes with its one arrow
            lines += [services[arrow.used.id]] if arrow.used.id in services else []
            lines.append(line(arrow))
    return "\n".join([*lines, *COLOURS, ""])


def _escaped(text: str) -> str:
    """Text for a quoted label: letters, digits, slashes, single underscores, spaces; codes for the rest."""
    return re.sub(r"[^A-Za-z0-9/ _]|_(?=_)", lambda match: f"#{ord(match.group())};", text)


def plain_line(text: str) -> str:
    """Text for a line of its own, in which `#` and `;` would have a meaning."""
    return re.sub(r"[#;{}<>\n]+", ",", text)
