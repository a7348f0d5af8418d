"""A workspace in which robot_controller is installed, as after `colcon build`, for tests of commands that look into it."""

from __future__ import annotations

import textwrap
from pathlib import Path

from turtle_lesson.ros.ament.package import Package
from turtle_lesson.ros.idl.registry import registry
from turtle_lesson.ros.runtime.world import World

HEAD = """\
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch_ros.actions import Node
def generate_launch_description():
    return LaunchDescription([
"""

LAUNCH_FILES = {
    "start_system": HEAD + "        Node(package='robot_controller', executable='navigator', name='navigator'),\n"
    "        Node(package='robot_controller', executable='status_monitor', name='status_monitor'),\n    ])\n",
    "noexec": HEAD + "        Node(package='robot_controller', executable='navigatr'),\n    ])\n",
    "nopkg": HEAD + "        Node(package='robot_controler', executable='navigator'),\n    ])\n",
    "nofunc": "x = 1\n",
    "syntax": HEAD + "        Node(package='robot_controller' executable='navigator'),\n    ])\n",
    "args": HEAD + "        DeclareLaunchArgument('rate', default_value='10', description='Publish rate [Hz]'),\n"
    "        DeclareLaunchArgument('robot', description='Name of the robot (required)'),\n    ])\n",
}

NODE = """
import rclpy
def main():
    rclpy.init()
    node = rclpy.create_node({name!r})
    node.get_logger().info({text!r})
    rclpy.spin(node)
main()
"""

PROGRAMS = {
    "navigator": NODE.format(name="navigator", text="Navigator node started"),
    "status_monitor": NODE.format(name="status_monitor", text="Status Monitor started"),
    "raise_init": "import rclpy\ndef main():\n    rclpy.init()\n    Strng\nmain()\n",
    "raise_cb": textwrap.dedent("""
        import rclpy
        def tick():
            raise ValueError('boom in callback')
        def main():
            rclpy.init()
            node = rclpy.create_node('raise_cb')
            node.create_timer(0.5, tick)
            rclpy.spin(node)
        main()
        """),
}

MANIFEST = """\
<?xml version="1.0"?>
<package format="3">
  <name>robot_controller</name>
  <version>0.0.0</version>
  <description>TODO: Package description</description>
  <maintainer email="root@todo.todo">root</maintainer>
  <license>TODO: License declaration</license>

  <export>
    <build_type>ament_cmake</build_type>
  </export>
</package>
"""

INTERFACES = {
    "msg/TurtleStatus.msg": "float32 x\nfloat32 y\nfloat32 theta\nfloat32 vel_x\nfloat32 vel_y\nfloat32 battery\n",
    "srv/NavigateTo.srv": "float32 x\nfloat32 y\nfloat32 theta\n---\nbool success\nfloat32 time_taken\n",
}


def install_robot_controller(world: World, folder: Path) -> Package:
    """Write an installed robot_controller below a folder and make it known to a world."""
    prefix = folder / "install" / "robot_controller"
    share, libexec = prefix / "share" / "robot_controller", prefix / "lib" / "robot_controller"
    _write(share / "package.xml", MANIFEST)
    for name, text in PROGRAMS.items():
        _write(libexec / name, text)
    for name, text in LAUNCH_FILES.items():
        _write(share / "launch" / f"{name}.launch.py", text)
    for name, text in INTERFACES.items():
        _write(share / name, text)
    package = Package(
        "robot_controller",
        share,
        executables={name: libexec / name for name in PROGRAMS},
        interfaces=list(INTERFACES),
        prefix=prefix,
    )
    world.packages.add(package)
    registry.add("robot_controller", share, package.interfaces)
    return package


def _write(path: Path, text: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
