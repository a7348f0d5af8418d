"""Page 02: a service that adds, a package that is built with interfaces of its own, and a service that uses one of them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from .exam import Exam
from .fields import interface
from .parts import no_errors, node, offers
from .questions import answers
from .registry import Expectation, check
from .rows import CannotLook, Seen

PAGE = "02_services_and_interfaces"
ADD = "example_interfaces/srv/AddTwoInts"

STATUS = dict.fromkeys(("x", "y", "theta", "vel_x", "vel_y", "battery"), "float")
GOAL = dict.fromkeys(("x", "y", "theta"), "float")
RESULT = {"success": "boolean", "time_taken": "float"}
"""Fields and types of the lesson's interfaces, as ROS names them: float32 is "float", bool "boolean"."""


@check("adder", page=PAGE, points=3, limit=15)
def adder() -> list[Expectation]:
    """A service that adds."""
    return [
        node("/adder"),
        offers("/add_two_ints", ADD, by="/adder"),
        _adds(2, 3),
        _adds(-40, 7),
    ]


def _adds(a: int, b: int) -> Expectation:
    words = f"{a} + {b} is {a + b}".replace("-", "−")
    step = "response.sum = request.a + request.b, then return response."
    return answers("/add_two_ints", ADD, {"a": a, "b": b}, lambda response: response.sum == a + b, words, step)


NAVIGATE_TYPE = "robot_controller/srv/NavigateTo"


@check("interfaces", page=PAGE, points=4, limit=5)
def interfaces() -> list[Expectation]:
    """The package robot_controller is built and sourced, with its message and its service."""
    return [
        has_fields("robot_controller/msg/TurtleStatus", STATUS),
        has_fields(NAVIGATE_TYPE, GOAL, "request", lambda kind: kind.Request),
        has_fields(NAVIGATE_TYPE, RESULT, "response", lambda kind: kind.Response),
    ]


def has_fields(
    type_name: str, fields: dict[str, str], part: str = "", choose: Callable[[Any], Any] = lambda kind: kind
) -> Expectation:
    """An interface that can be imported and has exactly these fields, in this order."""
    what = f"{type_name}{f' ({part})' if part else ''}"

    def look(exam: Exam) -> Seen:
        package = type_name.split("/")[0]
        try:
            found = dict(choose(interface(type_name)).get_fields_and_field_types())
        except CannotLook as reason:
            step = (
                f"colcon build --packages-select {package}, then source install/setup.bash; CMakeLists.txt has to name "
                "the file in rosidl_generate_interfaces."
            )
            return Seen(False, str(reason), step)
        step = f"The fields are {_in_words(fields)}, in this order: change the file and build again."
        good = list(found.items()) == list(fields.items())
        return Seen(good, "it has" if good else f"it has {_in_words(found)}", step)

    return Expectation(f"{what.split('/')[-1]}: {' '.join(fields)}", look)


_AS_TYPED = {"float": "float32", "double": "float64", "boolean": "bool"}


def _in_words(fields: dict[str, str]) -> str:
    return ", ".join(f"{_AS_TYPED.get(kind, kind)} {name}" for name, kind in fields.items()) or "no field"


# -- a service of an own type --------------------------------------------------------------------------------------------

MIDDLE = 5.544445
"""Where the turtle starts, m: the middle of its world."""

SPEED = 0.2
"""m/s, as the lesson's navigator drives."""


@check("estimator", page=PAGE, points=4, limit=20)
def estimator() -> list[Expectation]:
    """A service that says how long the way to a goal takes."""
    return [
        node("/estimator"),
        offers("/estimate", NAVIGATE_TYPE, by="/estimator"),
        _estimates("3 m ahead take 15 s", MIDDLE + 3.0, MIDDLE, 15.0),
        _estimates("5 m aslant take 25 s", MIDDLE - 3.0, MIDDLE - 4.0, 25.0),
        _estimates("where it stands: 0 s", MIDDLE, MIDDLE, 0.0),
        *(_declines(x, y) for x, y in ((20.0, 5.0), (5.0, -1.0))),
        no_errors(),
    ]


def _estimates(words: str, x: float, y: float, seconds: float) -> Expectation:
    step = f"response.success = True, response.time_taken = math.hypot(dx, dy) / {SPEED:g}; dx, dy from the middle."
    return answers(
        "/estimate",
        NAVIGATE_TYPE,
        {"x": x, "y": y},
        lambda response: response.success and abs(response.time_taken - seconds) < 0.05,
        words,
        step,
    )


def _declines(x: float, y: float) -> Expectation:
    step = "Look whether 0 ≤ x ≤ 11.09 and 0 ≤ y ≤ 11.09; if not, success is False and time_taken 0.0."
    return answers(
        "/estimate",
        NAVIGATE_TYPE,
        {"x": x, "y": y},
        lambda response: not response.success and response.time_taken == 0.0,
        f"({x:g}, {y:g}) is outside: success is False".replace("-", "−"),
        step,
    )
