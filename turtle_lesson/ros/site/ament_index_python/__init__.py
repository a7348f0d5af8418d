"""`ament_index_python`: where packages are, for programs that ask (facts: ament_index of Humble)."""

from .constants import AMENT_PREFIX_PATH_ENV_VAR
from .packages import (
    PackageNotFoundError,
    get_package_prefix,
    get_package_share_directory,
    get_package_share_path,
    get_packages_with_prefixes,
)

__all__ = [
    "AMENT_PREFIX_PATH_ENV_VAR",
    "PackageNotFoundError",
    "get_package_prefix",
    "get_package_share_directory",
    "get_package_share_path",
    "get_packages_with_prefixes",
]


def __getattr__(name: str) -> object:
    if name.startswith("_"):
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    raise ImportError(
        f"ament_index_python has no {name!r} in this classroom. It has: {', '.join(__all__)}", name=__name__
    )
