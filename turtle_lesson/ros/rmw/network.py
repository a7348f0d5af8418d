"""What the network between publishers and subscriptions is like: the usual one, or as bad as a page wants it.

A name, or a pattern such as `/turtle*/pose`, may have conditions of its own. They hold for a service of that name, too.
"""

from __future__ import annotations

from dataclasses import dataclass
from fnmatch import fnmatchcase
from random import Random
from typing import TYPE_CHECKING

from .names import full_topic_name_flaw

if TYPE_CHECKING:
    from .graph import Graph

SECOND = 1_000_000_000
LONGEST = 3600.0
"""The longest latency in seconds that anybody may want."""


@dataclass(frozen=True)
class Conditions:
    """How messages travel: `latency` and at most `jitter` more (ns), a share `loss` of the transmissions is lost."""

    latency: int = 0
    jitter: int = 0
    loss: float = 0.0

    def __repr__(self) -> str:
        longer = f" to {_span(self.latency + self.jitter)}" if self.jitter else ""
        way = f"{_span(self.latency)}{longer} under way" if self.latency or self.jitter else "under way as usual"
        return f"<{way}, {self.loss * 100:g} % lost>" if self.loss else f"<{way}>"


def _span(nanoseconds: int) -> str:
    return f"{nanoseconds / SECOND:g} s"


def conditions(latency: float | None = None, jitter: float | None = None, loss: float | None = None) -> Conditions:
    """Conditions from seconds and a share; None stands for what is usual. Raises ValueError for what cannot be."""
    return Conditions(
        round(_number("latency", latency, LONGEST, "a number of seconds", "0.2") * SECOND),
        round(_number("jitter", jitter, LONGEST, "a number of seconds", "0.05") * SECOND),
        _number("loss", loss, 1.0, "a share", "0.3"),
    )


def _number(what: str, value: float | None, most: float, kind: str, example: str) -> float:
    if value is None:
        return 0.0
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not 0 <= value <= most:
        per_cent = isinstance(value, (int, float)) and what == "loss" and 1 < value <= 100
        hint = f"for {value:g} % write loss={value / 100:g}" if per_cent else f"try {what}={example}"
        raise ValueError(f"{what} must be {kind} from 0 to {most:g}, got {value!r}: {hint}")
    return float(value)


class Network:
    """The conditions of all names. Its `seed` decides what is lost and how long each message takes."""

    def __init__(self, seed: object = 0) -> None:
        self.seed = seed
        self._names: dict[str, Conditions] = {}
        self._patterns: dict[str, Conditions] = {}
        self._lines: dict[str, int] = {}

    def set(self, name: str, found: Conditions | None) -> None:
        """Have a name, or all names that match a pattern, treated so; None: as if nothing had been said about it."""
        table = self._patterns if is_pattern(name) else self._names
        table.pop(name, None)
        if found is not None:
            table[name] = found

    def clear(self) -> None:
        """Forget all conditions."""
        self._names.clear()
        self._patterns.clear()

    def of(self, name: str) -> Conditions | None:
        """The conditions of a full name: its own, or those of the pattern that was set last; None for the usual."""
        if name in self._names:
            return self._names[name]
        for pattern, found in reversed(self._patterns.items()):
            if fnmatchcase(name, pattern):
                return found
        return None

    def rules(self) -> dict[str, Conditions]:
        """All that has been set, names first, then patterns as they were set."""
        return {**dict(sorted(self._names.items())), **self._patterns}

    def random(self, line: str) -> Random:
        """Random numbers for a line; the second line of the same ends has others than the first."""
        number = self._lines[line] = self._lines.get(line, 0) + 1
        return Random(f"{self.seed}/network/{line}/{number}")


def set_conditions(
    graph: Graph, name: str | None, latency: float | None, jitter: float | None, loss: float | None
) -> dict[str, Conditions]:
    """What `lesson.network` does: set, forget (with nothing but a name), forget all (None), or only look ("")."""
    if latency is jitter is loss is None:
        if name != "":
            graph.set_network(None if name is None else checked_name(name), None)
    elif not name:
        raise ValueError(
            'name the topic of these conditions; "*" means all topics, as in lesson.network("*", loss=0.1)'
        )
    else:
        graph.set_network(checked_name(name), conditions(latency, jitter, loss))
    return graph.network.rules()


def is_pattern(name: str) -> bool:
    """Whether this stands for several names."""
    return any(letter in name for letter in "*?[")


def checked_name(name: object) -> str:
    """A full name, or a pattern of them. Raises ValueError or TypeError, which say what would be right."""
    if not isinstance(name, str):
        raise TypeError(f"the name of a topic is a text such as '/scan', or a pattern such as '/turtle*', got {name!r}")
    if is_pattern(name) and name.startswith(("/", "*")):
        return name
    if not name.startswith("/"):
        raise ValueError(f"the full name of a topic begins with a slash, got '{name}': try '/{name}'")
    if flaw := full_topic_name_flaw(name):
        raise ValueError(f"'{name}' cannot be a topic: {flaw.reason}")
    return name
