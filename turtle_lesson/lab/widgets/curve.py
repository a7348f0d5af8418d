"""One curve of a live plot: from "/turtle1/cmd_vel/linear/x" to a topic, a type, and a number in its messages."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from typing import Any

from ..recording import Table
from ..words import did_you_mean, enumerated, is_hidden, nearest
from .message_types import find_class, kinds_of

KEPT = 20_000
"""Numbers that are kept of a curve: more than five minutes of a turtle's pose."""

SLIP = 0.8
"""A topic that is not there, but this much like one that is, counts as mistyped; less like one, as yet to come."""

_STEP = re.compile(r"[/.]?([A-Za-z_]\w*)|\[(\d+)\]")

Step = str | int


class Curve:
    """What was asked for, where it is found, and the numbers that came. Times are the messages' own, in ns."""

    def __init__(self, asked: str) -> None:
        self.asked = asked
        self.topic = ""
        self.type_name = ""
        self.path = ""
        self.problem = "The topic has not been looked for yet."
        """Why it cannot be heard now, as a sentence; "" if it can."""
        self.table = Table("value", limit=KEPT)
        self.read: Callable[[Any], float] = _nothing

    @property
    def name(self) -> str:
        """The field alone, as a label: "battery", "ranges[90]", "linear/x"."""
        return self.path or self.asked.rpartition("/")[2]

    def find(self, topics: Mapping[str, list[str]]) -> None:
        """Find topic and field in the graph. Raises ValueError where the type has no such number."""
        self.topic, rest = split(self.asked, topics)
        if not self.topic:
            visible = [name for name in topics if not is_hidden(name)]
            self.problem = f"There is no such topic yet; now there are {enumerated(visible)}."
            return
        self.type_name = topics[self.topic][0]
        self.path = rest.lstrip("/.").replace(".", "/")
        message_class = find_class(self.type_name)
        steps = check_steps(message_class, steps_of(rest), self)
        self.path = self.path or str(steps[0])
        self.read = reader(steps)
        self.problem = ""

    def hear(self, message: Any, info: Mapping[str, Any]) -> None:
        """Take the number of a message."""
        self.table.append(info["source_timestamp"], self.read(message))


def split(asked: str, topics: Iterable[str]) -> tuple[str, str]:
    """The longest topic with which this begins, and what follows; "" for both where none does."""
    for topic in sorted(topics, key=len, reverse=True):
        if asked == topic or (asked.startswith(topic) and asked[len(topic)] in "/.["):
            return topic, asked[len(topic) :]
    return "", ""


def steps_of(rest: str) -> list[Step]:
    """ "/linear/x" is ["linear", "x"], "/ranges[90]" is ["ranges", 90]. Raises ValueError for anything else."""
    steps: list[Step] = []
    at = 0
    while at < len(rest):
        found = _STEP.match(rest, at)
        if not found:
            raise ValueError(f'"{rest}" is not a path to a field: try /linear/x or /ranges[90]')
        steps.append(found[1] if found[1] is not None else int(found[2]))
        at = found.end()
    return steps


def check_steps(message_class: Any, steps: list[Step], curve: Curve) -> list[Step]:
    """The steps to a number in messages of this class. Raises ValueError where they lead to none.

    Without any, a message whose one field is a number (std_msgs/Float64) stands for that number.
    """
    where, kinds = curve.type_name, kinds_of(message_class)
    if not steps:
        only = [name for name, kind in kinds.items() if kind.is_number]
        if len(kinds) == 1 and only:
            return [*only]
        raise ValueError(f"say which field of {curve.topic} to draw: {enumerated(_ways(curve.topic, kinds))}")
    walked = curve.topic
    pending = list(steps)
    while True:
        name = pending.pop(0)
        if not isinstance(name, str) or name not in kinds:
            hint = did_you_mean(str(name), kinds)
            raise ValueError(" ".join(filter(None, (f'{where} has no field "{name}".', hint, _fields(kinds)))))
        kind, walked = kinds[name], f"{walked}/{name}"
        if kind.array:
            kind, walked = _element(kind, pending, walked)
        if kind.is_message and pending:
            where, kinds = kind.base, kinds_of(find_class(kind.base))
            continue
        if kind.is_message:
            ways = _ways(walked, kinds_of(find_class(kind.base)))
            raise ValueError(f"{walked} is not a number but a {kind.base}: try {enumerated(ways)}")
        if not kind.is_number:
            raise ValueError(f"{walked} is not a number but a {kind}, which cannot be drawn as a curve")
        if pending:
            raise ValueError(f"{walked} is a {kind}, a number without fields: leave out the rest")
        return steps


def _fields(kinds: Mapping[str, Any]) -> str:
    return f"Its fields: {enumerated(kinds)}."


def _element(kind: Any, pending: list[Step], walked: str) -> tuple[Any, str]:
    if not pending or not isinstance(pending[0], int):
        raise ValueError(f"{walked} is an array ({kind}): say which element, such as {walked}[0]")
    index = pending.pop(0)
    if kind.array in ("fixed", "bounded") and int(index) >= kind.size:
        raise ValueError(f"{walked} has elements 0 to {kind.size - 1}, so there is no [{index}]")
    return kind.element, f"{walked}[{index}]"


def _ways(start: str, kinds: Mapping[str, Any]) -> list[str]:
    """What may be tried below a topic or a field: its numbers first."""
    numbers = [name for name, kind in kinds.items() if kind.is_number]
    return [f"{start}/{name}" for name in numbers or kinds]


def reader(steps: list[Step]) -> Callable[[Any], float]:
    """A function from a message to the number at the end of the steps; not-a-number where an array is too short."""

    def read(message: Any) -> float:
        found = message
        try:
            for step in steps:
                found = found[step] if isinstance(step, int) else getattr(found, step)
        except IndexError:
            return float("nan")
        return float(found[0] if isinstance(found, bytes) else found)

    return read


def mistyped(asked: str, topics: Iterable[str], to_come: Iterable[str]) -> str:
    """The topic that was probably meant, or "" if this may well be one that is yet to come.

    One that differs in its digits only (/turtle2/pose beside /turtle1/pose) may.
    """
    if split(asked, to_come)[0]:
        return ""
    parts = re.split(r"[/.\[]", asked)
    known = list(topics)
    for length in range(len(parts), 1, -1):
        begin = "/".join(parts[:length])
        meant = nearest(begin, [each for each in known if each.count("/") == begin.count("/")], SLIP)
        if meant:
            return "" if _without_digits(meant) == _without_digits(begin) else meant
    return ""


def _without_digits(name: str) -> str:
    return re.sub(r"\d+", "#", name)


def _nothing(message: Any) -> float:
    return float("nan")
