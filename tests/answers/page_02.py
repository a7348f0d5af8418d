"""Answers to the exercises of page 02."""

from __future__ import annotations

from . import Answer, Answers, changed, solution

PAGE = "02_services_and_interfaces"
ADDER, INTERFACES, ESTIMATOR = (solution(PAGE, name) for name in ("adder", "interfaces", "estimator"))

SUM = "response.sum = request.a + request.b"

PLAIN_ADDER = """
import rclpy
from example_interfaces.srv import AddTwoInts
def add(request, response):
    response.sum = sum((request.a, request.b))
    return response
rclpy.try_shutdown()
rclpy.init()
adder = rclpy.create_node("adder")
adder.create_service(AddTwoInts, "add_two_ints", add)
"""

NAMES = '  "msg/TurtleStatus.msg"\n  "srv/NavigateTo.srv"\n'

SERVICE = """%%writefile workspace/src/robot_controller/srv/NavigateTo.srv
float32 x
float32 y
float32 theta
---
bool success
float32 time_taken
"""


def service(*changes: tuple[str, str]) -> Answer:
    """The right CMakeLists.txt, with another service file."""
    return Answer(INTERFACES, cells={"srv/NavigateTo.srv\nfloat32 x": changed(SERVICE, *changes)})


TEST = "0 <= request.x <= 11.09 and 0 <= request.y <= 11.09"
WAY = "math.hypot(request.x - 5.544445, request.y - 5.544445)"

EARLY_ESTIMATOR = """
import rclpy
from math import sqrt
from rclpy.node import Node
from robot_controller.srv import NavigateTo
MIDDLE, SPEED = 5.544445, 0.2
def inside(value):
    return not (value < 0 or value > 11.09)
class Anything(Node):
    def __init__(self, name):
        super().__init__(name)
        self.service = self.create_service(NavigateTo, "estimate", self.callback)
    def callback(self, request, response):
        if not (inside(request.x) and inside(request.y)):
            return response
        dx, dy = request.x - MIDDLE, request.y - MIDDLE
        response.success, response.time_taken = True, sqrt(dx ** 2 + dy ** 2) / SPEED
        return response
rclpy.try_shutdown()
rclpy.init()
estimator = Anything("estimator")
"""

FRESH_RESPONSE = changed(
    ESTIMATOR,
    (
        f"        response.success = {TEST}\n        if response.success:\n"
        f"            response.time_taken = {WAY} / 0.2\n        return response",
        f"        good = {TEST}\n        seconds = 5 * math.dist((request.x, request.y), (5.544445, 5.544445))\n"
        "        return NavigateTo.Response(success=good, time_taken=seconds if good else 0.0)",
    ),
)

ANSWERS = {
    "adder": Answers(
        wrong={
            "the difference": (changed(ADDER, ("request.a + request.b", "request.a - request.b")), "2 + 3 is 5"),
            "the first one twice": (changed(ADDER, ("request.a + request.b", "request.a + request.a")), "2 + 3 is 5"),
            "the example's sum": (changed(ADDER, ("request.a + request.b", "5")), "−40 + 7 is −33"),
            "without signs": (changed(ADDER, ("request.a + request.b", "abs(request.a) + abs(request.b)")), "47"),
            "the larger one first": (
                changed(ADDER, ("request.a + request.b", "max(request.a, request.b) + abs(min(request.a, request.b))")),
                "47",
            ),
            "no return": (
                changed(ADDER, ("        return response\n", "")),
                "the callback of /add_two_ints returned None",
            ),
            "print instead of sum": (changed(ADDER, (SUM, "print(request.a + request.b)")), "2 + 3 is 5"),
            "a float": (
                changed(ADDER, ("request.a + request.b", "float(request.a + request.b)")),
                "line 9 in on_request",
            ),
            "a callback without response": (
                changed(
                    ADDER,
                    ("self, request, response", "self, request"),
                    (SUM, "return request.a + request.b"),
                    ("        return response\n", ""),
                ),
                "on_request() takes 2 positional arguments",
            ),
            "another service": (changed(ADDER, ("/add_two_ints", "/add_two_int")), "/add_two_int"),
            "another node": (changed(ADDER, ('"adder"', '"doorbell"')), "/doorbell"),
            "the doorbell's type": (
                changed(
                    ADDER,
                    ("from example_interfaces.srv import AddTwoInts", "from std_srvs.srv import Trigger"),
                    ("AddTwoInts,", "Trigger,"),
                ),
                "std_srvs/srv/Trigger",
            ),
            "sleeps for ever": (
                changed(ADDER, (SUM, "import time; time.sleep(1000)")),
                "on_request has not returned",
            ),
        },
        right={
            "functions": PLAIN_ADDER,
            "a fresh response": changed(
                ADDER,
                (
                    f"        {SUM}\n        return response",
                    "        return AddTwoInts.Response(sum=request.a + request.b)",
                ),
            ),
            "a lambda's helper": changed(
                ADDER, ("self.on_request)", "lambda request, response: self.on_request(request, response))")
            ),
            "an answer that takes a second": changed(ADDER, (SUM, f"import time; time.sleep(1.0); {SUM}")),
            "it prints, too": changed(ADDER, (SUM, f"{SUM}; self.get_logger().info('added')")),
        },
    ),
    "interfaces": Answers(
        wrong={
            "a comma": (
                changed(INTERFACES, ('TurtleStatus.msg"', 'TurtleStatus.msg",')),
                "What does colcon build say?",
            ),
            "no folder": (
                changed(INTERFACES, ("srv/NavigateTo.srv", "NavigateTo.srv")),
                "does not name srv/NavigateTo.srv",
            ),
            "no suffix": (changed(INTERFACES, ("NavigateTo.srv", "NavigateTo")), "does not name srv/NavigateTo.srv"),
            "in place of the message": (changed(INTERFACES, ('  "msg/TurtleStatus.msg"\n', "")), "TurtleStatus"),
            "below the bracket": (
                changed(
                    INTERFACES,
                    (NAMES, '  "msg/TurtleStatus.msg"\n'),
                    (")\n\nament_package", ')\n"srv/NavigateTo.srv"\nament_package'),
                ),
                "What does colcon build say?",
            ),
            "no bracket": (changed(INTERFACES, (f"{NAMES})", NAMES)), "What does colcon build say?"),
            "doubles": (service(("float32", "float64")), "float64 x"),
            "y before x": (service(("float32 x\nfloat32 y", "float32 y\nfloat32 x")), "float32 y, float32 x"),
            "no theta": (service(("float32 theta\n", "")), "it has float32 x, float32 y"),
            "no dashes": (service(("---\n", "")), "What does colcon build say?"),
            "request and response swapped": (
                service(
                    (
                        "float32 x\nfloat32 y\nfloat32 theta\n---\nbool success\nfloat32 time_taken",
                        "bool success\nfloat32 time_taken\n---\nfloat32 x\nfloat32 y\nfloat32 theta",
                    )
                ),
                "it has bool success",
            ),
            "another name in the response": (service(("time_taken", "time")), "float32 time"),
            "success as a number": (service(("bool success", "int32 success")), "int32 success"),
        },
        right={
            "on one line": changed(INTERFACES, (NAMES, '  "msg/TurtleStatus.msg" "srv/NavigateTo.srv"\n')),
            "without quotes": changed(INTERFACES, (NAMES, "  msg/TurtleStatus.msg srv/NavigateTo.srv\n")),
            "the service first": changed(INTERFACES, (NAMES, '  "srv/NavigateTo.srv"\n  "msg/TurtleStatus.msg"\n')),
            "a variable": changed(
                INTERFACES,
                ("rosidl_generate", 'set(types "msg/TurtleStatus.msg" "srv/NavigateTo.srv")\nrosidl_generate'),
                (NAMES, "  ${types}\n"),
            ),
            "the package's name": changed(INTERFACES, ("${PROJECT_NAME}", "robot_controller")),
            "with comments": changed(INTERFACES, (NAMES, f"  # one line each\n{NAMES}")),
            "a service with comments": service(("float32 x\n", "# metres\nfloat32 x\n"), ("---\n", "\n---\n\n")),
        },
    ),
    "estimator": Answers(
        wrong={
            "x against the right edge, y against the lower": (
                changed(ESTIMATOR, (TEST, "request.x <= 11.09 and request.y >= 0")),
                "(−0.5, 5) is outside",
            ),
            "strict bounds": (
                changed(ESTIMATOR, (TEST, "0 < request.x < 11.09 and 0 < request.y < 11.09")),
                "on the left edge",
            ),
            "x alone": (changed(ESTIMATOR, (TEST, "0 <= request.x <= 11.09")), "(5, −0.5) is outside"),
            "y alone": (changed(ESTIMATOR, (TEST, "0 <= request.y <= 11.09")), "(−0.5, 5) is outside"),
            "or": (changed(ESTIMATOR, (" and ", " or ")), "(−0.5, 5) is outside"),
            "up to 11": (changed(ESTIMATOR, ("11.09", "11")), "in the corner"),
            "never refused": (changed(ESTIMATOR, (TEST, "True")), "(−0.5, 5) is outside"),
            "a time outside, too": (
                changed(ESTIMATOR, ("        if response.success:\n            response", "        response")),
                "(−0.5, 5) is outside",
            ),
            "half a metre a second": (changed(ESTIMATOR, ("/ 0.2", "/ 0.5")), "3 m ahead take 15 s"),
            "times the speed": (changed(ESTIMATOR, ("/ 0.2", "* 0.2")), "3 m ahead take 15 s"),
            "the distance": (changed(ESTIMATOR, (" / 0.2", "")), "3 m ahead take 15 s"),
            "from the corner": (changed(ESTIMATOR, (" - 5.544445", "")), "3 m ahead take 15 s"),
            "x alone in the distance": (changed(ESTIMATOR, (WAY, "abs(request.x - 5.544445)")), "5 m aslant take 25 s"),
            "along the axes": (
                changed(ESTIMATOR, (WAY, "(abs(request.x - 5.544445) + abs(request.y - 5.544445))")),
                "5 m aslant take 25 s",
            ),
            "without a sign's care": (
                changed(ESTIMATOR, (WAY, "(request.x - 5.544445 + request.y - 5.544445)")),
                "5 m aslant take 25 s",
            ),
            "the example's time": (changed(ESTIMATOR, (f"{WAY} / 0.2", "15.0")), "5 m aslant take 25 s"),
            "no success": (
                changed(ESTIMATOR, ("response.success = ", "good = "), ("if response.success", "if good")),
                "3 m ahead take 15 s",
            ),
            "another service": (changed(ESTIMATOR, ('"/estimate"', '"/navigate_to"')), "no node does"),
            "no return": (
                changed(ESTIMATOR, ("        return response\n", "")),
                "the callback of /estimate returned None",
            ),
            "an error": (changed(ESTIMATOR, ("math.hypot", "math.hypo")), "hypo"),
        },
        right={
            "with an early return": EARLY_ESTIMATOR,
            "a fresh response": FRESH_RESPONSE,
            "the middle by the world's size": changed(ESTIMATOR, ("5.544445", "(11.08889 / 2)")),
            "limits in a list": changed(
                ESTIMATOR, (TEST, "all(0.0 <= each <= 11.09 for each in (request.x, request.y))")
            ),
            "the world's exact size": changed(ESTIMATOR, ("11.09", "11.088889")),
        },
    ),
}
