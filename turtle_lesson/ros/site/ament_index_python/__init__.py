"""`ament_index_python`: where packages are, for programs that ask (facts: ament_index of Humble)."""

# ruff: noqa: F401

from .packages import (
    PackageNotFoundError,
    get_package_prefix,
    get_package_share_directory,
    get_package_share_path,
    get_packages_with_prefixes,
)
