"""The Python modules that a program has for itself: its `__main__`, and those that lie in its own folders.

On a robot each process imports its modules anew, so that two processes share no global variable. Here all live in one
Python, which has one `sys.modules`. So each program keeps its own modules, and has them put into `sys.modules` while it
imports something; the libraries, which are big and know nothing of each other's users, are shared.

Whose import statement it is, is known from the `__builtins__` that the modules of a program are run with: Python looks
there for `__import__`. The notebook's own imports never come here.
"""

from __future__ import annotations

import builtins
import importlib.util
import os
import sys
import threading
from collections.abc import Callable, Iterable, Mapping, Sequence
from importlib.machinery import ModuleSpec, PathFinder
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any

from .program_code import ProgramLoader, code_of
from .strand import running_strand

if TYPE_CHECKING:
    from .process import Process

on_import: dict[str, Callable[[], ModuleType | None]] = {}
"""By the first name of a module of the standard library: called when a program imports it, and may give another."""


class ProgramModules:
    """The modules of one program. `folders` is where they are looked for, before all others."""

    def __init__(self, process: Process, folders: Iterable[str]) -> None:
        self._process = process
        self.folders = list(folders)
        self.builtins = {**vars(builtins), "__import__": self._import, "exit": _exit, "quit": _exit}
        self._modules: dict[str, ModuleType] = {}
        self._own = {"__main__": True}
        self._hidden: dict[str, ModuleType] = {}
        self._path = list(sys.path)

    def run(self, path: str, text: str | None = None) -> None:
        """Run a file as the main program, or a text that stands for one."""
        main = ModuleType("__main__")
        main.__dict__.update(__file__=path, __builtins__=self.builtins, __cached__=None)
        self._modules["__main__"] = main
        self.show()
        exec(code_of(path, text), main.__dict__)

    def made(self, function: Any) -> bool:
        """Whether a function stands in a module of this program."""
        function = getattr(function, "__func__", function)
        return getattr(function, "__globals__", {}).get("__builtins__") is self.builtins

    # -- what is in sys.modules --------------------------------------------------------------------------------------------

    @property
    def shown(self) -> bool:
        """Whether they are in `sys.modules` now."""
        return self._process.simulation.modules_shown is self

    def show(self) -> None:
        """Have `sys.modules` hold this program's modules, until another's are shown or the cell goes on."""
        simulation = self._process.simulation
        if self.shown:
            return
        if simulation.modules_shown is not None:
            simulation.modules_shown.hide()
        simulation.modules_shown = self
        self._hidden = _take_out(self._tops())
        sys.modules.update(self._modules)

    def hide(self) -> None:
        """Have it hold again what it held before."""
        self._process.simulation.modules_shown = None
        self._modules.update(_take_out(self._tops()))
        sys.modules.update(self._hidden)
        self._hidden = {}

    def _tops(self) -> set[str]:
        return {name for name, own in self._own.items() if own}

    def owns(self, name: str) -> bool:
        """Whether a module is of this program, because it is found in its folders."""
        top = name.partition(".")[0]
        own = self._own.get(top)
        if own is None:
            own = self._own[top] = self._find(top, self.folders) is not None
            if own and self.shown:
                self._hidden.update(_take_out({top}))
        return own

    # -- finding -----------------------------------------------------------------------------------------------------------

    def find_spec(self, name: str, path: Sequence[str] | None) -> ModuleSpec | None:
        """Where a module of this program is, None if it is none."""
        if path is None:
            return self._find(name, self.folders) if self.owns(name) else None
        parent = sys.modules.get(name.rpartition(".")[0])
        if parent is None or not (_is_folder(parent) or vars(parent).get("__builtins__") is self.builtins):
            return None
        return self._find(name, path)

    def _find(self, name: str, path: Sequence[str]) -> ModuleSpec | None:
        spec = PathFinder.find_spec(name, path)
        if spec is None or spec.origin is None or not spec.origin.endswith(".py"):
            return None if spec is None or _is_found_elsewhere(name, path) else spec
        loader = ProgramLoader(spec.name, spec.origin, self.builtins)
        return importlib.util.spec_from_file_location(
            spec.name, spec.origin, loader=loader, submodule_search_locations=spec.submodule_search_locations
        )

    # -- importing ---------------------------------------------------------------------------------------------------------

    def _import(
        self,
        name: str,
        globals: Mapping[str, object] | None = None,
        locals: Mapping[str, object] | None = None,
        fromlist: Sequence[str] | None = (),
        level: int = 0,
    ) -> Any:
        """What the import statements of this program call."""
        if sys.path != self._path:
            self._take_path()
        if level or self.owns(name):
            self.show()
        elif (top := name.partition(".")[0]) in on_import and (module := on_import[top]()) is not None:
            return module
        return builtins.__import__(name, globals, locals, fromlist or (), level)

    def _take_path(self) -> None:
        """What the program has added to `sys.path` is looked through for this program alone."""
        before = self._process.simulation.path_before
        added = [folder for folder in sys.path if folder not in before and folder not in self.folders]
        if added:
            first = sys.path.index(added[0]) == 0
            sys.path[:] = [folder for folder in sys.path if folder not in added]
            self.folders[:] = [*added, *self.folders] if first else [*self.folders, *added]
            self._own = {name: True for name, own in self._own.items() if own}
        self._path = list(sys.path)


def _exit(code: object = None) -> None:
    """`exit()` and `quit()`, which in a notebook would end the notebook."""
    raise SystemExit(code)


def _is_folder(module: ModuleType) -> bool:
    """Whether a module is a mere folder, without __init__.py."""
    return module.__dict__.get("__file__") is None and "__path__" in module.__dict__


def _take_out(tops: set[str]) -> dict[str, ModuleType]:
    """Take the modules with these first names out of `sys.modules`."""
    present = [top for top in tops if top in sys.modules]
    if not present:
        return {}
    prefixes = tuple(f"{top}." for top in present)
    names = [name for name in sys.modules if name in tops or name.startswith(prefixes)]
    return {name: sys.modules.pop(name) for name in names}


def _is_found_elsewhere(name: str, path: Sequence[str]) -> bool:
    """Whether somebody else has a module of this name: then a mere folder, or compiled code, does not hide it."""
    for finder in sys.meta_path:
        find = getattr(finder, "find_spec", None)
        others = finder is not ProgramFinder and finder is not PathFinder
        if others and find is not None and find(name, path) is not None:
            return True
    return "." not in name and PathFinder.find_spec(name) is not None


class ProgramFinder:
    """What Python asks first for a module that it does not have yet."""

    @staticmethod
    def find_spec(name: str, path: Sequence[str] | None = None, target: object = None) -> ModuleSpec | None:
        """Where a module of the running program is; None where no program is importing."""
        modules = running_modules()
        if modules is None or not modules.shown:
            return None
        return modules.find_spec(name, path)


def running_modules() -> ProgramModules | None:
    """The modules of the program that runs, if it was read from a file."""
    strand = running_strand()
    return None if strand is None else strand.process.modules


def run_program(path: Path, folders: Iterable[Path] = (), text: str | None = None) -> None:
    """Run a file, or a text that stands for it, as the main program of the running process.

    `folders` are those of its modules, beside the one that the file itself lies in.
    """
    strand = running_strand()
    assert strand is not None
    own = os.path.dirname(os.path.realpath(path))
    modules = strand.process.modules = ProgramModules(strand.process, [own, *map(str, folders)])
    hooks: list[tuple[Any, Any]] = [(sys, sys.excepthook), (threading, threading.excepthook)]

    def put_hooks_back() -> None:
        for module, hook in hooks:
            if modules.made(module.excepthook):
                module.excepthook = hook

    strand.process.at_exit.append(put_hooks_back)
    modules.run(str(path), text)
