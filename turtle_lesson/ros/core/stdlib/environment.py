"""Environment variables: each simulated process has its own, as it found them when it began.

They are a copy of the notebook's, or what the launch file says that starts it.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

from ..strand import Strand, getcurrent


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
