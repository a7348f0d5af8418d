"""All widgets of one system, each made when it is first asked for; asked for again, it is the same one in another place.

So a cell that is run twice leaves nothing behind, and two views of a widget are always in step.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable
from typing import TYPE_CHECKING, Any, TypeVar

if TYPE_CHECKING:
    from .lab.widgets.dashboard import Dashboard
    from .lab.widgets.form import Form
    from .lab.widgets.lab_view import LabView
    from .lab.widgets.live_plot import LivePlot
    from .lab.widgets.parameters import ParametersPanel
    from .lab.widgets.scene import Scene
    from .lab.widgets.station import Station
    from .lab.widgets.teleop import Teleop

Widget = TypeVar("Widget")


class Shelf:
    """What shows a running system and acts on it. A subclass says where: `_make_station()`."""

    _widgets: dict[Hashable, Any]

    def _make_station(self) -> Station:
        raise NotImplementedError

    def _widget(self, key: Hashable, make: Callable[[Station], Widget]) -> Widget:
        """The widget of this key; made now if there is none yet."""
        widgets = self.__dict__.setdefault("_widgets", {})
        if key not in widgets:
            widgets[key] = make(self._make_station())
        return widgets[key]

    def goal_pad(self) -> LabView:
        """A map that is alive: click on it, and the turtle goes there; drag to say how it shall face."""
        from .lab.widgets.lab_view import GOAL_PAD, LabView

        return self._widget("goal pad", lambda station: LabView(station, GOAL_PAD))

    def dashboard(self) -> Dashboard:
        """Everything at once: map, clock, status, scan, rates, nodes, services and log."""
        from .lab.widgets.dashboard import Dashboard

        return self._widget("dashboard", Dashboard)

    def teleop(self, topic: str = "/turtle1/cmd_vel") -> Teleop:
        """Drive by hand, with keys or a stick: publishes geometry_msgs/msg/Twist on a topic."""
        from .lab.widgets.teleop import Teleop

        return self._widget(("teleop", topic), lambda station: Teleop(station, topic))

    def form(self, name: str) -> Form:
        """A form for the messages of a topic, or for the requests of a service: "/turtle1/cmd_vel", "/navigate_to"."""
        from .lab.widgets.form import Form

        return self._widget(("form", name), lambda station: Form(station, name))

    def live_plot(self, *fields: str, seconds: float = 30.0) -> LivePlot:
        """Curves that go on: a topic and a field each, such as "/robot/status/battery" or "/turtle1/pose/x"."""
        from .lab.widgets.live_plot import LivePlot

        return self._widget(("live plot", fields, seconds), lambda station: LivePlot(station, fields, seconds))

    def parameters(self, node: str) -> ParametersPanel:
        """The parameters of a node, each with a slider or a field: "/navigator"."""
        from .lab.widgets.parameters import ParametersPanel

        return self._widget(("parameters", node), lambda station: ParametersPanel(station, node))

    def scene(self) -> Scene:
        """The world in three dimensions."""
        from .lab.widgets.scene import Scene

        return self._widget("scene", Scene)
