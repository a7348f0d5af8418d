"""Functions of the standard library that look into `sys.modules` for a module of the program that runs."""

from __future__ import annotations

import dataclasses
import importlib
import inspect
import pickle
import typing
from collections.abc import Callable
from typing import Any

from ..program import running_modules

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
