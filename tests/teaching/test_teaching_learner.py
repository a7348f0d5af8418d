"""`turtle-lesson open`: a learner's folder is made without outputs, and what was worked on in it stays."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

import nbformat
import pytest
import teaching_copies as copies

from turtle_lesson.teaching import main as command
from turtle_lesson.teaching import pages
from turtle_lesson.teaching.main import main
from turtle_lesson.teaching.pages import MEMORY, NAMES, LearnersFolder

NAME = f"{copies.PAGE}.ipynb"
REAL = Path(__file__).resolve().parents[2] / "notebooks"


@pytest.fixture
def checkout(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    return copies.publish(tmp_path, monkeypatch)


@pytest.fixture
def mine(tmp_path: Path) -> Path:
    return tmp_path / "my-lesson" / NAME


def work(path: Path, answer: str = copies.RIGHT) -> Any:
    """Type an answer into a copy, and run it."""
    notebook = nbformat.read(path, as_version=4)
    notebook.cells[1].source = answer
    nbformat.write(copies.was_run(notebook), path)
    return notebook


def publish_anew(checkout: Path, text: str) -> None:
    notebook = nbformat.read(checkout, as_version=4)
    notebook.cells.append(nbformat.v4.new_markdown_cell(text))
    nbformat.write(notebook, checkout)


def update(path: Path) -> list[str]:
    return LearnersFolder(path.parent).update()


def test_every_published_page_is_there_without_outputs_and_otherwise_unchanged(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(pages, "_from_git", lambda name: None)
    LearnersFolder(tmp_path).update()
    for name in NAMES:
        page, published = nbformat.read(tmp_path / name, as_version=4), nbformat.read(REAL / name, as_version=4)
        code = [cell for cell in page.cells if cell.cell_type == "code"]
        assert not any(cell.outputs or cell.execution_count for cell in code)
        kept = ("id", "cell_type", "source", "metadata")
        assert [[cell[key] for key in kept] for cell in page.cells] == [
            [cell[key] for key in kept] for cell in published.cells
        ]
        assert page.metadata == published.metadata


def test_pages_refer_to_no_file_that_a_learners_folder_lacks() -> None:
    import re

    for name in NAMES:
        text = "\n".join(cell.source for cell in nbformat.read(REAL / name, as_version=4).cells)
        linked = re.findall(r"\]\((?!https?:|#|attachment:)([^)#\s]+)|<img[^>]*src=\"(?!https?:|data:)([^\"]+)", text)
        assert {first or second for first, second in linked} <= set(NAMES), f"{name}: let LearnersFolder copy these"


def test_work_stays_and_an_untouched_page_follows_the_published_one(checkout: Path, mine: Path) -> None:
    assert update(mine) == []
    publish_anew(checkout, "second edition")
    assert update(mine) == []
    assert nbformat.read(mine, as_version=4).cells[-1].source == "second edition"
    work(mine)
    before = mine.read_bytes()
    assert update(mine) == []
    assert mine.read_bytes() == before


def test_a_newer_page_is_put_beside_work_once(checkout: Path, mine: Path) -> None:
    update(mine)
    work(mine)
    before = mine.read_bytes()
    publish_anew(checkout, "second edition")
    (sentence,) = update(mine)
    assert sentence.startswith(f"{NAME} holds your work, and the lesson has a newer version of the page")
    assert mine.read_bytes() == before
    beside = nbformat.read(mine.with_name(f"{copies.PAGE}.new-1.ipynb"), as_version=4)
    assert beside.cells[-1].source == "second edition"
    assert beside.cells[1].source == copies.STUB and not beside.cells[1].outputs
    mine.with_name(f"{copies.PAGE}.new-1.ipynb").unlink()
    assert update(mine) == [], "it was offered already"
    publish_anew(checkout, "third edition")
    assert len(update(mine)) == 1


def test_a_page_that_was_only_run_and_one_that_is_damaged_stay_too(checkout: Path, mine: Path) -> None:
    update(mine)
    nbformat.write(copies.was_run(nbformat.read(mine, as_version=4)), mine)
    publish_anew(checkout, "second edition")
    assert len(update(mine)) == 1
    assert nbformat.read(mine, as_version=4).cells[1].outputs
    mine.write_text("damaged")
    publish_anew(checkout, "third edition")
    assert len(update(mine)) == 1
    assert mine.read_text() == "damaged"
    (mine.parent / MEMORY).write_text("damaged, too")
    assert len(update(mine)) == 1
    assert mine.read_text() == "damaged"


def test_a_page_that_was_deleted_comes_back(checkout: Path, mine: Path) -> None:
    update(mine)
    mine.unlink()
    update(mine)
    assert mine.is_file()


def test_reset_in_a_learners_folder_leaves_no_outputs(
    checkout: Path, mine: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    update(mine)
    fresh = mine.read_bytes()
    work(mine)
    before = mine.read_bytes()
    publish_anew(checkout, "second edition")
    assert main(["reset", str(mine)]) == 0
    assert mine.with_name(f"{copies.PAGE}.mine-1.ipynb").read_bytes() == before
    page = nbformat.read(mine, as_version=4)
    assert page.cells[-1].source == "second edition" and not page.cells[1].outputs
    assert fresh != mine.read_bytes()
    work(mine)
    assert update(mine) == [], "the version that reset brought is not offered again"
    assert main(["reset", str(mine)]) == 0
    assert main(["reset", str(mine)]) == 0
    assert "It already was." in capsys.readouterr().out


def test_what_was_begun_in_notebooks_is_taken_along(checkout: Path, mine: Path) -> None:
    copies.commit()
    work(checkout)
    update(mine)
    assert nbformat.read(mine, as_version=4).cells[1].source == copies.STUB
    assert LearnersFolder(mine.parent).take_along() == [f"{NAME} was copied."]
    page = nbformat.read(mine, as_version=4)
    assert page.cells[1].source == copies.RIGHT and not page.cells[1].outputs
    assert update(mine) == [], "it is work on the published version that is there"


def test_what_is_here_already_is_not_overwritten_by_what_is_taken_along(checkout: Path, mine: Path) -> None:
    copies.commit()
    update(mine)
    work(mine, copies.TOO_SLOW)
    before = mine.read_bytes()
    work(checkout)
    assert LearnersFolder(mine.parent).take_along() == [f"{NAME} was copied, as {copies.PAGE}.mine-1.ipynb."]
    assert mine.read_bytes() == before


def test_nothing_to_take_along_is_said(checkout: Path, mine: Path) -> None:
    copies.commit()
    update(mine)
    assert LearnersFolder(mine.parent).take_along() == [f"No page was begun in {checkout.parent}."]


# -- the command ---------------------------------------------------------------------------------------------------------


@pytest.fixture
def served(checkout: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> list[Path]:
    """The folders for which the command would start JupyterLab, which has a test of its own in a browser."""
    folders: list[Path] = []
    monkeypatch.setattr(command, "serve", lambda folder, *_: folders.append(folder.resolve()) or 0)
    monkeypatch.chdir(tmp_path)
    return folders


def test_without_a_command_and_again_inside_the_same_folder_is_opened(
    served: list[Path], mine: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert main([]) == 0
    monkeypatch.chdir(mine.parent)
    assert main(["open"]) == 0
    assert main(["open", "--take-along", str(mine.parent)]) == 0
    assert served == [mine.parent] * 3
    assert main(["open", str(mine.parent / "deeper")]) == 0
    assert (mine.parent / "deeper" / NAME).is_file()


def test_a_new_folder_reminds_of_what_was_begun_elsewhere(
    served: list[Path], checkout: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    copies.commit()
    work(checkout)
    assert main(["open"]) == 0
    assert f"You began {NAME} in {checkout.parent}. Add --take-along" in capsys.readouterr().out
    assert main(["open"]) == 0
    assert "--take-along" not in capsys.readouterr().out


def test_a_folder_that_cannot_be_the_learners_is_explained(
    served: list[Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "notes").write_text("")
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / "thesis.txt").write_text("")
    for wrong, reason in {
        "notes": "pages cannot be kept in notes: File exists",
        "notes/deeper": "pages cannot be kept in notes/deeper: Not a directory",
        "other": "other already holds other files, and they are left alone",
    }.items():
        assert main(["open", wrong]) == 1
        said = capsys.readouterr().err
        assert reason in said and "Name another folder: turtle-lesson open" in said
    assert [each.name for each in (tmp_path / "other").iterdir()] == ["thesis.txt"]
    assert served == []


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="nothing is forbidden to this user")
def test_a_folder_that_is_not_writable_is_explained(
    served: list[Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "locked").mkdir(mode=0o500)
    assert main(["open", "locked/my-lesson"]) == 1
    assert "pages cannot be kept in locked/my-lesson: Permission denied" in capsys.readouterr().err


def test_missing_pages_are_explained(
    served: list[Path], checkout: Path, mine: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    page = checkout.read_bytes()
    checkout.unlink()
    assert main(["open"]) == 1
    assert "the lesson's pages cannot be found in" in capsys.readouterr().err
    checkout.write_bytes(page)
    assert main(["open"]) == 0
    checkout.unlink()
    assert main(["open"]) == 0, "pages that are there can be opened without the checkout"


def test_readmes_first_command_ends_in_opening_the_lesson() -> None:
    readme = (REAL.parent / "README.md").read_text(encoding="utf-8")
    block = readme.split("<!-- first command -->")[1].split("```")[1]
    assert block.strip().split(" && ")[-1] == ".venv/bin/python -m turtle_lesson"


def test_learners_copies_are_graded(checkout: Path, mine: Path, capsys: pytest.CaptureFixture[str]) -> None:
    update(mine)
    work(mine)
    capsys.readouterr()
    assert main(["grade", str(mine), "--json"]) == 0
    (graded,) = json.loads(capsys.readouterr().out)["copies"]
    assert graded["page"] == copies.PAGE
    assert {each["name"]: each["state"] for each in graded["checks"]}["counter"] == "passed"


def test_pages_whose_numbers_begin_alike_are_told_apart() -> None:
    assert pages.page_of(Path("anna_03_navigator.ipynb")) == "03_navigator"
    assert pages.page_of(Path("03b_answer_on_arrival.mine-1.ipynb")) == "03b_answer_on_arrival"
