"""The Python modules that a program has for itself: its `__main__`, and those that lie in its own folders.

On a robot each process imports its modules anew, so that two processes share no global variable. Here all live in one
Python, which has one `sys.modules`. So each program keeps its own modules. It has them put into `sys.modules` when it
imports something or asks for `sys.modules`, until another process goes on. The libraries, which are big and know nothing
of each other's users, are shared.

Whose import statement it is, is known from the `__builtins__` that the modules of a program are run with: Python looks
there for `__import__`. The notebook's own imports never come here.
"""

from __future__ import annotations

import builtins
import importlib.util
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from importlib.machinery import ModuleSpec, PathFinder
from types import ModuleType
from typing import TYPE_CHECKING, Any

from .busy_loops import NAME, another_look
from .program_code import ProgramLoader, code_of
from .program_input import ProgramInput
from .program_sys import ProgramSys

if TYPE_CHECKING:
    from .process import Process

on_import: dict[str, Callable[[], ModuleType | None]] = {}
"""By the first name of a module of the standard library: called when a program imports it, and may give another."""


class ProgramModules:
    """The modules of one program. `folders` is where they are looked for, before all others; `stdin` is its input."""

    def __init__(self, process: Process, folders: Iterable[str]) -> None:
        self._process = process
        self._folders = list(folders)
        self.stdin = ProgramInput(process)
        self.sys = ProgramSys(process, [*self._folders, *sys.path], self.stdin, self.show)
        own = {"__import__": self._import, "input": self.stdin.ask, "exit": _exit, "quit": _exit, NAME: another_look}
        self.builtins = {**vars(builtins), **own}
        self._modules: dict[str, ModuleType] = {}
        self._own = {"__main__": True}
        self._looked_in: list[str] = []
        self._hidden: dict[str, ModuleType] = {}

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
        folders = self._own_folders()
        if folders != self._looked_in:  # what was not found in the others may be in a new one
            self._looked_in = folders
            self._own = {top: True for top, own in self._own.items() if own}
        top = name.partition(".")[0]
        own = self._own.get(top)
        if own is None:
            own = self._own[top] = self._find(top, folders) is not None
            if own and self.shown:
                self._hidden.update(_take_out({top}))
        return own

    def _own_folders(self) -> list[str]:
        """What the program's import path has beside the libraries."""
        return [folder for folder in self.sys.path if folder in self._folders or folder not in sys.path]

    # -- finding -----------------------------------------------------------------------------------------------------------

    def find_spec(self, name: str, path: Sequence[str] | None) -> ModuleSpec | None:
        """Where a module of this program is, None if it is none."""
        if path is None:
            return self._find(name, self._own_folders()) if self.owns(name) else None
        parent = sys.modules.get(name.rpartition(".")[0])
        if parent is None or not (_is_folder(parent) or vars(parent).get("__builtins__") is self.builtins):
            return None
        return self._find(name, path)

    def _find(self, name: str, path: Sequence[str]) -> ModuleSpec | None:
        spec = PathFinder.find_spec(name, path)
        if spec is None or spec.origin is None or not spec.origin.endswith(".py"):
            return None if spec is None or _is_found_elsewhere(name, path) else spec
        loader = ProgramLoader(spec.name, spec.origin, self)
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
        if name == "sys" and not level:
            return self.sys
        if level or self.owns(name):
            self.show()
        elif (top := name.partition(".")[0]) in on_import and (module := on_import[top]()) is not None:
            for part in name.split(".")[1:] if fromlist else ():
                module = getattr(module, part)
            return module
        return builtins.__import__(name, globals, locals, fromlist or (), level)


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
        others = getattr(finder, "__name__", "") != "ProgramFinder" and finder is not PathFinder
        if others and find is not None and find(name, path) is not None:
            return True
    return "." not in name and PathFinder.find_spec(name) is not None
