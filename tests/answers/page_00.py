"""Answers to the exercises of page 00."""

from __future__ import annotations

from . import Answers, changed, solution

PAGE = "00_welcome"
FACE_UP, CORNER = solution(PAGE, "face_up"), solution(PAGE, "corner")

DEGREES = changed(FACE_UP, ("1.57", "90.0"))
RIGHT = changed(FACE_UP, ("1.57", "-1.57"))
DRIVES = changed(FACE_UP, ("turn.angular.z", "turn.linear.x = 1.0\nturn.angular.z"))

MANY = """turn = Twist()
turn.angular.z = 1.57 / 2
for _ in range(10):
    publisher.publish(turn)
    lesson.run(0.1)
lesson.run(2)
"""

SHELL = """ros2 topic pub --once /turtle1/cmd_vel geometry_msgs/msg/Twist "{angular: {z: 1.57}}"
lesson.run(2)
"""

CALLED = """request = NavigateTo.Request(x=2.0, y=2.0, theta=1.57)
future = client.call_async(request)
rclpy.spin_until_future_complete(me, future)
"""

ANSWERS = {
    "face_up": Answers(
        wrong={
            "degrees": (DEGREES, "ROS measures angles in radians"),
            "to the right": (RIGHT, "its heading is -1.58 rad"),
            "half a turn": (changed(FACE_UP, ("1.57", "3.14")), "angular.z = 3.14 rad/s"),
            "one radian": (changed(FACE_UP, ("1.57", "1.0")), "angular.z = 1.00 rad/s"),
            "it drives, too": (DRIVES, "it drove 1.0"),
            "only forward": (changed(FACE_UP, ("angular.z = 1.57", "linear.x = 1.57")), "angular.z = 0.00 rad/s"),
            "another axis": (changed(FACE_UP, ("angular.z", "angular.x")), "angular.z = 0.00 rad/s"),
            "set after it was sent": (
                "turn = Twist()\npublisher.publish(turn)\nturn.angular.z = 1.57\nlesson.run(2)",
                "angular.z = 0.00 rad/s",
            ),
            "never sent": (changed(FACE_UP, ("publisher.publish(turn)\n", "")), "its heading is 0.00 rad"),
            "sent for three seconds": (
                changed(
                    FACE_UP,
                    (
                        "publisher.publish(turn)\n",
                        "for _ in range(3):\n    publisher.publish(turn)\n    lesson.run(1)\n",
                    ),
                ),
                "it turned a quarter to the left",
            ),
            "no time for it": (
                changed(FACE_UP, ("lesson.run(2)", "lesson.run(0.2)")),
                "it turned a quarter to the left",
            ),
            "first right, then wrong": ((FACE_UP, RIGHT), "its heading is 0.00 rad"),
        },
        right={
            "run twice": (FACE_UP, FACE_UP),
            "after degrees": (DEGREES, FACE_UP),
            "after a turn to the right": (RIGHT, FACE_UP),
            "after a drive": (DRIVES, FACE_UP),
            "three times": (FACE_UP, FACE_UP, FACE_UP),
            "a fraction of pi": changed(
                FACE_UP, ("turn = Twist()", "import math\nturn = Twist()"), ("1.57", "math.pi / 2")
            ),
            "in a terminal": SHELL,
            "slower, for longer": (changed(MANY, ("range(10)", "range(11)"))),
            "another name": changed(FACE_UP, ("turn", "to_the_left")),
        },
    ),
    "corner": Answers(
        wrong={
            "x alone": (changed(CORNER, ("y=2.0", "y=8.0")), "it is at (2."),
            "y alone": (changed(CORNER, ("x=2.0", "x=8.0")), "2.0"),
            "the corner itself": (changed(CORNER, ("2.0", "0.0")), "it is at (0.0"),
            "the other corner": (changed(CORNER, ("2.0", "9.0")), "it is at (8.96, 9.00)"),
            "not sent": (changed(CORNER, ("client.call(corner)", "")), "it is at (7.98, 7.97)"),
            "a new request is not sent": (
                changed(CORNER, ("client.call(corner)", "client.call(goal)")),
                "it is at (7.9",
            ),
            "half a metre off": (changed(CORNER, ("x=2.0", "x=2.5")), "it is at (2.53, 2.03)"),
            "theta in place of y": (changed(CORNER, ("y=2.0, theta=0.0", "theta=2.0")), "it is at (2."),
            "outside": (changed(CORNER, ("x=2.0", "x=-2.0")), "it is at (7.98, 7.97)"),
        },
        right={
            "facing up": changed(CORNER, ("theta=0.0", "theta=1.57")),
            "run twice": (CORNER, CORNER),
            "after a mistake": (changed(CORNER, ("y=2.0", "y=8.0")), CORNER),
            "asked and spun": CALLED,
            "in a terminal": 'ros2 service call /navigate_to robot_controller/srv/NavigateTo "{x: 2.0, y: 2.0}"',
            "on one line": "client.call(NavigateTo.Request(x=2.0, y=2.0))",
        },
    ),
}
