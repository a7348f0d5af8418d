"""The panel with the lights: which nodes and services of the lesson's system are there."""

from __future__ import annotations

from collections import Counter
from typing import Any

import traitlets

from ..system import is_hidden
from ..words import listed
from .live_widget import LiveWidget
from .pace import Pace

NODES = ("/turtlesim", "/navigator", "/status_monitor", "/obstacle_detector")
SERVICES = ("/navigate_to",)


class LightsPanel(LiveWidget):
    """Shows the nodes and services that the system needs, as the graph has them."""

    lights = traitlets.List(traitlets.Dict()).tag(sync=True)
    """"name", "kind" ("node" or "service"), "state" ("present", "missing", "several", "extra") and "words" for each."""

    def __init__(self, *arguments: Any, **traits: Any) -> None:
        self._lights_pace = Pace(2)
        super().__init__(*arguments, **traits)

    def tick(self) -> None:
        """Look at the graph, now and then."""
        super().tick()
        if self._lights_pace.due():
            self.lights = look(self.station.node)


def look(node: Any) -> list[dict[str, Any]]:
    """The lights, from the graph that `node` (an rclpy Node) sees."""
    places = sorted(node.get_node_names_and_namespaces())
    found = Counter(name for name in map(_full_name, places) if not is_hidden(name))
    nodes = [_light(name, "node", found[name]) for name in NODES]
    extra = [{**_light(name, "node", found[name]), "state": "extra"} for name in sorted(found) if name not in NODES]
    servers = {service: _servers(node, service, places) for service in SERVICES}
    services = [_light(name, "service", len(who), listed(who)) for name, who in servers.items()]
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


def _servers(node: Any, service: str, places: list[tuple[str, str]]) -> list[str]:
    """Which nodes offer a service. A list of all services would also name those that are only asked for."""
    from rclpy.node import NodeNameNonExistentError

    offering = []
    for name, namespace in places:
        try:
            offers = node.get_service_names_and_types_by_node(name, namespace)
        except NodeNameNonExistentError:  # gone since the list was made
            continue
        if any(offered == service for offered, _ in offers):
            offering.append(_full_name((name, namespace)))
    return offering


def _full_name(place: tuple[str, str]) -> str:
    name, namespace = place
    return f"{namespace.rstrip('/')}/{name}"
