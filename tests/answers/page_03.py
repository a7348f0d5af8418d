"""Answers to the exercises of page 03: the blind navigator, the short way, and a navigator that refuses nonsense."""

from __future__ import annotations

from . import Answers, changed, solution

BLIND = solution("03_navigator", "simple_navigator")
SHORT = solution("03_navigator", "short_way")
CAREFUL = solution("03_navigator", "navigator")

LOOP = """\
        began, command = time.time(), Twist()
        command.linear.x = 0.5
        while time.time() < began + math.hypot(request.x - 5.544, request.y - 5.544) / 0.5:
            self.commands.publish(command)
            time.sleep(0.1)
        self.commands.publish(Twist())
        response.time_taken = time.time() - began
"""

ANSWERS = {
    "simple_navigator": Answers(
        wrong={
            "the first navigator as it is": (
                changed(
                    BLIND, (f"    def on_goal(self, request, response):\n{LOOP}        return response\n", "    pass\n")
                ),
                "time_taken is 46.90 s",
            ),
            "from (0, 0)": (
                changed(BLIND, ("request.x - 5.544, request.y - 5.544", "request.x, request.y")),
                "time_taken is 18.80 s",
            ),
            "at 0.2 m/s": (changed(BLIND, ("linear.x = 0.5", "linear.x = 0.2"), (") / 0.5:", ") / 0.2:")), "is 10.0"),
            "drives at 0.2 m/s, calculates with 0.5": (
                changed(BLIND, ("linear.x = 0.5", "linear.x = 0.2")),
                "it drove 0.8",
            ),
            "multiplies by the speed": (changed(BLIND, (") / 0.5:", ") * 0.5:")), "time_taken is 1.0"),
            "x alone": (
                changed(BLIND, ("math.hypot(request.x - 5.544, request.y - 5.544)", "abs(request.x - 5.544)")),
                "time_taken is 0.0",
            ),
            "x plus y": (
                changed(
                    BLIND,
                    (
                        "math.hypot(request.x - 5.544, request.y - 5.544)",
                        "(abs(request.x - 5.544) + abs(request.y - 5.544))",
                    ),
                ),
                "time_taken is 4.0",
            ),
            "a constant": (
                changed(BLIND, ("math.hypot(request.x - 5.544, request.y - 5.544) / 0.5", "4.0")),
                "the answer came after 4.0",
            ),
            "no stop": (changed(BLIND, ("        self.commands.publish(Twist())\n", "")), "it was 0.50 m/s"),
            "one command": (
                changed(
                    BLIND,
                    ("            self.commands.publish(command)\n", ""),
                    ("        while", "        self.commands.publish(command)\n        while"),
                ),
                "it drove 0.5",
            ),
            "one command a second": (changed(BLIND, ("sleep(0.1)", "sleep(1.0)")), "the longest gap was 1000 ms"),
            "no time_taken": (
                changed(BLIND, ("        response.time_taken = time.time() - began\n", "")),
                "time_taken is 0.00 s",
            ),
            "the distance as time_taken": (
                changed(BLIND, ("time.time() - began\n", "math.hypot(request.x - 5.544, request.y - 5.544)\n")),
                "time_taken is 2.00 s",
            ),
            "believes that it is at the last goal": (
                changed(
                    BLIND,
                    ("request.x - 5.544, request.y - 5.544", "request.x - self.x, request.y - self.y"),
                    (
                        "        return response",
                        "        self.x, self.y = request.x, request.y\n        return response",
                    ),
                    ("navigator = BlindNavigator()", "navigator = BlindNavigator()\nnavigator.x = navigator.y = 5.544"),
                ),
                "time_taken is 4.50 s",
            ),
            "no sleep": (changed(BLIND, ("            time.sleep(0.1)\n", "")), "on_goal has not returned"),
            "no return": (changed(BLIND, ("        return response\n", "")), "TypeError"),
            "sideways": (changed(BLIND, ("command.linear.x", "command.linear.y")), "it drove 2.0"),
            "backwards": (changed(BLIND, ("linear.x = 0.5", "linear.x = -0.5")), "to (3.5"),
        },
        right={
            "counts its commands": changed(
                BLIND,
                (
                    "while time.time() < began + math.hypot(request.x - 5.544, request.y - 5.544) / 0.5:",
                    "for _ in range(round(math.hypot(request.x - 5.544, request.y - 5.544) / 0.5 / 0.1)):",
                ),
            ),
            "by the robot's clock": changed(
                BLIND,
                (
                    "began, command = time.time(), Twist()",
                    "began, command = self.get_clock().now().nanoseconds, Twist()",
                ),
                ("time.time() < began +", "(self.get_clock().now().nanoseconds - began) / 1e9 <"),
                ("time.time() - began", "(self.get_clock().now().nanoseconds - began) / 1e9"),
            ),
            "by the monotonic clock, twenty commands a second": changed(
                BLIND.replace("time.time()", "time.monotonic()"), ("sleep(0.1)", "sleep(0.05)")
            ),
            "says what it planned": changed(
                BLIND,
                ("time.time() - began\n", "math.hypot(request.x - 5.544, request.y - 5.544) / 0.5\n"),
            ),
            "start and speed in __init__": changed(
                BLIND,
                (
                    "    def on_goal",
                    "    def __init__(self):\n        super().__init__()\n"
                    "        self.start, self.speed = (5.544, 5.544), 0.5\n\n"
                    "    def on_goal",
                ),
                (
                    "math.hypot(request.x - 5.544, request.y - 5.544) / 0.5",
                    "math.dist(self.start, (request.x, request.y)) / self.speed",
                ),
                ("linear.x = 0.5", "linear.x = self.speed"),
            ),
            "answers success, too": changed(
                BLIND, ("        return response", "        response.success = True\n        return response")
            ),
        },
    ),
    "short_way": Answers(
        wrong={
            "too large is put right, too small is not": (
                changed(
                    SHORT,
                    (
                        "    return math.remainder(wanted - heading, math.tau)\n",
                        "    d = wanted - heading\n    if d > math.pi:\n        d -= math.tau\n    return d\n",
                    ),
                ),
                "turn_to(-3.13, 3.13) is -6.26, not 0.0232",
            ),
            "too small is put right, too large is not": (
                changed(
                    SHORT,
                    (
                        "    return math.remainder(wanted - heading, math.tau)\n",
                        "    d = wanted - heading\n    if d < -math.pi:\n        d += math.tau\n    return d\n",
                    ),
                ),
                "turn_to(3.13, -3.13) is 6.26, not -0.0232",
            ),
            "both, but one whole turn only": (
                changed(
                    SHORT,
                    (
                        "    return math.remainder(wanted - heading, math.tau)\n",
                        "    d = wanted - heading\n    if d < -math.pi:\n        d += math.tau\n    if d > math.pi:\n"
                        "        d -= math.tau\n    return d\n",
                    ),
                ),
                "turn_to(9.0, -3.0) is 5.7168",
            ),
            "half a turn is added": (
                changed(
                    SHORT,
                    (
                        "    return math.remainder(wanted - heading, math.tau)\n",
                        "    d = wanted - heading\n    while d < -math.pi:\n        d += math.pi\n    while d > math.pi:\n"
                        "        d -= math.pi\n    return d\n",
                    ),
                ),
                "not 0.0232",
            ),
            "degrees": (changed(SHORT, ("wanted - heading, math.tau", "wanted - heading, 360")), "is -6.26, not"),
            "from 0 to 2π": (
                changed(SHORT, ("math.remainder(wanted - heading, math.tau)", "(wanted - heading) % math.tau")),
                "turn_to(0.5, 1.0) is 5.78",
            ),
            "fmod": (changed(SHORT, ("math.remainder", "math.fmod")), "turn_to(-3.13, 3.13) is -6.26"),
            "by half turns": (changed(SHORT, ("math.tau", "math.pi")), "turn_to(-1.0, 1.0) is 1.14"),
            "the other way round": (
                changed(SHORT, ("wanted - heading", "heading - wanted")),
                "turn_to(1.0, 0.5) is -0.5, not 0.5",
            ),
            "its size alone": (
                changed(
                    SHORT,
                    ("math.remainder(wanted - heading, math.tau)", "abs(math.remainder(wanted - heading, math.tau))"),
                ),
                "turn_to(0.5, 1.0) is 0.5, not -0.5",
            ),
            "each angle by itself": (
                changed(
                    SHORT,
                    (
                        "math.remainder(wanted - heading, math.tau)",
                        "math.remainder(wanted, math.tau) - math.remainder(heading, math.tau)",
                    ),
                ),
                "turn_to(-3.13, 3.13) is -6.26",
            ),
            "the examples by heart": (
                changed(
                    SHORT,
                    (
                        "    return math.remainder",
                        "    if (wanted, heading) == (-3.13, 3.13):\n        return math.tau - 6.26\n"
                        "    if (wanted, heading) == (9.0, -3.0):\n        return 12.0 - 2 * math.tau\n"
                        "    return wanted - heading\n    return math.remainder",
                    ),
                ),
                "turn_to(-2.0, 2.0) is -4.0",
            ),
            "no return": (changed(SHORT, ("    return math.remainder", "    math.remainder")), "TypeError"),
            "rounded": (
                changed(
                    SHORT,
                    (
                        "math.remainder(wanted - heading, math.tau)",
                        "round(math.remainder(wanted - heading, math.tau), 2)",
                    ),
                ),
                "is 0.02, not 0.0232",
            ),
            "prints": (
                changed(SHORT, ("    return math", "    print(wanted - heading)\n    return 0.0 * math")),
                "is 0.0, not 0.5",
            ),
        },
        right={
            "loops": changed(
                SHORT,
                (
                    "    return math.remainder(wanted - heading, math.tau)\n",
                    "    d = wanted - heading\n    while d < -math.pi:\n        d += 2 * math.pi\n    while d > math.pi:\n"
                    "        d -= 2 * math.pi\n    return d\n",
                ),
            ),
            "by sine and cosine": changed(
                SHORT,
                (
                    "math.remainder(wanted - heading, math.tau)",
                    "math.atan2(math.sin(wanted - heading), math.cos(wanted - heading))",
                ),
            ),
            "by the rest of a division": changed(
                SHORT,
                (
                    "math.remainder(wanted - heading, math.tau)",
                    "(wanted - heading + math.pi) % (2 * math.pi) - math.pi",
                ),
            ),
            "by rounding": changed(
                SHORT,
                (
                    "math.remainder(wanted - heading, math.tau)",
                    "wanted - heading - math.tau * round((wanted - heading) / math.tau)",
                ),
            ),
            "a lambda": changed(
                SHORT,
                (
                    "def turn_to(wanted, heading):\n    return math.remainder(wanted - heading, math.tau)\n",
                    "turn_to = lambda wanted, heading: math.remainder(wanted - heading, 2 * math.pi)\n",
                ),
            ),
            "calls itself": changed(
                SHORT,
                (
                    "    return math.remainder(wanted - heading, math.tau)\n",
                    "    if abs(wanted - heading) > math.pi:\n"
                    "        return turn_to(wanted - math.copysign(math.tau, wanted - heading), heading)\n"
                    "    return wanted - heading\n",
                ),
            ),
            "by complex numbers": changed(
                SHORT,
                (
                    "    return math.remainder(wanted - heading, math.tau)\n",
                    "    import cmath\n    return cmath.phase(cmath.exp(1j * (wanted - heading)))\n",
                ),
            ),
        },
    ),
    "navigator": Answers(
        wrong={
            "x alone": (changed(CAREFUL, (" and 0.0 <= request.y <= 11.09", "")), "(5, 20, 0): success is True"),
            "y alone": (changed(CAREFUL, (" and 0.0 <= request.x <= 11.09", "")), "(20, 5, 0): success is True"),
            "the upper end alone": (
                changed(
                    CAREFUL, ("0.0 <= request.x <= 11.09 and 0.0 <= request.y", "request.x <= 11.09 and request.y")
                ),
                "(-1, 5, 0): success is True",
            ),
            "theta is not looked at": (
                changed(CAREFUL, ("(request.x, request.y, request.theta)", "(request.x, request.y)")),
                "(5, 6, nan): success is True",
            ),
            "nan alone": (
                changed(
                    CAREFUL,
                    (
                        "all(map(math.isfinite, (request.x, request.y, request.theta)))",
                        "not any(map(math.isnan, (request.x, request.y, request.theta)))",
                    ),
                ),
                "(5, 6, inf): success is True",
            ),
            "comparisons that let nan pass": (
                changed(
                    CAREFUL,
                    (
                        "if finite and 0.0 <= request.x <= 11.09 and 0.0 <= request.y <= 11.09:",
                        "if not (request.x < 0 or request.x > 11.09 or request.y < 0 or request.y > 11.09):",
                    ),
                ),
                "(nan, 5, 0): success is True",
            ),
            "the ends are refused": (
                changed(
                    CAREFUL,
                    ("0.0 <= request.x <= 11.09 and 0.0 <= request.y", "0.0 < request.x < 11.09 and 0.0 < request.y"),
                ),
                "(0, 0, -2.3): success is False",
            ),
            "up to 11": (
                changed(CAREFUL, ("request.x <= 11.09", "request.x <= 11")),
                "(11.08, 11.08, 0.8): success is False",
            ),
            "up to 12": (changed(CAREFUL, ("request.x <= 11.09", "request.x <= 12")), "(11.2, 5, 0): success is True"),
            "theta from −π to π": (
                changed(CAREFUL, ("if finite and", "if finite and abs(request.theta) <= math.pi and")),
                "(6.5, 5.5, 7): success is False",
            ),
            "or for and": (changed(CAREFUL, ("11.09 and 0.0", "11.09 or 0.0")), "(20, 5, 0): success is True"),
            "keeps the goal first": (
                changed(
                    CAREFUL,
                    ("            self.goal = request\n", ""),
                    ("        finite", "        self.goal = request\n        finite"),
                ),
                "refuses",
            ),
            "forgets its goal": (
                changed(
                    CAREFUL,
                    ("        return response", "        else:\n            self.goal = None\n        return response"),
                ),
                "it still gets there",
            ),
            "no log": (
                changed(
                    CAREFUL, ('            self.get_logger().info(f"Goal: ({request.x:.2f}, {request.y:.2f})")\n', "")
                ),
                "no line of its log",
            ),
            "logs x alone": (
                changed(CAREFUL, ("({request.x:.2f}, {request.y:.2f})", "{request.x:.2f}")),
                "no line of its log",
            ),
            "refuses everything": (changed(CAREFUL, ("if finite", "if not finite")), "success is False after"),
            "no success": (changed(CAREFUL, ("            response.success = True\n", "")), "success is False after"),
            "raises": (
                changed(
                    CAREFUL,
                    (
                        "        return response",
                        '        else:\n            raise ValueError("nonsense")\n        return response',
                    ),
                ),
                "ValueError: nonsense",
            ),
            "no answer to nonsense": (
                changed(CAREFUL, ("        return response", "            return response")),
                "no answer in 5 s",
            ),
        },
        right={
            "returns early": changed(
                CAREFUL,
                (
                    "        if finite and 0.0 <= request.x <= 11.09 and 0.0 <= request.y <= 11.09:\n",
                    "        if not finite or not 0 <= request.x <= 11.09 or not 0 <= request.y <= 11.09:\n"
                    '            self.get_logger().warning("refused")\n            return response\n        if True:\n',
                ),
            ),
            "one by one": changed(
                CAREFUL,
                (
                    "        if finite and 0.0 <= request.x <= 11.09 and 0.0 <= request.y <= 11.09:\n",
                    "        for value in (request.x, request.y):\n            if not 0.0 <= value <= 11.09:\n"
                    "                return response\n        if abs(request.theta) < math.inf:\n",
                ),
            ),
            "says False, and drives on": changed(
                CAREFUL,
                (
                    "        return response",
                    "        else:\n            response.success = False\n        return response",
                ),
            ),
            "to the simulator's very wall": changed(CAREFUL, ("request.x <= 11.09", "request.x <= 11.0901")),
            "a copy of the goal": changed(
                CAREFUL, ("self.goal = request", "self.goal = Pose(x=request.x, y=request.y, theta=request.theta)")
            ),
            "logs it otherwise": changed(
                CAREFUL,
                ('f"Goal: ({request.x:.2f}, {request.y:.2f})"', 'f"x={request.x} y={request.y} theta={request.theta}"'),
            ),
            "logs refused goals, too": changed(
                CAREFUL, ("        finite", '        self.get_logger().info(f"{request}")\n        finite')
            ),
        },
    ),
}
