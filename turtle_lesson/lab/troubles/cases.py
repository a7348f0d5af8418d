"""The troubles, and the case file of one: what a user reports of a broken system, and hints for finding the cause."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from random import Random
from typing import TYPE_CHECKING, Any

from ...ros.idl.names import nearest
from ..checks.probe import Probe
from ..checks.registry import Expectation, expectation
from ..checks.results import CannotLook, CheckResult, Seen
from . import faults
from .faults import Fault

if TYPE_CHECKING:
    from ...session.trouble_environment import TroubleEnvironment


@dataclass(frozen=True)
class Trouble:
    """A symptom and where it may come from.

    Attributes:
        name: by which `lesson.trouble(name=…)` asks for it.
        report: what a user says.
        hints: where to look first, then with what.
        faults: what it may come from; names and numbers in it are drawn by chance.
        expectations: what is so in a well system.
    """

    name: str
    report: str
    hints: tuple[str, str]
    faults: Callable[[Random], Sequence[Fault]]
    expectations: Callable[[], list[Expectation]]


# The troubles: four of the lesson, and bugs that were found in published teaching code.
TROUBLES: dict[str, Trouble] = {
    trouble.name: trouble
    for trouble in (
        Trouble(
            "message not found",
            "I copied my package into a new workspace, trouble_ws, and wanted to start the status monitor there. ROS cannot "
            "find robot_controller/msg/TurtleStatus.",
            ("A message type is only a text at first. What has to happen before a program can use it?",
             "Go through the three steps in order: CMakeLists.txt, colcon build, source."),
            faults.no_message,
            faults.message_rows,
        ),
        Trouble(
            "service times out",
            "I call /navigate_to, and no answer ever comes.",
            ("Some node has to offer the service, under this name, and its callback has to be called.",
             "ros2 service list, ros2 node info /navigator; then lesson.plot_sequence() after a call."),
            faults.no_answer,
            lambda: faults.drives((8.0, 5.5), (5.5, 5.5)),
        ),
        Trouble(
            "topic silent",
            "The dashboard stays empty, or moves in jerks. It needs ten messages a second on /robot/status.",
            ("A topic needs a publisher, the right name, and the right rate.",
             "ros2 topic list, ros2 topic info /robot/status, ros2 topic hz /robot/status."),
            faults.silent,
            faults.status_as_specified,
        ),
        Trouble(
            "turtle stands still",
            "I send the turtle to a goal, and it hardly moves, or not at all. It never gets there.",
            ("Follow the commands from the navigator to the turtle: are they sent, on which topic, how large, how often?",
             "ros2 node list, ros2 topic info /turtle1/cmd_vel --verbose, ros2 topic echo /turtle1/cmd_vel during a call."),
            faults.stands,
            faults.motion_rows,
        ),
        Trouble(
            "alarm stays silent",
            "The laser sees a wall half a metre ahead, ros2 topic echo /obstacles shows it, and the alarm does not ring.",
            ("Both nodes run and use the same topic and type. What else must fit between two ends?",
             "ros2 topic info /obstacles --verbose shows the quality of service of each end. The log has a warning, too."),
            faults.deaf,
            faults.alarm_rows,
        ),
        Trouble(
            "status of another type",
            "ros2 topic list shows /robot/status, and my display gets nothing from it, or ros2 topic echo complains.",
            ("A name alone does not connect two ends.",
             "ros2 topic list -t, ros2 topic info /robot/status --verbose."),
            faults.typed_wrong,
            faults.status_as_specified,
        ),
        Trouble(
            "goal in the west",
            "The turtle goes to every goal in the east. Sent to the west, it turns and turns.",
            ("Which number jumps when the turtle looks due west?",
             "ros2 topic echo /turtle1/pose --field theta, while it turns; lesson.plot_path()."),
            faults.goal_in_the_west,
            lambda: faults.drives((8.0, 5.5), (2.5, 5.5), (1.0, 5.4)),
        ),
        Trouble(
            "status comes twice",
            "The display for /robot/status flickers: twenty messages come a second, where ten are specified.",
            ("If messages come twice, there are two publishers, or one callback is called twice.",
             "ros2 topic hz /robot/status, ros2 topic info /robot/status --verbose, ros2 node list."),
            faults.twice,
            faults.twice_rows,
        ),
        Trouble(
            "status frozen",
            "The status comes ten times a second and says that the turtle is at (0, 0), wherever it is.",
            ("The monitor runs, but it does not know where the turtle is. Which topic should tell it?",
             "ros2 node info /status_monitor and ros2 topic info /turtle1/pose --verbose; its log warns, too."),
            faults.frozen,
            faults.status_as_specified,
        ),
    )
}  # fmt: skip


@dataclass(frozen=True, repr=False)
class Case:
    """One broken system. It does not say what is wrong until that is mended.

    Attributes:
        number: by which `lesson.trouble(number)` brings it back.
        trouble: the name under which it was asked for; None if it was drawn by its number.
        check: whether the system is well now, from the running graph alone: the same as `lesson.check("trouble")`.
    """

    number: int
    trouble: str | None
    _trouble: Trouble
    _fault: Fault
    check: Callable[[], CheckResult]

    @property
    def _title(self) -> str:
        return f"Case {self.number}, {self.trouble}" if self.trouble else f"Case {self.number}"

    def __repr__(self) -> str:
        return (
            f"{self._title}. A user reports: “{self._trouble.report}” Look at the running system, mend it, then: case.check(). "
            "If you are stuck: case.hint(1), up to 3."
        )

    def _repr_markdown_(self) -> str:
        todo = "Look at the running system, mend it, then: `case.check()`. If you are stuck: `case.hint(1)`, up to 3."
        return f"**{self._title}.** A user reports:\n\n> {self._trouble.report}\n\n{todo}"

    def hint(self, level: int = 1) -> str:
        """A hint: 1 says where to look, 2 with what, 3 nearly tells."""
        if isinstance(level, bool) or not isinstance(level, int) or not 1 <= level <= 3:
            raise ValueError(f"hints have levels from 1 to 3, got {level!r}: try case.hint(1)")
        return (*self._trouble.hints, self._fault.hint)[level - 1]

    @property
    def cause(self) -> str:
        """What was wrong: told once the system is mended, which is looked at now."""
        return (
            self._fault.cause if self.check().passed else "It is not mended yet; case.check() says what is still wrong."
        )


_current: tuple[Case, TroubleEnvironment] | None = None


def open_case(
    environment: TroubleEnvironment, seed: int | None, name: str | None, check: Callable[[], CheckResult]
) -> Case:
    """What `Lesson.trouble` does in a world; `check` looks at the system and says whether it is mended.

    Raises ValueError for a name that does not exist, with the one that may be meant, and for a seed that is not a number.
    """
    global _current
    number = 0 if seed is None else seed
    if isinstance(number, bool) or not isinstance(number, int):
        raise ValueError(f"a seed is a whole number, got {seed!r}: try lesson.trouble(1), or lesson.trouble(name=…)")
    chance = Random(f"trouble {number}")
    trouble = TROUBLES[chance.choice(sorted(TROUBLES))] if name is None else _named(name)
    chance = Random(f"{trouble.name} {number}")
    fault = chance.choice(trouble.faults(chance))
    environment.clear()
    if fault.workspace:
        environment.make_workspace(fault.workspace)
    environment.start(fault.programs)
    if not fault.simulator:
        environment.stop_simulator()
    case = Case(number, None if name is None else trouble.name, trouble, fault, check)
    _current = (case, environment)
    return case


def _named(name: Any) -> Trouble:
    key = str(name).replace("_", " ").strip().lower()
    if key not in TROUBLES:
        close = nearest(key, TROUBLES, cutoff=0.5)
        meant = f' Did you mean "{close}"?' if close else ""
        raise ValueError(f"there is no trouble {name!r}.{meant} There are: {', '.join(TROUBLES)}.")
    return TROUBLES[key]


def carry_over(before: Any) -> None:
    """Take over the open case of an earlier import of this module, `before`; what it expects is what is written here."""
    global _current
    if before._current is not None:
        case, environment = before._current
        trouble = TROUBLES[case._trouble.name]
        _current = (Case(case.number, case.trouble, trouble, case._fault, case.check), environment)


def _open_case() -> Case | None:
    """The case that is open in a world that goes on."""
    return None if _current is None or _current[1].ended else _current[0]


def current_expectations() -> list[Expectation]:
    """What is expected of the system once the current case is mended."""
    case = _open_case()
    return case._trouble.expectations() if case else [_some_case()]


@expectation("a case that was opened")
def _some_case(probe: Probe) -> Seen:
    raise CannotLook("there is none in this world yet: case = lesson.trouble(1)")


def expectations_of(number: int, name: str) -> list[Expectation]:
    """What is expected once this case is mended, after the expectation that it is the one that is open."""
    case = _open_case()
    open_now = case is not None and (case.number, case.trouble) == (number, name)
    return [_is_open(number, name), *(TROUBLES[name].expectations() if open_now else [])]


@expectation("the case {number}, {name}")
def _is_open(probe: Probe, number: int, name: str) -> Seen:
    wanted = f'case = lesson.trouble({number}, name="{name}")'
    case = _open_case()
    if case is None:
        return Seen(False, "there is none in this world yet", f"Run the cell with {wanted} first.")
    good = (case.number, case.trouble) == (number, name)
    return Seen(good, f"it is {case._title}", f"Another one is asked for: {wanted}")
