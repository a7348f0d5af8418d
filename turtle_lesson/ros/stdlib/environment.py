"""What each simulated process has for itself: environment variables, imported modules and random numbers."""

from __future__ import annotations

import os
import zlib
from collections.abc import Callable, Iterator, Mapping
from typing import Any

from greenlet import getcurrent

from ..sim.strand import Strand
from .program import running_modules

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


def encoded(variables: Mapping[str, str] | None, name: str, default: str) -> dict[Any, Any]:
    """These variables as a process keeps them, and one that has a default; without any, a copy of the caller's."""
    environ: Any = os.environ
    if variables is None:
        own = _own()
        kept = dict(environ._data if own is None else own)  # as they are: to decode and encode each takes 70 calls
    else:
        kept = {environ.encodekey(each): environ.encodevalue(text) for each, text in variables.items()}
    kept.setdefault(environ.encodekey(name), environ.encodevalue(default))
    return kept


def _own() -> dict[Any, Any] | None:
    """The variables of the simulated process that runs, if one does."""
    strand = getcurrent()
    return strand.process.environ if type(strand) is Strand else None


# -- modules -----------------------------------------------------------------------------------------------------------

LOOKS_INTO_SYS_MODULES = (
    ("importlib", "import_module"),
    ("importlib", "reload"),
    ("pickle", "dump"),
    ("pickle", "dumps"),
    ("typing", "get_type_hints"),
    ("dataclasses", "dataclass"),
    ("inspect", "getfile"),
)
"""Functions of the standard library that look into `sys.modules` for a module of the program that runs."""


def showing() -> Callable[..., Any]:
    """A function that has the program's modules be there, and then does what the real one does."""

    def show_and_call(real: Any, *arguments: Any, **keywords: Any) -> Any:
        modules = running_modules()
        if modules is not None:
            modules.show()
        return real(*arguments, **keywords)

    return show_and_call


# -- random numbers ----------------------------------------------------------------------------------------------------
# They are drawn from a source of the process, seeded by the world's seed and the process's name. So one program's draws
# never shift another's, and a run can be repeated.

NUMPY = (
    *("choice", "normal", "permutation", "rand", "randint", "randn", "random", "random_sample", "seed", "shuffle"),
    *("standard_normal", "uniform"),
)
"""The functions of `numpy.random` that draw from one state of the whole program."""


def drawing(name: str) -> Callable[..., Any]:
    """A function of the standard `random` module that draws from the source of the process."""

    def draw(strand: Strand, *arguments: Any, **keywords: Any) -> Any:
        return getattr(strand.process.random, name)(*arguments, **keywords)

    return draw


def random(real: Callable[[], float]) -> float:
    """`random.random`, which is by far the most used, and so is spelled out."""
    strand = getcurrent()
    return strand.process.random.random() if type(strand) is Strand else real()


class _NumpyState:
    """The numpy RandomState of a process."""

    def __init__(self, seed: str) -> None:
        import numpy

        self.source = numpy.random.RandomState(zlib.crc32(seed.encode()))


def numpy_drawing(name: str) -> Callable[..., Any]:
    """One of numpy's old global functions that draws from a state of the process."""

    def draw(strand: Strand, *arguments: Any, **keywords: Any) -> Any:
        source = strand.process.state(_NumpyState, strand.process.seed).source
        return getattr(source, name)(*arguments, **keywords)

    return draw


def default_rng(real: Callable[..., Any], seed: Any = None) -> Any:
    """`numpy.random.default_rng`: without a seed, it is seeded by the process's own random numbers."""
    strand = getcurrent()
    if seed is None and type(strand) is Strand:
        seed = strand.process.random.getrandbits(64)
    return real(seed)
