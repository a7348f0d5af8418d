"""The ROS graph as a diagram: publishers, subscriptions, services and their clients."""

from __future__ import annotations

from typing import Any

from .graph_drawing import draw_graph
from .mermaid import flowchart
from .svg import image
from .system import Ends, NodeView, read_system, services_of, topics_of
from .words import count, listed


class GraphPicture:
    """A diagram, and the same in words.

    `text` is one paragraph, `svg` the drawing, `mermaid` the diagram in Mermaid's language, for a README or a page of
    your own ("" when there is nothing to show).
    """

    def __init__(self, text: str, mermaid: str = "", svg: str = "") -> None:
        self.text = text
        self.mermaid = mermaid
        self.svg = svg

    def __repr__(self) -> str:
        return self.text

    def _repr_mimebundle_(self, include: Any = None, exclude: Any = None) -> dict[str, str]:
        """What Jupyter shows: the drawing with its alternative text, with or without a kernel."""
        if not self.svg:
            return {"text/plain": self.text}
        shown = image(self.svg, self.text)
        return {"text/html": shown, "text/vnd.mermaid": self.mermaid, "text/plain": self.text}


def plot_graph(node: Any) -> GraphPicture:
    """Return the ROS graph that `node` (an rclpy Node) sees, as a diagram and in words.

    Left out, as by ROS's own tools: hidden names, and the topics and services that every node has.
    """
    nodes = read_system(node)
    if not nodes:
        return GraphPicture("No node is running. Start some: ros2 run turtlesim turtlesim_node, or lesson.launch(…).")
    text = describe(nodes)
    title = f"ROS graph: {_summary(nodes)}"
    return GraphPicture(text, flowchart(nodes, title, text), draw_graph(nodes, title, text))


def describe(nodes: list[NodeView]) -> str:
    """Return the graph in words: the numbers, then a sentence for each node."""
    types = topics_of(nodes) | services_of(nodes)
    sentences = [f"The ROS graph has {_summary(nodes)}."]
    sentences += [_node_sentence(node) for node in nodes]
    sentences.append(_types_sentence(types))
    return " ".join(filter(None, sentences))


def _summary(nodes: list[NodeView]) -> str:
    amount = sum(node.copies for node in nodes)
    topics, services = topics_of(nodes), services_of(nodes)
    return listed([count(amount, "node"), count(len(topics), "topic"), count(len(services), "service")])


def _node_sentence(node: NodeView) -> str:
    verbs = {"publishes": node.publishes, "hears": node.hears, "offers": node.offers, "calls": node.calls}
    parts = [f"{verb} {listed(list(ends))}" for verb, ends in verbs.items() if ends]
    name = node.name if node.copies == 1 else f"{node.name} ({node.copies} nodes of this name)"
    return f"{name} {'; '.join(parts)}." if parts else f"{name} uses no topic and no service."


def _types_sentence(types: Ends) -> str:
    if not types:
        return ""
    return f"Types: {', '.join(f'{name} {listed(kinds)}' for name, kinds in types.items())}."
