"""Environment variables and imported modules: each simulated process has its own."""

from __future__ import annotations

import dataclasses
import importlib
import inspect
import os
import pickle
import typing
from collections.abc import Callable, Mapping
from typing import Any

from greenlet import getcurrent

from ..sim.strand import Strand
from .program import running_modules

# -- environment --------------------------------------------------------------------------------------------------
# Environment variables: each simulated process has its own, as it found them when it began.
# They are a copy of the notebook's, or what the launch file says that starts it.


class ProcessEnviron(os._Environ):
    """The type of `os.environ`: which variables it holds depends on the process that reads it."""

    _data: Any = property(lambda self: vars(self)["_data"] if (own := _own()) is None else own)

    def __setitem__(self, key: Any, value: Any) -> None:
        own = _own()
        if own is None:
            super().__setitem__(key, value)
        else:
            own[self.encodekey(key)] = self.encodevalue(value)

    def __delitem__(self, key: Any) -> None:
        own = _own()
        if own is None:
            super().__delitem__(key)
        elif own.pop(self.encodekey(key), None) is None:
            raise KeyError(key)


def encoded(variables: Mapping[str, str] | None) -> dict[Any, Any]:
    """These variables as a process keeps them; without any, a copy of the caller's."""
    environ: Any = os.environ
    if variables is None:
        return dict(environ._data)
    return {environ.encodekey(name): environ.encodevalue(text) for name, text in variables.items()}


def _own() -> dict[Any, Any] | None:
    """The variables of the simulated process that runs, if one does."""
    strand = getcurrent()
    return strand.process.environ if type(strand) is Strand else None


# -- own modules --------------------------------------------------------------------------------------------------
# Functions of the standard library that look into `sys.modules` for a module of the program that runs.

LOOKS_INTO_SYS_MODULES: tuple[tuple[Any, str], ...] = (
    (importlib, "import_module"),
    (importlib, "reload"),
    (pickle, "dump"),
    (pickle, "dumps"),
    (typing, "get_type_hints"),
    (dataclasses, "dataclass"),
    (inspect, "getfile"),
)


def showing() -> Callable[..., Any]:
    """A function that has the program's modules be there, and then does what the real one does."""

    def show_and_call(real: Any, *arguments: Any, **keywords: Any) -> Any:
        modules = running_modules()
        if modules is not None:
            modules.show()
        return real(*arguments, **keywords)

    return show_and_call
