"""Substitutions that find packages and what is in them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ament_index_python.packages import get_package_prefix, get_package_share_directory
from launch import LaunchContext
from launch._entities import SomeSubstitutionsType, Substitution
from launch._package import explain_missing
from launch.frontend import expose_substitution
from launch.substitutions import SubstitutionFailure
from launch.substitutions._values import arguments
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions

from turtle_lesson.ros.ament.errors import ExecutableNotFoundError
from turtle_lesson.ros.ament.index import current_packages

if TYPE_CHECKING:
    from turtle_lesson.ros.ament.package import Target

__all__ = ["ExecutableInPackage", "FindPackage", "FindPackagePrefix", "FindPackageShare"]


@expose_substitution("exec-in-pkg")
class ExecutableInPackage(Substitution):
    """Stands for the path at which a real ROS 2 has the program; `target` is what runs here."""

    @classmethod
    def parse(cls, data: Any) -> tuple[type, dict[str, Any]]:
        """Its arguments as they stand behind `$(exec-in-pkg `."""
        return cls, arguments("exec-in-pkg", data, ["executable", "package"], 2)

    def __init__(self, executable: SomeSubstitutionsType, package: SomeSubstitutionsType) -> None:
        self.__executable = normalize_to_list_of_substitutions(executable)
        self.__package = normalize_to_list_of_substitutions(package)

    def describe(self) -> str:
        """As in `ExecInPkg(pkg='turtlesim', exec='turtlesim_node')`."""
        package = " + ".join(part.describe() for part in self.__package)
        return f"ExecInPkg(pkg={package}, exec={' + '.join(part.describe() for part in self.__executable)})"

    def perform(self, context: LaunchContext) -> str:
        """The path.

        Raises:
            PackageNotFoundError, SubstitutionFailure: if there is no such package or program.
        """
        package, executable = self._names(context)
        self.target(context)
        return (current_packages().get(package).libexec / executable).as_posix()

    def target(self, context: LaunchContext) -> Target:
        """The file, or the `main()`, that is run."""
        package, executable = self._names(context)
        try:
            return current_packages().executable(package, executable)
        except ExecutableNotFoundError as error:
            raise SubstitutionFailure(error.text, error.hint) from error

    def _names(self, context: LaunchContext) -> tuple[str, str]:
        return perform_substitutions(context, self.__package), perform_substitutions(context, self.__executable)


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


__getattr__ = explain_missing(
    __name__,
    {
        "FindPackageShareDirectory": "use FindPackageShare",
        "Parameter": "give SetParameter a LaunchConfiguration, and use that",
    },
)
