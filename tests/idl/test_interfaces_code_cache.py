"""The cache of compiled classes: it saves the compiling, and code comes from nowhere else."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from types import CodeType
from typing import Any

import pytest

from turtle_lesson.ros.idl import generator
from turtle_lesson.ros.idl.generator import compiled
from turtle_lesson.ros.runtime import files
from turtle_lesson.teaching import copies, runner

SOURCE = "answer = 42\n"
linux = pytest.mark.skipif(sys.platform != "linux", reason="the folder has another name there")


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """The folder of the cache, beside the learner's folder."""
    (tmp_path / "learner").mkdir()
    monkeypatch.chdir(tmp_path / "learner")
    monkeypatch.setattr(files, "_opened", None)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.delenv(generator.VARIABLE, raising=False)
    monkeypatch.setattr(sys, "dont_write_bytecode", False)
    generator.cache_folder.cache_clear()
    yield generator._user_folder()
    generator.cache_folder.cache_clear()


def kept(folder: Path) -> list[Path]:
    return sorted(path for path in folder.parent.rglob("*") if path.is_file())


def value(code: CodeType) -> int:
    names: dict[str, Any] = {}
    exec(code, names)
    return int(names["answer"])


def refuse(*_: object, **__: object) -> CodeType:
    raise AssertionError("this was compiled")


@linux
def test_what_was_compiled_once_is_read_from_then_on(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    first = compiled(SOURCE, "generated/a.py")
    assert len(kept(folder)) == 1
    monkeypatch.setattr(generator, "compile", refuse, raising=False)
    second = compiled(SOURCE, "generated/a.py")
    assert second == first and second.co_filename == "generated/a.py" and value(second) == 42


@linux
@pytest.mark.parametrize("change", ["text", "name", "python", "optimize"])
def test_what_the_code_depends_on_has_a_file_of_its_own(
    folder: Path, monkeypatch: pytest.MonkeyPatch, change: str
) -> None:
    compiled(SOURCE, "generated/a.py")
    if change == "python":
        monkeypatch.setattr(generator, "MAGIC_NUMBER", b"another")
    elif change == "optimize":
        monkeypatch.setattr(generator, "sys", _Sys(optimize=2))
    generator.cache_folder.cache_clear()
    source, name = (SOURCE.replace("42", "43") if change == "text" else SOURCE), ("b" if change == "name" else "a")
    code = compiled(source, f"generated/{name}.py")
    assert value(code) == (43 if change == "text" else 42) and code.co_filename == f"generated/{name}.py"
    assert len(kept(folder)) == 2


class _Sys:
    """The module sys, with another flag."""

    def __init__(self, optimize: int) -> None:
        self.flags = type("flags", (), {"optimize": optimize})

    def __getattr__(self, name: str) -> Any:
        return getattr(sys, name)


@linux
@pytest.mark.parametrize("damage", [lambda b: b"", lambda b: b[:-1], lambda b: b[:40] + b"?" + b[41:], lambda b: b * 2])
def test_a_damaged_file_is_replaced(folder: Path, damage: Any) -> None:
    compiled(SOURCE, "generated/a.py")
    (file,) = kept(folder)
    whole = file.read_bytes()
    file.write_bytes(damage(whole))
    assert value(compiled(SOURCE, "generated/a.py")) == 42
    assert file.read_bytes() == whole


@linux
def test_a_folder_that_cannot_be_written_changes_nothing(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder.parents[2].write_text("a file is in the way")
    assert value(compiled(SOURCE, "generated/a.py")) == 42
    assert generator.cache_folder() is None


@linux
def test_a_file_appears_whole_or_not_at_all(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object) -> None:
        raise OSError("no space left on device")

    monkeypatch.setattr(Path, "replace", full)
    assert value(compiled(SOURCE, "generated/a.py")) == 42
    assert kept(folder) == []


@linux
def test_it_is_switched_off_by_a_variable(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(generator.VARIABLE, "off")
    assert value(compiled(SOURCE, "generated/a.py")) == 42
    assert generator.cache_folder() is None and not folder.exists()


@linux
def test_nothing_is_written_where_python_writes_no_bytecode(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "dont_write_bytecode", True)
    compiled(SOURCE, "generated/a.py")
    assert kept(folder) == []


@linux
@pytest.mark.parametrize("place", ["{here}/cache", "{here}", "{link}", "cache"])
def test_a_folder_among_the_learners_files_is_never_used(
    folder: Path, monkeypatch: pytest.MonkeyPatch, place: str
) -> None:
    here = Path.cwd()
    link = here.parent / "link"
    link.symlink_to(here)
    monkeypatch.setenv("XDG_CACHE_HOME", place.format(here=here, link=link))
    assert value(compiled(SOURCE, "generated/a.py")) == 42
    assert generator.cache_folder() is None and list(here.iterdir()) == []


@linux
@pytest.mark.parametrize("mode", [0o777, 0o770])
def test_a_folder_that_others_can_write_is_never_used(folder: Path, mode: int) -> None:
    folder.mkdir(parents=True)
    folder.chmod(mode)
    compiled(SOURCE, "generated/a.py")
    assert kept(folder) == []


@linux
def test_a_folder_of_somebody_else_is_never_used(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder.mkdir(parents=True)
    mine = os.getuid()
    monkeypatch.setattr(os, "getuid", lambda: mine + 1)
    compiled(SOURCE, "generated/a.py")
    assert kept(folder) == []


@linux
@pytest.mark.parametrize("in_grading", [False, True])
def test_grading_neither_reads_nor_writes_it(tmp_path: Path, in_grading: bool) -> None:
    home, desk = tmp_path / "home", tmp_path / "desk"
    home.mkdir()
    desk.mkdir()
    variables = copies.environment(home, "mark", str(runner.HOME.parent))
    if not in_grading:
        del variables[generator.VARIABLE]
    program = "import turtle_lesson; from std_msgs.msg import String; print(String(data='as ever').data)"
    run = subprocess.run([sys.executable, "-c", program], cwd=desk, env=variables, capture_output=True, text=True)
    assert run.stdout == "as ever\n", run.stderr
    assert (home / ".cache" / "turtle-lesson").exists() is not in_grading
