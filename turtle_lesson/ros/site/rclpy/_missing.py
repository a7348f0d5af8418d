"""What this rclpy does not have says so, instead of failing as if it had never existed."""

from __future__ import annotations

import importlib
import importlib.util
import sys
from collections.abc import Callable
from typing import Any

from ._mistakes import did_you_mean


def explain_missing(module: str) -> Callable[[str], Any]:
    """A module-level `__getattr__`: imports a submodule that is used without having been imported, as in
    `rclpy.logging.get_logger`, which works on a real ROS 2, too; or says that there is nothing of that name.
    """

    def missing(name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        if not name.startswith("_") and importlib.util.find_spec(f"{module}.{name}") is not None:
            return importlib.import_module(f"{module}.{name}")
        known = [public for public in vars(sys.modules[module]) if not public.startswith("_")]
        hint = did_you_mean(name, known) or "; a real ROS 2 may have it, but it is not available here yet"
        # With an object that has nothing, Python adds no "Did you mean" of its own.
        raise AttributeError(f"the simulated module {module!r} has no {name!r}{hint}", name=name, obj=None)

    return missing


def refuse_unbuilt(**arguments: Any) -> None:
    """Raise NotImplementedError if one of these arguments was given, which rclpy has and the simulation does not."""
    for name, value in arguments.items():
        if value:
            raise NotImplementedError(f"{name} is not available here, got {value!r}: leave it out")
