"""The ROS graph as a Mermaid flowchart: boxes with round ends are nodes, boxes topics, boxes with double
sides services.

Mermaid's language: https://mermaid.js.org/syntax/flowchart.html. Names stand in quotes, and everything in
them that is no plain letter as a character code, so that no name can be taken for Mermaid's own words.
"""

from __future__ import annotations

import re

from .system import Ends, NodeView, services_of, topics_of

THEME = '"theme": "base", "themeVariables": {"lineColor": "#767b82", "signalColor": "#767b82", "signalTextColor": "#767b82"}'
"""Lines and their texts that are seen on a light and on a dark page, also when the theme is changed later on."""

SETTINGS = f'%%{{init: {{{THEME}, "flowchart": {{"nodeSpacing": 22, "rankSpacing": 32, "padding": 9}}}}}}%%'
"""Closer together than Mermaid's own 50 and 50, so that four nodes are legible in a narrow window."""

COLOURS = (
    "classDef rosnode fill:#cfe6f5,stroke:#0072B2,stroke-width:1.5px,color:#10222e,font-size:14px",
    "classDef rostopic fill:#fcfcfa,stroke:#8a8f96,color:#24292f,font-size:14px",
    "classDef rosservice fill:#fbe6bd,stroke:#a86f00,color:#2e2410,font-size:14px",
)
"""Fill, edge and text of each kind, all three given, so that a dark page shows them as a light one does."""


def flowchart(nodes: list[NodeView], title: str, description: str) -> str:
    """Return the Mermaid text for these nodes; `title` and `description` are for readers who cannot see it."""
    lines = [SETTINGS, "flowchart TD", f"accTitle: {_plain(title)}", f"accDescr: {_plain(description)}"]
    lines += [f'n{number}(["{_label(_counted(node))}"]):::rosnode' for number, node in enumerate(nodes)]
    topics = topics_of(nodes)
    lines += [f'{_id("t", topics, topic)}["{_label(topic, *types)}"]:::rostopic' for topic, types in topics.items()]
    for number, node in enumerate(nodes):
        lines += [f"n{number} --> {_id('t', topics, topic)}" for topic in node.publishes]
        lines += [f"{_id('t', topics, topic)} --> n{number}" for topic in node.hears]
    lines += _services(nodes)
    return "\n".join([*lines, *COLOURS, ""])


def _services(nodes: list[NodeView]) -> list[str]:
    """Services that somebody calls have a box each; those of a node that nobody calls share one."""
    lines: list[str] = []
    services = services_of(nodes)
    called = {service for node in nodes for service in node.calls}
    for service in sorted(called):
        lines.append(f'{_id("s", services, service)}[["{_label(service, *services[service])}"]]:::rosservice')
    for number, node in enumerate(nodes):
        lines += [f"n{number} -.-> {_id('s', services, service)}" for service in node.calls]
        lines += [f"{_id('s', services, service)} -.-> n{number}" for service in node.offers if service in called]
        if waiting := [service for service in node.offers if service not in called]:
            lines.append(f'w{number}[["{_waiting_label(node, waiting)}"]]:::rosservice')
            lines.append(f"w{number} -.-> n{number}")
    return lines


def _waiting_label(node: NodeView, waiting: list[str]) -> str:
    if len(waiting) == 1:
        return _label(waiting[0], *node.offers[waiting[0]])
    return "<br/>".join(_escaped(service) for service in waiting)


def _counted(node: NodeView) -> str:
    return node.name if node.copies == 1 else f"{node.name} ({node.copies} nodes of this name)"


def _label(name: str, *types: str) -> str:
    small = [f"<small>{_escaped(kind)}</small>" for kind in types]
    return "<br/>".join([_escaped(name), *small])


def _id(letter: str, names: Ends, name: str) -> str:
    return f"{letter}{list(names).index(name)}"


def _escaped(text: str) -> str:
    """Text for a quoted label: letters, digits, slashes, single underscores, spaces; codes for the rest."""
    return re.sub(r"[^A-Za-z0-9/ _]|_(?=_)", lambda match: f"#{ord(match.group())};", text)


def _plain(text: str) -> str:
    """Text for a line of its own, in which `#` and `;` would have a meaning."""
    return re.sub(r"[#;{}<>\n]+", ",", text)
