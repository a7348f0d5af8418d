"""Page 11: a recorded robot is played back."""

from __future__ import annotations

from ..words import listed
from . import page_04
from .exam import Exam
from .registry import Expectation, check
from .rows import Seen
from .streams import rate

PAGE = "11_to_a_real_robot"
PLAYER = "rosbag2_player"


@check("replay", page=PAGE, points=3, limit=15)
def replay() -> list[Expectation]:
    """A bag speaks for a status monitor that does not run."""
    return [
        Expectation("no status monitor runs", _no_monitor),
        Expectation(f"{page_04.STATUS} comes from a bag", _from_a_bag),
        rate(page_04.STATUS, page_04.STATUS_TYPE, hz=10, seconds=2.0),
    ]


def _no_monitor(exam: Exam) -> Seen:
    there = "/status_monitor" in exam.nodes()
    return Seen(not there, "it runs" if there else "none does", "Begin with start(), and launch nothing.")


def _from_a_bag(exam: Exam) -> Seen:
    who = sorted({owner for owner, _ in exam.publishers(page_04.STATUS)})
    good = len(who) == 1 and who[0].rsplit("/", 1)[-1].startswith(PLAYER)
    return Seen(good, listed(who) or "nobody publishes it", "ros2 bag play FOLDER --loop &")
