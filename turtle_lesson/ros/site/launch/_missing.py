"""What `launch` and `launch_ros` do not have here says so on import, with what was perhaps meant."""

from __future__ import annotations

import difflib
import sys
from collections.abc import Callable, Mapping
from typing import Any


def explain_missing(module: str, real: Mapping[str, str]) -> Callable[[str], Any]:
    """A module-level `__getattr__` that raises ImportError for a public name that is not here.

    Args:
        module: the module's name.
        real: names that the real module has, each with what to do without it, or an empty text.
    """

    def missing(name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(f"module {module!r} has no attribute {name!r}")
        raise ImportError(_explanation(module, name, real), name=module)

    return missing


def _explanation(module: str, name: str, real: Mapping[str, str]) -> str:
    here = [public for public in vars(sys.modules[module]) if not public.startswith("_")]
    if name in real:
        advice = real[name] or "a real ROS 2 has it"
        return f"{module} has no {name!r} here yet: {advice}"
    close = difflib.get_close_matches(name, [*here, *real], n=1)
    if close:
        return f"{module} has no {name!r}; did you mean {close[0]!r}?"
    classes = ", ".join(sorted(public for public in here if public[0].isupper()))
    return f"{module} has no {name!r}. It has: {classes or ', '.join(sorted(here))}"
