"""Carries a check out within a copy's kernel, after the copy's cells, by checking code that the copy does not have.

The grader reads this module and the checking code before any copy runs, and sends them compiled; what a copy has done to its
own modules, or to the files, does not matter. What the checking code looks at is the copy's, and cannot be told from a fake.
"""

from __future__ import annotations

import contextlib
import hashlib
import hmac
import importlib.abc
import importlib.util
import json
import os
import sys
from collections.abc import Iterator, Sequence
from importlib.machinery import ModuleSpec
from types import CodeType, FunctionType, ModuleType
from typing import Any

CASES = "turtle_lesson.lab.troubles.cases"
"""The one module of the checking code that remembers something: the case that is open."""

USED = {
    *("builtins", "contextlib", "dataclasses", "functools", "hashlib", "hmac", "importlib", "json", "marshal", "math"),
    *("os", "socket", "sys", "typing"),
}
"""Python's own modules in which a function of a copy's cells is noticed; so it is in all modules of the lesson."""

Sent = dict[str, tuple[str, CodeType]]
"""Modules by name: the file of each, and its code."""


def answer(question: dict[str, Any], names: dict[str, Any], key: bytes) -> bytes:
    """What a check sees, signed: `{"rows": […], "replaced": […]}`.

    Args:
        question: the check's name, the name of the lesson in the cells, the checking code, the folder of the installed package,
            and half of the secret to sign with, which was made a moment ago.
        names: those of the copy's cells.
        key: the other half.
    """
    replaced = strangers(question["home"], names)
    rows: list[dict[str, str]] = []
    if not any(each.startswith("the package") for each in replaced):
        with open(os.devnull, "w") as nowhere, contextlib.redirect_stdout(nowhere), contextlib.redirect_stderr(nowhere):
            sent = question["modules"]
            before = {name: sys.modules.pop(name) for name in sent if name in sys.modules}
            finder = _Finder(sent)
            sys.meta_path.insert(0, finder)
            try:
                rows = _look(question, names, before)
            finally:
                sys.meta_path.remove(finder)
        replaced += [name for name, old in before.items() for name in _changed(name, old, sys.modules[name])]
    text = json.dumps({"rows": rows, "replaced": sorted(set(replaced))[:5]}).encode()
    return hmac.digest(question["secret"] + key, text, hashlib.sha256) + text


def _look(question: dict[str, Any], names: dict[str, Any], before: dict[str, ModuleType]) -> list[dict[str, str]]:
    for name in question["modules"]:
        importlib.import_module(name)
    new = {name.removeprefix("turtle_lesson."): sys.modules[name] for name in question["modules"]}
    if CASES in before:
        new["lab.troubles.cases"].carry_over(before[CASES])
    kind = getattr(sys.modules.get("turtle_lesson.session.lesson"), "Lesson", None)
    lessons = [each for each in (names.get(question["variable"]), *reversed(names.values())) if type(each) is kind]
    if not lessons:
        return []
    place = new["session.check_target"].CheckTarget(lessons[0]._world, lessons[0]._recording, lessons[0]._board)
    checks = new["lab.checks.registry"]
    rows: list[dict[str, str]] = checks.run(checks.find(question["check"]), place).figures()["rows"]
    return rows


class _Finder(importlib.abc.MetaPathFinder, importlib.abc.Loader):
    """Imports what was sent, whatever is on the path."""

    def __init__(self, modules: Sent) -> None:
        self._modules = modules

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        if fullname not in self._modules:
            return None
        file = self._modules[fullname][0]
        inside = [os.path.dirname(file)] if os.path.basename(file) == "__init__.py" else None
        return importlib.util.spec_from_file_location(fullname, file, loader=self, submodule_search_locations=inside)

    def exec_module(self, module: ModuleType) -> None:
        exec(self._modules[module.__name__][1], vars(module))


def strangers(home: str, names: dict[str, Any]) -> list[str]:
    """What is not as it was installed: a package that hides the lesson's in `home`, or a function or class in a module that is
    not from an installed file, as those of the cells (`names`) are."""
    found = []
    for name, folder in (("turtle_lesson", home), ("rclpy", os.path.join(home, "ros", "site", "rclpy"))):
        file = getattr(sys.modules.get(name), "__file__", None) or ""
        if name in sys.modules and os.path.dirname(os.path.realpath(file)) != folder:
            found.append(f"the package {name}, by {file or 'a module of its own'}")
    installed = (home, sys.prefix, sys.base_prefix, os.path.dirname(os.__file__), "<frozen")
    for name, module in list(sys.modules.items()):
        file = getattr(module, "__file__", None) or ""
        if name != "__main__" and (name in USED or file.startswith(home)):
            for key, value in list(vars(module).items()):
                if _is_strange(key, value, names, installed):
                    found.append(f"{name}.{key}")
                elif isinstance(value, type) and value.__module__ == name:
                    inside = list(vars(value).items())
                    found += [f"{name}.{key}.{each}" for each, it in inside if _is_strange(each, it, names, installed)]
    return found


def _is_strange(name: str, value: Any, names: dict[str, Any], installed: tuple[str, ...]) -> bool:
    if isinstance(value, type):
        return value.__module__ == "__main__"
    function = _function_in(value)
    if not isinstance(function, FunctionType):
        return False
    generated = name.startswith("__") and function.__code__.co_filename.startswith("<")  # by dataclasses and namedtuple
    return function.__globals__ is names or not (generated or function.__code__.co_filename.startswith(installed))


def _function_in(value: Any) -> Any:
    """The function within a property, static method or class method; else the value itself."""
    if isinstance(value, property):
        return value.fget
    return value.__func__ if isinstance(value, staticmethod | classmethod) else value


def _changed(path: str, old: Any, new: Any) -> Iterator[str]:
    """Which of the names in a module or class differ from those in a new one, imported afresh."""
    mine, theirs = dict(vars(new)), dict(vars(old))
    for name, value in theirs.items():
        if isinstance(value, ModuleType) or (name.startswith("__") and isinstance(new, ModuleType)):
            continue
        if name not in mine:
            yield f"{path}.{name}"
        elif isinstance(new, ModuleType) and getattr(mine[name], "__module__", path) != path:
            continue  # imported from elsewhere: what the cells put in its place is found by `strangers`
        elif isinstance(mine[name], type) and isinstance(value, type):
            if isinstance(new, ModuleType):
                yield from _changed(f"{path}.{name}", value, mine[name])
        elif not _same(value, mine[name]):
            yield f"{path}.{name}"


def _same(old: Any, new: Any) -> bool:
    old, new = _function_in(old), _function_in(new)
    if isinstance(new, FunctionType):
        return isinstance(old, FunctionType) and old.__code__ == new.__code__
    if isinstance(new, dict):
        return isinstance(old, dict) and all(key in new and _same(value, new[key]) for key, value in old.items())
    if isinstance(new, list | tuple):
        return isinstance(old, list | tuple) and len(old) == len(new) and all(map(_same, old, new))
    if isinstance(new, str | bytes | int | float):
        return type(old) is type(new) and repr(old) == repr(new)
    if hasattr(new, "__dataclass_fields__") and hasattr(new, "__dict__") and not isinstance(new, type):
        return type(old).__name__ == type(new).__name__ and _same(vars(old), vars(new))
    return new is None or type(old).__name__ == type(new).__name__
