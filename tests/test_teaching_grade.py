"""`turtle-lesson grade`: whatever a copy does, it gets an answer, and so do the others."""

from __future__ import annotations

import json
import time
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest
import teaching_copies as copies

from turtle_lesson.lab.checks import checks_of
from turtle_lesson.teaching.grade import CheckScore, Graded
from turtle_lesson.teaching.main import main
from turtle_lesson.teaching.report import as_json, in_words


def test_a_class_of_twenty_is_graded(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    expected = copies.a_class(tmp_path)
    assert len(expected) == 20
    began = time.monotonic()
    code = main(
        ["grade", str(tmp_path), "--json", "--junit", str(tmp_path / "junit.xml"), "--timeout", "30", "--jobs", "2"]
    )
    assert time.monotonic() - began < 20 * 35, "each copy has its limit, and nobody waits for ever"
    assert code == 1  # some could not be run to their end
    graded = {Path(each["path"]).stem: each for each in json.loads(capsys.readouterr().out)["copies"]}
    assert {name: each["earned"] for name, each in graded.items()} == {
        name: points for name, (points, _) in expected.items()
    }
    for name, (_, problem) in expected.items():
        assert (problem in graded[name]["problem"]) if problem else not graded[name]["problem"], name
    assert graded["typing_error"]["errors"][0].startswith("cell 2 raised SyntaxError")
    assert graded["endless_cell"]["errors"] == ["cell 2 took more than 12 s, and was stopped"]
    assert {each["state"] for each in graded["dies"]["checks"]} == {"not run"}
    of_the_page = sum(each.points for each in checks_of(copies.PAGE))
    assert {each["points"] for each in graded.values() if each["page"]} == {of_the_page}
    missed = graded["slow"]["checks"][0]["rows"]
    assert any("every 1000.0 ms" in row["seen"] and row["mark"] == "✗" for row in missed)
    suites = ElementTree.parse(tmp_path / "junit.xml").getroot()
    assert len(suites) == 20
    assert not list(tmp_path.glob(".turtle_lesson*")), "grading leaves no points behind"


def test_the_table_says_what_was_missed() -> None:
    rows = [
        {"mark": "✓", "expected": "one node /counter", "seen": "it is there", "next": ""},
        {"mark": "✗", "expected": "/count: a message every 500 ms", "seen": "every 1000.0 ms", "next": "0.5 s"},
    ]
    anna = Graded(
        Path("anna.ipynb"), copies.PAGE, [CheckScore("counter", 3, "failed", rows), CheckScore("doubler", 3, "not run")]
    )
    ben = Graded(
        Path("benjamin.ipynb"), problem="is not a notebook: Expecting value", errors=["cell 2 raised NameError: x"]
    )
    assert in_words([anna, ben]).splitlines() == [
        "anna.ipynb        0 of   6 points  01_publish_and_subscribe",
        "  ✗ counter   0 of  3  /count: a message every 500 ms: every 1000.0 ms",
        "  – doubler   0 of  3  it was not run",
        "",
        "benjamin.ipynb    0 of   0 points",
        "  ! is not a notebook: Expecting value",
        "  ! cell 2 raised NameError: x",
        "",
        "2 graded, 0 with all points, 1 not run to the end.",
    ]
    assert as_json([anna])["copies"][0]["checks"][0]["state"] == "failed"


def test_a_named_file_that_is_missing_is_an_answer_too(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["grade", str(tmp_path / "gone.ipynb")]) == 1
    assert "gone.ipynb" in capsys.readouterr().out


def test_a_folder_without_notebooks_is_said(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["grade", str(tmp_path)]) == 1
    assert "there is no notebook in" in capsys.readouterr().err


@pytest.mark.parametrize(
    "wrong",
    [["grade"], ["grade", "x", "--timeout", "0"], ["grade", "x", "--jobs", "no"], ["mark"], ["reset", "x", "--all"]],
)
def test_a_wrong_use_is_explained(wrong: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as stop:
        main(wrong)
    assert stop.value.code == 2
    assert "usage: turtle-lesson" in capsys.readouterr().err


def test_results_are_read_with_care() -> None:
    from turtle_lesson.teaching.worker import results_in

    notebook = copies.copy("", "")
    fakes: list[Any] = [None, 3, {"name": "counter"}, {"name": "counter", "rows": [1, {"mark": "✓"}], "passed": "yes"}]
    import nbformat

    cell = notebook.cells[0]
    cell.outputs = [
        nbformat.v4.new_output("display_data", metadata={"turtle_lesson_check": figures}) for figures in fakes
    ]
    assert results_in(notebook)["counter"]["passed"] is False
