"""The troubles: four of the lesson, and bugs that were found in published teaching code."""

from __future__ import annotations

from . import faults
from .model import Trouble

TROUBLES: dict[str, Trouble] = {
    trouble.name: trouble
    for trouble in (
        Trouble(
            "message not found",
            "I copied my package into a new workspace, trouble_ws, and wanted to start the status monitor there. ROS cannot "
            "find robot_controller/msg/TurtleStatus.",
            ("A message type is only a text at first. What has to happen before a program can use it?",
             "Go through the three steps in order: CMakeLists.txt, colcon build, source."),
            ("ros2 interface show robot_controller/msg/TurtleStatus", "ros2 pkg list", "ls trouble_ws",
             "cat trouble_ws/src/robot_controller/CMakeLists.txt"),
            faults.no_message,
            faults.message_rows,
        ),
        Trouble(
            "service times out",
            "I call /navigate_to, and no answer ever comes.",
            ("Some node has to offer the service, under this name, and its callback has to be called.",
             "ros2 service list, ros2 node info /navigator; then lesson.plot_sequence() after a call."),
            ("ros2 node list", "ros2 service list", "ros2 node info /navigator", 'lesson.plot_timeline("/navigator")'),
            faults.no_answer,
            faults.service_rows,
        ),
        Trouble(
            "topic silent",
            "The dashboard stays empty, or moves in jerks. It needs ten messages a second on /robot/status.",
            ("A topic needs a publisher, the right name, and the right rate.",
             "ros2 topic list, ros2 topic info /robot/status, ros2 topic hz /robot/status."),
            ("ros2 node list", "ros2 topic list", "ros2 topic hz /robot/status", "ros2 node info /status_monitor",
             "ros2 param get /status_monitor publish_rate"),
            faults.silent,
            faults.topic_rows,
        ),
        Trouble(
            "turtle stands still",
            "I send the turtle to a goal, and it hardly moves, or not at all. It never gets there.",
            ("Follow the commands from the navigator to the turtle: are they sent, on which topic, how large, how often?",
             "ros2 node list, ros2 topic info /turtle1/cmd_vel --verbose, ros2 topic echo /turtle1/cmd_vel during a call."),
            ("ros2 node list", "ros2 topic info /turtle1/cmd_vel --verbose", "ros2 topic echo /turtle1/cmd_vel",
             "ros2 node info /navigator", 'lesson.plot_timeline("/turtle1/cmd_vel")'),
            faults.stands,
            faults.motion_rows,
        ),
        Trouble(
            "alarm stays silent",
            "The laser sees a wall half a metre ahead, ros2 topic echo /obstacles shows it, and the alarm does not ring.",
            ("Both nodes run and use the same topic and type. What else must fit between two ends?",
             "ros2 topic info /obstacles --verbose shows the quality of service of each end. The log has a warning, too."),
            ("ros2 topic info /obstacles --verbose", "ros2 param get /obstacle_alarm reliability", "ros2 topic hz /alarm"),
            faults.deaf,
            faults.alarm_rows,
        ),
        Trouble(
            "status of another type",
            "ros2 topic list shows /robot/status, and my display gets nothing from it, or ros2 topic echo complains.",
            ("A name alone does not connect two ends.",
             "ros2 topic list -t, ros2 topic info /robot/status --verbose."),
            ("ros2 topic list -t", "ros2 topic info /robot/status --verbose", "ros2 node list"),
            faults.typed_wrong,
            faults.topic_rows,
        ),
        Trouble(
            "goal in the west",
            "The turtle goes to every goal in the east. Sent to the west, it turns and turns.",
            ("Which number jumps when the turtle looks due west?",
             "ros2 topic echo /turtle1/pose --field theta, while it turns; lesson.plot_path()."),
            ("ros2 topic echo /turtle1/pose --field theta", "ros2 topic echo /turtle1/cmd_vel", "ros2 param list /navigator"),
            faults.goal_in_the_west,
            faults.west_rows,
        ),
        Trouble(
            "status comes twice",
            "The display for /robot/status flickers: twenty messages come a second, where ten are specified.",
            ("If messages come twice, there are two publishers, or one callback is called twice.",
             "ros2 topic hz /robot/status, ros2 topic info /robot/status --verbose, ros2 node list."),
            ("ros2 topic hz /robot/status", "ros2 topic info /robot/status --verbose", "ros2 node list",
             'lesson.plot_timeline("/status_monitor")'),
            faults.twice,
            faults.twice_rows,
        ),
        Trouble(
            "status frozen",
            "The status comes ten times a second and says that the turtle is at (0, 0), wherever it is.",
            ("The monitor runs, but it does not know where the turtle is. Which topic should tell it?",
             "ros2 node info /status_monitor and ros2 topic info /turtle1/pose --verbose; its log warns, too."),
            ("ros2 topic echo /robot/status --once", "ros2 node info /status_monitor",
             "ros2 topic info /turtle1/pose --verbose"),
            faults.frozen,
            faults.frozen_rows,
        ),
    )
}  # fmt: skip
