"""A class of the standard library of which there are two now: Python's own, and one that waits in virtual time.

A caller of the class gets an object of one or the other, depending on whose it is to be. A subclass derives from
that one. Objects of both are its instances, so that callers need not know the difference.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from .home import process_here


class _Facade(type):
    """The type of such classes."""

    _real: Any
    _virtual: Callable[..., Any]
    _base: type | None

    def __call__(cls, *arguments: Any, **keywords: Any) -> Any:
        make = cls._real if process_here() is None else cls._virtual
        return make(*arguments, **keywords)

    def __instancecheck__(cls, instance: Any) -> bool:
        return isinstance(instance, cls._kinds)

    def __subclasscheck__(cls, subclass: Any) -> bool:
        return subclass is cls or issubclass(subclass, cls._kinds)

    def __new__(mcls, name: str, bases: tuple[type, ...], namespace: dict[str, Any], **keywords: Any) -> Any:
        """Make a facade, or a class that is derived from one: then the facade gives way to what is behind it."""
        if not any(isinstance(base, _Facade) for base in bases):
            return super().__new__(mcls, name, bases, namespace)
        virtual = process_here() is not None
        real_bases = tuple(base._behind(virtual) if isinstance(base, _Facade) else base for base in bases)
        return type(real_bases[0])(name, real_bases, namespace, **keywords)

    def _behind(cls, virtual: bool) -> Any:
        return cls._virtual if virtual and isinstance(cls._virtual, type) else cls._real

    def __init__(cls, name: str, bases: tuple[type, ...], namespace: dict[str, Any], **keywords: Any) -> None:
        super().__init__(name, bases, namespace)

    def __repr__(cls) -> str:
        return repr(cls._real)

    def __getattr__(cls, name: str) -> Any:
        return getattr(cls._real, name)


def facade(real: Any, virtual: Callable[..., Any], kinds: tuple[type, ...]) -> Any:
    """The class that stands before `real` and `virtual`; `kinds` are the types of the objects that they make."""
    namespace = {
        "__module__": getattr(real, "__module__", None),
        "__qualname__": real.__qualname__,
        "__doc__": real.__doc__,
        "_real": staticmethod(real),
        "_virtual": staticmethod(virtual),
        "_kinds": kinds,
    }
    return _Facade(real.__name__, (), namespace)
