"""`turtle-lesson grade`: whatever a copy does, it gets an answer, and so do the others; and no copy gets points by a trick."""

from __future__ import annotations

import csv
import io
import json
import os
import subprocess
import sys
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import nbformat
import psutil
import pytest
import teaching_copies as copies
from forgeries import FORGERIES, FORKED, PACKAGE_BESIDE

from turtle_lesson.lab.checks.registry import all_checks
from turtle_lesson.teaching import runner
from turtle_lesson.teaching.copies import Copy, environment, is_too_full
from turtle_lesson.teaching.grade import CheckScore, Graded, as_csv, as_json, grade, in_words, judged, plain
from turtle_lesson.teaching.main import main
from turtle_lesson.teaching.runner import Runner, Seen
from turtle_lesson.teaching.worker import _parts


@dataclass
class Run:
    """One run of `turtle-lesson grade` over many copies."""

    folder: Path
    expected: dict[str, tuple[int, str]]
    code: int
    copies: dict[str, Any]
    """What the JSON says of each copy, by its path in the folder."""
    said: str
    """What was told meanwhile."""


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Run]:
    """A class and the forgeries, graded together: a kernel's start is what takes most of the time."""
    folder = tmp_path_factory.mktemp("class")
    expected = copies.a_class(folder)
    for name, cell in FORGERIES.items():
        copies.write(folder, f"forged_{name}", forged(cell))
    copies.write(folder, "forged_by_children", forged(FORKED.replace("PIDS", str(folder / "pids"))))
    beside = forged(PACKAGE_BESIDE)
    beside.cells = [beside.cells[1], beside.cells[0], *beside.cells[2:]]
    copies.write(folder, "forged_package_beside", beside)
    copies.write(folder, "forged_outputs", with_outputs(forged("pass")))
    out, err = io.StringIO(), io.StringIO()
    reports = ["--junit", str(folder / "junit.xml"), "--csv", str(folder / "points.csv")]
    with pytest.MonkeyPatch.context() as patch, redirect_stdout(out), redirect_stderr(err):
        patch.setenv("TEACHERS_TOKEN", "of-the-teacher")
        patch.setattr(runner, "installed", dict)  # work on the lesson may go on meanwhile
        code = main(["grade", str(folder), "--json", *reports, "--timeout", "8", "--memory", "1.5"])
    graded = {each["path"].removeprefix(f"{folder}{os.sep}"): each for each in json.loads(out.getvalue())["copies"]}
    by_name = {path.removesuffix(".ipynb"): each for path, each in graded.items()}
    yield Run(folder, expected, code, by_name, err.getvalue())


def forged(cell: str) -> Any:
    """A copy of the page without answers, with this cell before its first check."""
    notebook = copies.copy(copies.STUB, copies.STUB)
    notebook.cells = [notebook.cells[0], nbformat.v4.new_code_cell(cell), notebook.cells[2], notebook.cells[-1]]
    return notebook


def with_outputs(notebook: Any) -> Any:
    """The same, as if its checks had been passed."""
    rows = [{"mark": "✓", "expected": "one node /counter", "seen": "it is there", "next": ""}]
    for name, cell in zip(("", "", "counter", "doubler"), notebook.cells, strict=True):
        figures = {"name": name, "passed": True, "rows": rows}
        cell.outputs = [nbformat.v4.new_output("display_data", metadata={"turtle_lesson_check": figures})]
    return notebook


def test_a_class_is_graded(run: Run) -> None:
    assert run.code == 1  # some could not be run to their end
    honest = {name: each for name, each in run.copies.items() if not name.startswith("forged")}
    assert {name: each["earned"] for name, each in honest.items()} == {
        name: points for name, (points, _) in run.expected.items()
    }
    for name, (_, problem) in run.expected.items():
        assert (problem in honest[name]["problem"]) if problem else not honest[name]["problem"], name
    assert honest["typing_error"]["errors"][0].startswith("cell 2 raised SyntaxError")
    assert honest["endless_cell"]["errors"] == ["cell 2 took more than 3 s, and was stopped"]
    assert honest["curious"]["errors"] == [], "no variable of the teacher's shell is seen"
    of_the_page = sum(each.points for each in all_checks() if each.page == copies.PAGE)
    assert {each["points"] for each in honest.values() if each["page"]} == {of_the_page}
    missed = honest["slow"]["checks"][0]["rows"]
    assert any("every 1000.0 ms" in row["seen"] and row["mark"] == "✗" for row in missed)
    assert not list(run.folder.glob(".turtle_lesson*")), "grading leaves no points behind"


@pytest.mark.skipif(not hasattr(os, "fork"), reason="this system limits neither memory nor files")
def test_a_copy_that_wants_too_much_is_refused(run: Run) -> None:
    memory, file = run.copies["greedy"]["errors"]
    assert memory.startswith("cell 2 raised MemoryError")
    assert file.startswith("cell 3 raised OSError")


def test_a_forged_copy_gets_nothing(run: Run) -> None:
    found = {name: each for name, each in run.copies.items() if name.startswith("forged")}
    assert len(found) == len(FORGERIES) + 3
    assert {name: each["earned"] for name, each in found.items()} == dict.fromkeys(found, 0)


@pytest.mark.parametrize(
    ("name", "replaced"),
    [
        ("results_patched", "turtle_lesson.lab.checks.results.CheckResult.passed"),
        ("results_redefined", "turtle_lesson.lab.checks.assertions.Row"),
        ("checks_replaced", "turtle_lesson.lab.checks.registry._checks"),
        ("runner_replaced", "turtle_lesson.lab.checks.registry.run"),
        ("lesson_patched", "turtle_lesson.session.views.Inspection.check"),
        ("probe_patched", "turtle_lesson.lab.checks.probe.Probe.hear"),
        ("place_patched", "turtle_lesson.session.check_target.CheckTarget.published"),
        ("place_patched", "turtle_lesson.session.live.CellNodes.run_until"),
        ("node_patched", "rclpy.node.Node.get_node_names_and_namespaces"),
        ("builtins_patched", "builtins.all"),
        ("json_patched", "json.dumps"),
        ("package_beside", "the package turtle_lesson"),
    ],
)
def test_what_a_copy_has_replaced_is_named(run: Run, name: str, replaced: str) -> None:
    assert any(replaced in error for error in run.copies[f"forged_{name}"]["errors"]), run.copies[f"forged_{name}"]


@pytest.mark.skipif(not hasattr(os, "fork"), reason="there are no groups of processes on this system")
def test_nothing_that_a_copy_has_started_goes_on(run: Run) -> None:
    pids = (run.folder / "pids").read_text().split()
    assert len(pids) == 3
    alive = [pid for pid in map(int, pids) if psutil.pid_exists(pid)]
    assert all(psutil.Process(pid).status() == psutil.STATUS_ZOMBIE for pid in alive)


def test_each_report_names_the_copies_by_their_paths(run: Run) -> None:
    """Two of them have the same file name."""
    amount = len(run.copies)
    junit = ElementTree.parse(run.folder / "junit.xml").getroot()
    suites = {each.get("name") for each in junit}
    assert len({(case.get("classname"), case.get("name")) for case in junit.iter("testcase")}) == len(
        list(junit.iter("testcase"))
    )
    table = list(csv.DictReader(io.StringIO((run.folder / "points.csv").read_text(encoding="utf-8"))))
    assert len(suites) == len(table) == len(run.said.splitlines()) == amount
    for who, points in (("anna", 6), ("ben", 3)):
        path = str(run.folder / who / "page_01.ipynb")
        assert path in suites
        assert f"{path}  {points} of 10 points" in run.said
        (line,) = [each for each in table if each["path"] == path]
        assert (line["earned"], line["counter"], line["doubler"]) == (str(points), "3", str(points - 3))
    (forged,) = [each for each in junit if each.get("name", "").endswith("forged_runner_replaced.ipynb")]
    assert "turtle_lesson.lab.checks.registry.run" in forged.findtext("system-out", "")
    (line,) = [each for each in table if each["path"] == forged.get("name")]
    assert "turtle_lesson.lab.checks.registry.run" in line["remarks"]


def test_no_report_passes_on_what_a_terminal_or_a_browser_obeys(run: Run) -> None:
    junit, table = ((run.folder / name).read_text(encoding="utf-8") for name in ("junit.xml", "points.csv"))
    error = next(each for each in run.copies["error_first"]["errors"] if "ValueError" in each)
    assert error == "cell 3 raised ValueError: red ‹script>alert(1)‹/script>"
    copy = Graded(Path("a\x1b[2J\x07<b>.ipynb"), errors=["\x1b]8;;http://x\x1b\\link", "=HYPERLINK(1)"])
    copy.scores = [
        CheckScore("counter", 3, "failed", [{"mark": "✗", "expected": "\x9b31ma", "seen": "<i>", "next": ""}])
    ]
    for text in (
        junit,
        table,
        run.said,
        in_words([copy]),
        as_csv([copy]),
        json.dumps(as_json([copy]), ensure_ascii=False),
    ):
        assert not {"\x1b", "\x07", "\x9b", "\u202e"} & set(text)
        assert not any(tag in text for tag in ("<script", "<b>", "<i>"))
    assert plain("1 < 2, x <y>") == "1 < 2, x ‹y>"
    assert as_csv([Graded(Path("-1.ipynb"))]).splitlines()[1].startswith("'-1.ipynb,")


def ran(path: Path, found: Iterable[dict[str, Any]], monkeypatch: pytest.MonkeyPatch) -> Graded:
    """The verdict on a copy, if what runs it says this."""
    monkeypatch.setattr(Runner, "_run", lambda self, content, folder, stopped: iter(found))
    return judged(Copy(path), Runner(10, 1).run(b"", lambda: False))


def test_a_verdict_needs_every_row_of_its_check(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    good = [
        {"mark": "✓", "expected": each.expected, "seen": "", "next": ""}
        for each in next(found for found in all_checks() if found.page == copies.PAGE).expectations
    ]

    def verdict(rows: list[dict[str, str]], replaced: list[str], **more: Any) -> str:
        found = [
            {"metadata": {}, "asked": []},
            {"check": "counter", "rows": rows, "replaced": replaced},
            {"end": True} | more,
        ]
        return ran(tmp_path / f"{copies.PAGE}.ipynb", found, monkeypatch).scores[0].state

    monkeypatch.setattr(runner, "installed", dict)
    assert verdict(good, []) == "passed"
    assert verdict(good[1:], []) == "failed"
    assert verdict([*good, good[0] | {"mark": "–"}], []) == "failed"
    assert verdict([], []) == "failed"
    assert verdict(good, ["json.dumps"]) == "failed"


def test_a_grader_that_was_changed_meanwhile_says_so(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    states = iter([{"teaching/grade.py": b"1"}, {"teaching/grade.py": b"2"}])
    monkeypatch.setattr(runner, "installed", lambda: next(states))
    graded = ran(tmp_path / "00_welcome.ipynb", [{"end": True}], monkeypatch)
    assert graded.earned == 0
    assert "changed" in graded.problem and "teaching/grade.py" in graded.errors[0]


CASE = """
import json
from turtle_lesson import start
from turtle_lesson.teaching import observer, runner

lesson = start(seed=0)
case = lesson.trouble(9, name="topic silent")
for _ in range(2):
    question = {**runner.checking_code(), "check": "topic_case", "variable": "lesson", "secret": b""}
    print(observer.answer(question, globals(), b"key")[32:].decode())
"""


def test_the_open_case_is_known_to_checking_code_that_is_imported_afresh(tmp_path: Path) -> None:
    """In a process of its own, since all checks are imported again."""
    done = subprocess.run([sys.executable, "-c", CASE], cwd=tmp_path, capture_output=True, text=True, check=True)
    for line in done.stdout.splitlines()[-2:]:
        found = json.loads(line)
        case, *others = found["rows"]
        assert (case["expected"], case["mark"]) == ("the case 9, topic silent", "✓")
        assert len(others) > 2 and any(row["mark"] == "✗" for row in others), "the system is not mended"
        assert found["replaced"] == []


def test_an_interrupt_ends_all_copies_that_still_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    ended = []

    def wait(self: Runner, content: bytes, stopped: Callable[[], bool]) -> Seen:
        if content != b"first":
            while not stopped():
                time.sleep(0.01)
            ended.append(content)
        return Seen()

    def interrupt(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(Runner, "run", wait)
    monkeypatch.setattr("turtle_lesson.teaching.grade.in_a_line", interrupt)
    monkeypatch.setattr(Copy, "content", lambda self: self.path.name.encode())
    with pytest.raises(KeyboardInterrupt):
        grade([Copy(Path("first")), Copy(Path("second")), Copy(Path("third"))], 10, 2, 2)
    assert b"second" in ended


def test_a_machine_that_is_full_is_an_answer_too(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full() -> Iterator[dict[str, Any]]:
        yield {"metadata": {}, "asked": []}
        raise OSError(28, "No space left on device")

    graded = ran(tmp_path / "00_welcome.ipynb", full(), monkeypatch)
    assert graded.problem == "it could not be run: No space left on device"


def test_a_page_that_metadata_claim_is_compared_with_the_name(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    said = {"metadata": {"turtle_lesson": {"page": "00_welcome"}}, "asked": [], "end": True}
    graded = ran(tmp_path / "10_test_and_validate.ipynb", [said], monkeypatch)
    assert "its metadata say that it is 00_welcome, and its name that it is 10_test_and_validate" in graded.errors


@pytest.mark.parametrize(
    ("cell", "parts"),
    [
        ('lesson.check("a")', [("", "lesson", "a")]),
        ('x = 1\nlesson.check("a")  # now\ny = 2', [("x = 1", "lesson", "a"), ("y = 2", "", "")]),
        ('ros2 node list\nlesson.check("a")', [("ros2 node list", "lesson", "a")]),
        ('# lesson.check("a")', [('# lesson.check("a")', "", "")]),
        ('result = mine.check("a")', [('result = mine.check("a")', "mine", "a")]),
        ("case.check()", [("case.check()", "case", "trouble")]),
        ('%%solution a\nlesson.check("a")', [('%%solution a\nlesson.check("a")', "", "")]),
        ("print(1)", [("print(1)", "", "")]),
    ],
)
def test_the_cells_say_where_a_check_is_due(cell: str, parts: list[tuple[str, str, str]]) -> None:
    assert _parts(cell) == parts


def test_a_copy_gets_few_variables(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("GITHUB_TOKEN", "secret")
    monkeypatch.setenv("LC_ALL", "C.UTF-8")
    given = environment(tmp_path, "mark", "package")
    assert "GITHUB_TOKEN" not in given
    assert given["LC_ALL"] == "C.UTF-8" and given["PATH"] == os.environ["PATH"]
    assert given["HOME"] == given["TMPDIR"] == str(tmp_path)


def test_a_full_folder_is_noticed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "file").write_bytes(bytes(100))
    assert not is_too_full(tmp_path)
    monkeypatch.setattr("turtle_lesson.teaching.copies.MOST_BYTES", 99)
    assert is_too_full(tmp_path)


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
