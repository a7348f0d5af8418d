"""Which packages the running code sees: those of its world, or of the one that is being launched."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from .index import PackageIndex

_given: list[PackageIndex] = []


def current_packages() -> PackageIndex:
    """The index of packages in force."""
    if _given:
        return _given[-1]
    from ..world import current_world

    return current_world().packages


@contextmanager
def seeing(packages: PackageIndex) -> Iterator[None]:
    """Have `current_packages()` be this index for a while."""
    _given.append(packages)
    try:
        yield
    finally:
        _given.pop()
