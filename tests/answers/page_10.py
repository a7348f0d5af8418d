"""Answers to the exercises of page 10: a test of one message, a watchdog, and a system in a hurry that is to be mended."""

from __future__ import annotations

from answers import Answers, changed, solution

PAGE = "10_test_and_validate"
BATTERY = solution(PAGE, "battery_test")
WATCHDOG = solution(PAGE, "watchdog")
SYSTEM = solution(PAGE, "system")

COMPARES = "0 <= status.battery <= 100"
IS_ALIVE = WATCHDOG[WATCHDOG.index("        if") : WATCHDOG.index("\n\nlesson")]
TIMEOUT, STATUS, SCAN = SYSTEM.splitlines()
LAUNCH = "ros2 launch robot_controller start_system.launch.py"


def battery(condition: str) -> str:
    """The test of the battery with another condition."""
    return changed(BATTERY, (COMPARES, condition))


def body(lines: str) -> str:
    """The watchdog with another body of is_alive."""
    return changed(WATCHDOG, (IS_ALIVE, "\n".join(f"        {line}" for line in lines.strip().splitlines())))


ANSWERS = {
    "battery_test": Answers(
        wrong={
            "lets nan through": (
                battery("not (status.battery < 0 or status.battery > 100)"),
                "battery_ok returned True for nan",
            ),
            "without 0 and 100": (battery("0 < status.battery < 100"), "battery_ok returned False for 0 %"),
            "100 is left out": (battery("0 <= status.battery < 100"), "battery_ok returned False for 100 %"),
            "the upper end alone": (battery("status.battery <= 100"), "battery_ok returned True for -1 %"),
            "the lower end alone": (battery("status.battery >= 0"), "battery_ok returned True for 150 %"),
            "or instead of and": (battery("status.battery >= 0 or status.battery <= 100"), "returned True for 150 %"),
            "a share instead of a percentage": (
                battery("0 <= status.battery <= 1"),
                "battery_ok returned False for 50 %",
            ),
            "whole percents": (battery("int(status.battery) in range(101)"), "battery_ok returned True for 100.5 %"),
            "the other way round": (battery("not 0 <= status.battery <= 100"), "battery_ok returned False for 50 %"),
            "prints instead of returning": (changed(BATTERY, ("return", "print(")) + ")", "battery_ok returned None"),
            "never False": (
                "def battery_ok(status):\n    if 0 <= status.battery <= 100:\n        return True",
                "battery_ok returned None for 150 %",
            ),
            "the test's own examples": (battery("status.battery == 50"), "battery_ok returned False for 0 %"),
            "another field": (battery("0 <= status.vel_x <= 100"), "battery_ok returned True for 150 %"),
            "a number for the status": (battery("0 <= status <= 100"), "TypeError"),
            "another name": (changed(BATTERY, ("battery_ok", "is_battery_ok")), "NameError"),
            "nan alone": (battery("status.battery == status.battery"), "battery_ok returned True for 150 %"),
            "without inf and nan alone": (
                "import math\n" + battery("math.isfinite(status.battery)"),
                "battery_ok returned True for 150 %",
            ),
        },
        right={
            "two comparisons": battery("status.battery >= 0 and status.battery <= 100"),
            "from the other side": battery("100 >= status.battery >= 0"),
            "distance from the middle": battery("abs(status.battery - 50) <= 50"),
            "a clamp": battery("min(max(status.battery, 0.0), 100.0) == status.battery"),
            "early returns": (
                "import math\n"
                "def battery_ok(status):\n"
                "    if math.isnan(status.battery):\n        return False\n"
                "    if status.battery < 0 or status.battery > 100:\n        return False\n"
                "    return True"
            ),
            "a lambda": "battery_ok = lambda status: 0 <= status.battery <= 100",
            "run twice": (BATTERY, BATTERY),
        },
    ),
    "watchdog": Answers(
        wrong={
            "remembers that, not when": (body("return self.heard_at is not None"), "0.54 s after it: True"),
            "0.9 s": (changed(WATCHDOG, ("0.5e9", "0.9e9")), "0.54 s after it: True"),
            "0.45 s": (changed(WATCHDOG, ("0.5e9", "0.45e9")), "0.46 s after it: False"),
            "nanoseconds taken for seconds": (changed(WATCHDOG, ("0.5e9", "0.5")), "it says False"),
            "milliseconds": (changed(WATCHDOG, ("0.5e9", "500")), "it says False"),
            "a zero too many": (changed(WATCHDOG, ("0.5e9", "5e9")), "0.54 s after it: True"),
            "the other way round": (changed(WATCHDOG, ("< 0.5e9", "> 0.5e9")), "it says False"),
            "subtracted the other way": (
                changed(WATCHDOG, ("self.get_clock().now() - self.heard_at", "self.heard_at - self.get_clock().now()")),
                "0.54 s after it: True",
            ),
            "True before the first": (changed(WATCHDOG, ("return False", "return True")), "a new one says True"),
            "None before the first": (changed(WATCHDOG, ("return False", "return None")), "a new one says None"),
            "does not ask for None": (
                body("return (self.get_clock().now() - self.heard_at).nanoseconds < 5e8"),
                "TypeError",
            ),
            "always True": (body("return True"), "a new one says True"),
            "always False": (body("return False"), "it says False"),
            "seconds of the duration alone": (
                body(
                    "if self.heard_at is None:\n    return False\n"
                    "silence = (self.get_clock().now() - self.heard_at).nanoseconds\n"
                    "return silence // 10**9 < 0.5"
                ),
                "0.54 s after it: True",
            ),
            "forgets after each look": (
                body("heard, self.heard_at = self.heard_at, None\nreturn heard is not None"),
                "it says False",
            ),
            "returns the silence": (
                changed(WATCHDOG, ("return silence.nanoseconds < 0.5e9", "return silence")),
                "AssertionError",
            ),
            "compares with a number": (changed(WATCHDOG, ("silence.nanoseconds", "silence")), "TypeError"),
            "beside a status monitor": (
                (WATCHDOG, "ros2 run robot_controller status_monitor"),
                "/status_monitor publishes /robot/status, so there is no silence",
            ),
        },
        right={
            "in seconds": changed(WATCHDOG, ("silence.nanoseconds < 0.5e9", "silence.nanoseconds / 1e9 < 0.5")),
            "in one line": body(
                "now = self.get_clock().now()\n"
                "return self.heard_at is not None and (now - self.heard_at).nanoseconds < 500_000_000"
            ),
            "compares durations": changed(
                WATCHDOG,
                ("class MyWatchdog", "from rclpy.duration import Duration\n\nclass MyWatchdog"),
                ("silence.nanoseconds < 0.5e9", "silence < Duration(seconds=0.5)"),
            ),
            "two moments": changed(
                WATCHDOG,
                (
                    "silence = self.get_clock().now() - self.heard_at",
                    "now, then = self.get_clock().now(), self.heard_at",
                ),
                ("silence.nanoseconds < 0.5e9", "now.nanoseconds - then.nanoseconds < 5 * 10**8"),
            ),
            "an exception for None": body(
                "try:\n    return (self.get_clock().now() - self.heard_at).nanoseconds < 0.5e9\n"
                "except TypeError:\n    return False"
            ),
            "its own on_status": changed(
                WATCHDOG,
                (
                    "    def is_alive",
                    "    def on_status(self, status):\n        self.heard_at = self.get_clock().now()\n\n    def is_alive",
                ),
            ),
            "run twice": (WATCHDOG, WATCHDOG),
            "checked before": (WATCHDOG, 'lesson.check("watchdog")'),
        },
    ),
    "system": Answers(
        wrong={
            "the timeout is left": (f"{STATUS}\n{SCAN}", "success is False after"),
            "the status is left": (f"{TIMEOUT}\n{SCAN}", "12.0 Hz"),
            "the scans are left": (f"{TIMEOUT}\n{STATUS}", "2.0 Hz"),
            "a timeout that is still too short": (changed(SYSTEM, ("5.0", "1.8")), "success is False after"),
            "a timeout that is no double": (changed(SYSTEM, ("5.0", "5")), "success is False after"),
            "the rates exchanged": (
                changed(SYSTEM, ("publish_rate 10", "publish_rate 5"), ("scan_rate 5", "scan_rate 10")),
                "5.0 Hz",
            ),
            "periods instead of rates": (changed(SYSTEM, ("publish_rate 10", "publish_rate 100")), "100.0 Hz"),
            "a slip in the name": (changed(SYSTEM, ("publish_rate", "publish_rat")), "12.0 Hz"),
            "launched once more": (f"{LAUNCH}", "2 nodes of this name"),
            "the finished package": (
                f"lesson = start(seed=0)\n{LAUNCH}",
                "navigator, status_monitor and obstacle_detector came from elsewhere",
            ),
            "stopped": ("kill -INT %1", "it is not there"),
            "looked at, not changed": ("ros2 param list\nros2 param get /navigator goal_timeout", "success is False"),
        },
        right={
            "in another order": f"{SCAN}\n{STATUS}\n{TIMEOUT}",
            "launched anew": f"kill -INT %1\n{LAUNCH}",
            "a longer timeout": changed(SYSTEM, ("5.0", "20.0")),
            "node by node": (
                'lesson = start(seed=0, package="mine")\n'
                "ros2 run robot_controller navigator\n"
                "ros2 run robot_controller status_monitor\n"
                "ros2 run robot_controller obstacle_detector"
            ),
        },
    ),
}
