"""The story from end to end: a learner's copies, with the solutions typed in, one page after the other in one folder.

It ends with a package of the learner's own that passes the examination of page 10, and that Debian's colcon builds.
"""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any

import nbformat
import pytest
from answers.client import PageServer
from test_page_exercises import tagged
from test_real_colcon import build, check_installed, generators  # noqa: F401
from test_real_colcon import pytestmark as with_colcon

from turtle_lesson.learner.story import PAGES
from turtle_lesson.teaching.pages import LearnersFolder

EXAMINATION = (
    '%load_ext turtle_lesson\nfrom turtle_lesson import start\nlesson = start(seed=1, package="mine")',
    "ros2 launch robot_controller start_system.launch.py",
    'lesson.check("system")',
)
PLANTED = ("diary.txt", "workspace/diary.txt", "workspace/src/robot_controller/robot_controller/diary.py")
"""Files of the learner's own, which no page may touch."""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A learner's folder, as README's first command makes it."""
    path = tmp_path_factory.mktemp("learner") / "my-lesson"
    LearnersFolder(path).update()
    return path


def solved(page: Path) -> list[Any]:
    """The code of a learner's copy, with the solution of each exercise typed in its cell."""
    cells = [cell for cell in nbformat.read(page, as_version=4).cells if cell.cell_type == "code"]
    solutions = {cell.metadata.turtle_lesson.exercise: cell.source for cell in tagged(cells, "solution")}
    for cell in tagged(cells, "exercise"):
        cell.source = solutions[cell.metadata.turtle_lesson.exercise].partition("\n")[2]
    return cells


@pytest.mark.parametrize("page", PAGES)
def test_every_solution_passes_its_check_and_no_page_loses_a_file(
    page_server: PageServer, folder: Path, page: str
) -> None:
    """The pages follow one another in the same folder; what each one leaves is what the next one goes on with."""
    if page == "03_navigator":
        for name in PLANTED:
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            (folder / name).write_text("'mine'")
    before = _files(folder)
    cells = [(cell.source, cell.metadata.get("tags", [])) for cell in solved(folder / f"{page}.ipynb")]
    results = page_server.results([(source, "raises-exception" in tags) for source, tags in cells], folder)
    for (_, tags), said in zip(cells, results, strict=True):
        assert "check" not in tags or said.startswith("✓"), said
    assert before <= _files(folder)
    assert page < "03" or all((folder / name).read_text() == "'mine'" for name in PLANTED)


def _files(folder: Path) -> set[str]:
    """The files of the learner's package."""
    package = folder / "workspace/src/robot_controller"
    return {path.relative_to(package).as_posix() for path in package.rglob("*") if path.is_file()}


def test_the_learners_own_three_nodes_pass_the_examination(page_server: PageServer, folder: Path) -> None:
    *_, said = page_server.results([(source, False) for source in EXAMINATION], folder)
    assert said.startswith("✓"), said
    assert {"navigator_node.py", "status_monitor_node.py", "obstacle_detector_node.py", "start_system.launch.py"} <= {
        Path(name).name for name in _files(folder)
    }


@with_colcon
def test_debians_colcon_builds_the_learners_package(folder: Path, generators: Path, tmp_path: Path) -> None:  # noqa: F811
    shutil.copytree(folder / "workspace/src", tmp_path / "src")
    done = build(tmp_path, generators)
    assert done.returncode == 0, done.stdout + done.stderr
    check_installed(tmp_path, ["navigator", "obstacle_detector", "status_monitor"], "start_system.launch.py")
