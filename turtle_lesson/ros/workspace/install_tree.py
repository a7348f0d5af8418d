"""Writes what a build installs: the package's own files, the ament index, and the setup files."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterable, Iterator
from pathlib import Path

from ... import files
from ..core.tracebacks import shown_path
from .discover import ColconError, Found
from .installed import LAYOUT, layout_of, prefix_of
from .outcome import Environment, Item, Outcome

SETUP_FILES = ("setup", "local_setup")
SHELLS = ("bash", "sh", "zsh")


def prepare(install: Path, build: Path, log: Path, layout: str = "isolated") -> None:
    """Make the three folders, marked so that colcon looks for no packages in them.

    Raises:
        ColconError: the install folder has the other layout.
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
    manifest = environment.build / found.name / "install_manifest.txt"
    _uninstall(prefix, manifest)
    lines = []
    items = [*outcome.items, *_index(found, outcome), *_environment(found, outcome)]
    files.save(manifest, "".join(f"{target}\n" for item in items for target in _targets(item)))
    for item in items:
        _write(item, prefix / item.target, environment.symlink)
        lines.append(f"-- Installing: {shown_path(str(prefix))}/{item.target}")
    _note_build(found, environment)
    return lines


def _targets(item: Item) -> Iterator[str]:
    """The files that come of an item."""
    if item.source is not None and item.source.is_dir():
        yield from (f"{item.target}/{path.relative_to(item.source).as_posix()}" for path in _files_in(item.source))
    else:
        yield item.target


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
    if item.source is None:
        files.save(target, item.text)
    elif symlink and not item.copied:
        _link(item.source, target)
        return
    elif item.source.is_dir():
        files.copy(item.source, target, shutil.ignore_patterns("__pycache__", "*.pyc"))
    else:
        files.check(target).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(item.source, target)
    if item.program:
        target.chmod(0o755)


def _link(source: Path, target: Path) -> None:
    """A link where the computer allows one (Windows may not), otherwise a copy. Folders stay folders, as with colcon."""
    if source.is_dir():
        for inner in _files_in(source):
            _link(inner, target / inner.relative_to(source))
        return
    files.check(target, follow=False).parent.mkdir(parents=True, exist_ok=True)
    target.unlink(missing_ok=True)
    try:
        target.symlink_to(source.resolve())
    except OSError:
        shutil.copyfile(source, target)


def _files_in(folder: Path) -> Iterator[Path]:
    for place, folders, names in os.walk(folder):
        folders[:] = sorted(name for name in folders if name != "__pycache__")
        yield from (Path(place, name) for name in sorted(names) if not name.endswith(".pyc"))


def _index(found: Found, outcome: Outcome) -> Iterator[Item]:
    """The entries in the ament index, by which ROS 2 finds the package."""
    name = found.name
    index = "share/ament_index/resource_index"
    targets = {item.target for item in outcome.items}
    if not found.is_python:
        yield Item(f"{index}/packages/{name}")
        yield Item(f"{index}/package_run_dependencies/{name}", text=";".join(outcome.dependencies))
        yield Item(f"{index}/parent_prefix_path/{name}", text="/opt/ros/humble")
        yield Item(f"share/{name}/cmake/{name}Config.cmake", text=_CONFIG.format(name=name))
    if f"share/{name}/package.xml" not in targets:
        yield Item(f"share/{name}/package.xml", found.path / "package.xml")
    yield Item(f"share/colcon-core/packages/{name}", text=":".join(sorted(set(outcome.dependencies))))


_CONFIG = "# By this file find_package({name}) finds the package.\nset({name}_FOUND TRUE)\n"


def _environment(found: Found, outcome: Outcome) -> Iterator[Item]:
    """What the package adds to the environment, one line a variable, as colcon's own .dsv files have it."""
    share = f"share/{found.name}"
    hooks = {"ament_prefix_path": "prepend-non-duplicate;AMENT_PREFIX_PATH;"}
    for folder in outcome.paths or _python_folders(outcome):
        hooks["pythonpath"] = f"prepend-non-duplicate;PYTHONPATH;{folder}"
    place = "hook" if found.is_python else "environment"
    for name, line in hooks.items():
        yield Item(f"{share}/{place}/{name}.dsv", text=line)
    sources = [f"source;{share}/{place}/{name}.dsv\n" for name in hooks]
    yield Item(f"{share}/package.dsv", text="".join(sources))
    for shell in SHELLS:
        yield Item(f"{share}/package.{shell}", text=_shell_lines(found.name, hooks, "$COLCON_CURRENT_PREFIX"))


def _python_folders(outcome: Outcome) -> list[str]:
    folders = [item.target for item in outcome.items if "/dist-packages/" in item.target]
    return [folders[0].partition("/dist-packages/")[0] + "/dist-packages"] if folders else []


def _shell_lines(name: str, hooks: dict[str, str], prefix: str) -> str:
    lines = [f"# What the package {name} adds to the environment; COLCON_CURRENT_PREFIX is its folder.\n"]
    for line in hooks.values():
        _, variable, folder = line.split(";")
        place = f"{prefix}/{folder}" if folder else prefix
        lines.append(f'export {variable}="{place}${{{variable}:+:${variable}}}"\n')
    return "".join(lines)


def _note_build(found: Found, environment: Environment) -> None:
    """The build folder, which remembers where the source is and that it went well.

    There is no CMakeCache.txt in it: a real colcon, to which this folder may be taken, runs CMake where there is none.
    """
    folder = environment.build / found.name
    files.save(folder / "colcon_build.rc", "0\n")
    files.save(folder / "source_folder.txt", f"{found.path.resolve()}\n")


def write_setup_files(install: Path, names: Iterable[str]) -> None:
    """`setup.bash`, `local_setup.bash` and the others, which overlay the packages in the order of `names`."""
    for shell in SHELLS:
        place = "${BASH_SOURCE[0]}" if shell == "bash" else "${(%):-%x}" if shell == "zsh" else "$0"
        lines = [
            "# Made by colcon build. In a page `source` reads the folder itself; a real terminal can run this, too.\n",
            f'_folder="$(cd "$(dirname "{place}")" > /dev/null && pwd)"\n',
        ]
        for name in names:
            inner = "" if prefix_of(install, name) == install else f"/{name}"
            lines.append(f'COLCON_CURRENT_PREFIX="$_folder{inner}"\n')
            lines.append(f'. "$COLCON_CURRENT_PREFIX/share/{name}/package.{shell}"\n')
        lines.append("unset COLCON_CURRENT_PREFIX _folder\n")
        files.save(install / f"local_setup.{shell}", "".join(lines))
        chain = f'. "$(cd "$(dirname "{place}")" > /dev/null && pwd)/local_setup.{shell}"\n'
        files.save(install / f"setup.{shell}", f"# Made by colcon build.\n{chain}")
