"""Answers to the exercises of page 07."""

from __future__ import annotations

from answers import Answers, changed, solution

PAGE = "07_command_line"
SET = solution(PAGE, "tuned")
SPAWN = solution(PAGE, "second_turtle")
PUB = solution(PAGE, "circle")
REQUEST = "{x: 2.0, y: 9.0, theta: 1.57, name: turtle2}"
TWIST = "{linear: {x: 1.0}, angular: {z: 0.5}}"
STATUS = "ros2 topic pub --rate 20 --print 100 /robot/status robot_controller/msg/TurtleStatus &"

TUNED = Answers(
    wrong={
        "not a whole number": (changed(SET, ("20", "20.0")), "it is 10"),
        "a slip in the name": (changed(SET, ("publish_rate", "publish_rat")), "it is 10"),
        "another node": (changed(SET, ("/status_monitor publish_rate", "/obstacle_detector scan_rate")), "it is 20"),
        "both nodes": (f"{SET}\nros2 param set /obstacle_detector scan_rate 20", "it is 20"),
        "the period in milliseconds": (changed(SET, ("20", "50")), "it is 50"),
        "out of range": (changed(SET, ("20", "2000")), "it is 10"),
        "read, not set": ("ros2 param get /status_monitor publish_rate", "it is 10"),
        "messages by hand": (STATUS, "2 publishers"),
        "a second monitor": (
            "ros2 run robot_controller status_monitor --ros-args -p publish_rate:=20",
            "2 nodes of this name",
        ),
    },
    right={
        "run twice": (SET, SET),
        "without the slash": changed(SET, ("/status_monitor", "status_monitor")),
        "by the service": (
            "ros2 service call /status_monitor/set_parameters rcl_interfaces/srv/SetParameters \\\n"
            '    "{parameters: [{name: publish_rate, value: {type: 2, integer_value: 20}}]}"'
        ),
        "the launch again": ("kill -INT %1\nros2 launch robot_controller start_system.launch.py publish_rate:=20",),
        "to and fro": (changed(SET, ("20", "5")), SET),
        "a file of parameters": (
            'open("tuned.yaml", "w").write("/status_monitor:\\n  ros__parameters:\\n    publish_rate: 20\\n")\n'
            "ros2 param load /status_monitor tuned.yaml"
        ),
    },
)

SECOND_TURTLE = Answers(
    wrong={
        "x and y exchanged": (changed(SPAWN, ("x: 2.0, y: 9.0", "x: 9.0, y: 2.0")), "it is at (9.00, 2.00)"),
        "degrees": (changed(SPAWN, ("1.57", "90.0")), "it faces"),
        "no heading": (changed(SPAWN, ("theta: 1.57, ", "")), "it faces 0.00 rad"),
        "facing down": (changed(SPAWN, ("1.57", "-1.57")), "it faces -1.57 rad"),
        "another name": (changed(SPAWN, ("turtle2", "second")), "there is /second/pose"),
        "another place": (changed(SPAWN, ("y: 9.0", "y: 8.0")), "it is at (2.00, 8.00)"),
        "no place": (changed(SPAWN, (REQUEST, "{name: turtle2}")), "it is at (0.00, 0.00)"),
        "another type": (changed(SPAWN, ("srv/Spawn", "srv/Kill")), "there is one turtle"),
        "turtle1 is moved": (
            'ros2 service call /turtle1/teleport_absolute turtlesim/srv/TeleportAbsolute "{x: 2.0, y: 9.0, theta: 1.57}"',
            "there is one turtle",
        ),
        "a goal": (
            'ros2 service call /navigate_to robot_controller/srv/NavigateTo "{x: 2.0, y: 9.0, theta: 1.57}"',
            "there is one turtle",
        ),
    },
    right={
        "run twice": (SPAWN, SPAWN),
        "the name that is next": changed(SPAWN, (", name: turtle2", "")),
        "as a block": changed(SPAWN, (REQUEST, "{name: 'turtle2', theta: 1.5708, y: 9, x: 2}")),
        "a turn further round": changed(SPAWN, ("1.57", "7.8540")),
        "spawned elsewhere, then moved": (
            changed(SPAWN, ("x: 2.0", "x: 5.0")),
            'ros2 service call /turtle2/teleport_absolute turtlesim/srv/TeleportAbsolute "{x: 2.0, y: 9.0, theta: 1.57}"',
        ),
        "killed and made again": (
            changed(SPAWN, ("x: 2.0", "x: 5.0")),
            'ros2 service call /kill turtlesim/srv/Kill "{name: turtle2}"',
            SPAWN,
        ),
    },
)

CIRCLE = Answers(
    wrong={
        "no &": (changed(PUB, ('" &', '"')), "no command in a terminal publishes"),
        "once a second": (changed(PUB, ("--rate 10 ", "")), "1.0 a second"),
        "a hundred a second": (changed(PUB, ("--rate 10 ", "--rate 100 ")), "99.5 a second"),
        "once": (changed(PUB, ("--rate 10 --print 100", "--once")), "no command in a terminal publishes"),
        "straight ahead": (changed(PUB, (", angular: {z: 0.5}", "")), "0.00 rad/s"),
        "on the spot": (changed(PUB, ("linear: {x: 1.0}, ", "")), "0.00 m/s"),
        "to the right": (changed(PUB, ("z: 0.5", "z: -0.5")), "-0.50 rad/s"),
        "backwards": (changed(PUB, ("x: 1.0", "x: -1.0")), "-1.00 m/s"),
        "half the radius": (changed(PUB, ("z: 0.5", "z: 1.0")), "it is 1.00 m"),
        "the radius as the turn": (changed(PUB, ("z: 0.5", "z: 2.0")), "it is 0.50 m"),
        "another axis": (changed(PUB, ("{z: 0.5}", "{x: 0.5}")), "0.00 rad/s"),
        "another topic": (changed(PUB, ("/turtle1/cmd_vel", "/cmd_vel")), "no command in a terminal publishes"),
        "the other turtle": (changed(PUB, ("/turtle1/", "/turtle2/")), "no command in a terminal publishes"),
    },
    right={
        "run twice": (PUB, PUB),
        "faster": changed(PUB, ("x: 1.0", "x: 2.0"), ("z: 0.5", "z: 1.0")),
        "slower": changed(PUB, ("x: 1.0", "x: 0.5"), ("z: 0.5", "z: 0.25")),
        "short options, the whole type": changed(
            PUB, ("--rate 10", "-r 10"), ("--print 100", "-p 100"), ("geometry_msgs/Twist", "geometry_msgs/msg/Twist")
        ),
        "all fields": changed(PUB, (TWIST, "{linear: {x: 1.0, y: 0.0, z: 0.0}, angular: {x: 0.0, y: 0.0, z: 0.5}}")),
        "many messages": changed(PUB, ("--rate 10", "--rate 10 --times 1000")),
    },
)

ANSWERS = {"tuned": TUNED, "second_turtle": SECOND_TURTLE, "circle": CIRCLE}
