"""The story of the pages: which files of the learner's package each page leaves, read from the published pages themselves.

A page writes the package by cells that begin with `%%writefile` (or `%%writefile -a`). Those cells, with each exercise's stub
replaced by its solution, are replayed here as text; nothing is run.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Sequence
from functools import cache
from itertools import chain, combinations
from pathlib import Path

PAGES = (
    "00_welcome",
    "01_publish_and_subscribe",
    "02_services_and_interfaces",
    "03_navigator",
    "03b_answer_on_arrival",
    "04_status_monitor",
    "05_obstacle_detector",
    "06_parameters_and_launch",
    "07_command_line",
    "08_executors",
    "09_debugging_lab",
    "10_test_and_validate",
    "11_to_a_real_robot",
    "12_a_thousand_runs",
)
"""The lesson's pages, in their order."""

HERE = Path(__file__).resolve().parents[1]
FINISHED = HERE / "robot_controller"
"""The finished package, as a folder of ROS's."""
PUBLISHED = HERE / "pages" if (HERE / "pages").is_dir() else HERE.parent / "notebooks"
"""The published pages: in `notebooks` of a checkout; a wheel has them beside the modules."""

PACKAGE = "workspace/src/robot_controller/"
"""Where the learner's package is, seen from the notebook's folder."""

_DEFINITION = re.compile(r"\s*\n( *)(?:async )?(?:def|class) (\w+)")
_WRITE = re.compile(r"%%writefile\s+(?P<append>-a\s+|--append\s+)?(?P<file>\S+)[^\S\n]*\n(?P<text>.*)", re.DOTALL)


def page_named(name: str) -> str:
    """The page of this name; its number alone is enough: "04". Raises ValueError, which names the pages."""
    matches = [page for page in PAGES if name in (page, page.partition("_")[0])]
    if matches:
        return matches[0]
    raise ValueError(f"there is no page {name!r}, but {', '.join(PAGES)}")


def files_before(page: str) -> dict[str, str]:
    """The files of the package when a page begins: their text by their path in the package.

    Raises FileNotFoundError where the published pages are missing.
    """
    return {path: "".join(parts) for path, parts in sorted(parts_before(page).items())}


def parts_before(page: str) -> dict[str, tuple[str, ...]]:
    """The same files, each in the parts in which cells wrote it."""
    earlier = PAGES[: PAGES.index(page)]
    return {path: parts for each in earlier for path, parts in _states(each)}


def is_published(path: str, text: str, before: str) -> bool:
    """Whether a page before this one writes exactly this text into a file, as its final or an intermediate text.

    So does a page whose exercises were left as they are, or some of them.
    """
    return any((path, text) in _versions_with_open_exercises(page) for page in PAGES[: PAGES.index(before)])


@cache
def versions(page: str) -> tuple[tuple[str, str], ...]:
    """Each state of each file of the package that a page writes, in the page's order: (path in the package, text)."""
    return tuple((path, "".join(parts)) for path, parts in _states(page))


@cache
def _versions_with_open_exercises(page: str) -> frozenset[tuple[str, str]]:
    """The same, and those where one exercise or more is still as published."""
    names = sorted({name for name, _, _ in _code_cells(page)} - {""})
    some = chain.from_iterable(combinations(names, count) for count in range(len(names) + 1))
    states = chain.from_iterable(_states(page, still_open) for still_open in some)
    return frozenset((path, "".join(parts)) for path, parts in states)


@cache
def _states(page: str, still_open: tuple[str, ...] = ()) -> tuple[tuple[str, tuple[str, ...]], ...]:
    """The states in the page's order, each text in its parts, with these exercises as published and the others solved."""
    states: list[tuple[str, tuple[str, ...]]] = []
    latest = {path: list(parts) for path, parts in parts_before(page).items()}
    for source in _sources(page, still_open):
        match = _WRITE.match(source)
        if match is None or not match["file"].startswith(PACKAGE):
            continue
        path = match["file"].removeprefix(PACKAGE)
        text = match["text"] if match["text"].endswith("\n") else match["text"] + "\n"  # as the magic is given it
        latest[path] = with_part(latest.get(path, []), text) if match["append"] else [text]
        states.append((path, tuple(latest[path])))
    return tuple(states)


def divided(text: str, parts: Sequence[str]) -> list[str]:
    """A text that was changed by hand, divided where each of these parts began; undivided where one is not found."""
    lines = text.splitlines(keepends=True)
    beginnings = [_beginning(line) for line in lines]
    cuts = [0]
    for part in parts[1:]:
        if _beginning(part) not in beginnings[cuts[-1] + 1 :]:
            return [text]
        cuts.append(beginnings.index(_beginning(part), cuts[-1] + 1))
    return ["".join(lines[begin:end]) for begin, end in zip(cuts, [*cuts[1:], None], strict=True)]


def with_part(parts: list[str], text: str) -> list[str]:
    """The parts of a file after one more was appended; it replaces a part that begins by defining the same name."""
    begins = _beginning(text)
    same = [index for index, part in enumerate(parts) if index and _beginning(part) == begins]
    return [*parts[: same[0]], text, *parts[same[0] + 1 :]] if same else [*parts, text]


def _beginning(part: str) -> tuple[str, ...]:
    """What a part of a file begins with: an indentation and a name that is defined, or else its first line."""
    match = _DEFINITION.match(f"\n{part}")
    return match.groups() if match else (part.strip().partition("\n")[0],)


def _sources(page: str, still_open: tuple[str, ...]) -> Iterator[str]:
    """The sources of a published page's code cells: each exercise as its solution has it, but for those still open."""
    cells = _code_cells(page)
    solutions = {name: source.partition("\n")[2] for name, tags, source in cells if "solution" in tags}
    for name, tags, source in cells:
        if "exercise" in tags:
            yield source if name in still_open else solutions.get(name, source)
        elif "solution" not in tags:
            yield source


@cache
def _code_cells(page: str) -> list[tuple[str, list[str], str]]:
    """Of each code cell of a published page: the exercise that it belongs to, or "", its tags and its source."""
    found = []
    for cell in json.loads((PUBLISHED / f"{page}.ipynb").read_text(encoding="utf-8"))["cells"]:
        if cell["cell_type"] == "code":
            metadata = cell["metadata"]
            exercise = metadata.get("turtle_lesson", {}).get("exercise", "")
            found.append((exercise, metadata.get("tags", []), "".join(cell["source"])))
    return found
