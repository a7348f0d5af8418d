"""Runs a Python file as the main program of a simulated process, with modules and a `sys` of its own.

On a robot each process imports its modules anew, so that two processes share no global variable. Here all live in one
Python, which has one `sys.modules`. So each program keeps its own modules: its `__main__`, and those that lie in its own
folders. It has them put into `sys.modules` when it imports something or asks for `sys.modules`, until another process goes
on. The libraries, which are big and know nothing of each other's users, are shared.

Whose import statement it is, is known from the `__builtins__` that the modules of a program are run with: Python looks
there for `__import__`. The notebook's own imports never come here.
"""

from __future__ import annotations

import builtins
import marshal
import os
import sys
import threading
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cache, lru_cache
from importlib.machinery import ModuleSpec, PathFinder, SourceFileLoader
from pathlib import Path
from types import CodeType, ModuleType
from typing import TYPE_CHECKING, Any

from ..sim.strand import running_strand
from .deadlock import NAME, another_look, without_busy_loops
from .terminals import ProgramInput

if TYPE_CHECKING:
    from ..sim.process import Process


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
    hook = threading.excepthook

    def put_hook_back() -> None:
        if modules.made(threading.excepthook):
            threading.excepthook = hook

    strand.process.at_exit.append(put_hook_back)
    modules.run(str(path), text)


@lru_cache(maxsize=256)
def _compiled(path: str, source: bytes | str) -> bytes:
    """The code of a text, which is compiled once, however many processes run it."""
    return marshal.dumps(compile(without_busy_loops(source, path), path, "exec", dont_inherit=True))


def code_of(path: str, text: str | None = None) -> CodeType:
    """The code of a file as it is now, or of a text in its place.

    Each process gets a copy of it: Python notes in it what it has learned about the globals that it runs with.
    """
    copy: CodeType = marshal.loads(_compiled(path, Path(path).read_bytes() if text is None else text))
    return copy


class ProgramLoader(SourceFileLoader):
    """Makes a module of a program from its file."""

    def __init__(self, fullname: str, path: str, modules: ProgramModules) -> None:
        super().__init__(fullname, path)
        self._modules = modules

    def exec_module(self, module: ModuleType) -> None:
        """Run the module's code with the program's own builtins."""
        module.__dict__["__builtins__"] = self._modules.builtins
        try:
            exec(code_of(self.path), module.__dict__)
        finally:
            self._modules.show()  # the code may have let others go on


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
        self._tops = {"__main__"}  # the first names of its own that it has imported
        self._finds = cache(lambda name, *folders: self._find(name, folders) is not None)
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

    @property
    def shown(self) -> bool:
        """Whether they are in `sys.modules` now."""
        return self._process.simulation.modules_shown is self

    def show(self) -> None:
        """Have `sys.modules` hold this program's modules, until another's are shown or the cell goes on."""
        if not self.shown:
            self._process.simulation.modules_shown = self  # another's were hidden when this process went on
            self._hidden = _take_out(self._tops)
            sys.modules.update(self._modules)

    def hide(self) -> None:
        """Have it hold again what it held before."""
        self._process.simulation.modules_shown = None
        self._modules.update(_take_out(self._tops))
        sys.modules.update(self._hidden)
        self._hidden = {}

    def owns(self, name: str) -> bool:
        """Whether a module is of this program, because it is found in its folders."""
        top = name.partition(".")[0]
        if top not in self._tops and self._finds(top, *self._own_folders()):
            self._tops.add(top)
            if self.shown:
                self._hidden.update(_take_out({top}))
        return top in self._tops

    def _own_folders(self) -> list[str]:
        """What the program's import path has beside the libraries."""
        return [folder for folder in self.sys.path if folder in self._folders or folder not in sys.path]

    def find_spec(self, name: str, path: Sequence[str] | None) -> ModuleSpec | None:
        """Where a module of this program is, None if it is none."""
        if path is None:
            return self._find(name, self._own_folders()) if self.owns(name) else None
        parent = vars(sys.modules.get(name.rpartition(".")[0], ModuleType("none")))
        is_folder = parent.get("__file__") is None and "__path__" in parent  # without __init__.py
        return self._find(name, path) if is_folder or parent.get("__builtins__") is self.builtins else None

    def _find(self, name: str, path: Sequence[str]) -> ModuleSpec | None:
        spec = PathFinder.find_spec(name, path)
        if spec is None or spec.origin is None or not spec.origin.endswith(".py"):
            return None if spec is None or _is_found_elsewhere(name, path) else spec
        spec.loader = ProgramLoader(spec.name, spec.origin, self)
        return spec

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


def _take_out(tops: set[str]) -> dict[str, ModuleType]:
    """Take the modules with these first names out of `sys.modules`."""
    present = [top for top in tops if top in sys.modules]
    if not present:
        return {}
    prefixes = tuple(f"{top}." for top in present)
    names = [name for name in sys.modules if name in tops or name.startswith(prefixes)]
    return {name: sys.modules.pop(name) for name in names}


def _is_found_elsewhere(name: str, path: Sequence[str]) -> bool:
    """Whether a library has this name: then a mere folder, or compiled code, does not hide it."""
    others = (each.find_spec(name, path) for each in sys.meta_path if each not in (ProgramFinder, PathFinder))
    return any(others) or ("." not in name and PathFinder.find_spec(name) is not None)


_OF_THE_PROCESS = ("argv", "stderr", "stdout")
_OF_THE_PROGRAM = ("excepthook", "path", "stdin")


class ProgramSys(ModuleType):
    """What `import sys` gives a program: its own import path, modules, streams and hook; all else is the real one's.

    `show` puts its modules into `sys.modules`.
    """

    def __init__(self, process: Process, path: list[str], stdin: ProgramInput, show: Callable[[], None]) -> None:
        super().__init__("sys", sys.__doc__)
        self.__dict__.update(path=path, stdin=stdin, __stdin__=stdin, _process=process, _show=show)

    def __getattr__(self, name: str) -> Any:
        if name == "modules":
            self.__dict__["_show"]()
        return getattr(sys, name)

    def __setattr__(self, name: str, value: Any) -> None:
        if name in _OF_THE_PROGRAM:
            self.__dict__[name] = value
            return
        if name in _OF_THE_PROCESS:
            setattr(self.__dict__["_process"], name, value)
        setattr(sys, name, value)
