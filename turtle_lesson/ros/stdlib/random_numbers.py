"""Random numbers that each simulated process has for itself, seeded by the world's seed and the process's name.

`random.random()` and the other functions of the standard module draw from the process that runs; everywhere else they
are the real ones. So one program's draws never shift another's, and a run can be repeated. The same holds for
numpy's unseeded `numpy.random.default_rng()` and for its old global functions.
"""

from __future__ import annotations

import zlib
from collections.abc import Callable
from typing import Any

from greenlet import getcurrent

from ..sim.strand import Strand

NUMPY = (
    "choice",
    "normal",
    "permutation",
    "rand",
    "randint",
    "randn",
    "random",
    "random_sample",
    "seed",
    "shuffle",
    "standard_normal",
    "uniform",
)
"""The functions of `numpy.random` that draw from one state of the whole program."""


def _dispatch(name: str, real: Callable[..., Any], source: Callable[[Strand], Any]) -> Callable[..., Any]:
    """A function that draws from the `source` of the process that runs, and is the real one everywhere else."""

    def draw(*arguments: Any, **keywords: Any) -> Any:
        strand = getcurrent()
        if type(strand) is Strand:
            return getattr(source(strand), name)(*arguments, **keywords)
        return real(*arguments, **keywords)

    draw.__name__ = draw.__qualname__ = name
    draw.__doc__ = real.__doc__
    return draw


def _random(strand: Strand) -> Any:
    """The random.Random of the process that runs."""
    return strand.process.random


def drawing(name: str, real: Callable[..., Any]) -> Callable[..., Any]:
    """What stands for a function of the standard `random` module."""
    return _draw_one(real) if name == "random" else _dispatch(name, real, _random)


def _draw_one(real: Callable[[], float]) -> Callable[[], float]:
    """`random.random` is by far the most used, so it is spelled out."""

    def random() -> float:
        strand = getcurrent()
        if type(strand) is Strand:
            return strand.process.random.random()
        return real()

    return random


class _NumpyState:
    """The numpy RandomState of a process."""

    def __init__(self, seed: str) -> None:
        import numpy

        self.source = numpy.random.RandomState(zlib.crc32(seed.encode()))


def _numpy_state(strand: Strand) -> Any:
    return strand.process.state(_NumpyState, strand.process.seed).source


def numpy_drawing(name: str, real: Callable[..., Any]) -> Callable[..., Any]:
    """What stands for one of numpy's old global functions."""
    return _dispatch(name, real, _numpy_state)


def default_rng(real: Callable[..., Any]) -> Callable[..., Any]:
    """What stands for `numpy.random.default_rng`."""

    def default_rng(seed: Any = None) -> Any:
        strand = getcurrent()
        if seed is None and type(strand) is Strand:
            seed = strand.process.random.getrandbits(64)
        return real(seed)

    default_rng.__doc__ = real.__doc__
    return default_rng
