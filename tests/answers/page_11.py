"""Answers to the exercises of page 11: an exported package that is started on site, a safety stop, and a bag that is played."""

from __future__ import annotations

from answers import Answers, changed, solution

PAGE = "11_to_a_real_robot"
ON_SITE = solution(PAGE, "on_site").strip()
SAFETY = solution(PAGE, "safety_stop")
REPLAY = solution(PAGE, "replay")

CONDITION = "distance >= 0.5 and 0.0 <= age <= 0.5"
LAUNCH = "ros2 launch robot_controller start_system.launch.py"
SETTINGS = "goal_timeout:=8.0 publish_rate:=20 scan_rate:=10"
PLAY = REPLAY.strip().splitlines()[-1]
CHANGED_LATER = f"""{LAUNCH}
ros2 param set /navigator goal_timeout 8.0
ros2 param set /status_monitor publish_rate 20
ros2 param set /obstacle_detector scan_rate 10"""
CHANGED_FILE = """from pathlib import Path
file = Path("robot_ws/src/robot_controller/robot_controller/status_monitor_node.py")
_ = file.write_text(file.read_text().replace("publish_rate", "publish_rate") + "\\n# changed on site\\n")
"""
BUILD = "cd robot_ws\ncolcon build --packages-select robot_controller\nsource install/setup.bash\ncd .."


def safe(condition: str) -> str:
    """The safety stop with another condition."""
    return changed(SAFETY, (CONDITION, condition))


ANSWERS = {
    "on_site": Answers(
        wrong={
            "without arguments": (LAUNCH, "it is 5.0"),
            "set after the launch": (CHANGED_LATER, "navigator was started with goal_timeout:=5.0"),
            "the finished package": (f"lesson = start(seed=0)\n{ON_SITE}", "navigator runs from the finished package"),
            "the package of the workspace": (
                f'lesson = start(seed=0, package="mine")\n{ON_SITE}',
                "navigator runs from your workspace",
            ),
            "scan_rate is left out": (changed(ON_SITE, (" scan_rate:=10", "")), "it is 5"),
            "publish_rate is left out": (changed(ON_SITE, (" publish_rate:=20", "")), "it is 10"),
            "a slip in a name": (changed(ON_SITE, ("goal_timeout", "goal_timout")), "it is 5.0"),
            "the rates exchanged": (
                changed(ON_SITE, ("rate:=20", "rate:=10"), ("scan_rate:=10", "scan_rate:=20")),
                "it is",
            ),
            "a rate that is no integer": (changed(ON_SITE, ("rate:=20", "rate:=20.5")), "status_monitor ended"),
            "the program's way of arguments": (
                f"{LAUNCH} --ros-args -p goal_timeout:=8.0 -p publish_rate:=20 -p scan_rate:=10",
                "it is not there",
            ),
            "launched twice": ((LAUNCH, ON_SITE), "2 nodes of this name"),
            "the monitor alone": (
                "ros2 run robot_controller status_monitor --ros-args -p publish_rate:=20",
                "it is not there",
            ),
            "a file was changed": ((CHANGED_FILE, f"{BUILD}\n{ON_SITE}"), "differs from status_monitor_node.py"),
        },
        right={
            "in another order": f"{LAUNCH} scan_rate:=10 goal_timeout:=8.0 publish_rate:=20",
            "after a wrong launch that was stopped": (f"{LAUNCH}\nkill -INT %1", ON_SITE),
            "from Python": 'handle = lesson.launch("robot_controller", "start_system.launch.py", '
            "goal_timeout=8.0, publish_rate=20, scan_rate=10)",
            "over two lines": changed(ON_SITE, (" publish_rate", " \\\n    publish_rate")),
            "built once more": f"{BUILD}\n{ON_SITE}",
            "by the path of the file": changed(
                ON_SITE,
                (
                    "robot_controller start_system.launch.py",
                    "robot_ws/install/robot_controller/share/robot_controller/launch/start_system.launch.py",
                ),
            ),
        },
    ),
    "safety_stop": Answers(
        wrong={
            "always": (safe("True"), "is_safe(0.3, 0.1) is True, not False"),
            "never": (safe("False"), "is_safe(2.0, 0.1) is False, not True"),
            "the distance alone": (safe("distance >= 0.5"), "is_safe(2.0, 3.0) is True"),
            "the age alone": (safe("0.0 <= age <= 0.5"), "is_safe(0.3, 0.1) is True"),
            "or instead of and": (safe("distance >= 0.5 or age <= 0.5"), "is_safe(0.3, 0.1) is True"),
            "0.4 m and 0.9 s": (safe("distance >= 0.4 and 0.0 <= age <= 0.9"), "is_safe(0.45, 0.1) is True"),
            "up to a second": (safe("distance >= 0.5 and 0.0 <= age <= 1.0"), "is_safe(2.0, 0.6) is True"),
            "more than 0.5 m": (safe("distance > 0.5 and 0.0 <= age <= 0.5"), "is_safe(0.5, 0.1) is False"),
            "less than 0.5 s": (safe("distance >= 0.5 and 0.0 <= age < 0.5"), "is_safe(2.0, 0.5) is False"),
            "the wrong way round": (safe("distance <= 0.5 and 0.0 <= age <= 0.5"), "is_safe(2.0, 0.1) is False"),
            "exchanged": (safe("age >= 0.5 and distance <= 0.5"), "is_safe(2.0, 0.1) is False"),
            "says what is dangerous": (
                safe("not (distance < 0.5 or age > 0.5 or age < 0.0)"),
                "is_safe(nan, 0.1) is True",
            ),
            "a negative age": (safe("distance >= 0.5 and age <= 0.5"), "is_safe(2.0, -0.1) is True"),
            "the size of the age": (safe("distance >= 0.5 and abs(age) <= 0.5"), "is_safe(2.0, -0.1) is True"),
            "inf is dangerous": (safe("0.5 <= distance < 10.0 and 0.0 <= age <= 0.5"), "is_safe(inf, 0.1) is False"),
            "nothing instead of False": (
                "def is_safe(distance, age):\n    if distance >= 0.5 and 0.0 <= age <= 0.5:\n        return True",
                "is_safe(0.3, 0.1) is None",
            ),
            "prints": (
                changed(SAFETY, ("return distance", "print(distance"), ("<= 0.5", "<= 0.5)")),
                "is None, not True",
            ),
            "centimetres": (safe("distance >= 50 and 0.0 <= age <= 0.5"), "is_safe(2.0, 0.1) is False"),
            "one argument": ("def is_safe(distance):\n    return distance >= 0.5", "TypeError"),
        },
        right={
            "early returns": (
                "import math\n"
                "def is_safe(distance, age):\n"
                "    if math.isnan(distance) or math.isnan(age):\n        return False\n"
                "    if distance < 0.5:\n        return False\n"
                "    return 0 <= age <= 0.5"
            ),
            "not nearer": "import math\n" + safe("not distance < 0.5 and 0 <= age <= 0.5 and not math.isnan(distance)"),
            "all": safe("all((distance >= 0.5, age >= 0, age <= 0.5))"),
            "distance from the middle": safe("distance >= 0.5 and abs(age - 0.25) <= 0.25"),
            "a lambda": "is_safe = lambda distance, age: 0.5 <= distance and 0.0 <= age <= 0.5",
            "run twice": (SAFETY, 'lesson.check("safety_stop")', SAFETY),
        },
    ),
    "replay": Answers(
        wrong={
            "all topics": (changed(REPLAY, (" --topics /robot/status", "")), "/turtle1/cmd_vel"),
            "played once": (changed(REPLAY, (" --loop", "")), "none after"),
            "half the speed": (changed(REPLAY, ("--loop", "--loop --rate 0.5")), "5.0 Hz"),
            "twice the speed": (changed(REPLAY, ("--loop", "--loop --rate 2")), "20.0 Hz"),
            "in the foreground": (changed(REPLAY, (" &", "")), "no node publishes it"),
            "another topic": (changed(REPLAY, ("/robot/status", "/turtle1/pose")), "no node publishes it"),
            "without its slash": (changed(REPLAY, ("/robot/status", "/robot_status")), "no node publishes it"),
            "the real monitor": (
                'lesson = start(seed=0, package="mine")\nros2 run robot_controller status_monitor',
                "/status_monitor",
            ),
            "beside the real monitor": (
                changed(REPLAY, ("lesson = start(seed=0)", 'lesson = start(seed=0, package="mine")'))
                + "\nros2 run robot_controller status_monitor",
                "it runs",
            ),
            "played twice": (f"{REPLAY}\n{PLAY}", "rosbag2_player"),
            "published by hand": (
                "lesson = start(seed=0)\n"
                'ros2 topic pub --rate 10 /robot/status robot_controller/msg/TurtleStatus "{battery: 50.0}" &',
                "ros2",
            ),
            "one of two topics": (
                changed(REPLAY, ("--topics /robot/status", "--topics /robot/status /obstacles")),
                "/obstacles, too",
            ),
        },
        right={
            "the short option": changed(REPLAY, ("--loop", "-l")),
            "options first": changed(REPLAY, (PLAY, "ros2 bag play --loop --topics /robot/status -- $BAG &")),
            "at the recorded rate": changed(REPLAY, ("--loop", "--loop --rate 1.0")),
            "by its name": changed(REPLAY, ("$BAG", "drive_1")),
            "run twice": (REPLAY, REPLAY),
        },
    ),
}
