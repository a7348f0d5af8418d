"""Copies as nbgrader, Moodle and GitHub Classroom hand them out: found, with their learners' names, also in a zip file."""

from __future__ import annotations

import csv
import io
import zipfile
from pathlib import Path
from xml.etree import ElementTree

import pytest

from turtle_lesson.teaching import copies
from turtle_lesson.teaching.copies import Copy, find
from turtle_lesson.teaching.grade import Graded, as_csv, as_json, as_junit, in_a_line, in_words
from turtle_lesson.teaching.pages import PageError

PAGE, OTHER = "01_publish_and_subscribe.ipynb", "03_navigator.ipynb"


def lay_out(folder: Path, *files: str) -> Path:
    for name in files:
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(name)
    return folder


def zipped(path: Path, *files: str) -> Path:
    with zipfile.ZipFile(path, "w") as archive:
        for name in files:
            archive.writestr(name, name)
    return path


def learners(*paths: Path) -> list[tuple[str, str]]:
    return [(copy.learner, copy.path.name) for copy in find(paths)]


def test_nbgrader(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    work = [f"submitted/{who}/{when}/{page}" for who, when, page in (("ben", "w1", PAGE), ("anna", "w2", OTHER))]
    lay_out(tmp_path, *work, f"submitted/anna/w1/{PAGE}", "submitted/anna/w1/timestamp.txt")
    expected = [("anna", PAGE), ("anna", OTHER), ("ben", PAGE)]
    assert learners(tmp_path) == learners(tmp_path / "submitted") == expected
    monkeypatch.chdir(tmp_path / "submitted" / "ben")
    assert learners(Path("w1") / PAGE) == [("", PAGE)], "a folder above that only has the same name says nothing"


MOODLE = (
    f"Ben Bär_101_assignsubmission_file/{PAGE}",
    f"Anna Maria Adler_102_assignsubmission_file_/work/{PAGE}",
    "Anna Maria Adler_102_assignsubmission_onlinetext/onlinetext.html",
    f"Default group_assignsubmission_file/{PAGE}",
)


def test_moodle(tmp_path: Path) -> None:
    expected = [("Anna Maria Adler", PAGE), ("Ben Bär", PAGE), ("Default group", PAGE)]
    assert learners(lay_out(tmp_path / "all", *MOODLE)) == expected
    archive = zipped(tmp_path / "Robotics-Week 1-17.zip", *MOODLE, f"__MACOSX/x/._{PAGE}")
    assert learners(archive) == expected
    (anna, *_) = find([archive])
    assert anna.path == archive / MOODLE[1]
    assert anna.content() == MOODLE[1].encode()
    flat = lay_out(tmp_path / "flat", f"Ben Bär_101_assignsubmission_file_{PAGE}")
    assert learners(flat) == [("Ben Bär", f"Ben Bär_101_assignsubmission_file_{PAGE}")]


def test_two_weeks_of_one_learner_stand_together_and_two_of_one_name_apart(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    first = zipped(tmp_path / "1.zip", *(f"{who}_assignsubmission_file_/{PAGE}" for who in ("Bo_7", "Kim_8", "Kim_9")))
    second = zipped(tmp_path / "2.zip", *(f"{who}_assignsubmission_file_/{OTHER}" for who in ("Bo_17", "Cy_20")))
    assert learners(first, second) == [
        ("Bo", PAGE),
        ("Bo", OTHER),
        ("Kim (8)", PAGE),
        ("Kim (9)", PAGE),
        ("Cy", OTHER),
    ]
    folder = lay_out(tmp_path / "2", *(f"{who}_assignsubmission_file_/{PAGE}" for who in ("Kim_8", "Kim_9")))
    monkeypatch.chdir(folder / "Kim_8_assignsubmission_file_")
    assert learners(Path(".."), Path("..", "Kim_9_assignsubmission_file_", PAGE)) == [
        ("Kim (8)", PAGE),
        ("Kim (9)", PAGE),
    ]


def test_github_classroom(tmp_path: Path) -> None:
    lay_out(tmp_path, f"week-1-submissions/week-1-ben-b/{PAGE}", f"week-1-submissions/week-1-anna/my-lesson/{PAGE}")
    expected = [("anna", PAGE), ("ben-b", PAGE)]
    assert learners(tmp_path) == learners(tmp_path / "week-1-submissions") == expected


def test_an_unknown_layout_names_nobody(tmp_path: Path) -> None:
    lay_out(tmp_path, f"b/{PAGE}", f"a/{PAGE}", f"submitted/anna/{PAGE}", f"class-1/{PAGE}", f"class-2/{PAGE}")
    found = find([tmp_path])
    assert {copy.learner for copy in found} == {""}
    assert [copy.path for copy in found] == sorted(copy.path for copy in found)


def test_what_cannot_be_read_says_why(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "no.zip").write_text("this is none")
    with pytest.raises(PageError, match=r"no\.zip is not a zip file"):
        find([tmp_path / "no.zip"])
    (gone,) = find([tmp_path / "gone.zip"])
    with pytest.raises(PageError, match="cannot be read: No such file"):
        gone.content()
    archive = zipped(tmp_path / "all.zip", PAGE)
    (copy,) = find([archive])
    archive.write_bytes(archive.read_bytes()[:-30])
    with pytest.raises(PageError, match="cannot be read from the zip file"):
        copy.content()
    monkeypatch.setattr(copies, "LARGEST", 3)
    large = zipped(tmp_path / "large.zip", PAGE)
    with pytest.raises(PageError, match="is larger than"):
        find([large])[0].content()


def test_each_report_has_a_column_for_the_learner() -> None:
    graded = [Graded(Path("a.ipynb"), learner="=Anna\x1b[2J <b>"), Graded(Path("b.ipynb"), learner="Ben")]
    assert in_words(graded).splitlines()[:3] == [
        "=Anna ‹b>  a.ipynb    0 of   0 points",
        "",
        "Ben        b.ipynb    0 of   0 points",
    ]
    assert in_a_line(graded[1]) == "Ben  b.ipynb  0 of 0 points"
    assert [each["learner"] for each in as_json(graded)["copies"]] == ["=Anna ‹b>", "Ben"]
    assert [line["learner"] for line in csv.DictReader(io.StringIO(as_csv(graded)))] == ["'=Anna ‹b>", "Ben"]
    names = [each.get("value") for each in ElementTree.fromstring(as_junit(graded).encode()).iter("property")]
    assert names == ["=Anna ‹b>", "Ben"]
    assert "property" not in as_junit([Graded(Path("c.ipynb"))])


def test_a_copy_is_read_as_it_lies_there(tmp_path: Path) -> None:
    (tmp_path / "a.ipynb").write_bytes(b"\xff\x00")
    assert Copy(tmp_path / "a.ipynb").content() == b"\xff\x00"
