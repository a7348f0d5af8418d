"""Which interfaces there are (names and sentences: rosidl_runtime_py/get_interfaces.py).

Where the real functions give the names of a package in no order, ours give them in alphabetical order.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable
from functools import partial
from pathlib import Path

from turtle_lesson.ros.ament.index import current_packages
from turtle_lesson.ros.idl.registry import FOLDERS, registry

SITE = Path(__file__).resolve().parents[1]


def get_interface_packages() -> list[str]:
    """The names of all packages that have interfaces."""
    return registry.packages()


def get_interfaces(package_names: Iterable[str] = (), folders: Collection[str] = FOLDERS) -> dict[str, list[str]]:
    """The interfaces of some packages, or of all if none is named: `{'std_srvs': ['srv/Empty', …]}`.

    A package without interfaces is left out. Raises LookupError if there is no package of a name.
    """
    found = {}
    for package in list(package_names) or registry.packages():
        _check_package(package)
        names = registry.interface_names(package) if registry.knows(package) else []
        if wanted := [name for name in names if name.partition("/")[0] in folders]:
            found[package] = wanted
    return found


get_message_interfaces = partial(get_interfaces, folders=("msg",))
get_service_interfaces = partial(get_interfaces, folders=("srv",))
get_action_interfaces = partial(get_interfaces, folders=("action",))


def get_interface_path(interface_name: str) -> str:
    """The file that defines an interface, by its name such as `geometry_msgs/msg/Twist`.

    Raises ValueError where the name is no such name, and LookupError where there is no such package or interface.
    """
    parts = interface_name.split("/")
    if len(parts) < 2:
        raise ValueError(f"Invalid name '{interface_name}'. Expected at least two parts separated by '/'")
    if not all(parts):
        raise ValueError(f"Invalid name '{interface_name}'. Must not contain empty parts")
    if ".." in parts:
        raise ValueError(f"Invalid name '{interface_name}'. Must not contain '..'")
    package = parts[0]
    _check_package(package)
    share = current_packages().get(package).share if package in current_packages() else SITE / package
    if registry.knows(package):
        share = registry.package(package).directory  # which holds `msg/`, `srv/` and `action/`
    path = share.joinpath(*parts[1:])
    if "." not in path.name:
        with_suffix = path.with_name(f"{path.name}.{parts[-2]}")
        path = with_suffix if with_suffix.is_file() else path.with_name(f"{path.name}.idl")
    if not path.exists():
        raise LookupError(f"Could not find the interface '{path}'")
    return str(path)


def _check_package(name: str) -> None:
    is_library = name.isidentifier() and (SITE / name / "__init__.py").is_file()
    if not registry.knows(name) and name not in current_packages() and not is_library:
        raise LookupError(f"Unknown package '{name}'")
