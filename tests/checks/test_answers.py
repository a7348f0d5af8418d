"""Every published stub fails its check, every solution passes it, and so does each wrong and each right answer in `answers`.

One page, or one check: pytest tests/checks/test_answers.py -k "page_03 and short_way"
"""

from __future__ import annotations

import importlib
import os
from collections.abc import Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pytest
from answers import NOTEBOOKS, Answer, Answers, answer, code_cells, solution, stub
from answers.client import PageServer

from turtle_lesson.lab.checks.registry import all_checks
from turtle_lesson.learner.story import PAGES

LEAST_WRONG, LEAST_RIGHT = 6, 4
TESTS = Path(__file__).resolve().parents[1]
PUBLISHED = [page for page in PAGES if (NOTEBOOKS / f"{page}.ipynb").is_file()]
EXERCISES = [(page, cell["exercise"]) for page in PUBLISHED for cell in code_cells(page) if "exercise" in cell["tags"]]
NAMES = [f"page_{page.partition('_')[0]}-{name}" for page, name in EXERCISES]
AT_ONCE = 2
"""How many pages are run side by side."""

Verdict = dict[str, Any]


def answers_to(page: str, exercise: str) -> Answers:
    """What is kept of an exercise; nothing where there is nothing yet."""
    name = f"page_{page.partition('_')[0]}"
    if not (TESTS / "answers" / f"{name}.py").is_file():
        return Answers({}, {})
    found: Answers = importlib.import_module(f"answers.{name}").ANSWERS.get(exercise, Answers({}, {}))
    return found


def wanted(page: str, exercise: str) -> dict[str, tuple[Answer, str | None]]:
    """All answers to an exercise, by their labels, each with what is to be said of it; None of a right one."""
    kept = answers_to(page, exercise)
    return {
        "(stub)": (Answer(stub(page, exercise)), ""),
        **{f"wrong: {label}": (answer(given), says) for label, (given, says) in kept.wrong.items()},
        "(solution)": (Answer(solution(page, exercise)), None),
        **{f"right: {label}": (answer(given), None) for label, given in kept.right.items()},
    }


def request(exercise: str, given: Answer) -> dict[str, Any]:
    """What the server is asked of an answer."""
    return {"exercise": exercise, "sources": given.sources, "cells": dict(given.cells)}


def run_page(server: PageServer, page: str, exercises: dict[str, Future[dict[str, Verdict]]]) -> None:
    """Run a page as far as these exercises want it, and give each the verdicts on its answers."""
    running = server.page(page)
    try:
        for exercise, future in exercises.items():
            try:
                given = wanted(page, exercise)
                future.set_result({label: running.ask(request(exercise, each)) for label, (each, _) in given.items()})
            except Exception as error:
                future.set_exception(error)
    finally:
        running.close()


@pytest.fixture(scope="module")
def verdicts(
    request: pytest.FixtureRequest, page_server: PageServer
) -> Iterator[dict[tuple[str, str], Future[dict[str, Verdict]]]]:
    """The verdicts on the answers to each exercise that a selected test wants, from two pages at a time."""
    selected = [
        item.callspec.params  # type: ignore[attr-defined]  # which each parametrized item has
        for item in request.session.items
        if getattr(item, "originalname", "") == test_wrong_answers_fail_and_right_ones_pass.__name__
    ]
    by_page: dict[str, dict[str, Future[dict[str, Verdict]]]] = {}
    for page, exercise in EXERCISES:  # in the order of the page's cells, whatever the order of the tests
        if {"page": page, "exercise": exercise} in selected:
            by_page.setdefault(page, {})[exercise] = Future()
    with ThreadPoolExecutor(AT_ONCE) as pool:
        for page, exercises in by_page.items():
            pool.submit(run_page, page_server, page, exercises)
        yield {(page, name): future for page, exercises in by_page.items() for name, future in exercises.items()}
        pool.shutdown(cancel_futures=True)


@pytest.mark.parametrize(("page", "exercise"), EXERCISES, ids=NAMES)
def test_wrong_answers_fail_and_right_ones_pass(
    verdicts: dict[tuple[str, str], Future[dict[str, Verdict]]], page: str, exercise: str
) -> None:
    found = verdicts[page, exercise].result()
    table, faults = [], []
    for label, (_, says) in wanted(page, exercise).items():
        verdict = found[label]
        fault = fault_of(verdict, says)
        table.append(f"{'FAULT' if fault else 'ok   '} {'passed' if verdict.get('passed') else 'failed'}  {label}")
        if fault:
            faults.append(
                f"--- {label}: {fault}\n{verdict.get('text', '')}\n{os.linesep.join(verdict.get('errors', []))}"
            )
    assert not faults, "\n".join(["", *table, *faults])


def fault_of(verdict: Verdict, says: str | None) -> str:
    """What is wrong with a verdict; "" if nothing is. `says`: what is to be said of a wrong answer, None of a right one."""
    if "broken" in verdict:
        return f"it could not be run: {verdict['broken']}{verdict.get('printed', '')}"
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
