"""Random numbers that each simulated process has for itself, seeded by the world's seed and the process's name.

`random.random()` and the other functions of the standard module draw from the process that runs; everywhere else they
are the real ones. So one program's draws never shift another's, and a run can be repeated. The same holds for
numpy's unseeded `numpy.random.default_rng()` and for its old global functions.
"""

from __future__ import annotations

import importlib
import random
import zlib
from collections.abc import Callable
from typing import Any

from greenlet import getcurrent

from ..sim.strand import Strand
from .patches import is_replaced, replace

_NUMPY_FUNCTIONS = [
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
]


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


def _draw_one(real: Callable[[], float]) -> Callable[[], float]:
    """`random.random` is by far the most used, so it is spelled out."""

    def random() -> float:
        strand = getcurrent()
        if type(strand) is Strand:
            return strand.process.random.random()
        return real()

    return random


def _numpy_state(strand: Strand) -> Any:
    """The numpy RandomState of the process that runs, made at first use."""
    state = strand.process.locals.get("numpy.random")
    if state is None:
        import numpy

        state = numpy.random.RandomState(zlib.crc32(strand.process.seed.encode()))
        strand.process.locals["numpy.random"] = state
    return state


def _default_rng(real: Callable[..., Any]) -> Callable[..., Any]:
    def default_rng(seed: Any = None) -> Any:
        strand = getcurrent()
        if seed is None and type(strand) is Strand:
            seed = strand.process.random.getrandbits(64)
        return real(seed)

    default_rng.__doc__ = real.__doc__
    return default_rng


def install() -> None:
    """Replace the functions of the standard `random` module; a second call does nothing."""
    if is_replaced(random, "random"):
        return
    for name, real in list(vars(random).items()):
        if getattr(real, "__self__", None) is random._inst:
            replace(random, name, _draw_one(real) if name == "random" else _dispatch(name, real, _random))


def install_for_numpy() -> None:
    """Do the same for `numpy.random`, which is imported for it."""
    module: Any = importlib.import_module("numpy.random")
    if is_replaced(module, "default_rng"):
        return
    for name in _NUMPY_FUNCTIONS:
        replace(module, name, _dispatch(name, getattr(module, name), _numpy_state))
    replace(module, "default_rng", _default_rng(module.default_rng))
