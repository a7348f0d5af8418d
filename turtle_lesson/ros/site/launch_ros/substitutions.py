"""Substitutions that find packages and what is in them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ament_index_python.packages import get_package_prefix, get_package_share_directory
from launch import LaunchContext
from launch._entities import SomeSubstitutionsType, Substitution
from launch._tags import expose_as
from launch.substitutions import SubstitutionFailure
from launch.utilities import normalize_to_list_of_substitutions as pieces
from launch.utilities import perform_substitutions

from turtle_lesson.ros.ament.index import current_packages
from turtle_lesson.ros.ament.package import ExecutableNotFoundError

if TYPE_CHECKING:
    from turtle_lesson.ros.ament.package import Target

__all__ = ["ExecutableInPackage", "FindPackage", "FindPackagePrefix", "FindPackageShare"]


@expose_as("exec-in-pkg")
class ExecutableInPackage(Substitution):
    """Stands for the path at which a real ROS 2 has the program; `target` is what runs here."""

    _shown = "ExecInPkg(pkg={package}, exec={executable})"

    def __init__(self, executable: SomeSubstitutionsType, package: SomeSubstitutionsType) -> None:
        self.executable, self.package = pieces(executable), pieces(package)

    def perform(self, context: LaunchContext) -> str:
        """The path. Raises PackageNotFoundError or SubstitutionFailure if there is no such package or program."""
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
        return perform_substitutions(context, self.package), perform_substitutions(context, self.executable)


class FindPackage(Substitution):
    """Base of the two."""

    def __init__(self, package: SomeSubstitutionsType) -> None:
        self.package = pieces(package)
        self._shown = f"{type(self).__name__}(pkg={{package}})"

    def find(self, package_name: str) -> str:
        """Where it is, for subclasses to say."""
        raise NotImplementedError

    def perform(self, context: LaunchContext) -> str:
        """The folder. Raises PackageNotFoundError if there is no such package."""
        return self.find(perform_substitutions(context, self.package))


@expose_as("find-pkg-prefix")
class FindPackagePrefix(FindPackage):
    """The folder that a package is installed in."""

    def find(self, package_name: str) -> str:
        """The folder."""
        return get_package_prefix(package_name)


@expose_as("find-pkg-share")
class FindPackageShare(FindPackage):
    """The folder with a package's launch files and other data."""

    def find(self, package_name: str) -> str:
        """The folder."""
        return get_package_share_directory(package_name)
