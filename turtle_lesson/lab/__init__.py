"""What a page shows: the lab listens to the system as a node of its own and draws what it hears.

Everything here knows the system through topics and the graph, as on a robot, and every picture also speaks:
its text says in figures what it shows. Matplotlib is imported with the first picture, rclpy with the first
recorder.
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
