import std_msgs.msg  # noqa: F401
from standin_messages import message

LaserScan = message(
    "sensor_msgs/msg/LaserScan",
    header="std_msgs/Header",
    angle_min="float",
    angle_max="float",
    angle_increment="float",
    range_min="float",
    range_max="float",
    ranges="sequence<float>",
)
