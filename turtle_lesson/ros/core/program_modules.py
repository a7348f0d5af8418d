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
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from importlib.machinery import ModuleSpec, PathFinder
from types import ModuleType
from typing import TYPE_CHECKING, Any

from .program_code import ProgramLoader, code_of

if TYPE_CHECKING:
    from .process import Process

_real_import = builtins.__import__

on_import: dict[str, Callable[[], ModuleType | None]] = {}
"""What a program gets for the import of a module of the standard library, if it is not to be that one."""


class ProgramModules:
    """The modules of one program. `folders` is where they are looked for, before all others."""

    def __init__(self, process: Process, folders: Iterable[str]) -> None:
        self._process = process
        self.folders = list(folders)
        self.builtins = {**vars(builtins), "__import__": self._import}
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

    # -- what is in sys.modules --------------------------------------------------------------------------------------------

    def show(self) -> None:
        """Have `sys.modules` hold this program's modules, until another's are shown or the cell goes on."""
        simulation = self._process.simulation
        shown = simulation.modules_shown
        if shown is self:
            return
        if shown is not None:
            shown.hide()
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
            own = self._own[top] = self._find(top) is not None
            if own and self._process.simulation.modules_shown is self:
                self._hidden.update(_take_out({top}))
        return own

    # -- finding -----------------------------------------------------------------------------------------------------------

    def find_spec(self, name: str, path: Sequence[str] | None) -> ModuleSpec | None:
        """Where a module of this program is, None if it is none."""
        if path is None:
            return self._find(name) if self.owns(name) else None
        parent = sys.modules.get(name.rpartition(".")[0])
        if parent is None or parent.__dict__.get("__builtins__") is not self.builtins and not _is_folder(parent):
            return None
        return self._ours(PathFinder.find_spec(name, path))

    def _find(self, name: str) -> ModuleSpec | None:
        spec = PathFinder.find_spec(name, self.folders)
        if spec is not None and spec.origin is None and _is_found_elsewhere(name):
            return None  # a mere folder hides no package
        return self._ours(spec)

    def _ours(self, spec: ModuleSpec | None) -> ModuleSpec | None:
        if spec is None or spec.origin is None or not spec.origin.endswith(".py"):
            return spec
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
        if level == 0 and name in on_import and (module := on_import[name]()) is not None:
            return module
        if level or self.owns(name):
            self.show()
        return _real_import(name, globals, locals, fromlist or (), level)

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


def _is_found_elsewhere(name: str) -> bool:
    for finder in sys.meta_path:
        find = getattr(finder, "find_spec", None)
        if finder is not ProgramFinder and find is not None and find(name, None) is not None:
            return True
    return False


class ProgramFinder:
    """What Python asks first for a module that it does not have yet."""

    @staticmethod
    def find_spec(name: str, path: Sequence[str] | None = None, target: object = None) -> ModuleSpec | None:
        """Where a module of the running program is; None where no program is importing."""
        from .strand import running_strand

        strand = running_strand()
        modules = None if strand is None else strand.process.modules
        if modules is None or strand is None or strand.simulation.modules_shown is not modules:
            return None
        return modules.find_spec(name, path)
