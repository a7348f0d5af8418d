"""The code of a program's modules. It is compiled once, however many processes run it.

Each process gets a copy of the code: Python notes in it what it has learned about the globals that it runs with.
"""

from __future__ import annotations

import marshal
from importlib.machinery import SourceFileLoader
from types import CodeType, ModuleType
from typing import TYPE_CHECKING

from .busy_loops import without_busy_loops

if TYPE_CHECKING:
    from .program_modules import ProgramModules

_compiled: dict[str, tuple[bytes, bytes]] = {}
"""By path: the text of a file, and its code."""


def code_of(path: str, text: str | None = None) -> CodeType:
    """The code of a file as it is now, or of a text in its place."""
    if text is not None:
        return compile(without_busy_loops(text, path), path, "exec", dont_inherit=True)
    with open(path, "rb") as file:
        source = file.read()
    known = _compiled.get(path)
    if known is None or known[0] != source:
        code = compile(without_busy_loops(source, path), path, "exec", dont_inherit=True)
        known = _compiled[path] = (source, marshal.dumps(code))
    copy: CodeType = marshal.loads(known[1])
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

    def get_code(self, fullname: str) -> CodeType:
        """The module's code."""
        return code_of(self.path)
