import geometry_msgs.msg  # noqa: F401
import std_msgs.msg  # noqa: F401
from standin_messages import message

Marker = message(
    "visualization_msgs/msg/Marker",
    header="std_msgs/Header",
    ns="string",
    id="int32",
    type="int32",
    action="int32",
    pose="geometry_msgs/Pose",
    scale="geometry_msgs/Vector3",
    color="std_msgs/ColorRGBA",
    CUBE=1,
    SPHERE=2,
    CYLINDER=3,
    ADD=0,
    DELETE=2,
    DELETEALL=3,
)
MarkerArray = message("visualization_msgs/msg/MarkerArray", markers="sequence<visualization_msgs/Marker>")
