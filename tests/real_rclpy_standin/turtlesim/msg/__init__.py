from standin_messages import message

Pose = message(
    "turtlesim/msg/Pose", x="float", y="float", theta="float", linear_velocity="float", angular_velocity="float"
)
