"""What this package puts in the place of other modules' functions and classes, and the originals, to be put back.

Every replacement in another module goes through `replace` or one of its relatives, so that `replaced` knows all of them.
"""

from __future__ import annotations

import atexit
import sys
from collections.abc import Callable
from types import MethodType
from typing import Any

replaced: list[tuple[Any, str, Any]] = []
"""Owner, name and original of each attribute that was replaced, the oldest first."""

finders: list[Any] = []
"""What was added to `sys.meta_path`."""


def replace(owner: Any, name: str, new: Any) -> None:
    """Put something in the place of an attribute of a module or class."""
    if not replaced:
        atexit.register(restore)  # nothing may ask which greenlet runs while Python takes itself apart
    replaced.append((owner, name, vars(owner)[name] if name in vars(owner) else getattr(owner, name)))
    setattr(owner, name, new)


def replace_function(owner: Any, name: str, function: Callable[..., Any]) -> None:
    """Put a function in the place of a module's, if it has one of this name; the real one is its first argument.

    As a method of the real one it is as good an attribute of a class as that: it is not bound once more.
    """
    real = getattr(owner, name, None)
    if real is not None:
        replace(owner, name, MethodType(named(function, name, real), real))


def replace_method(owner: type, name: str, method: Callable[..., Any]) -> None:
    """Put a method in the place of a class's."""
    replace(owner, name, named(method, name, getattr(owner, name)))


def named(function: Any, name: str, real: Any) -> Any:
    """Give a function the name and docstring of the one that it stands for."""
    function.__name__, function.__qualname__ = name, getattr(real, "__qualname__", name)
    function.__module__, function.__doc__ = getattr(real, "__module__", None), real.__doc__
    return function


def add_finder(finder: Any) -> None:
    """Have import statements ask a finder before all others."""
    finders.append(finder)
    sys.meta_path.insert(0, finder)


def is_replaced(owner: Any, name: str) -> bool:
    """Whether an attribute was replaced."""
    return any(each is owner and called == name for each, called, _ in replaced)


def original(owner: Any, name: str) -> Any:
    """The real attribute of a module or class, whether it was replaced or not."""
    found = (real for each, called, real in replaced if each is owner and called == name)
    return next(found, None) or getattr(owner, name)


def restore() -> None:
    """Put all originals back; who still holds one of ours gets from it what the real one gives."""
    ours = __name__.partition(".")[0]
    for name, module in list(sys.modules.items()):
        if name.startswith(ours) and name != "turtle_lesson.ros.sim.strand" and hasattr(module, "getcurrent"):
            module.getcurrent = _nothing  # type: ignore[attr-defined]
    for owner, name, real in reversed(replaced):
        setattr(owner, name, real)
    replaced.clear()
    sys.meta_path[:] = [finder for finder in sys.meta_path if finder not in finders]
    finders.clear()


def _nothing() -> None:
    """No strand runs any more."""
