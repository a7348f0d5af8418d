"""`ExecutableInPackage`: the path of a package's program."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from launch import LaunchContext
from launch.frontend import expose_substitution
from launch.some_types import SomeSubstitutionsType
from launch.substitution import Substitution
from launch.substitutions import SubstitutionFailure
from launch.substitutions._parsing import arguments
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions

from turtle_lesson.ros.workspace.current import current_packages
from turtle_lesson.ros.workspace.errors import ExecutableNotFoundError

if TYPE_CHECKING:
    from turtle_lesson.ros.workspace.package import Target


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
