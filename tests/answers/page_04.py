"""Answers to the exercises of page 04: batteries, velocities along the axes of the map, and a watch over the battery."""

from __future__ import annotations

from answers import Answers, changed, solution

PAGE = "04_status_monitor"
BATTERY = solution(PAGE, "battery")
STATUS = solution(PAGE, "status_monitor")
WATCH = solution(PAGE, "battery_watch")

DRAIN = "self.status.battery = max(0.0, self.status.battery - 0.1)"
PUBLISH = "self.publisher.publish(self.status)"
VELOCITY = """    return (pose.linear_velocity * math.cos(pose.theta),
            pose.linear_velocity * math.sin(pose.theta))"""
LOW = "low = status.battery < 20.0"
SAY = "self.publisher.publish(Bool(data=low))"


def drained(new: str) -> str:
    """The battery's solution with another line in place of the one that takes charge away."""
    return changed(BATTERY, (DRAIN, new))


def velocity(new: str) -> str:
    """The monitor's solution with another body of world_velocity."""
    return changed(STATUS, (VELOCITY, new))


def watch(new: str) -> str:
    """The watch's solution with another comparison."""
    return changed(WATCH, (LOW, new))


ANSWERS = {
    "battery": Answers(
        wrong={
            "falls below zero": (drained("self.status.battery -= 0.1"), "to -"),
            "one percent a message": (drained("self.status.battery = max(0.0, self.status.battery - 1.0)"), "99.00 %"),
            "a hundredth a message": (drained("self.status.battery = max(0.0, self.status.battery - 0.01)"), "99.99 %"),
            "min instead of max": (
                drained("self.status.battery = min(0.0, self.status.battery - 0.1)"),
                "next message 0.00 %",
            ),
            "charges": (drained("self.status.battery = max(0.0, self.status.battery + 0.1)"), "100.10 %"),
            "another variable": (
                drained("battery = max(0.0, self.status.battery - 0.1)"),
                "message 100.00 %",
            ),
            "keeps one percent": (
                drained("self.status.battery = max(1.0, self.status.battery - 0.1)"),
                "at the end 1.0",
            ),
            "starts at 50": (
                BATTERY.replace(
                    "monitor = BatteryMonitor()", "monitor = BatteryMonitor()\nmonitor.status.battery = 50.0"
                ),
                "50.0 % after",
            ),
            "takes away twice": (drained(f"{DRAIN}\n        {DRAIN}"), "99.80 %"),
            "jumps to zero below one": (
                drained(
                    "self.status.battery -= 0.1\n        if self.status.battery < 1:\n            self.status.battery = 0.0"
                ),
                "battery falls",
            ),
            "never publishes": (changed(BATTERY, (PUBLISH, "pass")), "no message"),
            "publishes twice": (changed(BATTERY, (PUBLISH, f"{PUBLISH}\n        {PUBLISH}")), "from 0.0 to 100.0 ms"),
            "publishes the number": (
                changed(BATTERY, (PUBLISH, "self.publisher.publish(self.status.battery)")),
                "TypeError",
            ),
            "forgets self": (drained("status.battery = max(0.0, status.battery - 0.1)"), "NameError"),
            "full again when empty": (
                drained(
                    "self.status.battery -= 0.1\n        if self.status.battery < 0:\n            self.status.battery = 100.0"
                ),
                "battery ends at 0",
            ),
        },
        right={
            "an if": drained(
                "self.status.battery -= 0.1\n        if self.status.battery < 0:\n            self.status.battery = 0.0"
            ),
            "max with the arguments exchanged": drained("self.status.battery = max(self.status.battery - 0.1, 0.0)"),
            "a fresh message each time": """
class BatteryMonitor(Monitor):
    charge = 1000

    def on_timer(self):
        self.publisher.publish(TurtleStatus(battery=self.charge / 10))
        self.charge = max(0, self.charge - 1)

lesson = start(seed=0, package="mine")
rclpy.init()
monitor = BatteryMonitor()
""",
            "a conditional expression": drained(
                "self.status.battery = self.status.battery - 0.1 if self.status.battery > 0.1 else 0.0"
            ),
            "rounded": drained("self.status.battery = max(0.0, round(self.status.battery - 0.1, 1))"),
            "run twice": (BATTERY, BATTERY),
        },
    ),
    "status_monitor": Answers(
        wrong={
            "speed along x alone": (velocity("    return pose.linear_velocity, 0.0"), "-0.50 m/s is right"),
            "vel_y never set": (
                velocity("    return pose.linear_velocity * math.cos(pose.theta), 0.0"),
                "vel_y follows the turtle",
            ),
            "vel_x never set": (
                velocity("    return 0.0, pose.linear_velocity * math.sin(pose.theta)"),
                "vel_x follows the turtle",
            ),
            "exchanged": (
                velocity("    v, t = pose.linear_velocity, pose.theta\n    return v * math.sin(t), v * math.cos(t)"),
                "vel_y follows the turtle",
            ),
            "no speed": (velocity("    return math.cos(pose.theta), math.sin(pose.theta)"), "when the turtle stands"),
            "angle taken for degrees": (
                velocity(
                    "    v, t = pose.linear_velocity, math.radians(pose.theta)\n    return v * math.cos(t), v * math.sin(t)"
                ),
                "0.50 m/s at",
            ),
            "never negative": (
                velocity(
                    "    v, t = pose.linear_velocity, pose.theta\n    return abs(v * math.cos(t)), abs(v * math.sin(t))"
                ),
                "vel_y follows the turtle",
            ),
            "turning speed": (
                velocity("    v, t = pose.angular_velocity, pose.theta\n    return v * math.cos(t), v * math.sin(t)"),
                "vel_x follows the turtle",
            ),
            "y upside down": (
                velocity("    v, t = pose.linear_velocity, pose.theta\n    return v * math.cos(t), -v * math.sin(t)"),
                "vel_y follows the turtle",
            ),
            "the example's speed": (
                velocity("    return 1.0 * math.cos(pose.theta), 1.0 * math.sin(pose.theta)"),
                "when the turtle stands",
            ),
            "prints instead of returning": (
                velocity("    print(pose.linear_velocity * math.cos(pose.theta))"),
                "TypeError",
            ),
            "one number": (velocity("    return pose.linear_velocity * math.cos(pose.theta)"), "TypeError"),
            "a name that is not there": (velocity("    return linear_velocity, 0.0"), "NameError"),
            "a field that is not there": (velocity("    return pose.vel_x, pose.vel_y"), "AttributeError"),
        },
        right={
            "short names": velocity(
                "    v, t = pose.linear_velocity, pose.theta\n    return v * math.cos(t), v * math.sin(t)"
            ),
            "a list": velocity("    return [pose.linear_velocity * f(pose.theta) for f in (math.cos, math.sin)]"),
            "a complex number": changed(
                velocity("    v = cmath.rect(pose.linear_velocity, pose.theta)\n    return v.real, v.imag"),
                ("import math\n", "import cmath\n"),
            ),
            "sine of the angle to the other axis": velocity(
                "    v, t = pose.linear_velocity, pose.theta\n"
                "    return v * math.sin(math.pi / 2 - t), v * math.cos(math.pi / 2 - t)"
            ),
            "from two poses, as the finished one": velocity(
                "    global last\n"
                "    before, last = last, pose\n"
                "    if before is None:\n"
                "        return 0.0, 0.0\n"
                "    return (pose.x - before.x) / 0.016, (pose.y - before.y) / 0.016\n\n"
                "last = None"
            ),
            "written twice": (STATUS, STATUS),
        },
    ),
    "battery_watch": Answers(
        wrong={
            "at most 20": (watch("low = status.battery <= 20.0"), "20 %: it said True"),
            "the wrong way round": (watch("low = status.battery > 20.0"), "100 %: it said True"),
            "as a fraction": (watch("low = status.battery < 0.2"), "19.5 %: it said False"),
            "always False": (watch("low = False"), "19.5 %: it said False"),
            "always True": (watch("low = True"), "100 %: it said True"),
            "below 19": (watch("low = status.battery < 19.0"), "19.5 %: it said False"),
            "only when low": (
                changed(WATCH, (SAY, "if low:\n            " + SAY)),
                "nothing came within 1 s",
            ),
            "only once": (
                changed(WATCH, (SAY, f"if not hasattr(self, 'done'):\n            {SAY}\n        self.done = True")),
                "nothing came within 1 s",
            ),
            "stays low": (
                changed(WATCH, (LOW, "self.low = low = getattr(self, 'low', False) or status.battery < 20.0")),
                "100 %: it said True",
            ),
            "says it twice": (changed(WATCH, (SAY, f"{SAY}\n        {SAY}")), "2 messages came instead of one"),
            "publishes a bool of Python": (changed(WATCH, (SAY, "self.publisher.publish(low)")), "TypeError"),
            "data by position": (changed(WATCH, (SAY, "self.publisher.publish(Bool(low))")), "TypeError"),
            "compares the message": (watch("low = status < 20.0"), "TypeError"),
            "whole percent": (watch("low = int(status.battery) <= 19 and status.battery != 0"), "0 %: it said False"),
            "by a timer": (
                """
class BatteryWatch(Watch):
    battery = 100.0

    def on_status(self, status):
        if status.battery != self.battery:
            self.create_timer(0.1, lambda: self.publisher.publish(Bool(data=self.battery < 20.0)))
        self.battery = status.battery

lesson = start(seed=0, package="mine")
rclpy.init()
watch = BatteryWatch()
""",
                "100 %: nothing came",
            ),
        },
        right={
            "the other way round": watch("low = 20.0 > status.battery"),
            "not at least": watch("low = not status.battery >= 20.0"),
            "an if": watch("low = False\n        if status.battery < 20:\n            low = True"),
            "a message that is filled in": changed(
                WATCH, (SAY, "message = Bool()\n        message.data = low\n        self.publisher.publish(message)")
            ),
            "logs, too": changed(WATCH, (SAY, f'{SAY}\n        self.get_logger().info(f"low: {{low}}")')),
            "run twice": (WATCH, WATCH),
        },
    ),
}
