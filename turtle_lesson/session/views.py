"""Views of one system: pictures that stay, and widgets, each made when it is first asked for.

Asked for again, a widget is the same one in another place. So a cell that is run twice leaves nothing behind, and two views
of a widget are always in step.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable
from functools import cached_property
from typing import TYPE_CHECKING, Any, TypeVar

if TYPE_CHECKING:
    from ..lab.graph import GraphPicture
    from ..lab.picture import Picture
    from ..lab.recorder import Recorder
    from ..lab.widgets.backend import Backend
    from ..lab.widgets.dashboard import Dashboard
    from ..lab.widgets.form import Form
    from ..lab.widgets.goal_pad import GoalPad
    from ..lab.widgets.live_plot import LivePlot
    from ..lab.widgets.parameters import ParametersPanel
    from ..lab.widgets.scene import Scene
    from ..lab.widgets.teleop import Teleop


Widget = TypeVar("Widget")


class Views:
    """The pictures and widgets of a running system, which a subclass names: `_backend` and `_recording`."""

    @cached_property
    def _backend(self) -> Backend:
        """One for all widgets, since they share the frames of its loop."""
        raise NotImplementedError

    @property
    def _recording(self) -> Recorder:
        raise NotImplementedError

    # -- widgets -----------------------------------------------------------------------------------------------------

    def _widget(self, kind: Callable[..., Widget], *arguments: Hashable) -> Widget:
        """The widget of this kind and these arguments; made now if there is none yet."""
        widget = self._widgets.get((kind, arguments))
        if widget is None or widget.comm is None:  # not made yet, or closed
            from ..lab.widgets.backend import Link

            widget = self._widgets[kind, arguments] = kind(Link(self._backend), *arguments)
        return widget

    @cached_property
    def _widgets(self) -> dict[Hashable, Any]:
        """Those that were made, by their kind and arguments; they end with the system."""
        self._backend.at_close.append(self._end_widgets)
        return {}

    def _end_widgets(self) -> None:
        for widget in self._widgets.values():
            widget.end()

    def goal_pad(self) -> GoalPad:
        """A map that is alive: click on it, and the turtle goes there; drag to say how it shall face."""
        from ..lab.widgets.goal_pad import GoalPad

        return self._widget(GoalPad)

    def dashboard(self) -> Dashboard:
        """Everything at once: map, clock, status, scan, rates, nodes, services and log."""
        from ..lab.widgets.dashboard import Dashboard

        return self._widget(Dashboard)

    def teleop(self, topic: str = "/turtle1/cmd_vel") -> Teleop:
        """Drive by hand, with keys or a stick: publishes geometry_msgs/msg/Twist on a topic."""
        from ..lab.widgets.teleop import Teleop

        return self._widget(Teleop, topic)

    def form(self, name: str) -> Form:
        """A form for the messages of a topic, or for the requests of a service: "/turtle1/cmd_vel", "/navigate_to"."""
        from ..lab.widgets.form import Form

        return self._widget(Form, name)

    def live_plot(self, *fields: str, seconds: float = 30.0) -> LivePlot:
        """Curves that go on: a topic and a field each, such as "/robot/status/battery" or "/turtle1/pose/x"."""
        from ..lab.widgets.live_plot import LivePlot

        return self._widget(LivePlot, fields, seconds)

    def parameters(self, node: str) -> ParametersPanel:
        """The parameters of a node, each with a slider or a field: "/navigator"."""
        from ..lab.widgets.parameters import ParametersPanel

        return self._widget(ParametersPanel, node)

    def scene(self) -> Scene:
        """The world in three dimensions."""
        from ..lab.widgets.scene import Scene

        return self._widget(Scene)

    # -- pictures ----------------------------------------------------------------------------------------------------

    def plot_path(self, **options: Any) -> Picture:
        """The way that the turtle went, on the map, from what /turtle1/pose said."""
        from ..lab.path import plot_path

        return plot_path(self._recording, **options)

    def plot_status(self, **options: Any) -> Picture:
        """Position, heading, velocity and battery over time, from what /robot/status said."""
        from ..lab.status import plot_status

        return plot_status(self._recording, **options)

    def plot_scan(self) -> Picture:
        """The last scan that /obstacles brought, as the turtle sees it."""
        from ..lab.scan import plot_scan

        return plot_scan(self._recording)

    def plot_graph(self) -> GraphPicture:
        """Which nodes there are, and by which topics and services they are joined."""
        from ..lab.graph import plot_graph

        return plot_graph(self._recording.node)
