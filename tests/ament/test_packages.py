"""Packages as they lie in their source folder, and the index in which they are found."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

import turtle_lesson
from turtle_lesson.ros.ament.index import PackageIndex, find_launch_file, seeing
from turtle_lesson.ros.ament.package import (
    ExecutableNotFoundError,
    LaunchFileNotFoundError,
    Package,
    PackageError,
    PackageNotFoundError,
)
from turtle_lesson.ros.ament.source import read_source_package

XML = """\
<?xml version="1.0"?>
<package format="3">
  <name>{name}</name>
  <version>0.0.0</version>
  <description>TODO</description>
  <maintainer email="user@example.org">user</maintainer>
  <license>Apache-2.0</license>
  <buildtool_depend>ament_cmake</buildtool_depend>
  <depend>rclpy</depend>
  {group}
  <export><build_type>{build_type}</build_type></export>
</package>
"""
GROUP = "<member_of_group>rosidl_interface_packages</member_of_group>"
CMAKE = """\
cmake_minimum_required(VERSION 3.8)
project(demo)
find_package(ament_cmake REQUIRED)
find_package(rosidl_default_generators REQUIRED)
rosidl_generate_interfaces(${PROJECT_NAME} "msg/Count.msg")
install(PROGRAMS demo/talker_node.py DESTINATION lib/${PROJECT_NAME} RENAME talker)
install(DIRECTORY launch DESTINATION share/${PROJECT_NAME})
ament_package()
"""


@pytest.fixture
def demo(tmp_path: Path) -> Path:
    """A good package."""
    folder = tmp_path / "demo"
    for name in ("demo", "msg", "launch"):
        (folder / name).mkdir(parents=True)
    (folder / "package.xml").write_text(XML.format(name="demo", group=GROUP, build_type="ament_cmake"))
    (folder / "CMakeLists.txt").write_text(CMAKE)
    (folder / "demo/talker_node.py").write_text("#!/usr/bin/env python3\nprint('hi')\n")
    (folder / "msg/Count.msg").write_text("int32 count\n")
    (folder / "launch/demo.launch.py").write_text("")
    return folder


def change(path: Path, old: str, new: str) -> None:
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new))


def refused(folder: Path) -> str:
    with pytest.raises(PackageError) as caught:
        read_source_package(folder)
    return " ".join(str(caught.value).replace(str(folder), "demo").split())


def test_a_good_package(demo: Path) -> None:
    package = read_source_package(demo)
    assert package.name == "demo"
    assert package.executables == {"talker": demo / "demo/talker_node.py"}
    assert package.interfaces == ["msg/Count.msg"]
    assert package.shared_files("demo.launch.py") == [demo / "launch/demo.launch.py"]


def test_the_finished_package_is_a_good_one() -> None:
    folder = Path(turtle_lesson.__file__).parent / "robot_controller"
    package = read_source_package(folder)
    assert sorted(package.executables) == ["navigator", "obstacle_detector", "status_monitor"]
    assert package.interfaces == ["msg/TurtleStatus.msg", "srv/NavigateTo.srv"]
    assert package.shared_files("start_system.launch.py") == [folder / "launch/start_system.launch.py"]


def test_what_is_missing(demo: Path) -> None:
    (demo / "CMakeLists.txt").rename(demo / "CMakeList.txt")
    assert "does not appear to contain CMakeLists.txt. Hint: A package that is built from a setup.py" in refused(demo)
    (demo / "package.xml").unlink()
    assert "demo/package.xml: it is missing. A folder is a ROS 2 package if" in refused(demo)


@pytest.mark.parametrize(
    ("file", "old", "new", "said"),
    [
        ("package.xml", "</export>", "", "contains invalid XML: mismatched tag"),
        (
            "package.xml",
            "ament_cmake</build",
            "ament_cmak</build",
            "'ament_cmak' is unknown. Did you mean 'ament_cmake'?",
        ),
        ("package.xml", GROUP, "", "Hint: Add that line to demo/package.xml, before <export>."),
        ("package.xml", "<name>demo", "<name>demos", "Hint: Write project(demos) in line 2 of CMakeLists.txt."),
        ("CMakeLists.txt", "talker_node.py D", "talker.py D", "names 'demo/talker.py', which does not exist."),
        ("CMakeLists.txt", "Count.msg", "Cout.msg", "the passed file 'msg/Cout.msg' doesn't exist"),
        ("CMakeLists.txt", "DIRECTORY launch", "DIRECTORY (", "line 7: the '(' of install is never closed"),
    ],
)
def test_what_a_build_would_refuse(demo: Path, file: str, old: str, new: str, said: str) -> None:
    change(demo / file, old, new)
    assert said in refused(demo)


def test_a_launch_file_that_is_not_installed_is_not_found(demo: Path) -> None:
    change(demo / "CMakeLists.txt", "install(DIRECTORY launch DESTINATION share/${PROJECT_NAME})\n", "")
    index = PackageIndex()
    index.add(read_source_package(demo))
    with pytest.raises(LaunchFileNotFoundError, match=r"install\(DIRECTORY launch DESTINATION"):
        find_launch_file(index, "demo", "demo.launch.py")


# -- the index --------------------------------------------------------------------------------------------


def make_index(*names: str) -> PackageIndex:
    index = PackageIndex()
    for name in names:
        index.add(Package(name, Path("install") / name / "share" / name, prefix=Path("install") / name))
    return index


def test_packages_are_found_and_can_be_hidden_by_an_overlay() -> None:
    index = make_index("turtlesim", "robot_controller")
    overlay = Package("robot_controller", Path("overlay"))
    index.add(overlay)
    assert index.names() == ["robot_controller", "turtlesim"]
    assert index.get("robot_controller") is overlay
    index.remove(index.get("robot_controller"))
    assert index.get("robot_controller").prefix == Path("install/robot_controller")
    index.remove(index.get("robot_controller"))
    assert "robot_controller" not in index


def test_an_unknown_package_is_refused_in_the_real_words() -> None:
    index = make_index("turtlesim", "robot_controller")
    with pytest.raises(PackageNotFoundError) as caught:
        index.get("robot_controler")
    assert caught.value.args[0] == (
        "package 'robot_controler' not found, searching: ['install/robot_controller', 'install/turtlesim']"
    )
    assert str(caught.value).endswith("\". Did you mean 'robot_controller'?")
    with pytest.raises(KeyError, match="Is it built, and is its setup file sourced"):
        index.get("zzz")


def test_an_unknown_executable_is_refused_in_the_real_words() -> None:
    index = PackageIndex()
    index.add(Package("demo", Path("share"), {"talker": print}, prefix=Path("install/demo")))
    assert index.executable("demo", "talker") is print
    with pytest.raises(ExecutableNotFoundError) as caught:
        index.executable("demo", "talkr")
    assert str(caught.value) == (
        "executable 'talkr' not found on the libexec directory 'install/demo/lib/demo'. "
        "Did you mean 'talker'? demo has: talker."
    )


def test_programs_ask_through_ament_index_python(demo: Path) -> None:
    from ament_index_python.packages import (
        get_package_prefix,
        get_package_share_directory,
        get_package_share_path,
        get_packages_with_prefixes,
    )

    index = make_index("turtlesim")
    index.add(read_source_package(demo))
    with seeing(index):
        assert get_package_share_directory("demo") == str(demo)
        assert get_package_share_path("turtlesim") == Path("install/turtlesim/share/turtlesim")
        assert get_package_prefix("turtlesim") == str(Path("install/turtlesim"))
        assert list(get_packages_with_prefixes()) == ["demo", "turtlesim"]
        with pytest.raises(ValueError, match=r"'x.launch.py' is not a valid package name"):
            get_package_prefix("x.launch.py")
        with pytest.raises(PackageNotFoundError):
            get_package_prefix("nowhere")


def test_importing_the_simulation_does_not_load_launch() -> None:
    code = "import sys, turtle_lesson.session.lesson; print('launch' in sys.modules, 'yaml' in sys.modules)"
    result = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert result.stdout.split()[0] == "False"
