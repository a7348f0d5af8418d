"""Page 02: a service that adds, a package that is built with interfaces of its own, and a service that uses one of them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from .assertions import answers, no_errors, node, offers
from .graph_view import interface
from .probe import Probe
from .registry import Expectation, check
from .results import CannotLook, Seen, hinted

ADD = "example_interfaces/srv/AddTwoInts"

STATUS = dict.fromkeys(("x", "y", "theta", "vel_x", "vel_y", "battery"), "float")
GOAL = dict.fromkeys(("x", "y", "theta"), "float")
RESULT = {"success": "boolean", "time_taken": "float"}
"""Fields and types of the lesson's interfaces, as ROS names them: float32 is "float", bool "boolean"."""


@check("adder", points=3, limit=15, learnt="A service answers each request by a callback that returns a response.")
def adder() -> list[Expectation]:
    """A service that adds."""
    sums = ((2, 3), (-40, 7), (7, -40), (3_000_000_000, 1))
    return [
        node("/adder"),
        offers("/add_two_ints", ADD, by="/adder"),
        *(_adds(a, b) for a, b in sums),
        no_errors(),
    ]


def _adds(a: int, b: int) -> Expectation:
    advice = hinted("Which fields does the request have, and which one the response?", 2)
    return answers(
        "/add_two_ints",
        ADD,
        {"a": a, "b": b},
        lambda response: response.sum == a + b,
        f"{a} + {b if b >= 0 else f'({b})'} is {a + b}".replace("-", "−"),
        advice,
    )


NAVIGATE_TYPE = "robot_controller/srv/NavigateTo"


@check("interfaces", points=4, limit=5, learnt="Named, built and sourced: then a type of your own can be used.")
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

    def look(probe: Probe) -> Seen:
        try:
            found = dict(choose(interface(type_name)).get_fields_and_field_types())
        except CannotLook as reason:
            return Seen(False, str(reason), hinted(_cause(type_name), 2))
        good = list(found.items()) == list(fields.items())
        direction = f"The fields are {_in_words(fields)}, in this order. Does the file say so, and was it built since?"
        return Seen(good, "it has" if good else f"it has {_in_words(found)}", direction)

    return Expectation(f"{what.split('/')[-1]}: {' '.join(fields)}", look)


def _cause(type_name: str) -> str:
    """Which of the three causes keeps a type of the learner's package from being found."""
    from ...learner.workspace import workspace

    package, kind, name = type_name.split("/")
    mine, file = workspace(), f"{kind}/{name}.{kind}"
    cmake = mine.package / "CMakeLists.txt"
    if not (mine.package / file).is_file():
        return f"There is no file {file} in the package. What is it called, and where is it?"
    if not cmake.is_file() or file not in cmake.read_text(encoding="utf-8", errors="replace"):
        return f"CMakeLists.txt does not name {file}."
    if not (mine.folder / "install" / package / "share" / package / file).is_file():
        return f"CMakeLists.txt names {file}, but it was not built. What does colcon build say?"
    return f"{file} was built. Was the workspace sourced since then?"


_AS_TYPED = {"float": "float32", "double": "float64", "boolean": "bool"}


def _in_words(fields: dict[str, str]) -> str:
    return ", ".join(f"{_AS_TYPED.get(kind, kind)} {name}" for name, kind in fields.items()) or "no field"


# -- a service of a type of its own --------------------------------------------------------------------------------------

MIDDLE = 5.544445
"""Where the turtle starts, m: the middle of its world."""

SPEED = 0.2
"""m/s, as the lesson's navigator drives."""

NEAR_ENOUGH = 0.05
"""How far an estimate may be off, s."""


@check(
    "estimator",
    points=4,
    limit=20,
    learnt="A service refuses what makes no sense, at once and in a field of its answer.",
)
def estimator() -> list[Expectation]:
    """A service that says how long the way to a goal takes."""
    outside = ((-0.5, 5.0), (11.5, 5.0), (5.0, -0.5), (5.0, 11.5))
    return [
        node("/estimator"),
        offers("/estimate", NAVIGATE_TYPE, by="/estimator"),
        _estimates("3 m ahead take 15 s", MIDDLE + 3.0, MIDDLE, 15.0),
        _estimates("5 m aslant take 25 s", MIDDLE - 3.0, MIDDLE - 4.0, 25.0),
        _estimates("where it stands: 0 s", MIDDLE, MIDDLE, 0.0),
        _estimates("(0, 5.54), on the left edge, takes 27.7 s", 0.0, MIDDLE, MIDDLE / SPEED),
        _estimates("(5.54, 0), on the lower edge, takes 27.7 s", MIDDLE, 0.0, MIDDLE / SPEED),
        _estimates("(11.05, 11.05), in the corner, takes 38.9 s", 11.05, 11.05, 2**0.5 * (11.05 - MIDDLE) / SPEED),
        *(_declines(x, y) for x, y in outside),
        no_errors(),
    ]


def _estimates(words: str, x: float, y: float, seconds: float) -> Expectation:
    advice = hinted(
        "How long is the straight way from the middle, and which goals are in the world?",
        "Open the hints under the exercise.",
    )
    return answers(
        "/estimate",
        NAVIGATE_TYPE,
        {"x": x, "y": y},
        lambda response: response.success and abs(response.time_taken - seconds) < NEAR_ENOUGH,
        words,
        advice,
    )


def _declines(x: float, y: float) -> Expectation:
    return answers(
        "/estimate",
        NAVIGATE_TYPE,
        {"x": x, "y": y},
        lambda response: not response.success and response.time_taken == 0.0,
        f"({x:g}, {y:g}) is outside: success is False, time_taken 0".replace("-", "−"),
        hinted("A goal is inside if both x and y are from 0 to 11.09.", 2),
    )
