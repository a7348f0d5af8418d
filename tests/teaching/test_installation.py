"""What a learner installs: the packages that run and no more, and a wheel that needs no checkout."""

from __future__ import annotations

import os
import subprocess
import sys
import sysconfig
import tomllib
import venv
import zipfile
from collections.abc import Iterable, Sequence
from importlib.metadata import distribution, version
from pathlib import Path

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from turtle_lesson.teaching.pages import NAMES

ROOT = Path(__file__).resolve().parents[2]
BEGIN_PAGE_04 = "from turtle_lesson import start; print(start(seed=0, page='04_status_monitor').workspace)"


# -- the pinned packages -------------------------------------------------------------------------------------------------


def pinned(file: str) -> dict[str, str]:
    """The versions in a file of pins, by name, of what this system and Python want."""
    lines = (ROOT / file).read_text(encoding="utf-8").splitlines()
    wanted = [Requirement(line) for line in lines if line and line[0] not in "#-"]
    return {
        canonicalize_name(each.name): str(each.specifier).removeprefix("==")
        for each in wanted
        if each.marker is None or each.marker.evaluate()
    }


def needed(requirements: Iterable[str]) -> set[str]:
    """The names of all packages that these requirements ask for, directly or not."""
    waiting = [(Requirement(each), "") for each in requirements]
    seen: set[tuple[str, str]] = set()
    while waiting:
        requirement, extra = waiting.pop()
        if requirement.marker is None or requirement.marker.evaluate({"extra": extra}):
            name = canonicalize_name(requirement.name)
            new = {(name, extra) for extra in ("", *requirement.extras)} - seen
            seen |= new
            waiting += [(Requirement(each), extra) for _, extra in new for each in distribution(name).requires or ()]
    return {name for name, _ in seen}


def test_learners_install_what_runs_and_tests_bring_the_rest() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    learners, tests = pinned("environment.txt"), pinned("tests/environment.txt")
    assert set(learners) == needed(project["dependencies"])
    assert set(learners) | set(tests) == needed([*project["dependencies"], *project["optional-dependencies"]["test"]])
    assert not set(learners) & set(tests)
    assert {name: version(name) for name in learners | tests} == learners | tests


# -- the wheel -----------------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The wheel of this checkout."""
    folder = tmp_path_factory.mktemp("dist")
    run([sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(folder)], ROOT)
    (built,) = folder.glob("*.whl")
    return built


@pytest.fixture(scope="module")
def fresh(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The programs of a new virtual environment with the wheel, which has never seen a checkout.

    What the wheel requires is borrowed from this environment. Python does not read .pth files of a folder that another one
    names, so a checkout that was installed for editing stays out.
    """
    home = tmp_path_factory.mktemp("fresh")
    venv.create(home, symlinks=os.name == "posix")
    programs = home / ("Scripts" if os.name == "nt" else "bin")
    pip = [sys.executable, "-m", "pip", "--python", str(programs / "python")]
    run([*pip, "install", "-q", "--no-index", "--no-deps", str(wheel)], home)
    site = run([str(programs / "python"), "-c", "import sysconfig; print(sysconfig.get_path('purelib'))"], home).strip()
    Path(site, "borrowed.pth").write_text(sysconfig.get_path("purelib") + "\n", encoding="utf-8")
    run([*pip, "check"], home)
    return programs


def run(words: Sequence[str], folder: Path) -> str:
    """What a program prints; an AssertionError with all that it said where it fails."""
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    done = subprocess.run(
        words, cwd=folder, env=environment, capture_output=True, text=True, encoding="utf-8", timeout=600, check=False
    )
    assert done.returncode == 0, f"{words}:\n{done.stdout}{done.stderr}"
    return done.stdout


def test_the_wheel_holds_every_page_and_every_file_of_the_package(wheel: Path) -> None:
    inside = set(zipfile.ZipFile(wheel).namelist())
    assert {f"turtle_lesson/pages/{name}" for name in NAMES} <= inside
    files = {path.relative_to(ROOT) for path in (ROOT / "turtle_lesson").rglob("*") if path.is_file()}
    assert {path.as_posix() for path in files if "__pycache__" not in path.parts} <= inside


@pytest.mark.parametrize("words", [["turtle-lesson"], ["python", "-m", "turtle_lesson"]], ids=" ".join)
def test_in_an_empty_folder_the_first_command_needs_no_checkout(fresh: Path, tmp_path: Path, words: list[str]) -> None:
    """With --version, which it passes on, JupyterLab ends at once."""
    program, *more = words
    said = run([str(fresh / program), *more, "open", "--version"], tmp_path).splitlines()
    assert said == [
        f"Your pages are in {tmp_path / 'my-lesson'}. Ctrl-C, pressed twice here, ends JupyterLab.",
        version("jupyterlab"),
    ]
    assert set(NAMES) <= {path.name for path in (tmp_path / "my-lesson").iterdir()}


def test_pages_begin_with_the_files_of_those_before_them_without_a_checkout(fresh: Path, tmp_path: Path) -> None:
    assert "navigator_node.py" in run([str(fresh / "python"), "-c", BEGIN_PAGE_04], tmp_path)


def test_what_other_pythons_leave_out_is_there() -> None:
    lines = (ROOT / ".ci/every_python").read_text(encoding="utf-8").split()
    assert [line for line in lines if not list(ROOT.glob(line.rpartition("=")[2]))] == []
