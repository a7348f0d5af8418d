"""The index of resources: small files by type and name, which packages install (facts: ament_index's resources.py).

Every package is itself a resource of the type `packages`, also one of the simulation's own, which installs no such file.
"""

from __future__ import annotations

from pathlib import Path

from turtle_lesson.ros.ament.index import current_packages

from .constants import RESOURCE_INDEX_SUBFOLDER
from .packages import get_packages_with_prefixes
from .search_paths import get_search_paths

PACKAGES = "packages"


class InvalidResourceTypeNameError(ValueError):
    """A type of resources that no folder can be called."""


class InvalidResourceNameError(ValueError):
    """A resource's name that no file can have."""


def get_resource(resource_type: str, resource_name: str) -> tuple[str, str]:
    """What a resource's file says, and the folder that its package is installed in. LookupError if there is none."""
    path = has_resource(resource_type, resource_name)
    if not isinstance(path, str):
        raise LookupError(f"Could not find the resource '{resource_name}' of type '{resource_type}'")
    file = _folder(path, resource_type) / resource_name
    return file.read_text(encoding="utf-8") if file.is_file() else "", path


def get_resources(resource_type: str) -> dict[str, str]:
    """The names of all resources of a type, each with the folder that its package is installed in."""
    _check(resource_type)
    found = get_packages_with_prefixes() if resource_type == PACKAGES else {}
    for path in get_search_paths():
        folder = _folder(path, resource_type)
        for file in sorted(folder.iterdir()) if folder.is_dir() else ():
            if file.is_file() and not file.name.startswith("."):
                found.setdefault(file.name, path)
    return found


def get_resource_types() -> set[str]:
    """All types of which there are resources."""
    indices = [_folder(path, "") for path in get_search_paths()]
    folders = [folder for index in indices if index.is_dir() for folder in index.iterdir()]
    return {PACKAGES, *(folder.name for folder in folders if folder.is_dir() and not folder.name.startswith("."))}


def has_resource(resource_type: str, resource_name: str) -> str | bool:
    """The folder that the package of a resource is installed in, False if there is no such resource."""
    _check(resource_type, resource_name)
    for path in get_search_paths():
        if (_folder(path, resource_type) / resource_name).is_file():
            return path
    if resource_type == PACKAGES and resource_name in current_packages():
        return get_packages_with_prefixes()[resource_name]
    return False


def _folder(path: str | bool, resource_type: str) -> Path:
    return Path(str(path), RESOURCE_INDEX_SUBFOLDER, resource_type)


def _check(resource_type: str, resource_name: str | None = None) -> None:
    assert resource_type, "The resource type must not be empty"
    assert resource_name is None or resource_name, "The resource name must not be empty"
    if set(resource_type) & set("/\\"):
        raise InvalidResourceTypeNameError(f"Resource type '{resource_type}' is invalid")
    if resource_name and set(resource_name) & set("/\\"):
        raise InvalidResourceNameError(f"Resource name '{resource_name}' is invalid")
