"""How launch's packages look like the real ones: the paths of their modules, and what is said of names that are not here."""

from __future__ import annotations

import difflib
import sys
from collections.abc import Callable, Mapping
from types import ModuleType
from typing import Any


def provide_modules(modules: Mapping[str, Mapping[str, str]]) -> None:
    """Let the modules of a real package be imported by their names, though fewer files hold what is in them.

    A class or function has the name of such a module as its `__module__`, as on a robot.

    Args:
        modules: for each module that is a file here, the real modules whose names are in it, and these names, parted by
            spaces. A package stands before what is in it.
    """
    for home, real in modules.items():
        source = vars(sys.modules[home])
        for path, names in real.items():
            module = ModuleType(path, source["__doc__"])
            module.__dict__.update({name: source[name] for name in names.split()})
            module.__dict__.update(__file__=source["__file__"], __all__=names.split())
            for value in vars(module).values():
                if getattr(value, "__module__", None) == home:
                    value.__module__ = path
            sys.modules[path] = module
            parent, _, last = path.rpartition(".")
            vars(sys.modules[parent]).setdefault(last, module)


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
