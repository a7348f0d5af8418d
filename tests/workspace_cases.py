"""A small package to break, `colcon` in a world, and the recorded answers of the real one."""

from __future__ import annotations

import argparse
import io
import re
from dataclasses import dataclass
from pathlib import Path

from turtle_lesson.ros.ament.create import add_arguments
from turtle_lesson.ros.ament.source import source
from turtle_lesson.ros.cli.colcon import run
from turtle_lesson.ros.runtime.world import World

XML = """\
<?xml version="1.0"?>
<package format="3">
  <name>robot_controller</name>
  <version>0.0.0</version>
  <description>A package for tests</description>
  <maintainer email="user@example.org">user</maintainer>
  <license>Apache-2.0</license>

  <buildtool_depend>ament_cmake</buildtool_depend>
  <buildtool_depend>rosidl_default_generators</buildtool_depend>
  <depend>rclpy</depend>
  <exec_depend>rosidl_default_runtime</exec_depend>
  <member_of_group>rosidl_interface_packages</member_of_group>

  <export>
    <build_type>ament_cmake</build_type>
  </export>
</package>
"""
CMAKE = """\
cmake_minimum_required(VERSION 3.8)
project(robot_controller)

if(CMAKE_COMPILER_IS_GNUCXX OR CMAKE_CXX_COMPILER_ID MATCHES "Clang")
  add_compile_options(-Wall -Wextra -Wpedantic)
endif()

find_package(ament_cmake REQUIRED)
find_package(rosidl_default_generators REQUIRED)
# line 10

rosidl_generate_interfaces(${PROJECT_NAME}
  "msg/TurtleStatus.msg"
  "srv/NavigateTo.srv"
)

install(PROGRAMS robot_controller/navigator_node.py
  DESTINATION lib/${PROJECT_NAME} RENAME navigator)
install(DIRECTORY launch DESTINATION share/${PROJECT_NAME})

ament_package()
"""
STATUS = "float32 x\nfloat32 y\nfloat32 theta\nfloat32 vel_x\nfloat32 vel_y\nfloat32 battery\n"
NAVIGATE = "float32 x\nfloat32 y\nfloat32 theta\n---\nbool success\nfloat32 time_taken\n"
NODE = """\
#!/usr/bin/env python3
from robot_controller.msg import TurtleStatus

print('navigator', TurtleStatus.get_fields_and_field_types())
"""


def make_package(workspace: Path) -> Path:
    """A good ament_cmake package in the workspace's src/, with two interfaces and one program; returns its folder."""
    folder = workspace / "src" / "robot_controller"
    for name in ("msg", "srv", "launch", "robot_controller"):
        (folder / name).mkdir(parents=True)
    (folder / "package.xml").write_text(XML)
    (folder / "CMakeLists.txt").write_text(CMAKE)
    (folder / "msg/TurtleStatus.msg").write_text(STATUS)
    (folder / "srv/NavigateTo.srv").write_text(NAVIGATE)
    (folder / "robot_controller/navigator_node.py").write_text(NODE)
    (folder / "launch/start_system.launch.py").write_text("")
    return folder


def parse(words: list[str]) -> argparse.Namespace:
    """The arguments for `create_package`, from the words after `ros2 pkg create`."""
    parser = argparse.ArgumentParser("ros2 pkg create", description="Create a new ROS 2 package")
    add_arguments(parser)
    return parser.parse_args(words)


def change(path: Path, old: str, new: str) -> None:
    """Replace a text that must be in the file."""
    text = path.read_text()
    assert old in text, (path, old)
    path.write_text(text.replace(old, new))


@dataclass
class Answer:
    """What a command answered."""

    code: int
    out: str
    err: str

    @property
    def shape(self) -> tuple[int, list[str], list[str]]:
        """The same without durations."""
        return self.code, timeless(self.out.splitlines()), timeless(self.err.splitlines())


def timeless(lines: list[str]) -> list[str]:
    """Lines without durations, and without empty lines at their end."""
    found = [re.sub(r"\[\d+\.\d+s", "[0.00s", line).rstrip() for line in lines]
    return "\n".join(found).rstrip("\n").split("\n")


def colcon(world: World, line: str = "build") -> Answer:
    """`colcon LINE` in the current folder."""
    out, err = io.StringIO(), io.StringIO()
    return Answer(run(world, line.split(), stdout=out, stderr=err), out.getvalue(), err.getvalue())


def source_in(world: World, file: str = "install/setup.bash") -> Answer:
    """`source FILE` in the current folder."""
    out, err = io.StringIO(), io.StringIO()
    code = source(world, [file], stdout=out, stderr=err, cwd=Path.cwd())
    return Answer(code, out.getvalue(), err.getvalue())


def started(world: World, package: str, executable: str) -> str:
    """What a program prints that is started and runs to its end."""
    out = io.StringIO()
    world.spawn(world.packages.executable(package, executable), name=executable, stdout=out, stderr=out)
    world.sim.settle()
    return out.getvalue()
