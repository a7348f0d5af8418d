"""Names that somebody typed: which one was meant, and a list of those that there are."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches

LISTED = 12
"""How many names a sentence lists at most."""


def nearest(name: str, known: Iterable[str], cutoff: float = 0.6) -> str:
    """The known name that is most like this one, or "" if none is; capitals and outer slashes do not count."""
    by_plain = {each.lower().strip("/"): each for each in known}
    close = get_close_matches(name.lower().strip("/"), by_plain, n=1, cutoff=cutoff)
    return by_plain[close[0]] if close else ""


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """'Did you mean "/navigator"?', or "" where nothing is near."""
    found = nearest(name, known)
    return f'Did you mean "{found}"?' if found else ""


def enumerated(names: Iterable[str]) -> str:
    """Names in a sentence: the first dozen, and how many more there are; "none" for none."""
    known = list(names)
    more = f" and {len(known) - LISTED} more" if len(known) > LISTED else ""
    return (", ".join(known[:LISTED]) or "none") + more


def is_hidden(name: str) -> bool:
    """Whether ROS's tools leave a name out of their lists: a part of it starts with an underscore."""
    return any(part.startswith("_") for part in name.split("/"))
