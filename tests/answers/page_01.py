"""Answers to the exercises of page 01."""

from __future__ import annotations

from . import Answers, changed, solution

PAGE = "01_publish_and_subscribe"
COUNTER, DOUBLER, REPORTER = (solution(PAGE, name) for name in ("counter", "doubler", "reporter"))

PLAIN_COUNTER = """
import itertools
import rclpy
from std_msgs.msg import Int32
rclpy.try_shutdown()
rclpy.init()
counter = rclpy.create_node("counter")
publisher = counter.create_publisher(Int32, "count", 10)
numbers = itertools.count(1)
def say():
    message = Int32()
    message.data = next(numbers)
    publisher.publish(message)
counter.create_timer(0.5, say)
"""

FAST_COUNTER = changed(
    COUNTER,
    ("create_timer(0.5", "create_timer(0.1"),
    (
        "        self.number += 1\n        self.publisher.publish(Int32(data=self.number))",
        "        self.number += 1\n        if self.number % 5 == 0:\n"
        "            self.publisher.publish(Int32(data=self.number // 5))",
    ),
)

NEXT_COUNTER = changed(
    COUNTER,
    ("self.number = 0", "self.next = 1"),
    (
        "        self.number += 1\n        self.publisher.publish(Int32(data=self.number))",
        "        self.publisher.publish(Int32(data=self.next))\n        self.next = self.next + 1",
    ),
)

CLOCK_COUNTER = changed(
    COUNTER,
    ("self.number = 0", "self.began = self.get_clock().now()"),
    (
        "        self.number += 1\n        self.publisher.publish(Int32(data=self.number))",
        "        seconds = (self.get_clock().now() - self.began).nanoseconds / 1e9\n"
        "        self.publisher.publish(Int32(data=round(2 * seconds)))",
    ),
)

PLAIN_DOUBLER = """
import rclpy
from std_msgs.msg import Int32
rclpy.try_shutdown()
rclpy.init()
doubler = rclpy.create_node("doubler")
publisher = doubler.create_publisher(Int32, "doubled", 10)
doubler.create_subscription(Int32, "count", lambda heard: publisher.publish(Int32(data=heard.data + heard.data)), 10)
"""

ON_COUNT = "self.publisher.publish(Int32(data=2 * message.data))"

QUEUE_DOUBLER = changed(
    DOUBLER,
    ("        self.create_subscription", "        self.heard = []\n        self.create_subscription"),
    ("        " + ON_COUNT, "        self.heard.append(message.data)"),
    (
        "    def on_count",
        "        self.create_timer(0.05, self.on_timer)\n"
        "    def on_timer(self):\n        while self.heard:\n"
        "            self.publisher.publish(Int32(data=2 * self.heard.pop(0)))\n"
        "    def on_count",
    ),
)

ON_TIMER = "lambda: self.publisher.publish(Float32(data=self.x))"

PLAIN_REPORTER = """
import rclpy
from std_msgs.msg import Float32
from turtlesim.msg import Pose
rclpy.try_shutdown()
rclpy.init()
reporter = rclpy.create_node("reporter")
publisher = reporter.create_publisher(Float32, "report", 1)
newest = []
def on_pose(pose):
    newest[:] = [pose]
def on_timer():
    if newest:
        publisher.publish(Float32(data=newest[0].x))
reporter.create_subscription(Pose, "turtle1/pose", on_pose, 1)
reporter.create_timer(1.0, on_timer)
"""

ONE_CALLBACK_REPORTER = changed(
    REPORTER,
    (
        f"        self.create_timer(1.0, {ON_TIMER})\n",
        "        self.next = self.get_clock().now().nanoseconds + 10**9\n",
    ),
    (
        "        self.x = pose.x",
        "        now = self.get_clock().now().nanoseconds\n        if now >= self.next:\n"
        "            self.next += 10**9\n            self.publisher.publish(Float32(data=pose.x))",
    ),
)

SENSOR_REPORTER = changed(
    REPORTER,
    ("import rclpy.node\n", "import rclpy.node\nfrom rclpy.qos import qos_profile_sensor_data\n"),
    ("self.on_pose, 10)", "self.on_pose, qos_profile_sensor_data)"),
)

ANSWERS = {
    "counter": Answers(
        wrong={
            "starts at 0": (changed(COUNTER, ("self.number = 0", "self.number = -1")), "began with 0, not with 1"),
            "starts at 7": (changed(COUNTER, ("self.number = 0", "self.number = 6")), "began with 7, not with 1"),
            "says 1 for ever": (changed(COUNTER, ("self.number += 1", "self.number = 1")), "message number 2 was 1"),
            "counts in twos": (changed(COUNTER, ("+= 1", "+= 2")), "began with 2, not with 1"),
            "counts down": (changed(COUNTER, ("+= 1", "-= 1")), "began with -1, not with 1"),
            "1 to 4, again and again": (
                changed(COUNTER, ("self.number += 1", "self.number = self.number % 4 + 1")),
                "message number 5 was 1",
            ),
            "two at once, once a second": (
                changed(
                    COUNTER,
                    ("create_timer(0.5", "create_timer(1.0"),
                    (
                        "        self.number += 1\n        self.publisher.publish(Int32(data=self.number))",
                        "        for _ in range(2):\n            self.number += 1\n"
                        "            self.publisher.publish(Int32(data=self.number))",
                    ),
                ),
                "Several messages come at once",
            ),
            "the rate as the period": (
                changed(COUNTER, ("create_timer(0.5", "create_timer(2.0")),
                "not the number of calls a second",
            ),
            "the period in milliseconds": (changed(COUNTER, ("create_timer(0.5", "create_timer(500")), "no message"),
            "text": (
                changed(COUNTER, ("Int32(data=self.number)", "String(data=str(self.number))"), ("Int32", "String")),
                "std_msgs/msg/String",
            ),
            "the topic's name is not quite right": (changed(COUNTER, ("/count", "/counts")), "but there is /counts"),
            "the node's name is not quite right": (changed(COUNTER, ('__("counter")', '__("Counter")')), "/Counter"),
            "never publishes": (
                changed(COUNTER, ("        self.publisher.publish(Int32(data=self.number))", "        pass")),
                "no message",
            ),
            "forgets self": (
                changed(COUNTER, ("self.publisher.publish(Int32(data=self.number))", "self.publisher.publish(number)")),
                "in on_timer: self.publisher.publish(number)",
            ),
            "a number that is none": (
                changed(COUNTER, ("data=self.number", "data=str(self.number)")),
                "in on_timer: self.publisher.publish(Int32(data=str(self.number)))",
            ),
            "a loop in the timer's callback": (
                changed(
                    COUNTER,
                    (
                        "        self.number += 1\n        self.publisher.publish(Int32(data=self.number))",
                        "        while True:\n            self.number += 1",
                    ),
                ),
                "on_timer has not returned: stopped in line",
            ),
        },
        right={
            "functions, a relative name": PLAIN_COUNTER,
            "every fifth call of a faster timer": FAST_COUNTER,
            "publishes, then adds": NEXT_COUNTER,
            "from the clock": CLOCK_COUNTER,
            "has counted for a while": COUNTER + "\nlesson.spin(3.2)",
            "run twice": (COUNTER, COUNTER),
        },
    ),
    "doubler": Answers(
        wrong={
            "says the number itself": (changed(DOUBLER, ("2 * message.data", "message.data")), "21 → 42: 21 came"),
            "says the message that it heard": (
                changed(DOUBLER, ("Int32(data=2 * message.data)", "message")),
                "21 → 42: 21 came",
            ),
            "squares": (changed(DOUBLER, ("2 * message.data", "message.data ** 2")), "21 → 42: 441 came"),
            "adds two": (changed(DOUBLER, ("2 * message.data", "2 + message.data")), "21 → 42: 23 came"),
            "always the example": (changed(DOUBLER, ("2 * message.data", "42")), "-500 → -1000: 42 came"),
            "only what is positive": (
                changed(DOUBLER, ("2 * message.data", "2 * abs(message.data)")),
                "-500 → -1000: 1000 came",
            ),
            "nothing for zero": (
                changed(DOUBLER, (ON_COUNT, f"if message.data:\n            {ON_COUNT}")),
                "0 → 0: nothing came",
            ),
            "twice the answer": (
                changed(DOUBLER, (ON_COUNT, f"{ON_COUNT}\n        {ON_COUNT}")),
                "1001 was answered 2 times",
            ),
            "only the newest, from a timer": (
                changed(
                    DOUBLER,
                    ("        self.create_subscription", "        self.n = 0\n        self.create_subscription"),
                    (ON_COUNT, "self.n = message.data"),
                    (
                        "    def on_count",
                        "        self.create_timer(0.5, self.on_timer)\n    def on_timer(self):\n"
                        "        self.publisher.publish(Int32(data=2 * self.n))\n    def on_count",
                    ),
                ),
                "1001 was answered never",
            ),
            "speaks where it listens": (changed(DOUBLER, ("/doubled", "/count")), "no node publishes /doubled"),
            "listens to another topic": (changed(DOUBLER, ("/count", "/counter")), "no node"),
            "a callback without the message": (
                changed(DOUBLER, ("def on_count(self, message)", "def on_count(self)")),
                "on_count",
            ),
            "the message instead of its number": (
                changed(DOUBLER, ("2 * message.data", "2 * message")),
                "in on_count: self.publisher.publish(Int32(data=2 * message))",
            ),
            "a float": (changed(DOUBLER, ("2 * message.data", "message.data / 0.5")), "must be of type 'int'"),
        },
        right={
            "functions, relative names": PLAIN_DOUBLER,
            "shifts bits": changed(DOUBLER, ("2 * message.data", "message.data << 1")),
            "from a timer, in order": QUEUE_DOUBLER,
            "changes the message and passes it on": changed(
                DOUBLER, (ON_COUNT, "message.data *= 2\n        self.publisher.publish(message)")
            ),
            "a short queue": changed(DOUBLER, ("self.on_count, 10)", "self.on_count, 3)")),
        },
    ),
    "reporter": Answers(
        wrong={
            "always the middle": (changed(REPORTER, ("self.x = pose.x", "self.x = 5.54")), "it said 5.54 when x was"),
            "y": (changed(REPORTER, ("self.x = pose.x", "self.x = pose.y")), "when x was"),
            "the heading": (changed(REPORTER, ("self.x = pose.x", "self.x = pose.theta")), "when x was"),
            "the first x": (changed(REPORTER, ("self.x = pose.x", "self.x = self.x or pose.x")), "when x was"),
            "the greatest x": (
                changed(REPORTER, ("self.x = pose.x", "self.x = max(self.x, pose.x)")),
                "it said 9.53 when x was 8.81",
            ),
            "whole metres": (changed(REPORTER, ("self.x = pose.x", "self.x = float(int(pose.x))")), "it said 9.00"),
            "at each pose": (
                changed(
                    REPORTER,
                    (f"        self.create_timer(1.0, {ON_TIMER})\n", ""),
                    ("self.x = pose.x", "self.publisher.publish(Float32(data=pose.x))"),
                ),
                "every 16.0 ms",
            ),
            "twice a second": (changed(REPORTER, ("create_timer(1.0", "create_timer(0.5")), "every 500.0 ms"),
            "every hundredth pose": (
                changed(
                    REPORTER,
                    (f"        self.create_timer(1.0, {ON_TIMER})\n", "        self.heard = 0\n"),
                    (
                        "self.x = pose.x",
                        "self.heard += 1\n        if self.heard % 100 == 0:\n"
                        "            self.publisher.publish(Float32(data=pose.x))",
                    ),
                ),
                "every 1600.0 ms",
            ),
            "a second late": (
                changed(
                    REPORTER,
                    ("self.x = 0.0", "self.xs = [0.0]"),
                    ("self.x = pose.x", "self.xs = [*self.xs[-60:], pose.x]"),
                    ("data=self.x)", "data=self.xs[0])"),
                ),
                "when x was",
            ),
            "never hears a pose": (changed(REPORTER, ("/turtle1/pose", "/turtle/pose")), "/turtle/pose"),
            "the whole pose": (changed(REPORTER, ("self.x = pose.x", "self.x = pose")), "Got turtlesim.msg.Pose"),
            "nothing is kept": (
                changed(REPORTER, ("        self.x = 0.0\n", ""), ("self.x = pose.x", "x = pose.x")),
                "has no attribute 'x'",
            ),
        },
        right={
            "functions, relative names": PLAIN_REPORTER,
            "by the clock, in the pose's callback": ONE_CALLBACK_REPORTER,
            "as a sensor's data": SENSOR_REPORTER,
            "a queue of one": changed(REPORTER, ("self.on_pose, 10)", "self.on_pose, 1)")),
            "keeps the whole pose": changed(
                REPORTER,
                ("self.x = 0.0", "self.pose = Pose()"),
                ("self.x = pose.x", "self.pose = pose"),
                ("self.x)", "self.pose.x)"),
            ),
        },
    ),
}
