"""Loads the package's node files as modules: they are programs, not a Python package, so by their path."""

import importlib.util
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import ModuleType

import turtle_lesson
from turtle_lesson.ros.idl.registry import registry

PACKAGE = Path(turtle_lesson.__file__).parent / "robot_controller"


def load_node(name: str) -> ModuleType:
    """Return the module of a node file, such as "navigator_node", for tests of what in it needs no ROS."""
    if name not in sys.modules:
        spec = importlib.util.spec_from_file_location(name, PACKAGE / "robot_controller" / f"{name}.py")
        assert spec is not None and spec.loader is not None
        sys.modules[name] = module = importlib.util.module_from_spec(spec)
        with _its_interfaces():
            spec.loader.exec_module(module)
    return sys.modules[name]


@contextmanager
def _its_interfaces() -> Iterator[None]:
    """Make `robot_controller.msg` and `.srv` importable, if no world has done so."""
    if "robot_controller" in registry.packages():
        yield
        return
    registry.add("robot_controller", PACKAGE)
    yield
    registry.remove("robot_controller")
