"""Answers to the exercises of page 03b: answering on arrival, and one goal at a time."""

from __future__ import annotations

from . import Answer, Answers, changed, solution

PAGE = "03b_answer_on_arrival"
ARRIVAL, ONE = solution(PAGE, "on_arrival"), solution(PAGE, "one_goal")

SENSE = "0 <= request.x <= 11.09 and 0 <= request.y <= 11.09 and math.isfinite(request.theta)"
BEGUN = "        self.goal, self.arrived, self.began = request, rclpy.task.Future(), self.get_clock().now()\n"
AWAIT = "        response.success = await self.arrived\n"
TAKEN = "        response.time_taken = (self.get_clock().now() - self.began).nanoseconds / 1e9\n"
LOG = '        self.get_logger().info(f"Goal: ({request.x:.2f}, {request.y:.2f})")\n'
BUSY = "if self.goal or not ("
NODE = """\
%%writefile -a workspace/src/robot_controller/robot_controller/navigator_node.py

class NavigatorNode(Node):
    def __init__(self):
        super().__init__("navigator")
        self.pose = self.goal = None
        self.commands = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.create_subscription(Pose, "/turtle1/pose", self.on_pose, 1)
        self.create_timer(0.1, self.on_timer)
        group = GROUP
        self.create_service(NavigateTo, "/navigate_to", self.on_goal, callback_group=group)
"""
A_NODE = "self.create_service(NavigateTo"
"""A text that is in the cell with `__init__` alone."""

ANSWERS = {
    "on_arrival": Answers(
        wrong={
            "waits by sleeping": (
                changed(
                    ARRIVAL,
                    (
                        AWAIT,
                        "        import time\n        while self.goal:\n            time.sleep(0.1)\n"
                        "        response.success = True\n",
                    ),
                ),
                "on_goal has not returned",
            ),
            "waits without sleeping": (
                changed(
                    ARRIVAL, (AWAIT, "        while self.goal:\n            pass\n        response.success = True\n")
                ),
                "on_goal has not returned",
            ),
            "spins in the callback": (
                changed(
                    ARRIVAL,
                    ("async def", "def"),
                    (
                        AWAIT,
                        "        rclpy.spin_until_future_complete(self, self.arrived)\n        response.success = True\n",
                    ),
                ),
                "no answer to the goal (5.00, 4.80)",
            ),
            "no await": (changed(ARRIVAL, ("await self.arrived", "self.arrived")), "AssertionError"),
            "no async": (changed(ARRIVAL, ("async def", "def")), "SyntaxError"),
            "no group of its own": (
                Answer(ARRIVAL, {A_NODE: NODE.replace("GROUP", "None")}),
                "no answer to the goal",
            ),
            "does not use what comes": (
                changed(ARRIVAL, (AWAIT, "        await self.arrived\n")),
                "success is False",
            ),
            "success is set, the answer comes at once": (
                changed(ARRIVAL, (AWAIT, "        response.success = True\n")),
                "2.92 m from (4.00, 3.00)",
            ),
            "no time": (changed(ARRIVAL, (TAKEN, "")), "it said 0.00 s"),
            "nanoseconds": (changed(ARRIVAL, (" / 1e9", " / 1.0")), "it said 2"),
            "milliseconds": (changed(ARRIVAL, ("1e9", "1e6")), "it said 2"),
            "the time of the answer": (
                changed(
                    ARRIVAL, ("(self.get_clock().now() - self.began).nanoseconds", "self.get_clock().now().nanoseconds")
                ),
                "it said 18000",
            ),
            "turned about": (
                changed(ARRIVAL, ("(self.get_clock().now() - self.began)", "(self.began - self.get_clock().now())")),
                "it said -2.",
            ),
            "begins after the wait": (
                changed(
                    ARRIVAL,
                    (BEGUN, BEGUN.replace(", self.began", "").replace(", self.get_clock().now()", "")),
                    (AWAIT, f"{AWAIT}        self.began = self.get_clock().now()\n"),
                ),
                "it said 0.00 s",
            ),
            "one box for all goals": (
                changed(
                    ARRIVAL,
                    (
                        "self.goal, self.arrived, self.began = request, rclpy.task.Future(), ",
                        "self.goal, self.began = request, ",
                    ),
                    (
                        AWAIT,
                        "        if not hasattr(self, 'arrived'):\n            self.arrived = rclpy.task.Future()\n"
                        + AWAIT,
                    ),
                ),
                "a goal in the west",
            ),
            "refuses nothing": (
                changed(ARRIVAL, (f"        if not ({SENSE}):\n            return response\n", "")),
                "(20, 5, 0): no answer in 5 s",
            ),
            "no return": (changed(ARRIVAL, ("1e9\n        return response", "1e9")), "TypeError"),
        },
        right={
            "a local name for the beginning, too": changed(
                ARRIVAL, (BEGUN, f"{BEGUN}        began = self.began\n"), ("- self.began)", "- began)")
            ),
            "float seconds": changed(
                ARRIVAL,
                ("(self.get_clock().now() - self.began).nanoseconds / 1e9", "now - start"),
                (BEGUN, f"{BEGUN}        start = self.began.nanoseconds * 1e-9\n"),
                (
                    "        response.time_taken",
                    "        now = self.get_clock().now().nanoseconds * 1e-9\n        response.time_taken",
                ),
            ),
            "a group that is not reentrant": Answer(
                ARRIVAL, {A_NODE: NODE.replace("GROUP", "rclpy.callback_groups.MutuallyExclusiveCallbackGroup()")}
            ),
            "the result of the future": changed(
                ARRIVAL, (AWAIT, "        await self.arrived\n        response.success = self.arrived.result()\n")
            ),
            "by Python's clock": changed(
                ARRIVAL,
                (
                    "self.get_clock().now()\n",
                    "self.get_clock().now()\n        import time\n        start = time.time()\n",
                ),
                ("(self.get_clock().now() - self.began).nanoseconds / 1e9", "time.time() - start"),
            ),
            "waits in a function of its own": changed(
                ARRIVAL, (AWAIT, "        response.success = await self.arrival()\n")
            )
            + "\n    async def arrival(self):\n        return await self.arrived\n",
            "one goal at a time, too": ONE,
        },
    ),
    "one_goal": Answers(
        wrong={
            "the last one wins, the first is told False": (
                changed(
                    ONE,
                    (BUSY, "if not ("),
                    (BEGUN, f"        if self.goal:\n            self.arrived.set_result(False)\n{BEGUN}"),
                ),
                "no answer to (3.00, 9.00) within 0.5 s",
            ),
            "refuses for ever": (
                changed(ONE, (BUSY, "if hasattr(self, 'began') or not (")),
                "success is False, with the turtle at",
            ),
            "stops at the second": (
                changed(
                    ONE,
                    (BUSY, "if not ("),
                    (
                        BEGUN,
                        f"        if self.goal:\n            self.finish(False)\n            return response\n{BEGUN}",
                    ),
                ),
                "m from (9.00, 3.00)",
            ),
            "accepts the second without a drive": (
                changed(
                    ONE,
                    (BUSY, "if not ("),
                    (
                        BEGUN,
                        f"        if self.goal:\n            response.success = True\n            return response\n{BEGUN}",
                    ),
                ),
                "success is True after 0.0",
            ),
            "waits for the first": (
                changed(
                    ONE,
                    (BUSY, "if not ("),
                    (BEGUN, f"        if self.goal:\n            await self.arrived\n{BEGUN}"),
                ),
                "no answer to (3.00, 9.00) within 0.5 s",
            ),
            "the wrong way round": (changed(ONE, ("self.goal or not", "not self.goal or not")), "answered at once"),
            "and for or": (changed(ONE, ("self.goal or not", "self.goal and not")), "no answer to (3.00, 9.00)"),
            "too late": (
                changed(
                    ONE,
                    (BUSY, "if not ("),
                    (
                        "        self.on_timer()\n",
                        "        if self.goal:\n            return response\n        self.on_timer()\n",
                    ),
                ),
                "answered at once",
            ),
            "nonsense is accepted": (
                changed(ONE, (f"{BUSY}{SENSE}):", "if self.goal:")),
                "(20, 5, 0): no answer in 5 s",
            ),
            "only the same goal is refused": (
                changed(ONE, (BUSY, "if self.goal == request or not (")),
                "no answer to (3.00, 9.00)",
            ),
            "raises": (
                changed(ONE, (BUSY, "assert self.goal is None\n        if not (")),
                "AssertionError",
            ),
        },
        right={
            "is not None": changed(ONE, ("self.goal or not", "self.goal is not None or not")),
            "a test of its own": changed(ONE, (BUSY, "if self.goal:\n            return response\n        if not (")),
            "a flag": changed(
                ONE,
                (BUSY, "if getattr(self, 'busy', False) or not ("),
                ("        self.on_timer()\n", "        self.busy = True\n        self.on_timer()\n"),
                (AWAIT, f"{AWAIT}        self.busy = False\n"),
            ),
            "by the future": changed(ONE, (BUSY, "if (hasattr(self, 'arrived') and not self.arrived.done()) or not (")),
            "and says why": changed(
                ONE,
                (
                    BUSY,
                    "if self.goal:\n            self.get_logger().warning('busy')\n            return response\n"
                    "        if not (",
                ),
            ),
        },
    ),
}
