"""The modules of the real launch packages can be imported by their names, though fewer files hold what is in them."""

from __future__ import annotations

import importlib
import subprocess
import sys
from pathlib import Path

import launch
import launch_ros
import pytest

LINES = (Path(__file__).parents[1] / "data" / "launch_modules.txt").read_text().splitlines()
MODULES = {path: names.split() for path, _, names in (line.partition(":") for line in LINES)}


@pytest.mark.parametrize("path", MODULES)
def test_a_module_has_the_same_classes_as_its_package(path: str) -> None:
    module = importlib.import_module(path)
    assert module is sys.modules[path]
    package = importlib.import_module(path.rpartition(".")[0] or path)
    for name in MODULES[path]:
        found = vars(module)[name]
        if name in vars(package):
            assert vars(package)[name] is found


@pytest.mark.parametrize(
    "line",
    [
        "from launch.actions.declare_launch_argument import DeclareLaunchArgument",
        "from launch.launch_description_sources.python_launch_description_source import PythonLaunchDescriptionSource",
        "import launch.substitutions.launch_configuration as found; found.LaunchConfiguration",
        "import launch; launch.actions.execute_process.ExecuteProcess; launch.events.matchers.matches_action",
        "from launch_ros.actions.node import Node; assert Node.__module__ == 'launch_ros.actions.node'",
        "import launch_ros.events.lifecycle; launch_ros.events.lifecycle.ChangeState",
        "from launch_xml.launch_description_sources import XMLLaunchDescriptionSource",
        "from launch_yaml.launch_description_sources import YAMLLaunchDescriptionSource",
    ],
)
def test_a_program_may_begin_with_any_of_them(line: str) -> None:
    before = f"import sys; sys.path[:0] = {sys.path!r}; import turtle_lesson.ros.runtime.world; "
    subprocess.run([sys.executable, "-c", before + line], check=True, capture_output=True, text=True)


def test_a_module_has_nothing_else() -> None:
    with pytest.raises(ImportError, match="cannot import name 'TimerAction'"):
        from launch.actions.execute_process import TimerAction  # noqa: F401
    with pytest.raises(ImportError, match=r"launch\.events has no 'ProcessExited'"):
        from launch.events import ProcessExited  # noqa: F401
    assert repr(launch.actions.LogInfo(msg="x")) == "<launch.actions.log_info.LogInfo object>"
    assert launch_ros.actions.Node.__module__ == "launch_ros.actions.node"
