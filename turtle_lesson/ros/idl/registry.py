"""Which interface packages there are, the classes made from their definition files, and how they are imported.

The built-in packages lie in `share/`, laid out as ROS installs them: `share/<package>/msg/<Name>.msg`. A
workspace adds its own with `registry.add`. Files are read, and classes made, when first asked for.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from functools import cached_property, partial
from importlib import import_module
from importlib.machinery import ModuleSpec, PathFinder
from pathlib import Path
from threading import RLock
from types import ModuleType, SimpleNamespace
from typing import Any

from . import names
from .definition import PARTS, parse, with_comments
from .generator import make_module
from .model import Definition, FieldType, InvalidDefinition

SHARE = Path(__file__).with_name("share")
FOLDERS = tuple(PARTS)
ALIASES = {"turtlesim_msgs": "turtlesim"}
"""Built-in packages that newer releases know by another name (turtlesim's interfaces since Kilted): the same classes."""

INSTALLED_SEPARATELY = frozenset((
    "ackermann_msgs", "control_msgs", "gazebo_msgs", "moveit_msgs", "nav2_msgs", "object_recognition_msgs",
    "octomap_msgs", "px4_msgs", "turtlebot3_msgs",
))  # fmt: skip
"""Built-in packages that an ordinary installation (ros-humble-desktop) lacks. They have what courses use, as in Humble and
in PX4 1.14; their other interfaces come with the package's own sources, which hide the built-in package."""

LONGEST = 100_000
"""How many characters a definition may have: five times as many as the longest of those in use."""

DEEPEST = 50
"""How many messages may lie within each other; Python's own stack would end at some 100."""


@dataclass(eq=False)
class Package:
    """One interface package: a folder with `msg/`, `srv/` and `action/`.

    Attributes:
        files: the files that count, relative to the folder, as CMakeLists.txt names them; None for all.
        modules: those that were generated, by names such as `msg/Twist`.
    """

    name: str
    directory: Path
    files: tuple[str, ...] | None = None
    modules: dict[str, ModuleType] = field(default_factory=dict)

    def interface_names(self) -> list[str]:
        """Names such as `msg/Twist`: messages, then services, then actions, each in alphabetical order."""
        return [f"{folder}/{name}" for folder in FOLDERS for name in self.names_in(folder)]

    def names_in(self, folder: str) -> list[str]:
        """Names of the interfaces of one folder."""
        if self.files is not None:
            found = [path.name for path in map(Path, self.files) if path.parent.name == folder]
        else:
            place = self.directory / folder
            found = os.listdir(place) if place.is_dir() else []
        return sorted(stem for stem, suffix in map(os.path.splitext, found) if suffix == f".{folder}")

    def has(self, interface: str) -> bool:
        """Whether there is an interface `msg/Twist`."""
        path = self.path(interface)
        return path.is_file() if self.files is None else f"{interface}{path.suffix}" in self.files

    def path(self, interface: str) -> Path:
        """The definition file of `msg/Twist`."""
        return self.directory / f"{interface}.{interface.partition('/')[0]}"

    def text(self, interface: str) -> str:
        """What the definition file of `msg/Twist` says. Raises InvalidDefinition if it cannot be read, or is too long."""
        path, hint = self.path(interface), ""
        try:
            with path.open(encoding="utf-8") as file:
                text = file.read(LONGEST + 1)
            if len(text) <= LONGEST:
                return text
            reason = f"the definition has more than {LONGEST:,} characters"
            hint = "Move some of its fields into messages of their own"
        except (OSError, UnicodeDecodeError) as error:
            reason = f"the file cannot be read ({error})"
        raise InvalidDefinition(reason, hint=hint).locate(interface=f"{self.name}/{interface}", file=str(path))

    def definition(self, interface: str) -> Definition:
        """The definition of `msg/Twist`, parsed."""
        folder, _, name = interface.partition("/")
        return parse(folder, self.name, name, self.text(interface), str(self.path(interface)))

    def advice(self, interface: str) -> str:
        """What to try where the package lacks an interface."""
        path = self.path(interface)
        if self.files is not None and path.is_file():
            return f"{interface}{path.suffix} is there, but CMakeLists.txt does not name it"
        folder, _, name = interface.partition("/")
        return names.did_you_mean(name, self.names_in(folder))


class Registry:
    """All interface packages by name; the later one of a name hides the built-in one until it is removed."""

    def __init__(self) -> None:
        self._added: dict[str, Package] = {}
        self._classes: dict[str, Any] = {}
        self._in_progress: list[str] = []
        self._uses: dict[str, set[str]] = {}  # packages that each interface's class is made of
        self._lock = RLock()

    def add(self, package: str, directory: str | Path, files: Iterable[str] | None = None) -> None:
        """Make a package known, in place of an earlier one of its name; InvalidResourceName where ROS would refuse that.

        `files` limits it to relative paths such as `msg/TurtleStatus.msg`; None stands for all files in the folder.
        """
        names.check("package", package)
        with self._lock:
            self._forget(package)
            chosen = None if files is None else tuple(Path(each).as_posix() for each in files)
            self._added[package] = Package(package, Path(directory), chosen)

    def remove(self, package: str) -> None:
        """Forget a package that was added, its classes, and its modules in `sys.modules`."""
        with self._lock:
            self._forget(package)
            del self._added[package]

    def packages(self) -> list[str]:
        """Names of all packages, in alphabetical order."""
        return sorted({*self._built_in, *self._added})

    def knows(self, package: str) -> bool:
        """Whether there is a package of this name, or of one that newer releases use."""
        return package in self._added or ALIASES.get(package, package) in self._built_in

    def added(self) -> list[Package]:
        """The packages that were added, and are not the built-in ones."""
        return list(self._added.values())

    def text(self, package: str, interface: str, *, comments: bool = False) -> str:
        """The text of a definition file, e.g. of `geometry_msgs` and `msg/Twist`.

        That of a built-in package can have `comments` that say what its fields mean.
        """
        owner = self._find(package, interface)
        text = owner.text(interface)
        return with_comments(owner.directory, interface, text) if comments and package not in self._added else text

    def definition(self, name: str) -> Definition:
        """The parsed definition of `geometry_msgs/msg/Twist`; InvalidDefinition where ROS refuses it."""
        package, interface = self._split(name)
        return self._find(package, interface).definition(interface)

    def get(self, name: str) -> Any:
        """The class of `geometry_msgs/msg/Twist`, `geometry_msgs/Twist`, or of a part such as `turtlesim/srv/Spawn_Request`.

        Raises LookupError where there is no such package or interface, and InvalidDefinition where ROS refuses its
        definition, or that of a field's type.
        """
        found = self._classes.get(name)
        if found is None:
            package, interface = self._split(name)
            found = getattr(self.module(package, interface), interface.partition("/")[2], None)
            if found is None:
                raise LookupError(f"'{name}' is not a part of a service or action")
            self._classes[name] = found
        return found

    def module(self, package: str, interface: str) -> ModuleType:
        """The generated module of an interface: `geometry_msgs.msg._twist` for `msg/Twist`."""
        with self._lock:
            is_whole = self.package(package).has(interface)
            whole = interface if is_whole else interface.partition("_")[0]  # X of X_SendGoal_Request
            owner = self._find(package, whole)
            if whole not in owner.modules:
                owner.modules[whole] = self._make(owner, whole)
            return owner.modules[whole]

    def resolve(self, type_: FieldType) -> Any:
        """The class of a field's messages; InvalidDefinition where there is none."""
        name = f"{type_.package}/{type_.folder}/{type_.base}"
        try:
            message_class = self.get(name)
        except LookupError as error:
            hint = self._where_is(type_.base) or error.args[0]
            whole = f"{type_.package}/{type_.base}"
            raise InvalidDefinition(f"the type '{whole}' is unknown", "UnknownMessageType", hint=hint) from None
        if self._in_progress:
            self._uses[self._in_progress[-1]] |= self._uses[name]
        return message_class

    def _make(self, owner: Package, interface: str) -> ModuleType:
        definition = owner.definition(interface)
        name = definition.full_name
        if name in self._in_progress:
            circle = " -> ".join([*self._in_progress, name])
            raise InvalidDefinition(f"a message cannot contain itself: {circle}", "UnknownMessageType")
        if len(self._in_progress) >= DEEPEST:
            raise InvalidDefinition(f"messages are nested more than {DEEPEST} deep", "UnknownMessageType")
        self._in_progress.append(name)
        self._uses[name] = {owner.name}
        try:
            return make_module(definition, self.resolve)
        finally:
            self._in_progress.pop()

    def _split(self, name: str) -> tuple[str, str]:
        parts = name.split("/")
        if len(parts) == 3 and parts[1] in FOLDERS:
            return parts[0], f"{parts[1]}/{parts[2]}"
        if len(parts) != 2:
            hint = self._where_is(parts[-1], "/msg")
            raise LookupError(f"'{name}' is not a name such as 'geometry_msgs/msg/Twist'. {hint}".rstrip())
        owner = self.package(parts[0])
        whole = parts[1].partition("_")[0]
        folder = next((each for each in FOLDERS if owner.has(f"{each}/{whole}")), "msg")
        return parts[0], f"{folder}/{parts[1]}"

    def package(self, name: str) -> Package:
        """One package; LookupError where there is none of that name."""
        owner = self._added.get(name) or self._built_in.get(ALIASES.get(name, name))
        if owner is None:
            raise LookupError(
                f"there is no interface package '{name}'. {names.did_you_mean(name, self.packages())}".rstrip()
            )
        return owner

    def _find(self, package: str, interface: str) -> Package:
        owner = self.package(package)
        if not owner.has(interface):
            text = f"the package '{package}' has no interface '{interface}'. {owner.advice(interface)}"
            raise LookupError(text.rstrip())
        return owner

    def _where_is(self, name: str, folder: str = "") -> str:
        """Say which packages have a message of this name."""
        owners = [each for each in self.packages() if self.package(each).has(f"msg/{name}")]
        owners.sort(key=lambda owner: owner == "example_interfaces")
        found = " or ".join(f"'{owner}{folder}/{name}'" for owner in owners)
        return f"Did you mean {found}?" if found else ""

    @cached_property
    def _built_in(self) -> dict[str, Package]:
        return {path.name: Package(path.name, path) for path in SHARE.iterdir() if path.is_dir()}

    def _forget(self, package: str) -> None:
        """Drop the classes and modules of a package, and of the packages that use it."""
        self._classes.clear()
        stale = {package}
        stale |= {user.partition("/")[0] for user, used in self._uses.items() if package in used}
        for owner in [*self._added.values(), *self._built_in.values()]:
            if owner.name in stale:
                owner.modules.clear()
                for name in (owner.name, *(alias for alias, real in ALIASES.items() if real == owner.name)):
                    forget_modules(name)


registry = Registry()
"""The registry that `import` statements look into."""


def forget_modules(package: str) -> None:
    """Take a package's interface modules out of `sys.modules`; a real Python package of that name stays."""
    if not sys.modules.keys().isdisjoint(f"{package}.{folder}" for folder in FOLDERS):  # there are thousands of names
        below = f"{package}."
        for name in [each for each in sys.modules if each.startswith(below) and each.split(".")[1] in FOLDERS]:
            del sys.modules[name]
    outer = sys.modules.get(package)
    if outer is None:
        return
    if outer.__spec__ is not None and outer.__spec__.origin == OUTER:
        del sys.modules[package]
    for folder in FOLDERS:
        if isinstance(outer.__dict__.get(folder), ModuleType):
            delattr(outer, folder)


# -- imports --------------------------------------------------------------------------------------------------------
# Real Python packages always come first, wherever on `sys.path` they are: where a ROS 2 is sourced, its own
# `geometry_msgs` is imported. A mere folder of that name without `__init__.py` does not count, as it would not beside
# an installed package: a workspace's source folder `robot_controller/` must not hide the messages built from it.


def install_finder(registry: Registry = registry) -> None:
    """Let import statements find the interface packages; a second call changes nothing."""
    if InterfaceFinder(registry) not in sys.meta_path:
        place = sys.meta_path.index(PathFinder) if PathFinder in sys.meta_path else len(sys.meta_path)
        sys.meta_path.insert(place, InterfaceFinder(registry))


def uninstall_finder(registry: Registry = registry) -> None:
    """Undo `install_finder`; what was imported stays imported."""
    sys.meta_path[:] = [each for each in sys.meta_path if each != InterfaceFinder(registry)]


OUTER = "interfaces only"
"""The origin of an outer package such as `geometry_msgs`, which is nothing but a place for its inner ones."""


@dataclass(frozen=True)
class InterfaceFinder:
    """Finds packages, their `msg`, `srv` and `action` packages, and the modules of single interfaces."""

    registry: Registry

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """Specification of one of our modules, or None to leave the name to others."""
        parts = fullname.split(".")
        if len(parts) > 3 or (len(parts) > 1 and parts[1] not in FOLDERS):
            return None
        if not self.registry.knows(parts[0]) or _is_found_elsewhere(fullname, path, target):
            return None
        owner, inner = self.registry.package(parts[0]), parts[1:]
        if not inner:
            return _spec(fullname, lambda: ModuleType(fullname), OUTER)
        folder, known = inner[0], owner.names_in(inner[0])
        if not known:
            return None
        if len(inner) == 1:
            return _spec(fullname, lambda: _folder_module(fullname, owner, folder), f"made from {owner.name}/{folder}")
        for name in known:
            if names.module_name(name) == inner[1]:
                return _spec(fullname, partial(self.registry.module, parts[0], f"{folder}/{name}"))
        if inner[1][:1].isupper():  # `from std_msgs.msg import Strng` ends here once the attribute is missing
            text = (
                f"cannot import name '{inner[1]}' from '{owner.name}.{folder}'. {owner.advice(f'{folder}/{inner[1]}')}"
            )
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


def _spec(name: str, make: Callable[[], ModuleType], origin: str | None = None) -> ModuleSpec:
    """The specification of a module, or of a package where it has an origin, which is made complete."""
    loader: Any = SimpleNamespace(create_module=lambda spec: make(), exec_module=lambda module: None)
    return ModuleSpec(name, loader, origin=origin, is_package=origin is not None)


def _folder_module(fullname: str, owner: Package, folder: str) -> ModuleType:
    """An inner package, e.g. `geometry_msgs.msg`, whose classes are made when first asked for."""
    module, known = ModuleType(fullname), owner.names_in(folder)

    def get(name: str) -> Any:
        if name not in known:
            if name.startswith("__"):  # asked of every module, by whoever looks through them all
                raise AttributeError(f"module '{fullname}' has no attribute '{name}'", name=name)
            text = f"module '{fullname}' has no attribute '{name}'. {owner.advice(f'{folder}/{name}')}"
            raise AttributeError(text.rstrip(". "), name=name)
        found = getattr(import_module(f"{fullname}.{names.module_name(name)}"), name)
        setattr(module, name, found)
        return found

    module.__dict__.update(__getattr__=get, __dir__=lambda: sorted({*module.__dict__, *known}), __all__=known)
    return module
