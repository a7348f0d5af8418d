"""Packages as a build has installed them: reads an install folder back."""

from __future__ import annotations

import os
from pathlib import Path

from .outcome import PYTHON
from .package import Package

LAYOUT = ".colcon_install_layout"
"""The file in which an install folder says `isolated` (a folder a package) or `merged` (one for all)."""
PYTHON_FOLDERS = (f"lib/{PYTHON}/site-packages", f"local/lib/{PYTHON}/dist-packages")
_INDEX = "share/ament_index/resource_index"


def layout_of(install: Path) -> str:
    """`isolated`, `merged`, or nothing where colcon has not installed anything yet."""
    file = install / LAYOUT
    return file.read_text(encoding="utf-8").strip() if file.is_file() else ""


def prefix_of(install: Path, name: str) -> Path:
    """The folder that a package is installed in."""
    return install if layout_of(install) == "merged" else install / name


def installed_names(install: Path) -> list[str]:
    """The packages in an install folder, each after those it needs."""
    pattern = "share/colcon-core/packages/*" if layout_of(install) == "merged" else "*/share/colcon-core/packages/*"
    files = {file.name: file for file in install.glob(pattern) if file.is_file()}
    needs = {name: set(file.read_text(encoding="utf-8").split(":")) & set(files) for name, file in files.items()}
    ordered: list[str] = []
    while needs:
        ready = sorted(name for name, others in needs.items() if others <= {*ordered, name}) or sorted(needs)
        ordered += ready
        needs = {name: others for name, others in needs.items() if name not in ready}
    return ordered


def read_installed(install: Path, name: str) -> Package:
    """One package of an install folder."""
    prefix = prefix_of(install, name)
    share = prefix / "share" / name
    return Package(
        name=name,
        share=share,
        executables={path.name: path for path in _programs(prefix / "lib" / name)},
        interfaces=_interfaces(prefix, name),
        source=source_of(install, name),
        prefix=prefix,
    )


def _programs(folder: Path) -> list[Path]:
    """The programs of a package: files that can be run, as `ros2 pkg executables` counts them."""
    if not folder.is_dir():
        return []
    return sorted(path for path in folder.iterdir() if path.is_file() and (os.name == "nt" or os.access(path, os.X_OK)))


def _interfaces(prefix: Path, name: str) -> list[str]:
    file = prefix / _INDEX / "rosidl_interfaces" / name
    if not file.is_file():
        return []
    lines = file.read_text(encoding="utf-8").splitlines()
    return [line for line in lines if "_Re" not in line.rpartition("/")[2] and not line.endswith(".idl")]


def source_of(install: Path, name: str) -> Path | None:
    """The folder that an installed package was built from, if it is still there."""
    file = install.parent / "build" / name / "source_folder.txt"
    if not file.is_file():
        return None
    folder = Path(file.read_text(encoding="utf-8").strip())
    return folder if folder.is_dir() else None


def python_folders(prefix: Path) -> list[Path]:
    """The folders with Python packages of the learner's own, which are put on the import path."""
    return [prefix / place for place in PYTHON_FOLDERS if _has_own(prefix / place, prefix)]


def _has_own(folder: Path, prefix: Path) -> bool:
    if not folder.is_dir():
        return False
    index = prefix / _INDEX / "rosidl_interfaces"
    made = {path.name for path in index.iterdir()} if index.is_dir() else set()
    return any(path.name not in made and not path.name.endswith(".egg-info") for path in folder.iterdir())
