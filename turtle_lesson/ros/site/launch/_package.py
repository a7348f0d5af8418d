"""How launch's packages look like the real ones: the paths of their modules, and what is said of names that are not here."""

from __future__ import annotations

import difflib
import re
import sys
from collections import defaultdict
from collections.abc import Mapping
from functools import partial
from pathlib import Path
from types import ModuleType
from typing import Any


def complete_package(package: str) -> None:
    """Let the modules of a real package be imported by their names, though fewer files hold what is in them.

    Each public class lies in a module of its own, too: `launch.actions.TimerAction` in `launch.actions.timer_action`. It has
    that name as its `__module__`, as on a robot. A public name that is not here raises an ImportError that says so.

    All files of the package have been imported. Its further modules are in its `modules.txt`, with the names in each, parted by
    spaces, and then the names that only the real one has, with what to do without them.
    """
    file = Path(str(sys.modules[package].__file__)).with_name("modules.txt")
    here, _, not_here = file.read_text(encoding="utf-8").partition("==== not here\n")
    missing: defaultdict[str, dict[str, str]] = defaultdict(dict)
    for line in not_here.splitlines():
        path, what_to_do = line.split(": ", 1)
        module_name, _, name = path.rpartition(".")
        missing[module_name][name] = what_to_do
    files = sorted(name for name in sys.modules if f"{name}.".startswith(f"{package}."))
    anywhere = {name: value for each in files for name, value in vars(sys.modules[each]).items()}
    for path, names in (line.split(": ", 1) for line in here.splitlines()[1:]):
        nearer = vars(sys.modules[path.rpartition(".")[0]])
        for name in names.split():
            _put(path, name, nearer.get(name, anywhere[name]), files)
    for place in (name for name in files if "._" not in name):
        module = sys.modules[place]
        for name in getattr(module, "__all__", ()):
            value = vars(module)[name]
            snake_case = re.sub(r"(?<=[a-z])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])", "_", name).lower()
            path = f"{place}.{snake_case}"
            has_none = isinstance(value, type) and (value.__module__ in (place, path) or "._" in value.__module__)
            if has_none and path not in files:
                _put(path, name, value, files)
        vars(module)["__getattr__"] = partial(_missing, module, missing[place])


def _put(path: str, name: str, value: Any, files: list[str]) -> None:
    """Put a name into a module, which is made if there is none."""
    if path not in sys.modules:
        sys.modules[path] = ModuleType(path)
        parent, _, last = path.rpartition(".")
        vars(sys.modules[path]).update(__all__=[], __file__=sys.modules[parent].__file__)
        vars(sys.modules[parent]).setdefault(last, sys.modules[path])
    module = vars(sys.modules[path])
    module[name] = value
    module["__all__"].append(name)
    if getattr(value, "__module__", None) in files:
        value.__module__ = path


def _missing(module: ModuleType, real: Mapping[str, str], name: str) -> Any:
    """What a module's `__getattr__` says of a name that is not in it."""
    if name.startswith("_"):
        raise AttributeError(f"module {module.__name__!r} has no attribute {name!r}")
    here = [public for public in vars(module) if not public.startswith("_")]
    begin = f"{module.__name__} has no {name!r}"
    if name in real:
        raise ImportError(f"{begin} here yet: {real[name]}", name=module.__name__)
    close = difflib.get_close_matches(name, [*here, *real], n=1)
    raise ImportError(f"{begin}; did you mean {close[0]!r}?" if close else begin, name=module.__name__)
