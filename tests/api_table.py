"""What of rclpy's public modules is here: the list in data/rclpy_api.txt, checked, and as a table for DIFFERENCES.md.

``python tests/api_table.py`` prints the table; with ``--write`` it puts it between the two markers in
turtle_lesson/ros/DIFFERENCES.md. The list holds the names and signatures of a real rclpy (Jazzy's, and what Kilted
added), and what we say of each:

    [rclpy.client]
    = Client.call(request, timeout_sec=None)     here, and with this signature
    = ClockType.(ROS_TIME, SYSTEM_TIME)          short for ClockType.ROS_TIME and ClockType.SYSTEM_TIME
    ~ name : why                                 here, but not in all that it does
    - name : why                                 not here
    - name : left out                            not here, as no course uses it: all of these share one row

A default that is no plain value is written …; a name without brackets is only looked for.
"""

from __future__ import annotations

import argparse
import importlib
import inspect
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import turtle_lesson  # puts our rclpy on the path

HERE = Path(__file__).parent
LIST = HERE / "data" / "rclpy_api.txt"
DIFFERENCES = Path(turtle_lesson.__file__).parent / "ros" / "DIFFERENCES.md"
"""The page that shows the table."""
MARKERS = ("<!-- rclpy: begin -->\n", "<!-- rclpy: end -->\n")
LEFT_OUT = "left out"
LINE = re.compile(r"(?P<mark>[=~-]) (?P<name>[\w.]+)(?P<signature>\([^()]*\))?(?: : (?P<why>.+))?")


@dataclass(frozen=True)
class Entry:
    """A name of the list, in its module."""

    module: str
    mark: str
    name: str
    signature: str
    why: str

    @property
    def is_here(self) -> bool:
        """Whether we say that it is here, at least in part."""
        return self.mark != "-"


def entries(path: Path = LIST) -> Iterator[Entry]:
    """All names of the list, in its order."""
    module = ""
    for line in path.read_text(encoding="utf-8").splitlines():
        text = line.split("  #")[0].strip()
        if text.startswith("["):
            module = text.strip("[]")
        elif text and not text.startswith("#"):
            yield from _of_line(module, text)


def _of_line(module: str, text: str) -> Iterator[Entry]:
    match = LINE.fullmatch(text)
    if match is None or (match["mark"] != "=") != bool(match["why"]):
        raise ValueError(f"a line of {LIST.name} that means nothing, or gives no reason: {text}")
    mark, name, signature, why = (match[part] or "" for part in ("mark", "name", "signature", "why"))
    if not name.endswith("."):
        yield Entry(module, mark, name, signature, why)
        return
    for member in signature.strip("()").split(", "):
        yield Entry(module, mark, name + member, "", why)


def faults(found: list[Entry]) -> list[str]:
    """What the list says and our modules don't: sentences."""
    return [fault for entry in found if (fault := fault_of(entry))]


def fault_of(entry: Entry) -> str:
    """What is wrong with one name, or nothing."""
    full = f"{entry.module}.{entry.name}"
    thing = _look_up(entry)
    if not entry.is_here:
        return "" if thing is _MISSING else f"{full} is here, but listed as missing"
    if thing is _MISSING:
        return f"{full} is not here"
    if not entry.signature:
        return ""
    ours = signature_of(thing)
    return "" if _alike(entry.signature, ours) else f"{full}{entry.signature} is {ours} here"


_MISSING = object()


def _look_up(entry: Entry) -> Any:
    try:
        thing: Any = importlib.import_module(entry.module)
    except (ImportError, NotImplementedError):
        return _MISSING
    for part in entry.name.split("."):
        try:
            thing = getattr(thing, part, _only_of_instances(thing, part))
        except NotImplementedError:  # that is how a missing name explains itself
            return _MISSING
    return thing


def _only_of_instances(thing: Any, name: str) -> Any:
    """What stands for an attribute that only the instances of a class have."""
    kinds = getattr(thing, "__mro__", ())
    return any(name in inspect.get_annotations(kind) for kind in kinds) or _MISSING


def signature_of(thing: Callable[..., Any]) -> str:
    """The parameters of something callable as one reads them, without self and annotations."""
    try:
        parameters = list(inspect.signature(thing).parameters.values())
    except (TypeError, ValueError):
        return "(not callable)"
    words: list[str] = []
    starred = False
    for index, one in enumerate(parameters):
        if index == 0 and one.name in ("self", "cls"):
            continue
        if one.kind is one.KEYWORD_ONLY and not starred:
            words.append("*")
        starred = starred or one.kind in (one.KEYWORD_ONLY, one.VAR_POSITIONAL)
        words.append(_word(one))
    return f"({', '.join(words)})"


def _word(one: inspect.Parameter) -> str:
    star = {one.VAR_POSITIONAL: "*", one.VAR_KEYWORD: "**"}.get(one.kind, "")
    if one.default is one.empty:
        return star + one.name
    plain = one.default is None or type(one.default) in (bool, int, float, str)
    return f"{one.name}={one.default!r}" if plain else f"{one.name}=…"


def _alike(theirs: str, ours: str) -> bool:
    """Whether two signatures say the same; what is written … there may be any default here."""
    wanted, found = theirs.split(", "), ours.split(", ")
    return len(wanted) == len(found) and all(
        a == b or (a.rstrip(")").endswith("=…") and a.split("=")[0] == b.split("=")[0]) or (a[:2] == b[:2] == "**")
        for a, b in zip(wanted, found, strict=True)
    )


def table(found: list[Entry]) -> str:
    """The Markdown table: a row for each module that lacks something, and one for all others."""
    by_module: dict[str, list[Entry]] = {}
    for entry in found:
        by_module.setdefault(entry.module, []).append(entry)
    left_out = _names_left_out(by_module)
    by_module = {
        module: of
        for module, all_of in by_module.items()
        if (of := [entry for entry in all_of if entry.why != LEFT_OUT])
    }
    whole = [f"`{module}` {len(of)}" for module, of in by_module.items() if not any(entry.why for entry in of)]
    rows = ["| module | names here | in part, or not at all |", "|---|---|---|"]
    rows += [_row(module, of) for module, of in by_module.items() if any(entry.why for entry in of)]
    if left_out:
        rows.append(f"| left out, as no course uses it | none | {left_out} |")
    rows.append(f"| {', '.join(whole)} | all | |")
    return "\n".join(rows) + "\n"


def _names_left_out(by_module: dict[str, list[Entry]]) -> str:
    """What no course uses, as names: of whole modules, and of members of classes that are here."""
    names: list[str] = []
    for module, found in by_module.items():
        gone = [entry.name for entry in found if entry.why == LEFT_OUT]
        names += [module] if gone and len(gone) == len(found) else gone
    return ", ".join(f"`{name}`" for name in names)


def _row(module: str, found: list[Entry]) -> str:
    here = sum(entry.is_here for entry in found)
    return f"| `{module}` | {here} of {len(found)} | {'; '.join(_reasons(found))} |"


def _reasons(found: list[Entry]) -> Iterator[str]:
    """For each reason the names that it is given for, those of classes standing for their members."""
    by_reason: dict[str, list[str]] = {}
    for entry in found:
        names = by_reason.setdefault(entry.why, [])
        if entry.why and entry.name.rpartition(".")[0] not in names:
            names.append(entry.name)
    for why, names in by_reason.items():
        if why:
            yield f"{', '.join(f'`{name}`' for name in names)}: {why}"


def write(text: str, path: Path = DIFFERENCES) -> None:
    """Put the table between the markers of a page."""
    before, after = MARKERS
    head, rest = path.read_text(encoding="utf-8").split(before)
    tail = rest.split(after)[1]
    path.write_text(head + before + text + after + tail, encoding="utf-8")


def main() -> None:
    """Print the table or write it; complain about what is not as listed."""
    parser = argparse.ArgumentParser(description="What of rclpy is here.")
    parser.add_argument("--write", action="store_true", help="put the table into DIFFERENCES.md")
    arguments = parser.parse_args()
    found = list(entries())
    if wrong := faults(found):
        raise SystemExit("\n".join(wrong))
    write(table(found)) if arguments.write else print(table(found), end="")


if __name__ == "__main__":
    main()
