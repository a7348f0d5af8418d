"""`turtle-lesson reset` and `student`: nothing of a learner's is ever lost."""

from __future__ import annotations

from pathlib import Path

import nbformat
import pytest
import teaching_copies as copies

from turtle_lesson.teaching.copies import find
from turtle_lesson.teaching.main import main


@pytest.fixture
def checkout(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    return copies.publish(tmp_path, monkeypatch)


@pytest.fixture
def mine(tmp_path: Path) -> Path:
    (tmp_path / "mine").mkdir()
    return copies.write(tmp_path / "mine", copies.PAGE, copies.copy(copies.RIGHT, copies.DOUBLER))


def test_a_page_is_reset_and_mine_is_kept(checkout: Path, mine: Path, capsys: pytest.CaptureFixture[str]) -> None:
    before = mine.read_bytes()
    assert main(["reset", str(mine)]) == 0
    assert mine.read_bytes() == checkout.read_bytes()
    assert mine.with_name(f"{copies.PAGE}.mine-1.ipynb").read_bytes() == before
    assert "Yours is kept as" in capsys.readouterr().out
    assert main(["reset", str(mine)]) == 0
    assert "It already was." in capsys.readouterr().out
    mine.write_text("damaged")
    assert main(["reset", str(mine)]) == 0
    assert mine.with_name(f"{copies.PAGE}.mine-2.ipynb").read_text() == "damaged"


def test_a_full_disk_is_said(
    checkout: Path, mine: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def fill_up(path: Path) -> None:
        raise OSError(28, "No space left on device")  # which names no file

    monkeypatch.setattr("turtle_lesson.teaching.pages.reset", fill_up)
    assert main(["reset", str(mine)]) == 1
    assert capsys.readouterr().err == "turtle-lesson reset: [Errno 28] No space left on device\n"


def test_the_published_page_itself_needs_version_control(checkout: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["reset", str(checkout)]) == 1
    assert "Download the lesson again" in capsys.readouterr().err


def test_with_version_control_the_published_page_is_what_was_committed(checkout: Path) -> None:
    published = checkout.read_bytes()
    copies.commit()
    checkout.write_text("edited in place")
    assert main(["reset", str(checkout)]) == 0
    assert checkout.read_bytes() == published
    assert checkout.with_name(f"{copies.PAGE}.mine-1.ipynb").read_text() == "edited in place"


def test_missing_pages_are_said(checkout: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    other = copies.write(tmp_path, "something_else", nbformat.v4.new_notebook())
    assert main(["reset", str(other)]) == 1
    assert "something_else.ipynb cannot be found in" in capsys.readouterr().err
    assert main(["reset", str(tmp_path / "notes.txt")]) == 1


def test_student_leaves_the_solutions_and_outputs_out(
    mine: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    copies.write(mine.parent, copies.PAGE, copies.was_run(nbformat.read(mine, as_version=4)))
    assert main(["student", str(mine)]) == 0
    assert "1 cell with a solution was left out" in capsys.readouterr().out
    written = mine.with_name(f"{copies.PAGE}.student.ipynb")
    notebook = nbformat.read(written, as_version=4)
    assert len(notebook.cells) == 5
    assert not any("%%solution" in cell.source for cell in notebook.cells)
    assert not any(cell.outputs or cell.execution_count for cell in notebook.cells)
    assert main(["student", str(mine)]) == 1
    assert f"{written}: File exists" in capsys.readouterr().err, "nothing is ever overwritten"
    assert main(["student", str(mine), "--to", str(tmp_path)]) == 0
    assert (tmp_path / mine.name).is_file()


def test_student_of_no_notebook(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "x.ipynb").write_text("{}")
    assert main(["student", str(tmp_path / "x.ipynb")]) == 1
    assert "is not a notebook" in capsys.readouterr().err


def test_notebooks_are_found_once_and_hidden_ones_are_not(tmp_path: Path, mine: Path) -> None:
    hidden = tmp_path / "mine" / ".ipynb_checkpoints"
    hidden.mkdir()
    copies.write(hidden, "old", nbformat.v4.new_notebook())
    assert [copy.path for copy in find([tmp_path, mine])] == [mine]
