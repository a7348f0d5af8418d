import builtin_interfaces.msg  # noqa: F401
from standin_messages import message

Header = message("std_msgs/msg/Header", stamp="builtin_interfaces/Time", frame_id="string")
String = message("std_msgs/msg/String", data="string")
ColorRGBA = message("std_msgs/msg/ColorRGBA", r="float", g="float", b="float", a="float")
