"""The troubles: four of the lesson, and bugs that were found in published teaching code."""

from __future__ import annotations

from random import Random

from ..checks import Expectation
from ..checks.drives import NAVIGATE_TYPE
from ..checks.parts import node, publishes, subscribes
from ..checks.streams import rate
from .expect import STATUS, STATUS_TYPE, battery_falls, drives, importable, status_as_specified, status_follows
from .model import DETECTOR, MONITOR, NAVIGATOR, Fault, Program, Trouble

DRAFT = "robot_draft"
OTHERS = (MONITOR, DETECTOR)


# -- 1: the custom message cannot be found ------------------------------------------------------------------------------


def _no_message(chance: Random) -> Fault:
    kind = chance.choice(("not in CMakeLists.txt", "not built", "not sourced"))
    hints = {
        "not in CMakeLists.txt": "Read trouble_ws/src/robot_controller/CMakeLists.txt: which files does "
        "rosidl_generate_interfaces name?",
        "not built": "There is a src folder in trouble_ws. Is there an install folder?",
        "not sourced": "All is built in trouble_ws/install. Has this terminal read its setup file?",
    }
    causes = {
        "not in CMakeLists.txt": "TurtleStatus.msg was not named in CMakeLists.txt, so nothing was generated from it.",
        "not built": "The package was written but never built.",
        "not sourced": "The package was built, but its setup file was not sourced.",
    }
    return Fault(causes[kind], hints[kind], (), workspace=kind)


def _message_rows() -> list[Expectation]:
    return [importable(STATUS_TYPE), importable(NAVIGATE_TYPE), *status_as_specified()]


# -- 2: the service does not answer -------------------------------------------------------------------------------------


def _no_answer(chance: Random) -> Fault:
    wrong = chance.choice(("/navigate", "/navigation/navigate_to", "/go_to", "/robot/navigate_to"))
    faults = (
        Fault("The navigator did not run.", "Compare ros2 node list with the nodes that should be there.", OTHERS),
        Fault(
            f"The navigator offered its service as {wrong}: it was started with a remapping.",
            "The navigator runs. Under which name does it offer its service? ros2 node info /navigator",
            (Program("navigator", remaps={"/navigate_to": wrong}), *OTHERS),
        ),
        Fault(
            "A callback of the navigator waited for a message that only another of its callbacks could have brought: "
            "its one thread was taken for ever.",
            'lesson.plot_timeline("/navigator"): which callback never ends?',
            (Program("navigator_waiting", DRAFT, "navigator"), *OTHERS),
        ),
    )
    return chance.choice(faults)


def _service_rows() -> list[Expectation]:
    return drives((8.0, 5.5), (5.5, 5.5))


# -- 3: a topic is silent -----------------------------------------------------------------------------------------------


def _silent(chance: Random) -> Fault:
    wrong = chance.choice(("/status", "/robot_status", "/robot/state", "/turtle1/status"))
    rate = chance.choice((1, 2))
    rest = (NAVIGATOR, DETECTOR)
    faults = (
        Fault("The status monitor did not run.", "Compare ros2 node list with the nodes that should be there.", rest),
        Fault(
            f"The status monitor published on {wrong}: it was started with a remapping.",
            "The status monitor runs. On which topic does it publish? ros2 node info /status_monitor",
            (Program("status_monitor", remaps={STATUS: wrong}), *rest),
        ),
        Fault(
            f"The parameter publish_rate was {rate}, where 10 is specified.",
            "Messages come, but too rarely. ros2 param get /status_monitor publish_rate",
            (Program("status_monitor", parameters={"publish_rate": rate}), *rest),
        ),
    )
    return chance.choice(faults)


def _topic_rows() -> list[Expectation]:
    return status_as_specified()


# -- 4: the turtle does not move ----------------------------------------------------------------------------------------


def _stands(chance: Random) -> Fault:
    wrong = chance.choice(("/cmd_vel", "/turtle/cmd_vel", "/turtle2/cmd_vel", "/turtle1/command"))
    speed = chance.choice((0.01, 0.02, 0.05))
    period = chance.choice((4.0, 5.0, 8.0))
    faults = (
        Fault(
            "The simulator did not run.",
            "Who hears /turtle1/cmd_vel? ros2 node list",
            (NAVIGATOR, *OTHERS),
            simulator=False,
        ),
        Fault(
            f"The navigator published its commands on {wrong}: it was started with a remapping.",
            "Compare the topics in ros2 node info /navigator and ros2 node info /turtlesim.",
            (Program("navigator", remaps={"/turtle1/cmd_vel": wrong}), *OTHERS),
        ),
        Fault(
            f"The parameter linear_speed was {speed} m/s: too small to get anywhere in time.",
            "Commands arrive. How large are they? ros2 topic echo /turtle1/cmd_vel, ros2 param dump /navigator",
            (Program("navigator", parameters={"linear_speed": speed}), *OTHERS),
        ),
        Fault(
            f"A command came every {period:g} s, and the simulator stops a turtle whose last command is a second old.",
            'How often do commands come? lesson.plot_timeline("/turtle1/cmd_vel"), ros2 param dump /navigator',
            (Program("navigator_draft", DRAFT, "navigator", {"command_period": period, "short_way": True}), *OTHERS),
        ),
    )
    return chance.choice(faults)


def _motion_rows() -> list[Expectation]:
    return [node("/turtlesim", "ros2 run turtlesim turtlesim_node"), *drives((8.0, 5.5), (5.5, 5.5))]


# -- more ---------------------------------------------------------------------------------------------------------------


def _deaf(chance: Random) -> Fault:
    alarm = Program("obstacle_alarm", DRAFT, parameters={"reliability": "reliable"})
    rest = chance.sample((NAVIGATOR, MONITOR), 2)
    return Fault(
        "The laser sends with best effort and the alarm asked for reliable delivery: such ends never connect.",
        "ros2 param get /obstacle_alarm reliability. A laser offers best_effort; the alarm reads its parameter at start.",
        (Program("laser", DRAFT), alarm, *rest),
    )


def _alarm_rows() -> list[Expectation]:
    scan = "sensor_msgs/msg/LaserScan"
    ends = [publishes("/obstacles", scan, by="/laser"), subscribes("/obstacles", scan, by="/obstacle_alarm")]
    return [node("/laser"), node("/obstacle_alarm"), *ends, rate("/alarm", "std_msgs/msg/Float32", 5.0)]


def _typed_wrong(chance: Random) -> Fault:
    twin = chance.random() < 0.5
    name = chance.choice(("status_text", "battery", "reporter"))
    also = (Program("status_text", DRAFT, name), MONITOR) if twin else (Program("status_text", DRAFT, "status_monitor"),)
    return Fault(
        f"Somebody published /robot/status as std_msgs/msg/String, where {STATUS_TYPE} is specified.",
        "ros2 topic info /robot/status --verbose: two ends of different types never connect.",
        (*also, NAVIGATOR, DETECTOR),
    )


def _goal_in_the_west(chance: Random) -> Fault:
    return Fault(
        "The navigator subtracted two angles and did not bring the difference into -180° to 180°: where the heading jumps "
        "from 180° to -180°, it turned the long way round, for ever.",
        "Call it for a goal due west and look at lesson.plot_path(). ros2 param list /navigator",
        (Program("navigator_draft", DRAFT, "navigator"), *chance.sample(OTHERS, 2)),
    )


def _west_rows() -> list[Expectation]:
    return drives((8.0, 5.5), (2.5, 5.5), (1.0, 5.4))


def _twice(chance: Random) -> Fault:
    faults = (
        Fault(
            "The node made its timer twice, so each tick was two calls of its callback.",
            'lesson.plot_timeline("/status_monitor"): how often is the callback called?',
            (Program("status_twice", DRAFT, "status_monitor"), NAVIGATOR, DETECTOR),
        ),
        Fault(
            "The status monitor ran twice, under one name.",
            "ros2 node list warns of it. jobs, and the lines of the launch, tell what runs and its pid.",
            (MONITOR, NAVIGATOR, DETECTOR, MONITOR),
        ),
    )
    return chance.choice(faults)


def _twice_rows() -> list[Expectation]:
    return [*status_as_specified(), battery_falls()]


def _frozen(chance: Random) -> Fault:
    wrong = chance.choice(("/pose", "/turtle/pose", "/turtle2/pose", "/turtle1/position"))
    return Fault(
        f"The status monitor heard {wrong}, where nobody publishes: it was started with a remapping.",
        "ros2 node info /status_monitor: which topic does it hear, and who publishes that one?",
        (Program("status_monitor", remaps={"/turtle1/pose": wrong}), NAVIGATOR, DETECTOR),
    )


def _frozen_rows() -> list[Expectation]:
    return [*status_as_specified(), status_follows()]


TROUBLES: dict[str, Trouble] = {
    trouble.name: trouble
    for trouble in (
        Trouble(
            "message not found",
            "I wrote TurtleStatus.msg in my package in trouble_ws and wanted to start the status monitor. ROS says that it "
            "knows no robot_controller/msg/TurtleStatus.",
            ("A message type is text first. What has to happen until a program can use it?",
             "Go through the three steps in order: CMakeLists.txt, colcon build, source."),
            ("ros2 interface show robot_controller/msg/TurtleStatus", "ros2 pkg list", "ls trouble_ws",
             "cat trouble_ws/src/robot_controller/CMakeLists.txt"),
            _no_message,
            _message_rows,
        ),
        Trouble(
            "service times out",
            "I call /navigate_to, and no answer ever comes.",
            ("Somebody has to offer the service, under this name, and have time to answer.",
             "ros2 service list, ros2 node info /navigator; then lesson.plot_sequence() after a call."),
            ("ros2 node list", "ros2 service list", "ros2 node info /navigator", 'lesson.plot_timeline("/navigator")'),
            _no_answer,
            _service_rows,
        ),
        Trouble(
            "topic silent",
            "The display for /robot/status stays grey, or moves in jerks; it wants ten messages a second.",
            ("A topic needs a publisher, the right name, and the right rate.",
             "ros2 topic list, ros2 topic info /robot/status, ros2 topic hz /robot/status."),
            ("ros2 node list", "ros2 topic list", "ros2 topic hz /robot/status", "ros2 node info /status_monitor",
             "ros2 param get /status_monitor publish_rate"),
            _silent,
            _topic_rows,
        ),
        Trouble(
            "turtle stands still",
            "I send the turtle to a goal and it hardly moves, or not at all. It never gets there.",
            ("Follow the command from the navigator to the turtle: is it sent, where to, how large, how often?",
             "ros2 node list, ros2 topic info /turtle1/cmd_vel --verbose, ros2 topic echo /turtle1/cmd_vel during a call."),
            ("ros2 node list", "ros2 topic info /turtle1/cmd_vel --verbose", "ros2 topic echo /turtle1/cmd_vel",
             "ros2 param dump /navigator", 'lesson.plot_timeline("/turtle1/cmd_vel")'),
            _stands,
            _motion_rows,
        ),
        Trouble(
            "alarm stays silent",
            "The laser sees a wall half a metre ahead, ros2 topic echo /obstacles shows it, and the alarm does not ring.",
            ("Both nodes run and use the same topic and type. What else must fit between two ends?",
             "ros2 topic info /obstacles --verbose shows the quality of service of each end. The log has a warning, too."),
            ("ros2 topic info /obstacles --verbose", "ros2 param get /obstacle_alarm reliability", "ros2 topic hz /alarm"),
            _deaf,
            _alarm_rows,
        ),
        Trouble(
            "status of another type",
            "ros2 topic list shows /robot/status, and my display gets nothing from it, or ros2 topic echo complains.",
            ("A name alone does not connect two ends.",
             "ros2 topic list -t, ros2 topic info /robot/status --verbose."),
            ("ros2 topic list -t", "ros2 topic info /robot/status --verbose", "ros2 node list"),
            _typed_wrong,
            _topic_rows,
        ),
        Trouble(
            "goal in the west",
            "The turtle goes to every goal in the east. Sent to the west, it turns and turns.",
            ("Which number jumps when the turtle looks due west?",
             "ros2 topic echo /turtle1/pose --field theta, while it turns; lesson.plot_path()."),
            ("ros2 topic echo /turtle1/pose --field theta", "ros2 topic echo /turtle1/cmd_vel", "ros2 param list /navigator"),
            _goal_in_the_west,
            _west_rows,
        ),
        Trouble(
            "battery drains twice as fast",
            "The battery is empty after 50 seconds; it should last 100.",
            ("A tenth of a percent is used for each message. How many come a second, and from whom?",
             "ros2 topic hz /robot/status, ros2 topic info /robot/status --verbose, ros2 node list."),
            ("ros2 topic hz /robot/status", "ros2 topic info /robot/status --verbose", "ros2 node list",
             'lesson.plot_timeline("/status_monitor")'),
            _twice,
            _twice_rows,
        ),
        Trouble(
            "status frozen",
            "The status comes ten times a second and says that the turtle is at (0, 0), wherever it is.",
            ("The monitor is alive, and knows nothing. Where should it know it from?",
             "ros2 node info /status_monitor and ros2 topic info /turtle1/pose --verbose; its log warns, too."),
            ("ros2 topic echo /robot/status --once", "ros2 node info /status_monitor", "ros2 topic info /turtle1/pose --verbose"),
            _frozen,
            _frozen_rows,
        ),
    )
}  # fmt: skip
