"""Looking packages up by name."""

from __future__ import annotations

import re
from pathlib import Path

from turtle_lesson.ros.ament.index import current_packages
from turtle_lesson.ros.ament.package import PackageNotFoundError as PackageNotFoundError


def get_packages_with_prefixes() -> dict[str, str]:
    """Every package's name, with the folder that it is installed in."""
    return {name: get_package_prefix(name) for name in current_packages().names()}


def get_package_prefix(package_name: str) -> str:
    """The folder that a package is installed in; for one that is used as it lies there, that folder.

    Raises PackageNotFoundError if there is no such package, and ValueError if the name cannot be a package's.
    """
    if not re.fullmatch(r"[A-Za-z]\w*", package_name, re.ASCII):
        raise ValueError(f"'{package_name}' is not a valid package name")
    package = current_packages().get(package_name)
    return str(package.prefix or package.share)


def get_package_share_directory(package_name: str, print_warning: bool = True) -> str:
    """The folder with a package's launch files and other data.

    Raises PackageNotFoundError if there is no such package, and ValueError if the name cannot be a package's.
    """
    get_package_prefix(package_name)
    return str(current_packages().get(package_name).share)


def get_package_share_path(package_name: str, print_warning: bool = True) -> Path:
    """The same as a path."""
    return Path(get_package_share_directory(package_name, print_warning))
