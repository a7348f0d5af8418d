"""What building a package comes to, and the install folder: written by a build, and read back by `source`.

A build's result is what it prints, how long it takes, and the items that it installs: the package's own files, what is made of
its interfaces, the ament index, and the setup files.
"""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath

from ..idl.registry import Registry
from ..runtime import files
from ..sim.errors import shown_path
from .manifest import RUNTIME, Found, by_rounds
from .package import BuildFailure, ColconError, Package, PythonProgram

PYTHON = "python3.10"
"""The Python of ROS 2 Humble, which is in the names of installed folders, whatever Python runs here."""

SETUP_FILES = tuple(f"{name}.{shell}" for name in ("setup", "local_setup") for shell in ("bash", "sh", "zsh"))

LAYOUT = ".colcon_install_layout"
"""The file in which an install folder says `isolated` (a folder a package) or `merged` (one for all)."""
PYTHON_FOLDERS = {"python": f"lib/{PYTHON}/site-packages", "cmake": f"local/lib/{PYTHON}/dist-packages"}
"""Where setuptools and where CMake install the modules of a package."""
_INDEX = "share/ament_index/resource_index"


@dataclass(frozen=True)
class Item:
    """One file to install at `target`, below the package's prefix: a copy of `source` or, without one, a file with this text.

    `program` says whether it can be run, `copied` whether it is copied even by `--symlink-install`.
    """

    target: str
    source: Path | None = None
    text: str = ""
    program: bool = False
    copied: bool = False


@dataclass
class Outcome:
    """How a build went: exit code, what is printed, how long it takes in robot time, and what is installed if it went well.

    Attributes:
        stderr: what colcon shows between `--- stderr: name` and `---`.
        stdout: what CMake or setuptools say meanwhile.
        colcon_error: what colcon itself says where it does not even begin.
        left_out: the C++ programs and libraries that are not built here, and scripts that are not Python.
        lacking: the packages that these need and that are not here.
    """

    code: int = 0
    stderr: str = ""
    stdout: list[str] = field(default_factory=list)
    seconds: float = 1.0
    items: list[Item] = field(default_factory=list)
    colcon_error: str = ""
    left_out: list[str] = field(default_factory=list)
    lacking: list[str] = field(default_factory=list)


@dataclass
class Environment:
    """Where a package is built, what it finds there, and whether the fields' types are looked up, as a compiler does."""

    install: Path
    build: Path
    findable: frozenset[str] = frozenset()
    types: Registry = field(default_factory=Registry)
    symlink: bool = False
    compiles: bool = True


def with_hint(text: str, hints: Iterable[str]) -> str:
    """The real tool's text, and below it what to try."""
    return text + "".join(f"Hint: {hint}\n" for hint in hints if hint)


def check_targets(items: Iterable[Item], name: str) -> None:
    """Nothing is installed outside of the package's own folder. Raises BuildFailure where something would be."""
    for item in items:
        place = PurePosixPath(item.target)
        if place.is_absolute() or ".." in place.parts or "\0" in item.target or ":" in place.parts[0]:
            text = f"error: '{item.target}' lies outside the package's install folder\n"
            raise BuildFailure(text, f"Programs go to lib/{name}, and everything else to share/{name}.")


def prepare(install: Path, build: Path, log: Path, layout: str = "isolated") -> None:
    """Make the three folders, marked so that colcon looks for no packages in them.

    Raises ColconError where the install folder has the other layout.
    """
    before = layout_of(install)
    if before not in {"", layout}:
        raise ColconError(
            f"The install directory '{install.name}' was created with the layout '{before}'. Please remove the install "
            f"directory, pick a different one or {'add' if before == 'merged' else 'remove'} the '--merge-install' option."
        )
    for folder in (install, build, log):
        files.save(folder / "COLCON_IGNORE", "")
    files.save(install / LAYOUT, f"{layout}\n")
    files.save(build / ".built_by", "colcon\n")


def install_package(found: Found, outcome: Outcome, environment: Environment) -> list[str]:
    """Write a package's files in place of those of its last build; return the lines `-- Installing: …`."""
    prefix = prefix_of(environment.install, found.name)
    build = environment.build / found.name
    manifest = build / "install_manifest.txt"
    _uninstall(prefix, manifest)
    items = [*outcome.items, *_index(found, outcome)]
    files.save(manifest, "".join(f"{item.target}\n" for item in items))
    for item in items:
        _write(item, prefix / item.target, environment.symlink)
    # There is no CMakeCache.txt: a real colcon, to which this folder may be taken, runs CMake where there is none.
    files.save(build / "colcon_build.rc", "0\n")
    files.save(build / "source_folder.txt", f"{found.path.resolve()}\n")
    return [f"-- Installing: {shown_path(str(prefix))}/{item.target}" for item in items]


def _uninstall(prefix: Path, manifest: Path) -> None:
    """Delete what the last build of a package has installed, and nothing else, whatever the manifest says."""
    names = manifest.read_text(encoding="utf-8").splitlines() if manifest.is_file() else []
    for name in names:
        file = prefix / name
        if file.parent.resolve().is_relative_to(prefix.resolve()) and (file.is_symlink() or file.is_file()):
            files.check(file, removes=True)
            file.unlink()
            for folder in file.parents:
                if folder == prefix or any(folder.iterdir()):
                    break
                folder.rmdir()


def _write(item: Item, target: Path, symlink: bool) -> None:
    """A link is made where the computer allows one (Windows may not), otherwise a copy."""
    if item.source is None:
        files.save(target, item.text)
    else:
        links = symlink and not item.copied
        files.check(target, follow=not links).parent.mkdir(parents=True, exist_ok=True)
        target.unlink(missing_ok=True)
        if links:
            with suppress(OSError):
                target.symlink_to(item.source.resolve())
                return
        shutil.copyfile(item.source, target)
    if item.program:
        target.chmod(0o755)


def names_in(folder: Path, ending: str = "") -> Iterator[str]:
    """The files below a folder, as seen from it and sorted, without those that Python compiles."""
    for place, folders, names in os.walk(folder):
        folders[:] = sorted(name for name in folders if name != "__pycache__")
        wanted = [name for name in sorted(names) if name.endswith(ending) and not name.endswith(".pyc")]
        yield from (Path(place, name).relative_to(folder).as_posix() for name in wanted)


def _index(found: Found, outcome: Outcome) -> Iterator[Item]:
    """The files by which ROS 2 and colcon find the package, and what it needs when it runs."""
    name = found.name
    if not found.is_python:
        yield Item(f"{_INDEX}/packages/{name}")
    if all(item.target != f"share/{name}/package.xml" for item in outcome.items):
        yield Item(f"share/{name}/package.xml", found.path / "package.xml")
    yield Item(f"share/colcon-core/packages/{name}", text=":".join(sorted(set(found.texts(*RUNTIME)))))


def write_setup_files(install: Path) -> None:
    """`setup.bash`, `local_setup.bash` and the others: names for `source`, which reads the install folder itself."""
    text = "# Made by colcon build of Turtle Lesson; `source` in a page reads this folder itself.\n"
    for name in SETUP_FILES:
        files.save(install / name, text)


# -- read back -----------------------------------------------------------------------------------------------------------


def layout_of(install: Path) -> str:
    """`isolated`, `merged`, or nothing where colcon has not installed anything yet."""
    file = install / LAYOUT
    return file.read_text(encoding="utf-8").strip() if file.is_file() else ""


def prefix_of(install: Path, name: str) -> Path:
    """The folder that a package is installed in."""
    return install if layout_of(install) == "merged" else install / name


def needs_of(install: Path, name: str) -> list[str]:
    """The packages that an installed one needs when it runs."""
    file = prefix_of(install, name) / "share/colcon-core/packages" / name
    return file.read_text(encoding="utf-8").split(":") if file.is_file() else []


def installed_names(install: Path) -> list[str]:
    """The packages in an install folder, each after those it needs."""
    pattern = "share/colcon-core/packages/*" if layout_of(install) == "merged" else "*/share/colcon-core/packages/*"
    names = {file.name for file in install.glob(pattern) if file.is_file()}
    needs = {name: names.intersection(needs_of(install, name)) for name in names}
    ordered, in_circles = by_rounds(needs)
    return ordered + in_circles


def read_installed(install: Path, name: str) -> Package:
    """One package of an install folder. Its programs are the files that can be run, as `ros2 pkg executables` counts them."""
    prefix = prefix_of(install, name)
    libexec, listed = prefix / "lib" / name, prefix / _INDEX / "rosidl_interfaces" / name
    lying = sorted(libexec.iterdir()) if libexec.is_dir() else []
    lines = listed.read_text(encoding="utf-8").splitlines() if listed.is_file() else []
    note = install.parent / "build" / name / "source_folder.txt"
    source = Path(note.read_text(encoding="utf-8").strip()) if note.is_file() else None
    programs = [path for path in lying if path.is_file() and (os.name == "nt" or os.access(path, os.X_OK))]
    modules = _python_folders(prefix)
    return Package(
        name=name,
        share=prefix / "share" / name,
        executables={path.name: PythonProgram(path, tuple(modules)) if modules else path for path in programs},
        interfaces=[line for line in lines if "_Re" not in line.rpartition("/")[2] and not line.endswith(".idl")],
        source=source if source and source.is_dir() else None,
        prefix=prefix,
        modules=modules,
    )


def _python_folders(prefix: Path) -> list[Path]:
    """The folders with Python packages of the learner's own, which are put on the import path."""
    index = prefix / _INDEX / "rosidl_interfaces"
    made = {path.name for path in index.iterdir()} if index.is_dir() else set()
    return [
        folder
        for folder in (prefix / place for place in PYTHON_FOLDERS.values())
        if folder.is_dir()
        and any(path.name not in made and not path.name.endswith(".egg-info") for path in folder.iterdir())
    ]
