"""Page 06: parameters that are really read, a launch file, and two configurations side by side."""

from __future__ import annotations

from ..words import listed, number
from . import page_03, page_04, page_05
from .drives import NAVIGATE, NAVIGATE_TYPE, far_away, where
from .exam import Answer, Exam
from .parts import get_parameter, no_errors, node, parameter, publishes
from .questions import gives_up, rate_follows
from .registry import Expectation, check
from .rows import CannotLook, Seen
from .streams import judge_rate, rate

PAGE = "06_parameters_and_launch"
STATUS, STATUS_TYPE = page_04.STATUS, page_04.STATUS_TYPE
SCAN, SCAN_TYPE = page_05.SCAN, page_05.SCAN_TYPE


@check("parameters", page=PAGE, points=5, limit=60)
def parameters() -> list[Expectation]:
    """Parameters that change what the nodes do, while they run."""
    return [
        parameter("/status_monitor", "publish_rate"),
        rate_follows("/status_monitor", "publish_rate", 20, STATUS, STATUS_TYPE),
        parameter("/obstacle_detector", "scan_rate"),
        rate_follows("/obstacle_detector", "scan_rate", 10, SCAN, SCAN_TYPE),
        parameter("/navigator", "goal_timeout"),
        gives_up("/navigator", "goal_timeout", 0.5, _far_goal),
    ]


def _far_goal(exam: Exam) -> Answer:
    x, y, theta = far_away(where(exam))
    return exam.ask(NAVIGATE, NAVIGATE_TYPE, 30.0, x=x, y=y, theta=theta)


@check("launch", page=PAGE, points=4, limit=20)
def launch() -> list[Expectation]:
    """One command has started all three nodes, with their parameters."""
    return [*system_is_there(), *system_is_configured(), no_errors()]


def system_is_there() -> list[Expectation]:
    """The three nodes, and what each of them is for."""
    return [
        *page_03.navigator_is_there(),
        node("/status_monitor", page_04.RUN),
        publishes(STATUS, STATUS_TYPE, by="/status_monitor"),
        node("/obstacle_detector", page_05.RUN),
        publishes(SCAN, SCAN_TYPE, by="/obstacle_detector"),
    ]


def system_is_configured() -> list[Expectation]:
    """The values of the lesson's launch file, and the rates that follow from them."""
    return [
        parameter("/navigator", "goal_timeout", 5.0),
        parameter("/status_monitor", "publish_rate", 10),
        parameter("/obstacle_detector", "scan_rate", 5),
        rate(STATUS, STATUS_TYPE, hz=10),
        rate(SCAN, SCAN_TYPE, hz=5),
    ]


# -- side by side ------------------------------------------------------------------------------------------------------


@check("side_by_side", page=PAGE, points=4, limit=20)
def side_by_side() -> list[Expectation]:
    """Two status monitors, each with its own namespace, topic and rate."""
    return [
        Expectation("two status monitors, each in its namespace", _two_monitors),
        Expectation("each publishes a topic of its own", _own_topics),
        Expectation("each has its own publish_rate", _own_rates),
        Expectation("each keeps its own rate", _kept_rates),
    ]


def _monitors(exam: Exam) -> list[str]:
    found = [name for name in exam.nodes() if name.endswith("/status_monitor") and name != "/status_monitor"]
    if len(found) < 2:
        raise CannotLook("there are no two status monitors with namespaces")
    return found


def _two_monitors(exam: Exam) -> Seen:
    found = exam.nodes()
    monitors = [name for name in found if name.endswith("/status_monitor")]
    good = len([name for name in monitors if name != "/status_monitor"]) >= 2 and max(found.values()) == 1
    seen = listed([f"{found[name]} × {name}" if found[name] > 1 else name for name in monitors]) or "none"
    return Seen(good, seen, 'Node(…, namespace="slow") and Node(…, namespace="fast") in the launch file.')


def _topics(exam: Exam) -> dict[str, list[str]]:
    """The status topics of each monitor."""
    topics: dict[str, list[str]] = {name: [] for name in _monitors(exam)}
    for topic in exam.topics():
        for owner, kind in exam.publishers(topic):
            if owner in topics and kind == STATUS_TYPE:
                topics[owner].append(topic)
    return topics


def _own_topics(exam: Exam) -> Seen:
    topics = _topics(exam)
    everything = [topic for each in topics.values() for topic in each]
    good = all(topics.values()) and len(set(everything)) == len(everything)
    seen = "; ".join(f"{owner}: {listed(each) or 'none'}" for owner, each in topics.items())
    step = f"An absolute name such as {STATUS} ignores the namespace: leave out the first /, or add remappings."
    return Seen(good, seen, step)


def _own_rates(exam: Exam) -> Seen:
    rates = {owner: get_parameter(exam, owner, "publish_rate") for owner in _monitors(exam)}
    seen = listed([f"{owner} {value!r}" for owner, value in rates.items()])
    good = None not in rates.values() and len(set(rates.values())) == len(rates)
    return Seen(good, seen, 'parameters=[{"publish_rate": 20}] in one of the two Nodes.')


def _kept_rates(exam: Exam) -> Seen:
    words, good = [], True
    for owner, topics in _topics(exam).items():
        wanted = get_parameter(exam, owner, "publish_rate")
        if not topics or not isinstance(wanted, (int, float)) or not wanted > 0:
            raise CannotLook(f"{owner} has no topic and rate of its own")
        heard = exam.hear(topics[0], STATUS_TYPE, max(2.0, 4.0 / wanted))
        right, seen, _ = judge_rate(heard, wanted, 0.1 / wanted, len(exam.publishers(topics[0])))
        words.append(f"{topics[0]} {seen} for {number(float(wanted), 0)} Hz")
        good = good and right
    return Seen(good, "; ".join(words), "Does the node read its parameter, and does each have a topic of its own?")
