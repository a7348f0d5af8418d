"""The troubles: each a symptom, what a well system shows, and the faults behind it, one of which is chosen by chance."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from random import Random
from typing import Any

from ..checks import navigation as nav
from ..checks.assertions import node, publishes, rate, some, subscribes
from ..checks.page_04 import STATUS, STATUS_TYPE
from ..checks.page_05 import SCAN_TYPE
from ..checks.probe import Probe, interface, remembered
from ..checks.registry import Expectation, expectation
from ..checks.results import CannotLook, Seen
from ..words import number, point


@dataclass(frozen=True)
class Program:
    """A node to start, as a launch file would."""

    executable: str
    package: str = "robot_controller"
    name: str = ""
    parameters: dict[str, Any] = field(default_factory=dict)
    remaps: dict[str, str] = field(default_factory=dict)


NAVIGATOR, MONITOR, DETECTOR = Program("navigator"), Program("status_monitor"), Program("obstacle_detector")


@dataclass(frozen=True)
class Fault:
    """What is wrong, and how it comes into the world.

    Attributes:
        cause: what it is, told when it is mended.
        hint: the last hint, which nearly tells it.
        programs: the nodes that run.
        simulator: whether the turtle simulator runs.
        workspace: what is wrong with the workspace `trouble_ws`; nothing if there is none.
    """

    cause: str
    hint: str
    programs: tuple[Program, ...] = ()
    simulator: bool = True
    workspace: str = ""


DRAFT = "robot_draft"
OTHERS = (MONITOR, DETECTOR)


@dataclass(frozen=True)
class Trouble:
    """A symptom and where it may come from.

    Attributes:
        name: by which `lesson.trouble(name=…)` asks for it.
        report: what a user says.
        where, how: the hints: where to look first, then with what.
        expectations: what is so in a well system.
        faults: what it may come from; names and numbers in it are drawn by chance.
    """

    name: str
    report: str
    where: str
    how: str
    expectations: Callable[[], list[Expectation]]
    faults: Callable[[Random], Iterator[Fault]]


# -- what a well system shows ------------------------------------------------------------------------------------------

SLOWEST = 10.0
"""Robot time, s, within which a goal in the turtle's world is reached; a longer goal_timeout mends nothing."""


@expectation("the type {type_name}")
def importable(probe: Probe, type_name: str) -> Seen:
    """A type can be used here."""
    try:
        interface(type_name)
    except CannotLook:
        step = "Named in CMakeLists.txt? Then: colcon build, source install/setup.bash, in the workspace's folder."
        return Seen(False, "no program can use it here", step)
    return Seen(True, "it can be used")


@expectation("{package} is found in {folder}")
def found_in(probe: Probe, folder: str, package: str) -> Seen:
    """A package is found in the workspace of this name, and not elsewhere."""
    from ament_index_python.packages import PackageNotFoundError, get_package_prefix

    try:
        prefix = Path(get_package_prefix(package))
    except PackageNotFoundError:
        return Seen(False, "it is not found at all", "Which step comes after colcon build?")
    if folder in prefix.parts:
        return Seen(True, "it is")
    step = f"Which setup file was sourced? {folder} has one, too."
    return Seen(False, f"it is found in {'/'.join(prefix.parts[-3:])}", step)


def advised(given: Expectation, step: str, after: float = 0.0) -> Expectation:
    """The same expectation, looked at after some time (s), and with another next step: here something is to be found."""

    def look(probe: Probe) -> Seen:
        probe.wait(after)
        return given.look(probe)._replace(advice=step)

    return Expectation(given.expected, look)


def there(name: str, command: str) -> Expectation:
    """One node of this name; `command` starts it."""
    step = (
        f"ros2 node list shows the nodes. One is missing: {command}. There is one too many: jobs and the lines of the "
        "launch tell its pid; kill."
    )
    return advised(node(name), step)


def status_as_specified() -> list[Expectation]:
    """The status: one monitor, the right topic and type, ten messages a second."""
    ends = f"ros2 topic info {STATUS} --verbose; ros2 node info /status_monitor: what does it publish?"
    pace = f"ros2 topic hz {STATUS}. Which node publishes it, and what sets its rate?"
    return [
        there("/status_monitor", "ros2 run robot_controller status_monitor"),
        advised(publishes(STATUS, STATUS_TYPE, by="/status_monitor"), ends),
        # a timer of a second may have begun before its rate was mended
        advised(rate(STATUS, STATUS_TYPE, 10.0), pace, after=1.5),
        status_follows(),
    ]


def drives(*goals: tuple[float, float]) -> list[Expectation]:
    """The navigator drives the turtle to each of these places, and says so."""
    navigator = there("/navigator", "ros2 run robot_controller navigator")
    return [navigator, Expectation(f"{nav.NAVIGATE} answers", _answers), *(reaches(x, y) for x, y in goals)]


@expectation(f"the goal ({{x:.2f}}, {{y:.2f}}) is reached within {SLOWEST:g} s")
def reaches(probe: Probe, x: float, y: float) -> Seen:
    """A goal is answered with success in reasonable time, and the turtle is there."""
    it = _drive_to(probe, x, y)
    if it.answer.response is None:
        return Seen(False, f"no answer in {nav.LONGEST:g} s", 'lesson.plot_timeline("/navigator")')
    success, end = bool(it.response.success), it.end()
    seen = f"success is {success} after {number(it.answer.seconds)} s, at {point(end.x, end.y)}"
    step = "ros2 topic echo /turtle1/cmd_vel during a call: do commands come, how large, how often, from which node?"
    return Seen(success and it.distance() <= nav.NEAR and it.answer.seconds <= SLOWEST, seen, step)


@expectation(f"{nav.COMMANDS}: ten commands a second meanwhile")
def commands_steady(probe: Probe, x: float, y: float) -> Seen:
    """On the way to a goal, commands come ten times a second."""
    it = _drive_to(probe, x, y)
    begin, end = it.moving()
    times = [each.at for each in it.commands if begin - 0.2 <= each.at <= end]
    pause = (times[-1] - times[0]) / (len(times) - 1) if len(times) > 1 else end - begin
    step = 'lesson.plot_timeline("/turtle1/cmd_vel") after a call. Which node publishes them, and what sets its rate?'
    return Seen(pause <= 0.125, f"one every {number(pause)} s on average", step)


def _drive_to(probe: Probe, x: float, y: float) -> nav.Drive:
    """The drive to a place. Raises CannotLook where the navigator does not answer at all."""
    if not _answers(probe).good:
        raise CannotLook(f"{nav.NAVIGATE} does not answer")
    return nav.drive(probe, nav.Way(f"to {x} {y}", None, (x, y, 0.0)))


@remembered
def _answers(probe: Probe) -> Seen:
    """Asked to go where the turtle is, the navigator answers, whether the turtle can move or not."""
    if not probe.servers(nav.NAVIGATE):
        step = "ros2 node list, ros2 service list: is the node there, and does it offer the service under another name?"
        return Seen(False, f"no node offers it{probe.like(nav.NAVIGATE, probe.services())}", step)
    try:
        here = nav.where(probe)
        x, y, theta = here.x, here.y, here.theta
    except CannotLook:
        x, y, theta = 5.5, 5.5, 0.0
    answer = probe.ask(nav.NAVIGATE, nav.NAVIGATE_TYPE, 30.0, x=x, y=y, theta=theta)
    if answer.response is None:
        step = 'lesson.plot_timeline("/navigator"): which callback holds the thread? lesson.plot_sequence().'
        return Seen(False, "no answer in 30 s", step)
    return Seen(True, f"after {number(answer.seconds)} s")


@expectation(f"{STATUS} says where the turtle is")
def status_follows(probe: Probe) -> Seen:
    poses, statuses = probe.listen(nav.POSE, nav.POSE_TYPE), probe.listen(STATUS, STATUS_TYPE)
    probe.wait(0.5)
    if not poses or not statuses:
        raise CannotLook(f"nothing came on {STATUS if poses else nav.POSE}")
    told, true = statuses[-1].message, poses[-1].message
    seen = f"it says {point(told.x, told.y)}, the turtle is at {point(true.x, true.y)}"
    good = math.dist((told.x, told.y), (true.x, true.y)) < 0.3
    step = "ros2 node info /status_monitor: which topic does it hear, and which node publishes that one?"
    return Seen(good, seen, step)


@expectation("the battery falls 1 % a second")
def battery_falls(probe: Probe) -> Seen:
    """The battery falls by a tenth of a percent a message, ten times a second."""
    heard = some(probe, STATUS, STATUS_TYPE, 2.0)
    first, last = heard[0], heard[-1]
    if last is first:
        raise CannotLook(f"only one message came on {STATUS} in 2 s")
    if last.message.battery <= 0.0:
        raise CannotLook("the battery is empty: start the monitor again")
    fall = (first.message.battery - last.message.battery) / (last.at - first.at)
    step = 'lesson.plot_timeline("/status_monitor"): how often is each callback called? ros2 node list: how many?'
    return Seen(abs(fall - 1.0) < 0.1, f"it falls {number(fall, 1)} % a second", step)


# -- the troubles: four of the lesson, and bugs that were found in published teaching code --------------------------------

# A function that yields the faults becomes a trouble by what stands above it.


@partial(
    Trouble,
    "message not found",
    "I copied my package into a new workspace, trouble_ws, and wanted to start the status monitor there. ROS cannot "
    "find robot_controller/msg/TurtleStatus.",
    "A message type is only a text at first. What has to happen before a program can use it?",
    "Go through the three steps in order: CMakeLists.txt, colcon build, source.",
    lambda: [
        found_in("trouble_ws", "robot_controller"),
        importable(STATUS_TYPE),
        importable(nav.NAVIGATE_TYPE),
        *status_as_specified(),
    ],
)
def no_message(chance: Random) -> Iterator[Fault]:
    yield Fault(
        "TurtleStatus.msg was not named in CMakeLists.txt, so nothing was generated from it.",
        "Read trouble_ws/src/robot_controller/CMakeLists.txt: which files does rosidl_generate_interfaces name?",
        workspace="not in CMakeLists.txt",
    )
    yield Fault(
        "The package was written but never built.",
        "There is a src folder in trouble_ws. Is there an install folder?",
        workspace="not built",
    )
    yield Fault(
        "The package was built, but its setup file was not sourced.",
        "All is built in trouble_ws/install. Has this terminal read its setup file?",
        workspace="not sourced",
    )


@partial(
    Trouble,
    "service times out",
    "I call /navigate_to, and no answer ever comes.",
    "Some node has to offer the service, under this name, and its callback has to be called.",
    "ros2 service list, ros2 node info /navigator; then lesson.plot_sequence() after a call.",
    lambda: drives((8.0, 5.5), (5.5, 5.5)),
)
def no_answer(chance: Random) -> Iterator[Fault]:
    wrong = chance.choice(("/navigate", "/navigation/navigate_to", "/go_to", "/robot/navigate_to"))
    yield Fault("The navigator did not run.", "Compare ros2 node list with the nodes that should be there.", OTHERS)
    yield Fault(
        f"The navigator offered its service as {wrong}: it was started with a remapping.",
        "The navigator runs. Under which name does it offer its service? ros2 node info /navigator",
        (Program("navigator", remaps={"/navigate_to": wrong}), *OTHERS),
    )
    yield Fault(
        "A callback of the navigator waited for a message that only another of its callbacks could have brought: "
        "its one thread was taken forever.",
        'lesson.plot_timeline("/navigator"): which callback never ends?',
        (Program("navigator_waiting", DRAFT, "navigator"), *OTHERS),
    )


@partial(
    Trouble,
    "topic silent",
    "The dashboard stays empty, or moves in jerks. It needs ten messages a second on /robot/status.",
    "A topic needs a publisher, the right name, and the right rate.",
    "ros2 topic list, ros2 topic info /robot/status, ros2 topic hz /robot/status.",
    status_as_specified,
)
def silent(chance: Random) -> Iterator[Fault]:
    wrong = chance.choice(("/status", "/robot_status", "/robot/state", "/turtle1/status"))
    rate = chance.choice((1, 2))
    rest = (NAVIGATOR, DETECTOR)
    yield Fault("The status monitor did not run.", "Compare ros2 node list with the nodes that should be there.", rest)
    yield Fault(
        f"The status monitor published on {wrong}: it was started with a remapping.",
        "The status monitor runs. On which topic does it publish? ros2 node info /status_monitor",
        (Program("status_monitor", remaps={STATUS: wrong}), *rest),
    )
    yield Fault(
        f"The parameter publish_rate was {rate}, where 10 is specified.",
        "Messages come, but too rarely. ros2 param get /status_monitor publish_rate",
        (Program("status_monitor", parameters={"publish_rate": rate}), *rest),
    )


@partial(
    Trouble,
    "turtle stands still",
    "I send the turtle to a goal, and it hardly moves, or not at all. It never gets there.",
    "Follow the commands from the navigator to the turtle: are they sent, on which topic, how large, how often?",
    "ros2 node list, ros2 topic info /turtle1/cmd_vel --verbose, ros2 topic echo /turtle1/cmd_vel during a call.",
    lambda: [
        there("/turtlesim", "ros2 run turtlesim turtlesim_node"),
        *drives((8.0, 5.5), (5.5, 5.5)),
        commands_steady(5.5, 5.5),
    ],
)
def stands(chance: Random) -> Iterator[Fault]:
    wrong = chance.choice(("/cmd_vel", "/turtle/cmd_vel", "/turtle2/cmd_vel", "/turtle1/command"))
    speed = chance.choice((0.01, 0.02, 0.05))
    period = chance.choice((4.0, 5.0, 8.0))
    yield Fault(
        "The simulator did not run.",
        "Which node should obey /turtle1/cmd_vel, and is it there? ros2 node list",
        (NAVIGATOR, *OTHERS),
        simulator=False,
    )
    yield Fault(
        f"The navigator published its commands on {wrong}: it was started with a remapping.",
        "Compare the topics in ros2 node info /navigator and ros2 node info /turtlesim.",
        (Program("navigator", remaps={"/turtle1/cmd_vel": wrong}), *OTHERS),
    )
    yield Fault(
        f"The speed limiter let no more than {speed} m/s through: too little to get anywhere in time.",
        "Commands arrive. How large are they, and which node sends them? ros2 param dump /speed_limiter",
        (*_limited({"max_speed": speed}), *OTHERS),
    )
    yield Fault(
        f"The speed limiter let a command through every {period:g} s, and the simulator stops a turtle whose last "
        "command is a second old.",
        "How often do commands come, and from which node? ros2 param dump /speed_limiter",
        (*_limited({"command_period": period}), *OTHERS),
    )


def _limited(parameters: dict[str, float]) -> tuple[Program, Program]:
    return (
        Program("navigator", remaps={"/turtle1/cmd_vel": "/wanted_vel"}),
        Program("speed_limiter", DRAFT, parameters=parameters),
    )


@partial(
    Trouble,
    "alarm stays silent",
    "The laser sees a wall half a metre ahead, ros2 topic echo /obstacles shows it, and the alarm does not ring.",
    "Both nodes run and use the same topic and type. What else must fit between two ends?",
    "ros2 topic info /obstacles --verbose shows the quality of service of each end. The log has a warning, too.",
    lambda: [
        there("/laser", "ros2 run robot_draft laser"),
        there("/obstacle_alarm", "ros2 run robot_draft obstacle_alarm"),
        publishes("/obstacles", SCAN_TYPE, by="/laser"),
        subscribes("/obstacles", SCAN_TYPE, by="/obstacle_alarm"),
        advised(
            rate("/alarm", "std_msgs/msg/Float32", 5.0),
            "ros2 topic info /obstacles --verbose: do both ends fit, name, type and quality of service?",
        ),
    ],
)
def deaf(chance: Random) -> Iterator[Fault]:
    alarm = Program("obstacle_alarm", DRAFT, parameters={"reliability": "reliable"})
    rest = chance.sample((NAVIGATOR, MONITOR), 2)
    yield Fault(
        "The laser sends with best effort and the alarm asked for reliable delivery: such ends never connect.",
        "ros2 param get /obstacle_alarm reliability. A laser offers best_effort; the alarm reads its parameter at start.",
        (Program("laser", DRAFT), alarm, *rest),
    )


@partial(
    Trouble,
    "status of another type",
    "ros2 topic list shows /robot/status, and my display gets nothing from it, or ros2 topic echo complains.",
    "A name alone does not connect two ends.",
    "ros2 topic list -t, ros2 topic info /robot/status --verbose.",
    status_as_specified,
)
def typed_wrong(chance: Random) -> Iterator[Fault]:
    twin = chance.random() < 0.5
    name = chance.choice(("status_text", "battery", "reporter"))
    text = Program("status_text", DRAFT, name if twin else "status_monitor")
    also = (text, MONITOR) if twin else (text,)
    yield Fault(
        f"A node published /robot/status as std_msgs/msg/String, where {STATUS_TYPE} is specified.",
        "ros2 topic info /robot/status --verbose: two ends of different types never connect.",
        (*also, NAVIGATOR, DETECTOR),
    )


@partial(
    Trouble,
    "goal in the west",
    "The turtle goes to every goal in the east. Sent to the west, it turns and turns.",
    "Which number jumps when the turtle looks due west?",
    "ros2 topic echo /turtle1/pose --field theta, while it turns; lesson.plot_path().",
    lambda: drives((8.0, 5.5), (2.5, 5.5), (1.0, 5.4)),
)
def goal_in_the_west(chance: Random) -> Iterator[Fault]:
    yield Fault(
        "The navigator subtracted two angles and did not bring the difference into -180° to 180°: where the heading jumps "
        "from 180° to -180°, it turned the long way round, forever.",
        "Call it for a goal due west and look at lesson.plot_path(). ros2 param list /navigator",
        (Program("navigator_draft", DRAFT, "navigator"), *chance.sample(OTHERS, 2)),
    )


@partial(
    Trouble,
    "status comes twice",
    "The display for /robot/status flickers: twenty messages come a second, where ten are specified.",
    "If messages come twice, there are two publishers, or one callback is called twice.",
    "ros2 topic hz /robot/status, ros2 topic info /robot/status --verbose, ros2 node list.",
    lambda: [*status_as_specified(), battery_falls()],
)
def twice(chance: Random) -> Iterator[Fault]:
    yield Fault(
        "The node made its timer twice, so each tick was two calls of its callback.",
        'lesson.plot_timeline("/status_monitor"): how often is the callback called?',
        (Program("status_twice", DRAFT, "status_monitor"), NAVIGATOR, DETECTOR),
    )
    yield Fault(
        "The status monitor ran twice, under one name.",
        "ros2 node list warns of it. jobs, and the lines of the launch, tell what runs and its pid.",
        (MONITOR, NAVIGATOR, DETECTOR, MONITOR),
    )


@partial(
    Trouble,
    "status frozen",
    "The status comes ten times a second and says that the turtle is at (0, 0), wherever it is.",
    "The monitor runs, but it does not know where the turtle is. Which topic should tell it?",
    "ros2 node info /status_monitor and ros2 topic info /turtle1/pose --verbose; its log warns, too.",
    status_as_specified,
)
def frozen(chance: Random) -> Iterator[Fault]:
    wrong = chance.choice(("/pose", "/turtle/pose", "/turtle2/pose", "/turtle1/position"))
    yield Fault(
        f"The status monitor heard {wrong}, where no node publishes: it was started with a remapping.",
        "ros2 node info /status_monitor: which topic does it hear, and which node publishes that one?",
        (Program("status_monitor", remaps={"/turtle1/pose": wrong}), NAVIGATOR, DETECTOR),
    )


TROUBLES: dict[str, Trouble] = {
    each.name: each
    for each in (no_message, no_answer, silent, stands, deaf, typed_wrong, goal_in_the_west, twice, frozen)
}
