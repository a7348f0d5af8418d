"""The points of a learner over all pages, in one small file beside the notebooks. No account, no network.

What was earned once stays. The file is read anew before each change, so that two notebooks at once lose nothing; one that
is damaged is kept under another name, and said so.
"""

from __future__ import annotations

import html
import json
import os
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from ..ros.runtime import files
from .checks.registry import Check
from .checks.results import CheckResult
from .words import count

FILE = ".turtle_lesson_progress.json"
VARIABLE = "TURTLE_LESSON_PROGRESS"
"""Environment variable: another file, or "off" to keep points only as long as the kernel lives (for tests of pages)."""

KERNEL_ONLY = "points are only kept until the kernel ends."
FORMAT = 1
BAR = 20


class ProgressFile:
    """Best points for each check, and how often it has failed in a row, kept in a file; in memory where `path` is None."""

    def __init__(self, path: Path | None) -> None:
        self.path = path
        self._points: dict[str, int] = {}
        self._failures: dict[str, int] = {}
        self.remark = ""
        """What went wrong with the file, as a sentence; "" if nothing did."""

    def note(self, result: CheckResult) -> int:
        """Keep what a check has earned, if it is more than before; returns how often it has failed in a row."""
        self._read()
        before = self._points.get(result.name, 0), self._failures.get(result.name, 0)
        self._points[result.name] = max(result.earned, before[0])
        self._failures[result.name] = failures = 0 if result.passed else before[1] + 1
        if (self._points[result.name], failures) != before:
            self._write()
        return failures

    def points(self) -> dict[str, int]:
        """Earned points by the name of the check."""
        self._read()
        return {name: each for name, each in self._points.items() if each}

    def _read(self) -> None:
        """Take over the points, and the failures in a row, that the file holds."""
        file = self.path
        if file is None or not file.is_file():
            return
        try:
            text = file.read_bytes()
            try:
                content = json.loads(text)
                points = _numbers_in(content, "points")
                self._points |= {name: max(each, self._points.get(name, 0)) for name, each in points.items()}
                self._failures |= _numbers_in({"failures": {}, **content}, "failures")
            except (ValueError, RecursionError):
                aside = files.unused(lambda number: file.with_name(f"{file.name}.broken-{number}"))
                file.rename(aside)
                self.remark = f"{file.name} was damaged. It is kept as {aside.name}, and a new one was started."
                self._write()
        except OSError as error:
            self.remark = f"{file.name} cannot be read, or not be replaced ({error.strerror}); {KERNEL_ONLY}"
            self.path = None

    def _write(self) -> None:
        if self.path is None:
            return
        kept = {"points": self._points, "failures": self._failures}
        content = {key: {k: v for k, v in sorted(each.items()) if v} for key, each in kept.items()}
        try:
            files.write(self.path, json.dumps({"format": FORMAT, **content}, indent=1) + "\n")
        except OSError as error:
            self.remark = f"{self.path.name} cannot be written ({error.strerror}); {KERNEL_ONLY}"


def _numbers_in(content: object, key: str) -> dict[str, int]:
    numbers = content.get(key) if isinstance(content, dict) and content.get("format") == FORMAT else None
    if not isinstance(numbers, dict) or not all(type(each) is int and each >= 0 for each in numbers.values()):
        raise ValueError("not a file of points")
    return numbers


def progress_file(folder: Path) -> ProgressFile:
    """The file of a folder of notebooks, or what the environment says instead."""
    said = os.environ.get(VARIABLE, "")
    if said.lower() == "off":
        return ProgressFile(None)
    return ProgressFile(Path(said) if said else folder / FILE)


@dataclass(frozen=True)
class PageScore:
    """One page: points earned and to be had, and the checks that are still open."""

    page: str
    earned: int
    points: int
    open: tuple[str, ...]


class Progress:
    """Points over all pages, as a table."""

    def __init__(self, checks: Iterable[Check], earned: dict[str, int], remark: str = "") -> None:
        self.remark = remark
        by_page: dict[str, list[Check]] = {}
        for check in checks:
            by_page.setdefault(check.page, []).append(check)
        self.pages: list[PageScore] = []
        for page, of_page in by_page.items():
            got = {each.name: min(earned.get(each.name, 0), each.points) for each in of_page}
            still = tuple(each.name for each in of_page if got[each.name] < each.points)
            self.pages.append(PageScore(page, sum(got.values()), sum(each.points for each in of_page), still))
        self.earned = sum(each.earned for each in self.pages)
        self.points = sum(each.points for each in self.pages)

    def so_far(self, page: str) -> str:
        """The points of a page and in all: "7 of 10 points on this page, 23 of 131 in all."."""
        here = next(each for each in self.pages if each.page == page)
        return f"{here.earned} of {count(here.points, 'point')} on this page, {self.earned} of {self.points} in all."

    @property
    def headline(self) -> str:
        """All in one line."""
        return f"{self.earned} of {count(self.points, 'point')}."

    def __repr__(self) -> str:
        wide = max((len(each.page) for each in self.pages), default=0)
        lines = []
        for each in self.pages:
            done = BAR * each.earned // each.points
            bar = "█" * done + "·" * (BAR - done)
            still = f"open: {', '.join(each.open)}" if each.open else "done"
            lines.append(f"  {each.page.ljust(wide)}  {bar}  {each.earned:2} of {each.points:2}  {still}")
        return "\n".join(filter(None, [self.headline, *lines, self.remark]))

    def _repr_html_(self) -> str:
        cell = 'style="text-align: left; white-space: nowrap"'
        rows = ""
        for each in self.pages:
            points = f"{each.earned} of {each.points}"
            meter = f'<meter min="0" max="{each.points}" value="{each.earned}">{points}</meter>'
            cells = (each.page, meter, points, html.escape(", ".join(each.open) or "none"))
            rows += f"<tr>{''.join(f'<td {cell}>{text}</td>' for text in cells)}</tr>"
        remark = f"<p>{html.escape(self.remark)}</p>" if self.remark else ""
        head = f"<tr><th {cell}>page</th><th></th><th {cell}>points</th><th {cell}>open</th></tr>"
        table = f"<table><thead>{head}</thead><tbody>{rows}</tbody></table>"
        return f"<p><strong>{self.headline}</strong></p>{table}{remark}"
