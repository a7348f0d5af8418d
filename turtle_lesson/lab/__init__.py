"""What a page shows and asks: pictures, widgets, predictions, checks of exercises and troubles.

The lab sees the system as any node does, through topics, services, parameters and the graph, so that it also works on a
robot. Every picture has an exact text. Matplotlib is imported with the first picture, rclpy with the first recorder.
"""

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
