"""Makes `from geometry_msgs.msg import Twist` work for every package of the registry.

Real Python packages always come first, wherever on `sys.path` they are: where a ROS 2 is sourced, its own
`geometry_msgs` is imported. A mere folder of that name without `__init__.py` does not count, as it would not
beside an installed package: a workspace's source folder `robot_controller/` must not hide the messages built
from it.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from functools import partial
from importlib import import_module
from importlib.machinery import ModuleSpec, PathFinder
from types import ModuleType
from typing import TYPE_CHECKING, Any

from . import names
from .registry import FOLDERS, Package, Registry, advice
from .registry import registry as the_registry

if TYPE_CHECKING:
    from importlib.abc import Loader
else:
    Loader = object  # importing importlib.abc would take longer than all the rest


def install(registry: Registry = the_registry) -> None:
    """Let import statements find the interface packages; a second call changes nothing."""
    if any(isinstance(each, InterfaceFinder) and each.registry is registry for each in sys.meta_path):
        return
    place = sys.meta_path.index(PathFinder) if PathFinder in sys.meta_path else len(sys.meta_path)
    sys.meta_path.insert(place, InterfaceFinder(registry))


def uninstall(registry: Registry = the_registry) -> None:
    """Undo `install`; what was imported stays imported."""
    sys.meta_path[:] = [
        each for each in sys.meta_path if not (isinstance(each, InterfaceFinder) and each.registry is registry)
    ]


class InterfaceFinder:
    """Finds packages, their `msg`, `srv` and `action` packages, and the modules of single interfaces."""

    def __init__(self, registry: Registry) -> None:
        self.registry = registry

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """Specification of one of our modules, or None to leave the name to others."""
        parts = fullname.split(".")
        if len(parts) > 3 or (len(parts) > 1 and parts[1] not in FOLDERS):
            return None
        try:
            owner = self.registry.package(parts[0])
        except LookupError:
            return None
        if _is_found_elsewhere(fullname, path, target):
            return None
        return self._spec(fullname, owner, parts[1:])

    def _spec(self, fullname: str, owner: Package, inner: list[str]) -> ModuleSpec | None:
        if not inner:
            return ModuleSpec(fullname, _Loader(_mark), origin="interfaces only", is_package=True)
        folder, known = inner[0], owner.names_in(inner[0])
        if not known:
            return None
        if len(inner) == 1:
            loader = _Loader(partial(_fill_folder, owner=owner, folder=folder))
            return ModuleSpec(fullname, loader, origin=f"made from {owner.name}/{folder}", is_package=True)
        for name in known:
            if names.module_name(name) == inner[1]:
                made = partial(self.registry.module, fullname.partition(".")[0], f"{folder}/{name}")
                return ModuleSpec(fullname, _Loader(made=made))
        if inner[1][:1].isupper():  # `from std_msgs.msg import Strng` ends here once the attribute is missing
            text = f"cannot import name '{inner[1]}' from '{owner.name}.{folder}'. {_hint(owner, folder, inner[1])}"
            raise ImportError(text.rstrip(". "), name=f"{owner.name}.{folder}")
        return None


def _is_found_elsewhere(fullname: str, path: Sequence[str] | None, target: ModuleType | None) -> bool:
    """Whether another finder has a real module of this name, and not just a folder."""
    for other in sys.meta_path:
        find = getattr(other, "find_spec", None)
        if isinstance(other, InterfaceFinder) or find is None:
            continue
        spec = find(fullname, path, target)
        if spec is not None and spec.loader is not None and spec.origin is not None:
            return True
    return False


class _Loader(Loader):
    """Fills in a module that Python makes, or has one that is complete already."""

    def __init__(
        self, fill: Callable[[ModuleType], None] | None = None, made: Callable[[], ModuleType] | None = None
    ) -> None:
        self._fill = fill
        self._made = made

    def create_module(self, spec: ModuleSpec) -> ModuleType | None:
        """The complete module, or None to leave it to Python."""
        return self._made() if self._made else None

    def exec_module(self, module: ModuleType) -> None:
        """Fill the module in."""
        if self._fill:
            self._fill(module)


def _mark(module: ModuleType) -> None:
    """The outer package, e.g. `geometry_msgs`: nothing but a place for its inner ones."""
    module.__interfaces__ = True  # type: ignore[attr-defined]


def _fill_folder(module: ModuleType, owner: Package, folder: str) -> None:
    """An inner package, e.g. `geometry_msgs.msg`, whose classes are made when first asked for."""
    known = owner.names_in(folder)

    def get(name: str) -> Any:
        if name not in known:
            text = f"module '{module.__name__}' has no attribute '{name}'. {_hint(owner, folder, name)}"
            raise AttributeError(text.rstrip(". "), name=name)
        found = getattr(import_module(f"{module.__name__}.{names.module_name(name)}"), name)
        setattr(module, name, found)
        return found

    module.__dict__.update(__getattr__=get, __dir__=lambda: sorted({*module.__dict__, *known}), __all__=known)


def _hint(owner: Package, folder: str, name: str) -> str:
    whole = names.without_part(name)
    if whole != name and whole in owner.names_in(folder):
        return f"Import {whole} and write {whole}.{name.rpartition('_')[2]}"
    return advice(owner, f"{folder}/{name}")
