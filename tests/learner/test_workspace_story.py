"""The learner's own package: it grows from page to page, and nothing in it is lost."""

from __future__ import annotations

import io
import shutil
from pathlib import Path
from typing import Any

import nbformat
import pytest
from workspace_cases import parse

from turtle_lesson.learner import story
from turtle_lesson.learner.workspace import Workspace, workspace
from turtle_lesson.ros.ament import create
from turtle_lesson.ros.cli import colcon
from turtle_lesson.ros.runtime import files
from turtle_lesson.ros.runtime.world import World

NODE = "robot_controller/navigator_node.py"
CMAKE = "cmake_minimum_required(VERSION 3.8)\nproject(robot_controller)\nament_package()\n"
MANIFEST = """<?xml version="1.0"?>
<package format="3">
  <name>robot_controller</name>
  <version>0.1.0</version>
  <description>Drives a turtle</description>
  <maintainer email="me@example.org">me</maintainer>
  <license>Apache-2.0</license>
  <buildtool_depend>ament_cmake</buildtool_depend>
  <export><build_type>ament_cmake</build_type></export>
</package>
"""
INSTALL = """install(PROGRAMS robot_controller/navigator_node.py
  DESTINATION lib/${PROJECT_NAME} RENAME navigator)
"""
WITH_NODE = CMAKE.replace("ament_package()", f"{INSTALL}ament_package()")


def writes(path: str, text: str, append: bool = False) -> str:
    return f"%%writefile {'-a ' if append else ''}{story.PACKAGE}{path}\n{text}".rstrip("\n")


def code(source: str, **metadata: Any) -> Any:
    return nbformat.v4.new_code_cell(source, metadata=metadata)


def exercise(source: str, solution: str) -> list[Any]:
    of = {"exercise": "x"}
    return [
        code(source, tags=["exercise"], turtle_lesson=of),
        code(f"%%solution x\n{solution}", tags=["solution"], turtle_lesson=of),
    ]


@pytest.fixture
def pages(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Published pages of which 02 makes the package, and 03 writes a node in two parts and an exercise."""
    folder = tmp_path / "published"
    folder.mkdir()
    cells: dict[str, list[Any]] = {page: [] for page in story.PAGES}
    cells["02_services_and_interfaces"] = [
        code("print('no file')"),
        code("%%writefile workspace/elsewhere.txt\nnot of the package"),
        code(writes("CMakeLists.txt", CMAKE)),
        code(writes("package.xml", MANIFEST)),
    ]
    cells["03_navigator"] = [
        code(writes(NODE, "first = 1\n")),
        code(writes(NODE, "\nsecond = 2\n", append=True)),
        code(writes("CMakeLists.txt", WITH_NODE)),
        *exercise(writes(NODE, "stub = 0\n"), writes(NODE, "solved = 3\n")),
    ]
    for page, its in cells.items():
        nbformat.write(nbformat.v4.new_notebook(cells=its), folder / f"{page}.ipynb")
    monkeypatch.setattr(story, "PUBLISHED", folder)
    for each in (story.versions, story._versions_with_open_exercises, story._states, story._code_cells):
        each.cache_clear()
    yield folder
    for each in (story.versions, story._versions_with_open_exercises, story._states, story._code_cells):
        each.cache_clear()


@pytest.fixture
def mine(pages: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Workspace:
    monkeypatch.chdir(tmp_path)
    return Workspace(tmp_path / "workspace")


def run_page(mine: Workspace, page: str) -> None:
    """Write what the page's cells write, as its reader would."""
    mine.prepare(page)
    for path, text in story.versions(page):
        mine.write(mine.package / path, text, append=False)


def node(mine: Workspace) -> str:
    return (mine.package / NODE).read_text()


# -- the story ---------------------------------------------------------------------------------------------------------


def test_a_page_begins_with_what_the_pages_before_it_leave(pages: Path) -> None:
    assert story.files_before("02_services_and_interfaces") == {}
    assert story.files_before("03_navigator") == {"CMakeLists.txt": CMAKE, "package.xml": MANIFEST}
    assert story.files_before("04_status_monitor") == {
        "CMakeLists.txt": WITH_NODE,
        "package.xml": MANIFEST,
        NODE: "solved = 3\n",
    }


def test_each_state_that_a_page_passes_through_is_known(pages: Path) -> None:
    states = [text for path, text in story.versions("03_navigator") if path == NODE]
    assert states == ["first = 1\n", "first = 1\n\nsecond = 2\n", "solved = 3\n"]


def test_an_exercise_that_was_left_open_is_filled_in_by_the_next_page(mine: Workspace) -> None:
    run_page(mine, "03_navigator")
    mine.write(mine.package / NODE, "stub = 0\n", append=False)
    mine.prepare("03_navigator")
    assert node(mine) == "stub = 0\n", "its own page leaves it to the learner"
    mine.prepare("04_status_monitor")
    assert node(mine) == "solved = 3\n"
    (mine.package / NODE).write_text("stub = 0  # nearly\n")
    mine.prepare("04_status_monitor")
    assert node(mine) == "stub = 0  # nearly\n"


def test_a_page_may_be_named_by_its_number(pages: Path) -> None:
    assert story.page_named("04") == "04_status_monitor"
    assert story.page_named("04_status_monitor") == "04_status_monitor"
    with pytest.raises(ValueError, match="00_welcome, 01_publish_and_subscribe"):
        story.page_named("04_status")


# -- filling in --------------------------------------------------------------------------------------------------------


def test_what_is_missing_is_filled_in(mine: Workspace) -> None:
    mine.prepare("04_status_monitor")
    assert node(mine) == "solved = 3\n"
    assert mine.state().splitlines() == [
        "Your package workspace/src/robot_controller:",
        "  CMakeLists.txt                      filled in",
        "  package.xml                         filled in",
        "  robot_controller/navigator_node.py  filled in",
    ]


def test_the_state_is_the_same_when_the_cell_is_run_twice(mine: Workspace) -> None:
    mine.prepare("04_status_monitor")
    before = mine.state()
    mine.prepare("04_status_monitor")
    assert mine.state() == before


def test_a_learners_file_is_kept(mine: Workspace) -> None:
    run_page(mine, "03_navigator")
    (mine.package / NODE).write_text("my_own = 4\n")
    mine.prepare("04_status_monitor")
    assert node(mine) == "my_own = 4\n"
    assert f"{NODE}  yours" in mine.state()


def test_a_page_that_was_left_in_its_middle_is_completed(mine: Workspace) -> None:
    mine.prepare("03_navigator")
    mine.write(mine.package / NODE, "first = 1\n", append=False)
    mine.prepare("04_status_monitor")
    assert node(mine) == "solved = 3\n"


def test_a_cmake_file_of_the_learners_own_gets_the_lines_that_are_missing(mine: Workspace) -> None:
    mine.prepare("03_navigator")
    own = CMAKE.replace("ament_package", "# mine\nament_package")
    (mine.package / "CMakeLists.txt").write_text(own)
    mine.prepare("04_status_monitor")
    merged = (mine.package / "CMakeLists.txt").read_text()
    assert "# mine\n" in merged and INSTALL in merged
    mine.prepare("04_status_monitor")
    assert (mine.package / "CMakeLists.txt").read_text() == merged


def test_files_of_the_learners_own_beside_the_packages_stay(mine: Workspace) -> None:
    mine.prepare("03_navigator")
    diary = mine.package / "diary.txt"
    diary.write_text("day one")
    for page in story.PAGES[3:]:
        run_page(mine, page)
    assert diary.read_text() == "day one"


def test_a_damaged_memory_makes_every_file_the_learners_own(mine: Workspace) -> None:
    mine.prepare("04_status_monitor")
    (mine.folder / ".pages.json").write_text("{")
    mine.prepare("04_status_monitor")
    assert "filled in" not in mine.state()


# -- reset -------------------------------------------------------------------------------------------------------------


def test_reset_puts_the_package_back_and_keeps_a_copy(mine: Workspace) -> None:
    run_page(mine, "03_navigator")
    (mine.package / NODE).write_text("broken(\n")
    assert "is kept in workspace/kept/1" in mine.reset("04")
    assert node(mine) == "solved = 3\n"
    assert (mine.folder / "kept" / "1" / "robot_controller" / NODE).read_text() == "broken(\n"
    mine.reset("02")
    assert not mine.package.exists()
    assert (mine.folder / "kept" / "2" / "robot_controller" / NODE).read_text() == "solved = 3\n"


def test_reset_of_a_page_that_does_not_exist_changes_nothing(mine: Workspace) -> None:
    mine.prepare("04_status_monitor")
    with pytest.raises(ValueError, match="there is no page"):
        mine.reset("99")
    assert node(mine) == "solved = 3\n"


# -- cells that write --------------------------------------------------------------------------------------------------


def test_what_pkg_create_made_is_replaced_without_a_question(mine: Workspace) -> None:
    def create_anew() -> None:
        words = [mine.package.name, "--build-type", "ament_cmake", "--destination-directory", str(mine.package.parent)]
        create.create_package(parse(words))

    mine.package.parent.mkdir(parents=True)
    create_anew()
    assert mine.write(mine.package / "CMakeLists.txt", CMAKE, append=False).startswith("Overwriting ")
    shutil.rmtree(mine.package)
    create_anew()
    mine.prepare("03_navigator")
    assert (mine.package / "CMakeLists.txt").read_text() == CMAKE
    assert (mine.package / "package.xml").read_text() == MANIFEST


def test_a_cell_may_be_edited_and_run_again(mine: Workspace) -> None:
    mine.prepare("03_navigator")
    assert mine.write(mine.package / NODE, "a = 1\n", append=False).startswith("Writing ")
    assert mine.write(mine.package / NODE, "a = 2\n", append=False).startswith("Overwriting ")
    assert node(mine) == "a = 2\n"


def test_a_text_is_appended_once(mine: Workspace) -> None:
    mine.prepare("03_navigator")
    mine.write(mine.package / NODE, "a = 1\n", append=False)
    for _ in range(2):
        mine.write(mine.package / NODE, "b = 2\n", append=True)
    assert node(mine) == "a = 1\nb = 2\n"


def test_a_changed_part_takes_the_place_of_the_one_that_defines_the_same(mine: Workspace) -> None:
    mine.prepare("03_navigator")
    for text in ("class A:\n", "    def one(self): ...\n", "    def two(self): ...\n\nA()\n"):
        mine.write(mine.package / NODE, text, append=text != "class A:\n")
    mine.write(mine.package / NODE, "\n    async def one(self, x): ...\n", append=True)
    assert node(mine) == "class A:\n\n    async def one(self, x): ...\n    def two(self): ...\n\nA()\n"
    (mine.package / NODE).write_text("by_hand = 1\n")
    for _ in range(2):
        mine.write(mine.package / NODE, "def one(): ...\n", append=True)
    assert node(mine) == "by_hand = 1\ndef one(): ...\n"


def test_a_later_page_replaces_one_part_of_what_an_earlier_one_wrote(pages: Path, mine: Workspace) -> None:
    cells = [writes(NODE, "import a"), writes(NODE, "def b(): 1", append=True), writes(NODE, "c()", append=True)]
    nbformat.write(nbformat.v4.new_notebook(cells=[code(each) for each in cells]), pages / "03_navigator.ipynb")
    changed = "async def b(): 2"
    page = nbformat.v4.new_notebook(cells=[code(writes(NODE, changed, append=True))])
    nbformat.write(page, pages / "04_status_monitor.ipynb")
    mine.prepare("04_status_monitor")
    mine.write(mine.package / NODE, f"{changed}\n", append=True)
    assert node(mine) == "import a\nasync def b(): 2\nc()\n" == story.files_before("05_obstacle_detector")[NODE]
    (mine.package / NODE).write_text("import a, mine\nasync def b(): 3\nc()\nmore()\n")
    for _ in range(2):
        mine.write(mine.package / NODE, f"{changed}\n", append=True)
    assert node(mine) == "import a, mine\nasync def b(): 2\nc()\nmore()\n"


def test_the_story_replaces_parts_as_the_cells_do(pages: Path) -> None:
    cells = [writes(NODE, "import a"), writes(NODE, "def b(): 1", append=True), writes(NODE, "c = 1", append=True)]
    cells.append(writes(NODE, "async def b(): 2", append=True))
    page = nbformat.v4.new_notebook(cells=[code(each) for each in cells])
    nbformat.write(page, pages / "03b_answer_on_arrival.ipynb")
    assert story.versions("03b_answer_on_arrival")[-1] == (NODE, "import a\nasync def b(): 2\nc = 1\n")


def test_what_was_changed_by_hand_is_replaced_only_when_the_cell_is_run_again(mine: Workspace) -> None:
    mine.prepare("03_navigator")
    mine.write(mine.package / NODE, "a = 1\n", append=False)
    (mine.package / NODE).write_text("by_hand = 1\n")
    assert "holds changes of your own" in mine.write(mine.package / NODE, "a = 1\n", append=False)
    assert "holds changes of your own" in mine.write(mine.package / NODE, "b = 2\n", append=True)
    assert node(mine) == "by_hand = 1\n"
    assert "holds changes of your own" in mine.write(mine.package / NODE, "a = 1\n", append=False)
    assert mine.write(mine.package / NODE, "a = 1\n", append=False).startswith("Overwriting ")
    assert node(mine) == "a = 1\n"
    assert (mine.folder / "kept" / "1" / NODE).read_text() == "by_hand = 1\n"


def test_an_earlier_page_asks_before_it_replaces_the_work_of_a_later_one(mine: Workspace) -> None:
    mine.prepare("06_parameters_and_launch")
    mine.write(mine.package / NODE, "my_work_of_page_06 = 1\n", append=False)
    mine.prepare("03_navigator")
    assert "holds changes of your own" in mine.write(mine.package / NODE, "first = 1\n", append=False)
    assert node(mine) == "my_work_of_page_06 = 1\n"


def test_a_later_page_goes_on_from_an_earlier_one(mine: Workspace) -> None:
    mine.prepare("03_navigator")
    mine.write(mine.package / NODE, "my_solution_of_page_03 = 1\n", append=False)
    mine.prepare("06_parameters_and_launch")
    assert node(mine) == "my_solution_of_page_03 = 1\n"
    assert mine.write(mine.package / NODE, "of_page_06 = 1\n", append=False).startswith("Overwriting ")


def test_the_workspace_is_beside_the_notebook(tmp_path: Path) -> None:
    assert workspace().folder.name == "workspace"


def test_it_is_built_again_after_a_build_by_hand_from_other_sources(
    tmp_path: Path, world: World, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    mine = Workspace(tmp_path / "workspace")
    mine.prepare("04_status_monitor")
    assert not mine.is_built
    assert mine.build(world) == ""
    assert mine.is_built
    cmake = mine.package / "CMakeLists.txt"
    published = cmake.read_text()
    cmake.write_text(published.replace("RENAME navigator", "RENAME pilot"))
    colcon.run(world, ["build"], stdout=io.StringIO(), stderr=io.StringIO(), cwd=mine.folder)
    cmake.write_text(published)
    assert not mine.is_built, "what is installed now lacks the node"
    assert mine.build(world) == ""
    assert mine.is_built


@pytest.mark.parametrize("link", ["workspace", "workspace/src"])
@pytest.mark.parametrize("do", [lambda mine: mine.prepare("05_obstacle_detector"), lambda mine: mine.reset("05")])
def test_nothing_is_written_through_a_link_that_leads_out_of_the_learners_folder(
    pages: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, link: str, do: Any
) -> None:
    outside, home = tmp_path / "outside", tmp_path / "mine"
    (outside / "src/robot_controller").mkdir(parents=True)
    place = home / link
    place.parent.mkdir(parents=True)
    place.symlink_to(outside, target_is_directory=True)
    monkeypatch.chdir(home)
    monkeypatch.setattr(files, "_home", home)
    before = sorted(outside.rglob("*"))
    with pytest.raises(PermissionError, match="outside your folder"):
        do(workspace())
    assert sorted(outside.rglob("*")) == before
