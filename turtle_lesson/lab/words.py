"""Numbers, angles, lists and names in plain words, the same on every machine."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

from ..ros.idl.names import nearest

if TYPE_CHECKING:
    import numpy as np


def number(value: float, decimals: int = 2) -> str:
    """A number with a fixed count of decimals: `number(-0.001)` is "0.00", not "-0.00"."""
    if math.isnan(value):
        return "not a number"
    if math.isinf(value):
        return "infinite" if value > 0 else "minus infinite"
    text = f"{value:.{decimals}f}"
    return text[1:] if text.startswith("-") and not text.strip("-0.") else text


def angle(radians: float) -> str:
    """An angle in both units: `angle(1.5708)` is "1.57 rad (90.0°)"."""
    return f"{number(radians)} rad ({number(math.degrees(radians), 1)}°)"


def point(x: float, y: float) -> str:
    """A place in the world, in metres: "(5.54, 5.54)"."""
    return f"({number(x)}, {number(y)})"


def count(amount: int, noun: str, plural: str = "") -> str:
    """How many of a thing: "1 message", "2 messages", "no message"."""
    if amount == 1:
        return f"1 {noun}"
    return f"{amount or 'no'} {noun if not amount else plural or noun + 's'}"


def listed(items: Sequence[str]) -> str:
    """A list in a sentence: "a, b and c"."""
    return " and ".join([", ".join(items[:-1]), items[-1]] if len(items) > 1 else items)


def turned(radians: float) -> float:
    """An angle brought into (-pi, pi], as a turn from one heading to another."""
    rest = math.remainder(radians, math.tau)
    return math.pi if rest == -math.pi else rest


def rate(stamps: np.ndarray) -> str:
    """How often messages came, from the times (ns, ascending) at which they were sent."""
    import numpy as np

    if len(stamps) < 2:
        return count(len(stamps), "message")
    gaps = np.diff(stamps) / 1e6
    mean = float(gaps.mean())
    frequency = f" ({number(1000 / mean, 1)} Hz)" if mean > 0 else ""
    shortest, longest = (number(float(gap), 1) for gap in (gaps.min(), gaps.max()))
    return (
        f"{count(len(stamps), 'message')}, one every {number(mean, 1)} ms on average{frequency}, "
        f"the shortest interval {shortest} ms and the longest {longest} ms"
    )


LISTED = 12
"""How many names a sentence lists at most."""


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """'Did you mean "/navigator"?', or "" where nothing is near."""
    found = nearest(name, known)
    return f'Did you mean "{found}"?' if found else ""


def enumerated(names: Iterable[str]) -> str:
    """Names in a sentence: the first dozen, and how many more there are; "none" for none."""
    known = list(names)
    more = f" and {len(known) - LISTED} more" if len(known) > LISTED else ""
    return (", ".join(known[:LISTED]) or "none") + more


def shortened(text: str, most: int) -> str:
    """The text, or as much of it as fits into so many characters, the last of which is an ellipsis."""
    return text if len(text) <= most else f"{text[: most - 1]}…"


def same(one: Any, other: Any) -> bool:
    """Whether two values are equal; not-a-number counts as equal to itself."""
    return bool(one == other or (one != one and other != other))


def within(what: str, value: Any, low: float = -math.inf, high: float = math.inf) -> float:
    """A number that came from a page or a cell. Raises ValueError unless it is a finite one from `low` to `high`."""
    is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
    if not is_number or not math.isfinite(value) or not low <= value <= high:
        span = f" from {low:g} to {high:g}" if math.isfinite(low) else ""
        raise ValueError(f"The {what} must be a number{span}, got {value!r}.")
    return float(value)


def suggestion(name: str, known: Iterable[str]) -> str:
    """What to try for a name that is not there, of those that are: the one that was perhaps meant, or all of them."""
    names = list(known)
    return did_you_mean(name, names) or f"There are: {enumerated(names)}."
