"""Substitutions that find packages and what is in them."""

from __future__ import annotations

from ament_index_python.packages import get_package_prefix, get_package_share_directory
from launch import LaunchContext
from launch._entities import SomeSubstitutionsType, Substitution, explained, text_of
from launch.frontend import expose_substitution
from launch.substitutions import SubstitutionFailure

from turtle_lesson.ros.ament.index import current_packages
from turtle_lesson.ros.ament.package import ExecutableNotFoundError, Target

__all__ = ["ExecutableInPackage", "FindPackagePrefix", "FindPackageShare"]


@expose_substitution("exec-in-pkg")
class ExecutableInPackage(Substitution):
    """Stands for the path at which a real ROS 2 has the program; `target` is what runs here."""

    executable: SomeSubstitutionsType
    package: SomeSubstitutionsType
    _shown = "ExecInPkg(pkg={package}, exec={executable})"

    def perform(self, context: LaunchContext) -> str:
        """The path. Raises PackageNotFoundError or SubstitutionFailure if there is no such package or program."""
        self.target(context)
        package, executable = text_of(context, self.package), text_of(context, self.executable)
        return (current_packages().get(package).libexec / executable).as_posix()

    def target(self, context: LaunchContext) -> Target:
        """The file, or the `main()`, that is run."""
        try:
            return current_packages().executable(text_of(context, self.package), text_of(context, self.executable))
        except ExecutableNotFoundError as error:
            raise explained(SubstitutionFailure(error.text), error.hint) from error


@expose_substitution("find-pkg-share")
class FindPackageShare(Substitution):
    """The folder with a package's launch files and other data."""

    package: SomeSubstitutionsType
    _shown = "FindPackageShare(pkg={package})"

    def perform(self, context: LaunchContext) -> str:
        """The folder. Raises PackageNotFoundError if there is no such package."""
        return get_package_share_directory(text_of(context, self.package))


@expose_substitution("find-pkg-prefix")
class FindPackagePrefix(Substitution):
    """The folder that a package is installed in."""

    package: SomeSubstitutionsType
    _shown = "FindPackagePrefix(pkg={package})"

    def perform(self, context: LaunchContext) -> str:
        """The folder. Raises PackageNotFoundError if there is no such package."""
        return get_package_prefix(text_of(context, self.package))
