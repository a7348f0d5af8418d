"""`ros2 pkg create`: console output as recorded, and files that build."""

from __future__ import annotations

import contextlib
import io
import shlex
import sys
from pathlib import Path
from xml.etree import ElementTree

import pytest
from command_cases import cases
from workspace_cases import colcon, parse, source_in, started

from turtle_lesson.ros.ament.create import LICENCES, create_package
from turtle_lesson.ros.ament.manifest import read_found
from turtle_lesson.ros.ament.setup_py import install_scripts, read_setup
from turtle_lesson.ros.runtime.world import World


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The current folder."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


def create(line: str) -> tuple[int, str, str]:
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        code = create_package(parse(shlex.split(line)))
    return code, out.getvalue(), err.getvalue()


def recorded() -> list[tuple[str, int, str, str]]:
    found = []
    for case in cases("pkg_create.txt"):
        line = case.command.removeprefix("ros2 pkg create")
        found.append((line, case.code, "\n".join(case.stdout).strip(), "\n".join(case.stderr).strip()))
    return [case for case in found if case[1] != 2]


def test_the_words_of_the_real_tool() -> None:
    for line, code, out, err in recorded():
        answer = create(line)
        assert (answer[0], answer[1].strip(), answer[2].strip()) == (code, out, err), line


def test_wrong_words(capsys: pytest.CaptureFixture[str]) -> None:
    for case in cases("pkg_create.txt"):
        if case.code == 2:
            with pytest.raises(SystemExit, match="2"):
                parse(shlex.split(case.command)[3:])
            said = capsys.readouterr().err.splitlines()[-1]
            expected = case.stderr[-1]
            if sys.version_info >= (3, 12):  # Python itself words this otherwise there
                said, expected = said.replace("'", ""), expected.replace("'", "")
            assert said == expected


def test_an_ament_cmake_package(folder: Path) -> None:
    create("robot_controller --dependencies rclpy geometry_msgs --license MIT --description 'Drives & reports'")
    package = folder / "robot_controller"
    found = read_found(package, folder)
    assert (found.name, found.build_type) == ("robot_controller", "ament_cmake")
    root = ElementTree.parse(package / "package.xml")
    assert root.findtext("description") == "Drives & reports"
    assert [each.text for each in root.findall("depend")] == ["rclpy", "geometry_msgs"]
    assert [each.text for each in root.findall("test_depend")] == ["ament_lint_auto", "ament_lint_common"]
    text = (package / "CMakeLists.txt").read_text()
    assert "project(robot_controller)" in text
    assert (
        "find_package(ament_cmake REQUIRED)\nfind_package(rclpy REQUIRED)\nfind_package(geometry_msgs REQUIRED)\n"
        in text
    )
    assert text.endswith("ament_package()\n")
    assert (package / "LICENSE").read_text().startswith("MIT\n")


def test_an_ament_python_package(folder: Path) -> None:
    create(
        "demo --build-type ament_python --node-name talker --maintainer-name 'Ada L' --maintainer-email ada@example.org"
    )
    setup = read_setup(folder / "demo")
    assert (setup["name"], setup["packages"], setup["maintainer"]) == ("demo", ["demo"], "Ada L")
    assert setup["entry_points"] == {"console_scripts": ["talker = demo.talker:main"]}
    assert setup["data_files"][1] == ["share/demo", ["package.xml"]]
    assert install_scripts(folder / "demo") == "lib/demo"
    for name in ("copyright", "flake8", "pep257"):
        compile((folder / f"demo/test/test_{name}.py").read_text(), name, "exec")


def test_cpp_files(folder: Path) -> None:
    create("w --node-name my_node --dependencies rclcpp")
    assert {path.name for path in (folder / "w/src").iterdir()} == {"my_node.cpp"}
    text = (folder / "w/CMakeLists.txt").read_text()
    assert "add_executable(my_node src/my_node.cpp)" in text
    assert "ament_target_dependencies(\n  my_node\n  rclcpp\n)" in text


def test_a_cmake_package(folder: Path) -> None:
    create("plain --build-type cmake")
    assert "ament" not in (folder / "plain/CMakeLists.txt").read_text()


def test_what_is_created_builds(world: World) -> None:
    create("one --destination-directory src --dependencies rclpy std_msgs")
    create("two --destination-directory src --build-type ament_python --node-name hello --dependencies rclpy")
    answer = colcon(world)
    assert (answer.code, answer.err) == (0, "")
    source_in(world)
    assert started(world, "two", "hello") == "Hi from two.\n"


@pytest.mark.parametrize("name", ["../x", "a/b", "", ".", "..", "a\\b", "a\nb"])
def test_names_that_are_no_folder(name: str, folder: Path) -> None:
    code, _, err = create(shlex.quote(name))
    assert (code, "cannot be the name of a folder" in err) == (1, True)
    assert list(folder.iterdir()) == []


def test_licences_are_listed(folder: Path) -> None:
    code, out, _ = create("x --license '?'")
    assert (code, out.split("\n")[1:-1]) == (0, list(LICENCES))
    assert list(folder.iterdir()) == []


def test_odd_names_are_refused() -> None:
    assert "cannot be the name of a program" in create("x --node-name 'my node'")[2]
    assert "C++ is not compiled here" in create("x --library-name arm")[2]
