"""`ros2 interface`: what messages, services and actions look like."""

from __future__ import annotations

import re
from argparse import Namespace
from collections.abc import Iterator
from typing import Any

from ..idl.definition import parse_message
from ..idl.model import FieldType
from ..idl.names import did_you_mean
from ..idl.registry import registry
from ..sim.errors import shown_path
from .arguments import arg, cut, either, flag
from .typed_values import interface_names
from .verb import CommandError, verb

TITLES = {"msg": "Messages", "srv": "Services", "action": "Actions"}

KINDS = (
    arg("-m --only-msgs", "messages only", action="append_const", dest="kinds", const="msg"),
    arg("-s --only-srvs", "services only", action="append_const", dest="kinds", const="srv"),
    arg("-a --only-actions", "actions only", action="append_const", dest="kinds", const="action"),
)
TYPE = arg("type", "full name of the interface, such as geometry_msgs/msg/Twist")


def _of_kind(kind: str) -> dict[str, list[str]]:
    """All interfaces of a kind, by their packages."""
    import rosidl_runtime_py as api

    getters = {
        "msg": api.get_message_interfaces,
        "srv": api.get_service_interfaces,
        "action": api.get_action_interfaces,
    }
    return getters[kind]()


@verb("interface list", *KINDS, in_cell=True)
def _list(args: Namespace) -> None:
    """List all interfaces."""
    for kind, title in TITLES.items():
        if args.kinds is None or kind in args.kinds:
            print(f"{title}:")
            for package, names in _of_kind(kind).items():
                for name in names:
                    print(f"    {package}/{name}")


@verb("interface packages", *KINDS, in_cell=True)
def _packages(args: Namespace) -> None:
    """List the packages that have interfaces."""
    for package in sorted({package for kind in args.kinds or TITLES for package in _of_kind(kind)}):
        print(package)


_PACKAGE = arg("package_name", "name of the package")


@verb("interface package", _PACKAGE, in_cell=True)
def _package(args: Namespace) -> None:
    """List the interfaces of a package."""
    from rosidl_runtime_py import get_interfaces

    _check_package(args.package_name)
    for package, names in get_interfaces([args.package_name]).items():
        for name in names:
            print(f"{package}/{name}")


def _check_package(name: str, base: str = "") -> None:
    if not registry.knows(name):
        hint = _where_is(base) or did_you_mean(name[:100], registry.packages())
        built = "A package of your own is known once it is built and its setup file is sourced."
        raise CommandError(f"Unknown package '{cut(name, 100)}'", hint or built)


def _check(name: str) -> None:
    """Raise CommandError, in the real tool's words, unless there is an interface of this full name."""
    parts = name.split("/")
    if len(parts) != 3 or not all(parts):
        hint = _where_is(parts[-1][:100]) or "Such as geometry_msgs/msg/Twist"
        raise CommandError(f"Invalid name '{cut(name, 100)}'. Expected three parts separated by '/'", hint)
    package, folder, base = parts
    _check_package(package, base[:100])
    owner = registry.package(package)
    if folder not in TITLES or not owner.has(f"{folder}/{base}"):
        where = shown_path(str(owner.directory / cut(f"{folder}/{base}", 100)))
        hint = did_you_mean(name[:100], [f"{package}/{each}" for each in registry.interface_names(package)])
        raise CommandError(f"Could not find the interface '{where}.idl'", hint)


def _where_is(base: str) -> str:
    """`Did you mean 'geometry_msgs/msg/Twist'?`, where an interface has this last name."""
    found = [name for name in interface_names() if name.rpartition("/")[2].lower() == base.lower()]
    return f"Did you mean {' or '.join(map(repr, found[:3]))}?" if found else ""


@verb(
    "interface show",
    TYPE,
    either(
        flag("--all-comments", "also show the comments of nested types"),
        flag("--no-comments", "show neither comments nor empty lines"),
    ),
    in_cell=True,
)
def _show(args: Namespace) -> None:
    """Print the definition of an interface."""
    _check(args.type)
    package, _, interface = args.type.partition("/")
    for line in _lines(package, interface, args, 0):
        print(line)


def _lines(package: str, interface: str, args: Namespace, depth: int) -> Iterator[str]:
    """The lines of a definition, each field of a message type followed by that type's own lines, one tab deeper."""
    commented = args.all_comments or (depth == 0 and not args.no_comments)
    text = registry.commented(package, interface) if commented else registry.text(package, interface)
    for line in (text if depth else text.rstrip()).splitlines():
        shown = line.rstrip() if commented else _without_comment(line)
        if shown or commented:
            yield "\t" * depth + shown if shown else ""
        field = _field_type(package, line)
        if field is not None and field.package:
            yield from _lines(field.package, f"msg/{field.base}", args, depth + 1)


_CODE = re.compile(r"""(?:[^'"#]|(['"]).*?(?:\1|$))*""")


def _without_comment(line: str) -> str:
    """A line up to its comment; a `#` in quotes is none."""
    found = _CODE.match(line)
    return found[0].rstrip() if found else ""


def _field_type(package: str, line: str) -> FieldType | None:
    """The type of the field that a line declares, if it declares one."""
    if not _without_comment(line).strip() or line.strip() == "---":
        return None
    fields = parse_message(package, "Line", line, "").fields
    return fields[0].type if fields else None


@verb("interface proto", TYPE, flag("--no-quotes", "without the quotation marks around it"), in_cell=True)
def _proto(args: Namespace) -> None:
    """Print an interface with its default values, to fill in."""
    from rosidl_runtime_py import message_to_yaml
    from rosidl_runtime_py.utilities import get_interface

    _check(args.type)
    made: Any = get_interface(args.type)
    for part in ("Request", "Goal"):
        made = getattr(made, part, made)
    text = message_to_yaml(made())
    print(text if args.no_quotes else f'"{text}"')
