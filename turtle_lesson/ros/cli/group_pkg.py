"""`ros2 pkg` and `ros2 interface`: find packages and create new ones; what messages, services and actions look like."""

from __future__ import annotations

import re
from argparse import Namespace
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from ..ament.create import add_arguments as add_create_arguments
from ..ament.create import create_package
from ..ament.index import current_packages, package_hint
from ..ament.package import Package
from ..idl.definition import parse
from ..idl.names import did_you_mean
from ..idl.registry import registry
from ..sim.errors import shown_path
from .arguments import arg, cut, either, flag
from .typed_values import interface_names, suggest_type
from .verb import CommandError, print_names, verb

SITE = Path(__file__).resolve().parents[1] / "site"


def package_names() -> list[str]:
    """The names of all packages: those of the world, the interface packages, and what a learner imports."""
    libraries = [path.name for path in SITE.iterdir() if (path / "__init__.py").is_file()]
    return sorted({*current_packages().names(), *registry.packages(), *libraries})


def find_prefix(name: str) -> Path | None:
    """The folder that a package is installed in; None if there is no such package."""
    packages = current_packages()
    if name in packages:
        return packages.get(name).prefix or packages.get(name).share
    if name in registry.packages():
        return registry.package(name).directory
    return SITE / name if name in package_names() else None


def not_found(name: str) -> CommandError:
    """The error for a package that is not there, in the words of the real tool."""
    return CommandError(f"Package '{cut(name, 100)}' not found", hint_for_package(name))


def hint_for_package(name: str) -> str:
    """What to try if there is no package of a name."""
    return package_hint(name[:100], package_names()) or "Is it built (colcon build), and is its setup file sourced?"


PACKAGE = arg("package_name", "name of the package")
ANY_PACKAGE = arg("package_name", "name of the package; all packages if left out", nargs="?")


@verb("pkg list", in_cell=True)
def _list(args: Namespace) -> None:
    """List the packages that can be found."""
    print_names(package_names())


@verb("pkg prefix", PACKAGE, flag("--share", "the folder of its shared files instead"), in_cell=True)
def _prefix(args: Namespace) -> None:
    """Print the folder in which a package is installed."""
    prefix = find_prefix(args.package_name)
    if prefix is None:
        raise CommandError("Package not found", hint_for_package(args.package_name))
    if args.share and args.package_name in current_packages():
        prefix = current_packages().get(args.package_name).share
    print(shown_path(str(prefix)))


@verb("pkg xml", PACKAGE, arg("-t --tag", "only this element, such as version"), in_cell=True)
def _xml(args: Namespace) -> None:
    """Print the package.xml of a package."""
    from xml.etree import ElementTree

    packages = current_packages()
    if find_prefix(args.package_name) is None:
        raise CommandError("Package not found", hint_for_package(args.package_name))
    path = packages.get(args.package_name).share / "package.xml" if args.package_name in packages else None
    if path is None or not path.is_file():
        raise CommandError(f"the package '{args.package_name}' has no package.xml here: it is a part of the simulation")
    text = path.read_text(encoding="utf-8")
    root = ElementTree.fromstring(text)
    if args.tag is None:
        print(text[text.index("<package") :].rstrip())
        return
    elements = [each for each in root.iter() if each.tag == args.tag]
    if not elements:
        raise CommandError("XML tag not found", did_you_mean(args.tag, {each.tag for each in root.iter()}))
    for element in elements:
        print((element.text or "").strip())


@verb("pkg executables", ANY_PACKAGE, flag("--full-path", "print the paths of the programs"), in_cell=True)
def _executables(args: Namespace) -> None:
    """List the programs of a package."""
    packages, name = current_packages(), args.package_name
    if name is not None and find_prefix(name) is None:
        raise not_found(name)
    names = packages.names() if name is None else [name]
    for package in [packages.get(each) for each in names if each in packages]:
        for executable in sorted(package.executables):
            print(shown_path(str(path_of(package, executable))) if args.full_path else f"{package.name} {executable}")


def path_of(package: Package, executable: str) -> Path:
    """Where a real ROS 2 would find a program, or where it lies."""
    target = package.executables[executable]
    return target if package.prefix is None and isinstance(target, Path) else package.libexec / executable


@verb("pkg create", add_create_arguments, in_cell=True)
def _create(args: Namespace) -> int:
    """Create a new package."""
    return create_package(args)


# -- interface ---------------------------------------------------------------------------------------------------------


TITLES = {"msg": "Messages", "srv": "Services", "action": "Actions"}

KINDS = (
    arg("-m --only-msgs", "messages only", action="append_const", dest="kinds", const="msg"),
    arg("-s --only-srvs", "services only", action="append_const", dest="kinds", const="srv"),
    arg("-a --only-actions", "actions only", action="append_const", dest="kinds", const="action"),
)
TYPE = arg("type", "full name of the interface, such as geometry_msgs/msg/Twist")


@verb("interface list", *KINDS, in_cell=True)
def _list_interfaces(args: Namespace) -> None:
    """List all interfaces."""
    for kind, title in TITLES.items():
        if args.kinds is None or kind in args.kinds:
            print(f"{title}:")
            print_names([f"    {name}" for name in interface_names() if f"/{kind}/" in name])


@verb("interface packages", *KINDS, in_cell=True)
def _packages(args: Namespace) -> None:
    """List the packages that have interfaces."""
    parts = [name.split("/") for name in interface_names()]
    print_names(sorted({package for package, kind, _ in parts if kind in (args.kinds or TITLES)}))


@verb("interface package", PACKAGE, in_cell=True)
def _package(args: Namespace) -> None:
    """List the interfaces of a package."""
    _check_package(args.package_name)
    print_names([name for name in interface_names() if name.startswith(f"{args.package_name}/")])


def _check_package(name: str, base: str = "") -> None:
    if not registry.knows(name):
        hint = suggest_type(base) or did_you_mean(name[:100], registry.packages())
        built = "A package of your own is known once it is built and its setup file is sourced."
        raise CommandError(f"Unknown package '{cut(name, 100)}'", hint or built)


def _check(name: str) -> None:
    """Raise CommandError, in the real tool's words, unless there is an interface of this full name."""
    parts = name.split("/")
    if len(parts) != 3 or not all(parts):
        hint = suggest_type(parts[-1][:100]) or "Such as geometry_msgs/msg/Twist"
        raise CommandError(f"Invalid name '{cut(name, 100)}'. Expected three parts separated by '/'", hint)
    package, folder, base = parts
    _check_package(package, base[:100])
    owner = registry.package(package)
    if folder not in TITLES or not owner.has(f"{folder}/{base}"):
        where = shown_path(str(owner.directory / cut(f"{folder}/{base}", 100)))
        hint = did_you_mean(name[:100], [f"{package}/{each}" for each in registry.package(package).interface_names()])
        raise CommandError(f"Could not find the interface '{where}.idl'", hint)


ALL_COMMENTS = flag("--all-comments", "also show the comments of nested types")
NO_COMMENTS = flag("--no-comments", "show neither comments nor empty lines")


@verb("interface show", TYPE, either(ALL_COMMENTS, NO_COMMENTS), in_cell=True)
def _show(args: Namespace) -> None:
    """Print the definition of an interface."""
    _check(args.type)
    package, _, interface = args.type.partition("/")
    for line in _lines(package, interface, args, 0):
        print(line)


def _lines(package: str, interface: str, args: Namespace, depth: int) -> Iterator[str]:
    """The lines of a definition, each field of a message type followed by that type's own lines, one tab deeper."""
    commented = args.all_comments or (depth == 0 and not args.no_comments)
    text = registry.text(package, interface, comments=commented)
    for line in (text if depth else text.rstrip()).splitlines():
        shown = line.rstrip() if commented else _without_comment(line)
        if shown or commented:
            yield "\t" * depth + shown if shown else ""
        declares = _without_comment(line).strip() not in ("", "---")
        for field in parse("msg", package, "Line", line).fields if declares else ():
            if field.type.package:
                yield from _lines(field.type.package, f"msg/{field.type.base}", args, depth + 1)


_CODE = re.compile(r"""(?:[^'"#]|(['"]).*?(?:\1|$))*""")


def _without_comment(line: str) -> str:
    """A line up to its comment; a `#` in quotes is none."""
    found = _CODE.match(line)
    return found[0].rstrip() if found else ""


@verb("interface proto", TYPE, flag("--no-quotes", "without the quotation marks around it"), in_cell=True)
def _proto(args: Namespace) -> None:
    """Print an interface with its default values, to fill in."""
    from rosidl_runtime_py import message_to_yaml

    _check(args.type)
    made: Any = registry.get(args.type)
    for part in ("Request", "Goal"):
        made = getattr(made, part, made)
    text = message_to_yaml(made())
    print(text if args.no_quotes else f'"{text}"')
