"""What a trouble is, and the faults behind each symptom, one of which is chosen by chance."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from random import Random
from typing import Any, Protocol

from ..checks import Expectation
from ..checks.assertions import publishes, subscribes
from ..checks.navigation import NAVIGATE_TYPE
from ..checks.streams import rate
from .expect import (
    STATUS,
    STATUS_TYPE,
    advised,
    battery_falls,
    commands_steady,
    drives,
    found_in,
    importable,
    status_as_specified,
    there,
)


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
    programs: tuple[Program, ...]
    simulator: bool = True
    workspace: str = ""


@dataclass(frozen=True)
class Trouble:
    """A symptom and where it may come from.

    Attributes:
        name: by which `lesson.trouble(name=…)` asks for it.
        report: what a user says.
        hints: where to look first, then with what.
        commands: those that show what is wrong, from outside.
        choose: chooses a fault by chance.
        expectations: what is so in a well system.
    """

    name: str
    report: str
    hints: tuple[str, str]
    commands: tuple[str, ...]
    choose: Callable[[Random], Fault]
    expectations: Callable[[], list[Expectation]]


class Environment(Protocol):
    """The world that a trouble is put into, and what can be done to it by public means."""

    def clear(self) -> None:
        """End every program but the simulator; the simulator and the package are there again, as before."""

    def start(self, programs: tuple[Program, ...]) -> None:
        """Launch nodes."""

    def stop_simulator(self) -> None:
        """Ctrl-C for the turtle simulator."""

    def make_workspace(self, fault: str) -> None:
        """Copy the package's source into the workspace `trouble_ws`; from now on the package is found nowhere else."""

    @property
    def ended(self) -> bool:
        """Whether a newer world has taken its place."""


DRAFT = "robot_draft"
OTHERS = (MONITOR, DETECTOR)

# -- 1: the custom message cannot be found ------------------------------------------------------------------------------


def no_message(chance: Random) -> Fault:
    """A message that no program can use."""
    kind = chance.choice(("not in CMakeLists.txt", "not built", "not sourced"))
    hints = {
        "not in CMakeLists.txt": "Read trouble_ws/src/robot_controller/CMakeLists.txt: which files does "
        "rosidl_generate_interfaces name?",
        "not built": "There is a src folder in trouble_ws. Is there an install folder?",
        "not sourced": "All is built in trouble_ws/install. Has this terminal read its setup file?",
    }
    causes = {
        "not in CMakeLists.txt": "TurtleStatus.msg was not named in CMakeLists.txt, so nothing was generated from it.",
        "not built": "The package was written but never built.",
        "not sourced": "The package was built, but its setup file was not sourced.",
    }
    return Fault(causes[kind], hints[kind], (), workspace=kind)


def message_rows() -> list[Expectation]:
    """Both types of the package in trouble_ws can be used, and the status comes."""
    return [
        found_in("trouble_ws", "robot_controller"),
        importable(STATUS_TYPE),
        importable(NAVIGATE_TYPE),
        *status_as_specified(),
    ]


# -- 2: the service does not answer -------------------------------------------------------------------------------------


def no_answer(chance: Random) -> Fault:
    """A service that is never answered."""
    wrong = chance.choice(("/navigate", "/navigation/navigate_to", "/go_to", "/robot/navigate_to"))
    faults = (
        Fault("The navigator did not run.", "Compare ros2 node list with the nodes that should be there.", OTHERS),
        Fault(
            f"The navigator offered its service as {wrong}: it was started with a remapping.",
            "The navigator runs. Under which name does it offer its service? ros2 node info /navigator",
            (Program("navigator", remaps={"/navigate_to": wrong}), *OTHERS),
        ),
        Fault(
            "A callback of the navigator waited for a message that only another of its callbacks could have brought: "
            "its one thread was taken forever.",
            'lesson.plot_timeline("/navigator"): which callback never ends?',
            (Program("navigator_waiting", DRAFT, "navigator"), *OTHERS),
        ),
    )
    return chance.choice(faults)


def service_rows() -> list[Expectation]:
    """The navigator drives."""
    return drives((8.0, 5.5), (5.5, 5.5))


# -- 3: a topic is silent -----------------------------------------------------------------------------------------------


def silent(chance: Random) -> Fault:
    """A status that does not come, or too rarely."""
    wrong = chance.choice(("/status", "/robot_status", "/robot/state", "/turtle1/status"))
    rate = chance.choice((1, 2))
    rest = (NAVIGATOR, DETECTOR)
    faults = (
        Fault("The status monitor did not run.", "Compare ros2 node list with the nodes that should be there.", rest),
        Fault(
            f"The status monitor published on {wrong}: it was started with a remapping.",
            "The status monitor runs. On which topic does it publish? ros2 node info /status_monitor",
            (Program("status_monitor", remaps={STATUS: wrong}), *rest),
        ),
        Fault(
            f"The parameter publish_rate was {rate}, where 10 is specified.",
            "Messages come, but too rarely. ros2 param get /status_monitor publish_rate",
            (Program("status_monitor", parameters={"publish_rate": rate}), *rest),
        ),
    )
    return chance.choice(faults)


# -- 4: the turtle does not move ----------------------------------------------------------------------------------------


def stands(chance: Random) -> Fault:
    """A turtle that gets nowhere."""
    wrong = chance.choice(("/cmd_vel", "/turtle/cmd_vel", "/turtle2/cmd_vel", "/turtle1/command"))
    speed = chance.choice((0.01, 0.02, 0.05))
    period = chance.choice((4.0, 5.0, 8.0))
    faults = (
        Fault(
            "The simulator did not run.",
            "Which node should obey /turtle1/cmd_vel, and is it there? ros2 node list",
            (NAVIGATOR, *OTHERS),
            simulator=False,
        ),
        Fault(
            f"The navigator published its commands on {wrong}: it was started with a remapping.",
            "Compare the topics in ros2 node info /navigator and ros2 node info /turtlesim.",
            (Program("navigator", remaps={"/turtle1/cmd_vel": wrong}), *OTHERS),
        ),
        Fault(
            f"The speed limiter let no more than {speed} m/s through: too little to get anywhere in time.",
            "Commands arrive. How large are they, and which node sends them? ros2 param dump /speed_limiter",
            (*limited({"max_speed": speed}), *OTHERS),
        ),
        Fault(
            f"The speed limiter let a command through every {period:g} s, and the simulator stops a turtle whose last "
            "command is a second old.",
            "How often do commands come, and from which node? ros2 param dump /speed_limiter",
            (*limited({"command_period": period}), *OTHERS),
        ),
    )
    return chance.choice(faults)


def limited(parameters: dict[str, float]) -> tuple[Program, Program]:
    """A navigator whose commands pass a speed limiter with these parameters."""
    return (
        Program("navigator", remaps={"/turtle1/cmd_vel": "/wanted_vel"}),
        Program("speed_limiter", DRAFT, parameters=parameters),
    )


def motion_rows() -> list[Expectation]:
    """Simulator and navigator are there, and goals are reached."""
    return [
        there("/turtlesim", "ros2 run turtlesim turtlesim_node"),
        *drives((8.0, 5.5), (5.5, 5.5)),
        commands_steady(5.5, 5.5),
    ]


# -- more ---------------------------------------------------------------------------------------------------------------


def deaf(chance: Random) -> Fault:
    """Two ends whose qualities of service do not fit."""
    alarm = Program("obstacle_alarm", DRAFT, parameters={"reliability": "reliable"})
    rest = chance.sample((NAVIGATOR, MONITOR), 2)
    return Fault(
        "The laser sends with best effort and the alarm asked for reliable delivery: such ends never connect.",
        "ros2 param get /obstacle_alarm reliability. A laser offers best_effort; the alarm reads its parameter at start.",
        (Program("laser", DRAFT), alarm, *rest),
    )


def alarm_rows() -> list[Expectation]:
    """The alarm rings for each scan."""
    scan = "sensor_msgs/msg/LaserScan"
    ends = [publishes("/obstacles", scan, by="/laser"), subscribes("/obstacles", scan, by="/obstacle_alarm")]
    step = "ros2 topic info /obstacles --verbose: do both ends fit, name, type and quality of service?"
    ringing = advised(rate("/alarm", "std_msgs/msg/Float32", 5.0), step)
    laser, alarm = "ros2 run robot_draft laser", "ros2 run robot_draft obstacle_alarm"
    return [there("/laser", laser), there("/obstacle_alarm", alarm), *ends, ringing]


def typed_wrong(chance: Random) -> Fault:
    """A topic of two types, or of the wrong one."""
    twin = chance.random() < 0.5
    name = chance.choice(("status_text", "battery", "reporter"))
    also = (
        (Program("status_text", DRAFT, name), MONITOR) if twin else (Program("status_text", DRAFT, "status_monitor"),)
    )
    return Fault(
        f"A node published /robot/status as std_msgs/msg/String, where {STATUS_TYPE} is specified.",
        "ros2 topic info /robot/status --verbose: two ends of different types never connect.",
        (*also, NAVIGATOR, DETECTOR),
    )


def goal_in_the_west(chance: Random) -> Fault:
    """An angle difference that is not wrapped."""
    return Fault(
        "The navigator subtracted two angles and did not bring the difference into -180° to 180°: where the heading jumps "
        "from 180° to -180°, it turned the long way round, forever.",
        "Call it for a goal due west and look at lesson.plot_path(). ros2 param list /navigator",
        (Program("navigator_draft", DRAFT, "navigator"), *chance.sample(OTHERS, 2)),
    )


def west_rows() -> list[Expectation]:
    """Goals are reached, also due west."""
    return drives((8.0, 5.5), (2.5, 5.5), (1.0, 5.4))


def twice(chance: Random) -> Fault:
    """Everything comes twice."""
    faults = (
        Fault(
            "The node made its timer twice, so each tick was two calls of its callback.",
            'lesson.plot_timeline("/status_monitor"): how often is the callback called?',
            (Program("status_twice", DRAFT, "status_monitor"), NAVIGATOR, DETECTOR),
        ),
        Fault(
            "The status monitor ran twice, under one name.",
            "ros2 node list warns of it. jobs, and the lines of the launch, tell what runs and its pid.",
            (MONITOR, NAVIGATOR, DETECTOR, MONITOR),
        ),
    )
    return chance.choice(faults)


def twice_rows() -> list[Expectation]:
    """The status comes once, and the battery falls as specified."""
    return [*status_as_specified(), battery_falls]


def frozen(chance: Random) -> Fault:
    """A monitor that hears nothing."""
    wrong = chance.choice(("/pose", "/turtle/pose", "/turtle2/pose", "/turtle1/position"))
    return Fault(
        f"The status monitor heard {wrong}, where no node publishes: it was started with a remapping.",
        "ros2 node info /status_monitor: which topic does it hear, and which node publishes that one?",
        (Program("status_monitor", remaps={"/turtle1/pose": wrong}), NAVIGATOR, DETECTOR),
    )
