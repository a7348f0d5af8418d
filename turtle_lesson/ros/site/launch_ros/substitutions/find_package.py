"""`FindPackageShare` and `FindPackagePrefix`: where a package is."""

from __future__ import annotations

from typing import Any

from ament_index_python.packages import get_package_prefix, get_package_share_directory
from launch import LaunchContext
from launch.frontend import expose_substitution
from launch.some_types import SomeSubstitutionsType
from launch.substitution import Substitution
from launch.substitutions._parsing import arguments
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions


class FindPackage(Substitution):
    """Base of the two."""

    def __init__(self, package: SomeSubstitutionsType) -> None:
        self.__package = normalize_to_list_of_substitutions(package)

    @property
    def package(self) -> list[Substitution]:
        """The package's name."""
        return self.__package

    def find(self, package_name: str) -> str:
        """Where it is, for subclasses to say."""
        raise NotImplementedError

    def describe(self) -> str:
        """As in `FindPackageShare(pkg='turtlesim')`."""
        return f"{type(self).__name__}(pkg={' + '.join(part.describe() for part in self.package)})"

    def perform(self, context: LaunchContext) -> str:
        """The folder.

        Raises:
            PackageNotFoundError: if there is no such package.
        """
        return self.find(perform_substitutions(context, self.package))


@expose_substitution("find-pkg-prefix")
class FindPackagePrefix(FindPackage):
    """The folder that a package is installed in."""

    @classmethod
    def parse(cls, data: Any) -> tuple[type, dict[str, Any]]:
        """Its arguments as they stand behind `$(find-pkg-prefix `."""
        return cls, arguments("find-pkg-prefix", data, ["package"], 1)

    def find(self, package_name: str) -> str:
        """The folder."""
        return get_package_prefix(package_name)


@expose_substitution("find-pkg-share")
class FindPackageShare(FindPackage):
    """The folder with a package's launch files and other data."""

    @classmethod
    def parse(cls, data: Any) -> tuple[type, dict[str, Any]]:
        """Its arguments as they stand behind `$(find-pkg-share `."""
        return cls, arguments("find-pkg-share", data, ["package"], 1)

    def find(self, package_name: str) -> str:
        """The folder."""
        return get_package_share_directory(package_name)
