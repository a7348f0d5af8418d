"""What this rclpy does not have says so, instead of failing as if it had never existed."""

from __future__ import annotations

import difflib
import sys
from collections.abc import Callable
from typing import Any


def explain_missing(module: str) -> Callable[[str], Any]:
    """A module-level `__getattr__` that names what is not here, and what was perhaps meant."""

    def missing(name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        known = [public for public in vars(sys.modules[module]) if not public.startswith("_")]
        close = difflib.get_close_matches(name, known, n=1)
        hint = f"did you mean {close[0]!r}?" if close else "on a real ROS 2 it may exist; here it is not built yet."
        raise AttributeError(f"module {module!r} of this classroom has no {name!r}: {hint}")

    return missing
