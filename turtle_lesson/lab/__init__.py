"""What a page shows and asks: pictures, widgets, predictions, checks of exercises and troubles.

The lab sees the system as any node does, through topics, services, parameters and the graph, so that it also works on a
robot. Every picture has an exact text. Its modules are imported when they are first asked for, Matplotlib with the first
picture, rclpy with the first recorder.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .graph import GraphPicture, plot_graph
    from .path import plot_path
    from .picture import Picture
    from .recorder import Recorder
    from .recording import Obstacle, Recording
    from .scan import plot_scan
    from .status import plot_status

__all__ = [
    "GraphPicture",
    "Obstacle",
    "Picture",
    "Recorder",
    "Recording",
    "plot_graph",
    "plot_path",
    "plot_scan",
    "plot_status",
]

_MODULES = {"GraphPicture": "graph", "Obstacle": "recording"}
"""The modules of those names that do not end with their module's name."""


def __getattr__(name: str) -> Any:
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    module = _MODULES.get(name, name.removeprefix("plot_").lower())
    return getattr(import_module(f"{__name__}.{module}"), name)
