"""Loads the package's node files as modules: they are programs, not a Python package, so by their path."""

import importlib.util
import sys
from pathlib import Path
from types import ModuleType

import turtle_lesson

PACKAGE = Path(turtle_lesson.__file__).parent / "robot_controller"


def load_node(name: str) -> ModuleType:
    """Return the module of a node file, such as "navigator_node"; loaded once."""
    if name not in sys.modules:
        spec = importlib.util.spec_from_file_location(name, PACKAGE / "robot_controller" / f"{name}.py")
        assert spec is not None and spec.loader is not None
        sys.modules[name] = module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
    return sys.modules[name]
