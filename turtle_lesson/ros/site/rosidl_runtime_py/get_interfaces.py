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


def get_interfaces(package_names: Iterable[str] = (), folders: Collection[str] = FOLDERS) -> dict[str, list[str]]:
    """The interfaces of some packages, or of all if none is named: `{'std_srvs': ['srv/Empty', …]}`.

    A package without interfaces is left out. Raises LookupError if there is no package of a name.
    """
    found = {}
    for package in list(package_names) or registry.packages():
        is_library = package.isidentifier() and (SITE / package / "__init__.py").is_file()
        if not registry.knows(package) and package not in current_packages() and not is_library:
            raise LookupError(f"Unknown package '{package}'")
        names = registry.package(package).interface_names() if registry.knows(package) else []
        if wanted := [name for name in names if name.partition("/")[0] in folders]:
            found[package] = wanted
    return found


get_message_interfaces = partial(get_interfaces, folders=("msg",))
get_service_interfaces = partial(get_interfaces, folders=("srv",))
get_action_interfaces = partial(get_interfaces, folders=("action",))
