"""Points: kept in a small file, never lost, never a reason to fail."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from turtle_lesson.lab.checks.registry import all_checks
from turtle_lesson.lab.checks.results import CheckResult, Row
from turtle_lesson.lab.progress import FILE, VARIABLE, Progress, ProgressFile, progress_file


def result(name: str, passed: bool = True, points: int = 3) -> CheckResult:
    return CheckResult(
        name, "A title", "01_publish_and_subscribe", points, (Row("✓" if passed else "✗", "a", "b"),), 0.0
    )


def test_points_survive_a_restart_and_a_later_failure(tmp_path: Path) -> None:
    ProgressFile(tmp_path / FILE).note(result("counter"))
    later = ProgressFile(tmp_path / FILE)
    later.note(result("counter", passed=False))
    assert later.points() == {"counter": 3}
    kept = json.loads((tmp_path / FILE).read_text())
    assert kept == {"format": 1, "points": {"counter": 3}, "failures": {"counter": 1}}


def test_failures_in_a_row_are_counted_over_restarts_and_begin_anew_when_it_is_passed(tmp_path: Path) -> None:
    counts = [
        ProgressFile(tmp_path / FILE).note(result("counter", passed=good)) for good in (False, False, True, False)
    ]
    assert counts == [1, 2, 0, 1]
    in_memory = ProgressFile(None)
    assert [in_memory.note(result(name, passed=False)) for name in ("counter", "doubler", "counter")] == [1, 1, 2]


def test_a_file_of_an_older_version_has_no_failures(tmp_path: Path) -> None:
    (tmp_path / FILE).write_text('{"format": 1, "points": {"counter": 3}}')
    file = ProgressFile(tmp_path / FILE)
    assert file.note(result("counter", passed=False)) == 1
    assert file.points() == {"counter": 3}


def test_two_notebooks_at_once_lose_nothing(tmp_path: Path) -> None:
    one, other = ProgressFile(tmp_path / FILE), ProgressFile(tmp_path / FILE)
    one.note(result("counter"))
    other.note(result("doubler"))
    one.note(result("adder"))
    assert ProgressFile(tmp_path / FILE).points() == {"counter": 3, "doubler": 3, "adder": 3}


@pytest.mark.parametrize(
    "damage",
    [
        b"",
        b"{",
        b"[]",
        b'{"format": 1}',
        b'{"format": 1, "points": {"a": "b"}}',
        b'{"format": 2, "points": {}}',
        b"\xff\xfe\x00",
    ],
)
def test_a_damaged_file_is_kept_aside_and_said(tmp_path: Path, damage: bytes) -> None:
    (tmp_path / FILE).write_bytes(damage)
    file = ProgressFile(tmp_path / FILE)
    file.note(result("counter"))
    assert file.points() == {"counter": 3}
    assert ProgressFile(tmp_path / FILE).points() == {"counter": 3}, "a new file holds what is earned from then on"
    assert (tmp_path / f"{FILE}.broken-1").read_bytes() == damage
    assert "was damaged" in file.remark
    assert "was damaged" in repr(Progress(all_checks(), file.points(), file.remark))


def test_what_was_earned_before_the_damage_goes_into_the_new_file(tmp_path: Path) -> None:
    file = ProgressFile(tmp_path / FILE)
    file.note(result("counter"))
    (tmp_path / FILE).write_text("{")
    assert file.points() == ProgressFile(tmp_path / FILE).points() == {"counter": 3}


def test_where_nothing_can_be_written_points_live_on_in_memory(tmp_path: Path) -> None:
    (tmp_path / "no folder").touch()
    file = ProgressFile(tmp_path / "no folder" / FILE)
    file.note(result("counter"))
    assert file.points() == {"counter": 3}
    assert "cannot be written" in file.remark


def test_the_environment_says_where(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert progress_file(tmp_path).path is None, "tests keep no points"
    monkeypatch.setenv(VARIABLE, str(tmp_path / "mine.json"))
    assert progress_file(tmp_path).path == tmp_path / "mine.json"
    monkeypatch.delenv(VARIABLE)
    assert progress_file(tmp_path).path == tmp_path / FILE


def test_the_table_shows_what_is_open() -> None:
    names = ("counter", "doubler", "adder", "interfaces")
    checks = [each for each in all_checks() if each.name in names]
    shown = Progress(checks, {"counter": 3, "doubler": 3, "adder": 3, "a check of old": 7})
    assert repr(shown) == (
        "9 of 13 points.\n"
        "  01_publish_and_subscribe    ████████████████████   6 of  6  done\n"
        "  02_services_and_interfaces  ████████············   3 of  7  open: interfaces"
    )
    assert shown._repr_html_().count("<meter") == 2
    assert shown.so_far("02_services_and_interfaces") == "3 of 7 points on this page, 9 of 13 in all."
