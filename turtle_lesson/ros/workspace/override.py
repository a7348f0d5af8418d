"""The warning about packages that are built although an underlay has them, and other packages there need them.

Facts: colcon-override-check 0.0.1, which comes with ROS 2. The last package of a chain, on which nothing else depends
(such as robot_controller), may be overridden without a word.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from ..core.tracebacks import shown_path
from ..interfaces.registry import INSTALLED_SEPARATELY, Registry
from .discover import Found
from .installed import prefix_of
from .known import CMAKE_PACKAGES, PYTHON_PACKAGES

if TYPE_CHECKING:
    from ..world import World

_ROS = "/opt/ros/humble"
_TEXT = """\
Some selected packages are already built in one or more underlay workspaces:
\t{where}
If a package in a merged underlay workspace is overridden and it installs headers, then all packages in the overlay must \
sort their include directories by workspace order. Failure to do so may result in build failures or undefined behavior at \
run time.
If the overridden package is used by another package in any underlay, then the overriding package in the overlay must be \
API and ABI compatible or undefined behavior at run time may occur.

If you understand the risks and want to override a package anyways, add the following to the command line:
\t--allow-overriding {names}

This may be promoted to an error in a future release of colcon-override-check."""


def overridden(world: World, chosen: list[Found], install: Path, allowed: list[str]) -> str:
    """The warning, or nothing where nothing is overridden that others need."""
    built_in = {*CMAKE_PACKAGES, *PYTHON_PACKAGES, *Registry().packages()} - INSTALLED_SEPARATELY
    needed = _needed_in_underlays(world, install)
    places: dict[str, str] = {}
    for found in chosen:
        if found.name in allowed:
            continue
        if found.name in built_in:
            places[found.name] = _ROS
        elif found.name in needed:
            places[found.name] = needed[found.name]
    where = "\n\t".join(f"'{name}' is in: {place}" for name, place in places.items())
    return _TEXT.format(where=where, names=" ".join(sorted(places))) if places else ""


def _needed_in_underlays(world: World, install: Path) -> dict[str, str]:
    """The packages of other install folders on which packages there depend, each with its place."""
    outside = {each.name: each.prefix for each in world.packages if each.prefix and not _below(each.prefix, install)}
    places = {}
    for name, prefix in outside.items():
        file = prefix / "share" / "colcon-core" / "packages" / name
        for other in file.read_text(encoding="utf-8").split(":") if file.is_file() else []:
            if other in outside:
                places[other] = shown_path(str(outside[other]))
    return places


def _below(prefix: Path, install: Path) -> bool:
    return prefix in {install.resolve(), prefix_of(install.resolve(), prefix.name)}
