"""Mistakes in a CMakeLists.txt: what a real CMake says about each, recorded, is what `colcon build` here says."""

from __future__ import annotations

import json
import os
from pathlib import Path

import pytest
from workspace_cases import XML, Answer, change, colcon, make_package, timeless

from turtle_lesson.ros.runtime.world import World

RECORDED = json.loads((Path(__file__).parents[1] / "data" / "cmake_mistakes.json").read_text(encoding="utf-8"))


@pytest.fixture
def demo(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The package of the recording, in a workspace that is the current folder."""
    monkeypatch.chdir(tmp_path)
    folder = tmp_path / "src/demo"
    for name in ("demo", "launch"):
        (folder / name).mkdir(parents=True)
    (folder / "package.xml").write_text(XML.replace("robot_controller", "demo"))
    (folder / "CMakeLists.txt").write_text(RECORDED["cmake"])
    (folder / "demo/node.py").write_text("#!/usr/bin/env python3\n")
    return folder


def said(answer: Answer) -> list[str]:
    """Its stderr without empty lines, durations and advice."""
    return timeless([line for line in answer.err.splitlines() if line.strip() and not line.startswith("Hint: ")])


@pytest.mark.parametrize("case", RECORDED["cases"], ids=lambda case: repr(case["new"][:40]))
def test_a_mistake(demo: Path, world: World, case: dict[str, object]) -> None:
    (demo / "CMakeLists.txt").write_text(RECORDED["cmake"].replace(case["old"], case["new"]))
    answer = colcon(world)
    assert (answer.code, said(answer)) == (case["code"], timeless(case["stderr"]))  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("old", "new", "hint"),
    [
        ("find_package(ament_cmake REQUIRED)", "find_package(ament_cmake REQUIRED", "line 4: the '(' of find_package is never"),
        ("DIRECTORY launch D", 'DIRECTORY "launch D', "line 9: this quote is never closed"),
        ("# line 5", "if(X)", "line 5: this if() has no endif()"),
        ("install(PROGRAMS", "install(PROGRAM", "Did you mean 'PROGRAMS'?"),
        ("cmake_minimum_required(VERSION 3.8)", "", "Write cmake_minimum_required(VERSION 3.8) at the beginning"),
        ("ament_package()", "ament_package()\nament_package()", "Delete line 12."),
        ("# line 5", "include(demo/node.py)", "Only CMakeLists.txt itself is read here"),
        (
            "# line 5",
            "find_package(rosidl_default_generators REQUIRED)\nrosidl_generate_interfaces(${PROJECT_NAME} msg/A.msg)",
            "Write that file first.",
        ),
        ("# line 5", f"if({'NOT ' * 5000}X)\nendif()", "is not a condition that CMake knows"),
    ],
)  # fmt: skip
def test_advice_names_the_line(demo: Path, world: World, old: str, new: str, hint: str) -> None:
    change(demo / "CMakeLists.txt", old, new)
    answer = colcon(world)
    assert answer.code == 1
    assert hint in answer.err


def test_what_a_message_says_is_seen(demo: Path, world: World) -> None:
    change(demo / "CMakeLists.txt", "# line 5", "message(NOTICE a b)\nmessage(STATUS quiet)")
    answer = colcon(world)
    assert (answer.code, said(answer)) == (0, ["--- stderr: demo", "ab", "---"])


def test_a_definition_that_nobody_names_is_spoken_of(
    tmp_path: Path, world: World, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    package = make_package(tmp_path)
    (package / "msg/Extra.msg").write_text("int32 a\n")
    answer = colcon(world)
    assert answer.code == 0
    assert "nothing is generated from msg/Extra.msg, which CMakeLists.txt does not name: write" in answer.err
    change(package / "msg/TurtleStatus.msg", "float32 x", "Extra x")
    answer = colcon(world)
    assert answer.code == 2
    assert "msg/Extra.msg is there, but CMakeLists.txt does not name it" in answer.err


@pytest.mark.parametrize(
    ("options", "installed"),
    [
        ("DIRECTORY tools/ DESTINATION x", "notes.txt old/late.py run.py"),
        ("DIRECTORY tools DESTINATION x", "tools/notes.txt tools/old/late.py tools/run.py"),
        ("DIRECTORY tools/ DESTINATION x USE_SOURCE_PERMISSIONS", "notes.txt old/late.py* run.py*"),
        ('DIRECTORY tools/ DESTINATION x PATTERN "old" EXCLUDE', "notes.txt old/late.py run.py"),
        ("DIRECTORY tools/ DESTINATION x FILE_PERMISSIONS OWNER_READ OWNER_EXECUTE", "notes.txt* old/late.py* run.py*"),
        (
            "DIRECTORY . DESTINATION x",
            "CMakeLists.txt demo/node.py package.xml tools/notes.txt tools/old/late.py tools/run.py",
        ),
        ("FILES tools/run.py tools/notes.txt DESTINATION x", "notes.txt run.py"),
        ("FILES tools/run.py DESTINATION x PERMISSIONS OWNER_READ OWNER_EXECUTE", "run.py*"),
    ],
)
def test_which_files_of_a_folder_are_installed_and_which_can_be_run(
    demo: Path, world: World, options: str, installed: str
) -> None:
    """As a real CMake does it. A star marks what can be run."""
    for name in ("run.py", "notes.txt", "old/late.py"):
        (demo / "tools" / name).parent.mkdir(parents=True, exist_ok=True)
        (demo / "tools" / name).write_text("#!/usr/bin/env python3\n")
        (demo / "tools" / name).chmod(0o755 if name.endswith(".py") else 0o644)
    change(demo / "CMakeLists.txt", "# line 5", f"install({options})")
    assert colcon(world).code == 0
    place = Path("install/demo/x")
    files = sorted(path for path in place.rglob("*") if path.is_file())
    found = [path.relative_to(place).as_posix() + ("*" if os.access(path, os.X_OK) else "") for path in files]
    assert " ".join(found) == installed


def test_programs_installed_as_a_mere_folder_cannot_be_run(demo: Path, world: World) -> None:
    (demo / "tools").mkdir()
    (demo / "tools/run.py").write_text("#!/usr/bin/env python3\n")
    change(demo / "CMakeLists.txt", "# line 5", "install(DIRECTORY tools/ DESTINATION lib/${PROJECT_NAME})")
    assert "line 5: what install(DIRECTORY …) installs cannot be run. Write install(PROGRAMS" in colcon(world).err
