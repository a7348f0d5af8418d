"""Page 06: parameters that are really read, a launch file with arguments, and two configurations side by side."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ..words import listed
from . import page_03, page_04, page_05
from .assertions import get_parameter, gives_up, no_errors, node, parameter, publishes, rate_follows
from .navigation import COMMANDS, NAVIGATE, ask_for, far_away, where
from .probe import Answer, Probe, remembered
from .registry import Expectation, check
from .results import CannotLook, Seen, hinted
from .streams import rate

STATUS, STATUS_TYPE = page_04.STATUS, page_04.STATUS_TYPE
SCAN, SCAN_TYPE = page_05.SCAN, page_05.SCAN_TYPE
PACKAGE, FILE = "robot_controller", "start_system.launch.py"
LAUNCH = f"ros2 launch {PACKAGE} {FILE}"


@check(
    "parameters", points=5, limit=60, learnt="A parameter that is read where it is used can be set while the node runs."
)
def parameters() -> list[Expectation]:
    """A status monitor whose rate follows its parameter."""
    return [
        node("/status_monitor", page_04.RUN),
        publishes(STATUS, STATUS_TYPE, by="/status_monitor"),
        parameter("/status_monitor", "publish_rate", 10),
        rate(STATUS, STATUS_TYPE, hz=10),
        *(rate_follows("/status_monitor", "publish_rate", value, STATUS, STATUS_TYPE) for value in (20, 4, 40)),
        no_errors(),
    ]


# -- the system ----------------------------------------------------------------------------------------------------------


def system_is_there() -> list[Expectation]:
    """The three nodes, and what each of them is for."""
    return [
        *page_03.navigator_is_there(LAUNCH),
        node("/status_monitor", LAUNCH),
        publishes(STATUS, STATUS_TYPE, by="/status_monitor"),
        node("/obstacle_detector", LAUNCH),
        publishes(SCAN, SCAN_TYPE, by="/obstacle_detector"),
    ]


@check("launch", points=5, limit=60, learnt="One command starts a whole system, and its arguments set it up.")
def launch() -> list[Expectation]:
    """One command has started all three nodes, and its arguments become their parameters."""
    return [
        *system_is_there(),
        only({"/navigator", "/status_monitor", "/obstacle_detector", "/turtlesim"}),
        parameter("/navigator", "goal_timeout", 5.0),
        parameter("/status_monitor", "publish_rate", 10),
        parameter("/obstacle_detector", "scan_rate", 5),
        rate(STATUS, STATUS_TYPE, hz=10),
        rate(SCAN, SCAN_TYPE, hz=5),
        *(
            Expectation(f"{name}:={value} reaches /{owner}", _argument_reaches(owner, name, value))
            for owner, name, value in ARGUMENTS
        ),
        gives_up("/navigator", "goal_timeout", 0.5, _far_goal),
        rate_follows("/obstacle_detector", "scan_rate", 10, SCAN, SCAN_TYPE),
        no_errors(),
    ]


ARGUMENTS: tuple[tuple[str, str, int | float], ...] = (
    ("navigator", "goal_timeout", 3.5),
    ("status_monitor", "publish_rate", 25),
    ("obstacle_detector", "scan_rate", 8),
)
"""What a second launch is given: owner, name and value, none of which is a default."""


def _far_goal(probe: Probe) -> Answer:
    return ask_for(probe, far_away(where(probe)), 25.0)


def only(wanted: set[str]) -> Expectation:
    """These nodes and no others, each once."""

    def look(probe: Probe) -> Seen:
        found = probe.nodes()
        more = [f"{amount} × {name}" if amount > 1 else name for name, amount in found.items()]
        extra = [text for text, name in zip(more, found, strict=True) if name not in wanted or found[name] > 1]
        advice = "Nothing else was asked for: what does the launch file start, and what ran before?"
        return Seen(not extra, f"there is {listed(extra)}, too" if extra else "none", advice)

    return Expectation("no other node", look)


def _argument_reaches(owner: str, name: str, value: int | float) -> Callable[[Probe], Seen]:
    """Whether the parameter has the value of the argument, when the launch file is started with it."""

    def look(probe: Probe) -> Seen:
        found = _launch_again(probe)
        if isinstance(found, str):
            return Seen(False, found, "Read the error from its last line up.")
        if found[owner] is None:
            raise CannotLook(f"there is no node /{owner}")
        advice = hinted(
            f"Where does the launch file declare {name}, and where does it hand the value on?",
            "Open Hints 1 and 2 under the exercise.",
        )
        good = type(found[owner]) is type(value) and found[owner] == value
        return Seen(good, f"{name} is {found[owner]!r} then", advice)

    return look


@remembered
def _launch_again(probe: Probe) -> dict[str, Any] | str:
    """The nodes' parameters in a second launch with other arguments, beside the first; or why it was refused."""
    from ...ros.launching import LaunchError

    apart = "exam"
    renamed = {name: f"/{apart}{name}" for name in (STATUS, SCAN, NAVIGATE, COMMANDS)}
    arguments = {name: value for _, name, value in ARGUMENTS}
    try:
        with probe.target.launched(PACKAGE, FILE, apart, renamed, arguments):
            there = probe.nodes()
            return {
                owner: get_parameter(probe, f"/{apart}/{owner}", name) if f"/{apart}/{owner}" in there else None
                for owner, name, _ in ARGUMENTS
            }
    except LaunchError as error:
        return f"the launch file was refused: {' '.join(str(error).split())[:160]}"


# -- side by side ------------------------------------------------------------------------------------------------------

SIDES = {"slow": 5, "fast": 20}
"""The namespaces of the two monitors, and the rate (Hz) of each."""


@check("side_by_side", points=4, limit=20, learnt="Namespaces and remapped names let one program run many times.")
def side_by_side() -> list[Expectation]:
    """Two status monitors, each with its own namespace, topic and rate."""
    return [
        *(Expectation(f"one node /{side}/status_monitor", _is_there(side)) for side in SIDES),
        only({"/slow/status_monitor", "/fast/status_monitor", "/turtlesim"}),
        *(publishes(f"/{side}{STATUS}", STATUS_TYPE, by=f"/{side}/status_monitor") for side in SIDES),
        Expectation(f"no node publishes {STATUS}", _none_does),
        *(parameter(f"/{side}/status_monitor", "publish_rate", hz) for side, hz in SIDES.items()),
        *(_comes_at(f"/{side}{STATUS}", hz) for side, hz in SIDES.items()),
        no_errors(),
    ]


def _is_there(side: str) -> Callable[[Probe], Seen]:
    def look(probe: Probe) -> Seen:
        found = probe.nodes()
        monitors = listed([f"{found[name]} × {name}" for name in found if name.endswith("status_monitor")])
        advice = hinted(
            "What does each Node say about its namespace? A launch that failed says why in its output above.", 1
        )
        there = found[f"/{side}/status_monitor"] == 1
        return Seen(there, "it is there" if there else f"there is {monitors or 'no monitor'}", advice)

    return look


def _none_does(probe: Probe) -> Seen:
    owners = [owner for owner, _ in probe.publishers(STATUS)]
    advice = hinted(
        f"{STATUS} is an absolute name, which a namespace does not change. What replaces a name at the start?", 2
    )
    return Seen(
        not owners, f"{listed(owners)} {'do' if len(owners) > 1 else 'does'}" if owners else "none does", advice
    )


def _comes_at(topic: str, hz: int) -> Expectation:
    return Expectation(f"{topic} comes at {hz} Hz", rate(topic, STATUS_TYPE, hz, within=0.1 / hz, seconds=2.0).look)
