"""The packages of a world, found by name, and those that a robot has and that are not here: windows, Gazebo, drivers."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

from ..idl.names import did_you_mean, nearest
from ..sim.errors import shown_path
from .cmake import compiled_programs
from .package import (
    CompiledProgramError,
    ExecutableNotFoundError,
    LaunchFileNotFoundError,
    NotHereError,
    Package,
    PackageNotFoundError,
    Target,
    sections,
)

_given: list[PackageIndex] = []

_SLIP = 0.885
"""How much alike two names of packages must be for one of them to be a slip: `lifecycle_py` is none of `lifecycle`."""


class PackageIndex:
    """Packages by name. One that is added later hides an earlier one of the same name, as an overlay does."""

    def __init__(self) -> None:
        self._layers: dict[str, list[Package]] = {}

    def __contains__(self, name: object) -> bool:
        return name in self._layers

    def __iter__(self) -> Iterator[Package]:
        return iter([layers[-1] for layers in self._layers.values()])

    def add(self, package: Package) -> None:
        """Make a package findable."""
        self._layers.setdefault(package.name, []).append(package)

    def remove(self, package: Package) -> None:
        """Take a package out, wherever it lies among those of its name; what it hid is found again."""
        layers = self._layers.get(package.name, [])
        layers[:] = [each for each in layers if each is not package]
        if not layers:
            self._layers.pop(package.name, None)

    def names(self) -> list[str]:
        """The names of all packages, sorted."""
        return sorted(self._layers)

    def get(self, name: str) -> Package:
        """The package of this name. Raises PackageNotFoundError with the real text, and the name that was perhaps meant."""
        if name in self._layers:
            return self._layers[name][-1]
        places = [shown_path(str(package.prefix or package.share)) for package in self]
        text = f"package '{name}' not found, searching: {list(dict.fromkeys(reversed(places)))}"
        raise PackageNotFoundError(
            text, package_hint(name, self._layers) or "Is it built, and is its setup file sourced?"
        )

    def executable(self, package: str, executable: str) -> Target:
        """What runs as `executable` of a package. Raises PackageNotFoundError or ExecutableNotFoundError with the real text."""
        found = self.get(package)
        if executable in found.executables:
            return found.executables[executable]
        raise _no_executable(found, executable)

    def program_at(self, path: str) -> tuple[str, str] | None:
        """Package and name of the program that lies at a path, as ExecutableInPackage gives it; None for other paths."""
        place = Path(path).absolute()
        package = self._layers[place.parent.name][-1] if place.parent.name in self._layers else None
        if package is None or place.name not in package.executables or place.parent != package.libexec.absolute():
            return None
        return package.name, place.name


class LaunchedPackages(PackageIndex):
    """The packages as a launch file sees them: what a robot has and the simulation has not is left out of the launch.

    The folder of such a package can be asked for, as launch files do when they are loaded; there is nothing in it.
    """

    def __init__(self, packages: PackageIndex) -> None:
        super().__init__()
        self._layers = packages._layers

    def get(self, name: str) -> Package:
        """The package of this name, an absent one included."""
        if _is_absent(name, self._layers):
            return Package(name, _PLACE / name)
        return super().get(name)

    def executable(self, package: str, executable: str) -> Target:
        """What runs as `executable` of a package. Raises NotHereError, too, if only a robot can start it."""
        if _is_absent(package, self._layers):
            what = package if package == executable else f"{executable} of {package}"
            raise NotHereError(what, why_not_here(package))
        try:
            return super().executable(package, executable)
        except CompiledProgramError as error:
            raise NotHereError(f"{executable} of {package}", f"it is {error.why}") from None


def package_hint(name: str, known: Iterable[str]) -> str:
    """What is known about a package that is not there: which one was perhaps meant, or that only robots have it."""
    if near := nearest(name, known, _SLIP):
        return f"Did you mean '{near}'?"
    why = why_not_here(name)
    return f"{name} is not available here: {why}." if why else ""


def _is_absent(name: str, known: Iterable[str]) -> bool:
    """Whether a package is only on robots: neither known nor the slip of one that is."""
    return not nearest(name, known, _SLIP) and bool(why_not_here(name))


def _no_executable(package: Package, executable: str) -> ExecutableNotFoundError:
    libexec = shown_path(str(package.libexec))
    text = f"executable '{executable}' not found on the libexec directory '{libexec}'"
    compiled = compiled_programs(package.source) if package.source else {}
    if executable in compiled:
        return CompiledProgramError(text, executable, compiled[executable])
    if (file := package.libexec / executable).is_file():
        place = shown_path(str(file.resolve()))
        hint = f"The file exists, but is not executable: !chmod +x {place}, then source again."
    elif package.executables:
        names = ", ".join(sorted(package.executables))
        close = did_you_mean(executable, package.executables)
        hint = f"{close} {package.name} has: {names}.".strip()
        module = executable.removesuffix(".py")
        lying = package.source / package.name / f"{module}.py" if package.source else Path()
        if _is_python(package) and module not in {*package.executables, "__init__"} and lying.is_file():
            entry = f"{module} = {package.name}.{module}:main"
            hint += f" For {module}.py add '{entry}' to console_scripts in setup.py, and build again."
    else:
        prefix = shown_path(str(package.prefix or package.share))
        text = f"package '{package.name}' found at '{prefix}', but libexec directory '{libexec}' does not exist"
        hint = (
            "The package installs no program; write in its CMakeLists.txt install(PROGRAMS <file> DESTINATION "
            f"lib/${{PROJECT_NAME}} RENAME {executable})."
        )
        if compiled:
            hint = f"{package.name} has C++ programs alone, which are not built here: {', '.join(compiled)}."
            hint = f"{did_you_mean(executable, compiled)} {hint}".strip()
    return ExecutableNotFoundError(text, hint)


def changed_since_built(package: Package) -> Path | None:
    """A module of an ament_python package that is another in its source than as it was installed; None if there is none."""
    if package.source is None or package.prefix is None or not _is_python(package):
        return None
    for folder in package.prefix.glob(f"lib/python3*/site-packages/{package.name}"):
        for installed in sorted(folder.rglob("*.py")):
            source = package.source / package.name / installed.relative_to(folder)
            if source.is_file() and source.read_bytes() != installed.read_bytes():
                return source
    return None


def _is_python(package: Package) -> bool:
    """Whether a package is built by its setup.py."""
    return package.source is not None and not (package.source / "CMakeLists.txt").is_file()


def find_launch_file(packages: PackageIndex, package: str, file_name: str) -> Path:
    """The launch file of this name that a package has installed.

    Raises PackageNotFoundError or LaunchFileNotFoundError with the texts of `ros2 launch`, and what to try.
    """
    found = packages.get(package)
    files = found.shared_files(file_name)
    if len(files) == 1:
        return files[0]
    share = shown_path(str(found.prefix / "share" / package if found.prefix else found.share))
    directory = f"in the share directory of package '{package}'"
    if files:
        shown = [shown_path(str(file)) for file in files]
        raise LaunchFileNotFoundError(f"file '{file_name}' was found more than once {directory}: {shown}")
    text = f"file '{file_name}' was not found {directory} which is at '{share}'"
    known = sorted({file.name for file in found.shared_files("*launch.*") if is_launch_file(file.name)})
    there_are = f"There are: {', '.join(known)}." if known else "The package installs no launch file."
    hint = did_you_mean(file_name, known) or there_are
    if found.source and (lying := sorted(found.source.rglob(file_name))):
        place = lying[0].parent.relative_to(found.source).as_posix()
        what = f"write install(DIRECTORY {place} DESTINATION share/${{PROJECT_NAME}}) in CMakeLists.txt"
        if _is_python(found):
            what = f"add ('share/{package}/{place}', ['{place}/{file_name}']) to data_files in setup.py"
        hint = f"The file is in {place}/, but it is not installed: {what} and build again."
    raise LaunchFileNotFoundError(text, hint)


def is_launch_file(name: str) -> bool:
    """Whether a file is named as launch files are, such as `start.launch.py` or `start_launch.xml`."""
    return name.endswith(tuple(f"{sign}launch.{kind}" for sign in "._" for kind in ("py", "xml", "yaml", "yml")))


def current_packages() -> PackageIndex:
    """The index of packages in force."""
    if _given:
        return _given[-1]
    from ..runtime.world import current_world

    return current_world().packages


@contextmanager
def seeing(packages: PackageIndex) -> Iterator[None]:
    """Have `current_packages()` be this index for a while."""
    _given.append(packages)
    try:
        yield
    finally:
        _given.pop()


# -- what a robot's ROS 2 has ------------------------------------------------------------------------------------------
# The packages that builds find, and those that are not here, with the reason. The names, in `catalog.txt`, are those of
# packages in the ROS index (https://index.ros.org), and of programs that launch files start.


def _words(section: str) -> tuple[str, ...]:
    """The words of a section of `catalog.txt`."""
    return tuple(sections("catalog.txt")[section].split())


_WITH_MODULES = _words("programs and modules")
"""Packages that have programs for launch files, and modules for programs."""

_ONLY_IMPORTED = _words("modules")
"""Packages that programs import, and launch files and builds hardly ever name."""

_NOT_HERE = {
    "there are no windows here; lesson.dashboard(), lesson.scene() and the lesson's plots draw into the page": _words(
        "not here: windows"
    ),
    "there is no Gazebo here; the simulated world is turtlesim": _words("not here: gazebo"),
    "the Python package xacro is not installed: pip install xacro (in a notebook: %pip install xacro)": ("xacro",),
    "it is not part of this simulation": _WITH_MODULES + _words("not here: other"),
}
"""Why some packages and programs are not available, and their names; `rqt_*` stands for all that begin so, but interfaces."""

_INTERFACES = ("_msgs", "_interfaces", "_srvs", "_actions")
_PLACE = Path("/opt/ros/not_here/share")
"""A folder that does not exist: in a launch file, those in it stand for the share folders of packages that are not here."""


def why_not_here(name: str) -> str:
    """Why a package or program that robots have is not available; nothing for a name that is none of theirs."""
    for why, names in _NOT_HERE.items():
        beginnings = tuple(each[:-1] for each in names if each.endswith("*"))
        if name in names or (name.startswith(beginnings) and not name.endswith(_INTERFACES)):
            return why
    return ""


_INSTEAD = {
    "rosbag2_py": " Bags are recorded, played and described by `ros2 bag` and by lesson.record().",
    "sensor_msgs_py": " The messages themselves, such as PointCloud2, are in sensor_msgs.msg.",
    "tf2_sensor_msgs": " The types of geometry_msgs can be transformed: import tf2_geometry_msgs.",
}


def missing_module(name: str) -> str:
    """A sentence about a package that robots have and that cannot be imported here; nothing for every other name."""
    if name not in _WITH_MODULES and name not in _ONLY_IMPORTED:
        return ""
    return (
        f"{name} is a package of ROS 2 that is not available here: a program that needs it runs on a robot "
        f"where it is installed (sudo apt install ros-$ROS_DISTRO-{name.replace('_', '-')}).{_INSTEAD.get(name, '')}"
    )


def package_of(path: str | Path) -> str:
    """The absent package whose folder a path leads into; nothing for every other path."""
    path = Path(path)
    return path.relative_to(_PLACE).parts[0] if path.is_relative_to(_PLACE) and path != _PLACE else ""


CMAKE_PACKAGES = frozenset(_words("found by find_package"))
"""What `find_package` finds, besides packages of interfaces."""

PYTHON_PACKAGES = frozenset(_words("Python packages"))
"""Packages that package.xml may name, but that `find_package` cannot find: they are Python alone."""

CMAKE_COMMANDS = frozenset(_words("commands of CMake"))
"""The commands that CMake itself has."""

_LISTED = dict(
    line.split(": ", 1) for line in re.split(r"\n(?! )", sections("catalog.txt")["commands by package"].strip())
)


def _commands(package: str) -> frozenset[str]:
    """The commands that are listed for a package; the name of another package stands for all of its commands."""
    return frozenset().union(*(_commands(word) if word in _LISTED else {word} for word in _LISTED[package].split()))


COMMANDS_OF = {package: _commands(package) for package in _LISTED}
"""The commands that each package brings to those who find it."""
