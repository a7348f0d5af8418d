from standin_messages import message

TurtleStatus = message(
    "robot_controller/msg/TurtleStatus",
    x="float",
    y="float",
    theta="float",
    vel_x="float",
    vel_y="float",
    battery="float",
)
