"""`lesson.export(…)`: a package to take to a robot."""

from __future__ import annotations

import filecmp
import os
from pathlib import Path

import pytest
from workspace_cases import change, colcon, make_package, source_in

import turtle_lesson
from turtle_lesson import Lesson, start
from turtle_lesson.ros.ament.package import PackageError

FINISHED = Path(turtle_lesson.__file__).parent / "robot_controller"


@pytest.fixture
def lesson(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Lesson:
    """A lesson in an empty folder."""
    monkeypatch.chdir(tmp_path)
    return start(simulator=False)


def test_the_finished_package(lesson: Lesson, tmp_path: Path) -> None:
    result = lesson.export("robot_controller", to="robot")
    assert repr(result) == (
        "robot_controller is in robot/src/robot_controller/; README.md beside src/ says how to build it.\n"
        "Copy src/ and README.md to the robot, but not build/, install/ or log/: the robot builds its own.\n"
        "programs: navigator, obstacle_detector, status_monitor\n"
        "interfaces: msg/TurtleStatus.msg, srv/NavigateTo.srv"
    )
    written = {path.relative_to(result.package) for path in result.package.rglob("*") if path.is_file()}
    lying = {path.relative_to(FINISHED) for path in FINISHED.rglob("*") if path.is_file() and path.suffix != ".pyc"}
    assert written == lying
    _, wrong, errors = filecmp.cmpfiles(FINISHED, result.package, [str(path) for path in lying], shallow=False)
    assert (wrong, errors) == ([], [])


def test_its_readme_says_how_to_build_it(lesson: Lesson) -> None:
    lesson.export("robot_controller", to="robot")
    text = Path("robot/README.md").read_text()
    for line in (
        "rosdep install --from-paths src", "colcon build\n", "source install/setup.bash\n",
        "ros2 launch robot_controller start_system.launch.py\n", "ros2 run turtlesim turtlesim_node", "Humble",
        "rm -rf build install log",
    ):  # fmt: skip
        assert line in text


def test_what_is_exported_builds(lesson: Lesson, monkeypatch: pytest.MonkeyPatch) -> None:
    lesson.export("robot_controller", to="robot")
    monkeypatch.chdir("robot")
    assert colcon(lesson._world).err == ""


def test_a_learners_package_comes_before_the_finished_one(lesson: Lesson, tmp_path: Path) -> None:
    folder = make_package(tmp_path)
    result = lesson.export("robot_controller", to=tmp_path.parent / f"{tmp_path.name}_robot")
    assert result.programs == ["navigator"]
    colcon(lesson._world)
    source_in(lesson._world)
    os.chdir(tmp_path.parent)
    assert lesson.export("robot_controller", to=result.folder, overwrite=True).programs == ["navigator"]
    assert lesson.export(folder, to=result.folder, overwrite=True).programs == ["navigator"]


def test_programs_can_be_run_and_lines_end_as_on_linux(lesson: Lesson, tmp_path: Path) -> None:
    folder = make_package(tmp_path)
    node = folder / "robot_controller/navigator_node.py"
    node.write_bytes(node.read_bytes().replace(b"\n", b"\r\n"))
    result = lesson.export("robot_controller", to=tmp_path / "robot")
    written = result.package / "robot_controller/navigator_node.py"
    assert os.access(written, os.X_OK)
    assert written.read_bytes().startswith(b"#!/usr/bin/env python3\n")


def test_what_a_build_would_refuse_is_refused(lesson: Lesson, tmp_path: Path) -> None:
    folder = make_package(tmp_path)
    change(folder / "package.xml", "  <member_of_group>rosidl_interface_packages</member_of_group>\n", "")
    with pytest.raises(PackageError, match="Packages installing interfaces must include") as caught:
        lesson.export("robot_controller", to="robot")
    assert "CMakeLists.txt:12 (rosidl_generate_interfaces)" in str(caught.value)
    assert not Path("robot").exists()


def test_what_a_robot_has_not_is_refused(lesson: Lesson, tmp_path: Path) -> None:
    folder = make_package(tmp_path)
    change(folder / "robot_controller/navigator_node.py", "from robot", "import turtle_lesson\nfrom robot")
    with pytest.raises(PackageError, match=r"navigator_node.py, line 2: this imports turtle_lesson"):
        lesson.export("robot_controller", to="robot")
    change(folder / "robot_controller/navigator_node.py", "import turtle_lesson", "import turtle_lesson (")
    with pytest.raises(PackageError, match=r"line 2: this is not valid Python"):
        lesson.export("robot_controller", to="robot")


def test_what_to_look_at_is_said(lesson: Lesson, tmp_path: Path) -> None:
    folder = make_package(tmp_path)
    change(
        folder / "robot_controller/navigator_node.py", "from robot", "from geometry_msgs.msg import Twist\nfrom robot"
    )
    change(folder / "package.xml", "A package for tests", "TODO: Package description")
    notes = lesson.export("robot_controller", to=tmp_path.parent / f"{tmp_path.name}_robot").notes
    assert notes == [
        "robot_controller/navigator_node.py, line 2, imports geometry_msgs: add <exec_depend>geometry_msgs</exec_depend> to "
        "package.xml",
        "package.xml still says 'TODO: Package description'",
    ]


def test_what_the_release_lacks_is_named_if_a_program_has_used_it(lesson: Lesson, tmp_path: Path) -> None:
    node = make_package(tmp_path) / "robot_controller/navigator_node.py"
    node.write_text("#!/usr/bin/env python3\nfrom rclpy.duration import Duration\n\nprint(Duration(seconds=1) * 2)\n")
    there = tmp_path.parent / f"{tmp_path.name}_robot"
    assert lesson.export("robot_controller", to=there).notes == []
    installed = tmp_path / "install/lib/robot_controller/navigator_node.py"  # a build's copy is what runs
    installed.parent.mkdir(parents=True)
    installed.write_text(node.read_text())
    lesson._world.spawn(installed, name="navigator_node")
    lesson.run(1)
    (note,) = lesson.export("robot_controller", to=there, overwrite=True).notes
    assert note.startswith(
        "robot_controller/navigator_node.py, line 4, uses what Humble lacks. Since Kilted durations can be added"
    )


def test_nothing_is_overwritten_unasked(lesson: Lesson) -> None:
    lesson.export("robot_controller", to="robot")
    with pytest.raises(PackageError, match=r"robot/src/robot_controller already exists\. Choose another folder"):
        lesson.export("robot_controller", to="robot")
    lesson.export("robot_controller", to="robot", overwrite=True)
    Path("README.md").write_text("mine\n")
    with pytest.raises(PackageError, match=r"README\.md already exists\. Choose another folder"):
        lesson.export("robot_controller", to=".")
    assert Path("README.md").read_text() == "mine\n"
    assert not Path("src").exists()


def test_it_never_writes_over_its_source(lesson: Lesson, tmp_path: Path) -> None:
    make_package(tmp_path)
    with pytest.raises(PackageError, match="is the package's own source"):
        lesson.export("robot_controller", to=tmp_path, overwrite=True)


def test_an_unknown_name(lesson: Lesson) -> None:
    with pytest.raises(PackageError, match="Did you mean 'robot_controller'"):
        lesson.export("robot_controler", to="robot")
