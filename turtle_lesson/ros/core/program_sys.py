"""The module `sys` as one program sees it: with its own import path, its own modules, its own streams and hook.

All else is the real one's.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from types import ModuleType
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .process import Process
    from .program_input import ProgramInput

_OF_THE_PROCESS = ("argv", "stderr", "stdout")
_OF_THE_PROGRAM = ("excepthook", "path", "stdin")


class ProgramSys(ModuleType):
    """What `import sys` gives a program. `show` puts its modules into `sys.modules`."""

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

    def __delattr__(self, name: str) -> None:
        delattr(sys, name)

    def __dir__(self) -> list[str]:
        return dir(sys)
