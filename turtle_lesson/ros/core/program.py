"""Runs a Python file, or a text that stands for one, as the main program of a simulated process."""

from __future__ import annotations

import os
import threading
from collections.abc import Iterable, Sequence
from importlib.machinery import ModuleSpec
from pathlib import Path

from .program_modules import ProgramModules
from .strand import running_strand


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
