"""Every published stub fails its check, every solution passes it, and so does each wrong and each right answer in `answers`.

One page, or one check: pytest tests/test_answers.py -k "page_03 and short_way"
"""

from __future__ import annotations

import importlib
import json
import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from answers import NOTEBOOKS, Answer, Answers, answer, code_cells, solution, stub

from turtle_lesson.lab.checks import all_checks
from turtle_lesson.lab.checks.registry import PAGES

LEAST_WRONG, LEAST_RIGHT = 6, 4
TESTS = Path(__file__).resolve().parent
PUBLISHED = [page for page in PAGES if (NOTEBOOKS / f"{page}.ipynb").is_file()]
EXERCISES = [(page, cell["exercise"]) for page in PUBLISHED for cell in code_cells(page) if "exercise" in cell["tags"]]
NAMES = [f"page_{page.partition('_')[0]}-{name}" for page, name in EXERCISES]

Ask = Callable[[str, Answer], dict[str, Any]]


def answers_to(page: str, exercise: str) -> Answers:
    """What is kept of an exercise; nothing where there is nothing yet."""
    name = f"page_{page.partition('_')[0]}"
    if not (TESTS / "answers" / f"{name}.py").is_file():
        return Answers({}, {})
    found: Answers = importlib.import_module(f"answers.{name}").ANSWERS.get(exercise, Answers({}, {}))
    return found


class Server:
    """The process that runs one page."""

    def __init__(self, page: str) -> None:
        self.page = page
        environ = {**os.environ, "PYTHONPATH": os.pathsep.join([str(TESTS), str(TESTS.parent)])}
        self.process = subprocess.Popen(
            [sys.executable, "-m", "answers.server", page],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            env=environ,
            cwd=TESTS,
        )

    def ask(self, exercise: str, given: Answer) -> dict[str, Any]:
        """The verdict on an answer."""
        assert self.process.stdin is not None
        assert self.process.stdout is not None
        request = {"exercise": exercise, "sources": given.sources, "cells": dict(given.cells)}
        self.process.stdin.write(json.dumps(request) + "\n")
        self.process.stdin.flush()
        reply: dict[str, Any] = json.loads(self.process.stdout.readline())
        assert "broken" not in reply, reply["broken"] + reply.get("printed", "")
        return reply

    def close(self) -> None:
        """End it."""
        self.process.communicate("")


@pytest.fixture(scope="module")
def servers() -> Iterator[Callable[[str], Server]]:
    """Returns what gives the server of a page; one at a time is kept."""
    running: list[Server] = []

    def server(page: str) -> Server:
        if not running or running[-1].page != page:
            close()
            running.append(Server(page))
        return running[-1]

    def close() -> None:
        while running:
            running.pop().close()

    yield server
    close()


@pytest.mark.parametrize(("page", "exercise"), EXERCISES, ids=NAMES)
def test_wrong_answers_fail_and_right_ones_pass(servers: Callable[[str], Server], page: str, exercise: str) -> None:
    kept = answers_to(page, exercise)
    wanted: dict[str, tuple[Answer, str | None]] = {
        "(stub)": (Answer(stub(page, exercise)), ""),
        **{f"wrong: {label}": (answer(given), says) for label, (given, says) in kept.wrong.items()},
        "(solution)": (Answer(solution(page, exercise)), None),
        **{f"right: {label}": (answer(given), None) for label, given in kept.right.items()},
    }
    table, faults = [], []
    for label, (given, says) in wanted.items():
        verdict = servers(page).ask(exercise, given)
        fault = fault_of(verdict, says)
        table.append(f"{'ok   ' if not fault else 'FAULT'} {'passed' if verdict['passed'] else 'failed'}  {label}")
        if fault:
            faults.append(f"--- {label}: {fault}\n{verdict['text']}\n{os.linesep.join(verdict['errors'])}")
    assert not faults, "\n".join(["", *table, *faults])


def fault_of(verdict: dict[str, Any], says: str | None) -> str:
    """What is wrong with a verdict; "" if nothing is. `says`: what is to be said of a wrong answer, None of a right one."""
    if says is None:
        return "" if verdict["passed"] else "it should pass"
    if verdict["passed"]:
        return "it should fail"
    if any(says in row["says"] for row in verdict["rows"] if row["mark"] != "✓"):
        return ""
    return f"no row says {says!r}"


@pytest.mark.parametrize(("page", "exercise"), EXERCISES, ids=NAMES)
def test_there_are_answers_enough(page: str, exercise: str) -> None:
    kept = answers_to(page, exercise)
    assert len(kept.wrong) >= LEAST_WRONG
    assert len(kept.right) >= LEAST_RIGHT
    assert all(says for _, says in kept.wrong.values()), "a wrong answer comes with a text that a row must say"


def test_every_check_but_the_labs_own_has_an_exercise() -> None:
    assert {name for _, name in EXERCISES} <= {each.name for each in all_checks()}
