"""Environment variables and imported modules: each simulated process has its own."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping
from typing import Any

from greenlet import getcurrent

from ..sim.strand import Strand
from .program import running_modules

# -- environment --------------------------------------------------------------------------------------------------
# Environment variables: each simulated process has its own, as it found them when it began.
# They are a copy of the notebook's, or what the launch file says that starts it.


_RealEnviron: Any = type(os.environ)


class ProcessEnviron(_RealEnviron):
    """The type of `os.environ`: which variables it holds depends on the process that reads it."""

    def __getitem__(self, key: Any) -> Any:
        own = _own()
        if own is None:
            return super().__getitem__(key)
        try:
            return self.decodevalue(own[self.encodekey(key)])
        except KeyError:
            raise KeyError(key) from None

    def __iter__(self) -> Iterator[Any]:
        own = _own()
        return super().__iter__() if own is None else map(self.decodekey, list(own))

    def __len__(self) -> int:
        own = _own()
        return super().__len__() if own is None else len(own)

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
    given = environ if variables is None else variables
    return {environ.encodekey(name): environ.encodevalue(text) for name, text in given.items()}


def _own() -> dict[Any, Any] | None:
    """The variables of the simulated process that runs, if one does."""
    strand = getcurrent()
    return strand.process.environ if type(strand) is Strand else None


# -- own modules --------------------------------------------------------------------------------------------------
# Functions of the standard library that look into `sys.modules` for a module of the program that runs.

LOOKS_INTO_SYS_MODULES = (
    ("importlib", "import_module"),
    ("importlib", "reload"),
    ("pickle", "dump"),
    ("pickle", "dumps"),
    ("typing", "get_type_hints"),
    ("dataclasses", "dataclass"),
    ("inspect", "getfile"),
)


def showing() -> Callable[..., Any]:
    """A function that has the program's modules be there, and then does what the real one does."""

    def show_and_call(real: Any, *arguments: Any, **keywords: Any) -> Any:
        modules = running_modules()
        if modules is not None:
            modules.show()
        return real(*arguments, **keywords)

    return show_and_call
