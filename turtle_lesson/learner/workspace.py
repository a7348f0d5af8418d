"""The learner's own workspace: one package that grows from page to page, and that no page deletes or overwrites unasked.

A small file, `workspace/.pages.json`, remembers what pages wrote: per file of the package its hash and the page. A file that
has another hash now was changed by the learner.
"""

from __future__ import annotations

import hashlib
import io
import json
import re
import shutil
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..ros.runtime import files
from ..ros.runtime.files import home
from . import story

if TYPE_CHECKING:
    from ..ros.runtime.world import World

PACKAGE = "robot_controller"
_INSTALL = re.compile(r"^install\(.*?\)\n", re.MULTILINE | re.DOTALL)


def workspace() -> Workspace:
    """The workspace beside this notebook, whether or not it exists already."""
    return Workspace(home() / "workspace")


@dataclass(frozen=True)
class Workspace:
    """A folder `workspace` with the learner's package in `src/robot_controller`."""

    folder: Path

    @property
    def package(self) -> Path:
        """The folder of the package's source."""
        return self.folder / "src" / PACKAGE

    @property
    def nodes(self) -> Path:
        """The folder of the package's programs."""
        return self.package / PACKAGE

    def __repr__(self) -> str:
        return self.state()

    def prepare(self, page: str) -> Workspace:
        """Bring what the pages before this one would have left, where it is missing. The learner's own files are kept.

        A file that is still as an earlier page published it, or as `ros2 pkg create` made it, becomes what this page begins
        with. In a CMakeLists.txt of the learner's own, the `install(…)` commands that are missing are added.
        """
        memory = self._memory()
        memory["page"] = page
        for path, text in story.files_before(page).items():
            file = self.package / path
            now = _text(file)
            if now is None or (now != text and (story.is_published(path, now, before=page) or _is_template(path, now))):
                self._write(file, text)
                memory["files"][path] = [_hash(text), ""]
            elif path == "CMakeLists.txt" and (merged := _with_installs(now, text)) != now:
                self._write(file, merged)
        self._remember(memory)
        return self

    def reset(self, page: str) -> str:
        """Put the package back as a page finds it: "05_obstacle_detector" or "05". Returns a sentence.

        What was there is kept as a copy in `workspace/kept`. Raises ValueError for a page that does not exist.
        """
        page = story.page_named(page)
        said = f"{PACKAGE} is now as page {page} begins."
        if self.package.exists():
            files.check(self.package, removes=True)
            kept = self._kept()
            shutil.copytree(self.package, kept / PACKAGE, ignore=shutil.ignore_patterns("__pycache__"))
            shutil.rmtree(self.package)
            said += f" What was there is kept in {self._shown(kept)}."
        memory = self._memory()
        memory["files"] = {}
        self._remember(memory)
        self.prepare(page)
        return f'{said} Continue with: lesson = start(seed=0, package="mine")'

    def state(self) -> str:
        """Which files the package has, and whether each was filled in or is the learner's own work; as a text."""
        have = [path.relative_to(self.package).as_posix() for path in sorted(_sources(self.package))]
        if not have:
            return f"There is no package in {self._shown(self.package)} yet."
        written, rows = self._memory()["files"], [f"Your package {self._shown(self.package)}:"]
        for path in have:
            filled_in = written.get(path) == [_hash(_text(self.package / path) or ""), ""]
            rows.append(f"  {path.ljust(max(map(len, have)))}  {'filled in' if filled_in else 'yours'}")
        return "\n".join(rows)

    @property
    def is_built(self) -> bool:
        """Whether `build()` built the package from exactly the sources that are there now, and nothing else did since."""
        return (self.folder / "install" / "setup.bash").exists() and self._memory().get("built") == self._fingerprint()

    def build(self, world: World) -> str:
        """`colcon build` of the package, in this world's terminal. Returns what it printed if it failed, else ""."""
        from ..ros.cli import colcon

        said = io.StringIO()
        words = ["build", "--packages-select", PACKAGE]
        if colcon.run(world, words, stdout=said, stderr=said, cwd=self.folder) != 0:
            return said.getvalue()
        memory = self._memory()
        memory["built"] = self._fingerprint()
        self._remember(memory)
        return ""

    def source(self, world: World) -> None:
        """`source install/setup.bash`, as the start-up file of a terminal does it; nothing where nothing was built."""
        from ..ros.ament.source import overlay

        if (self.folder / "install" / "setup.bash").exists():
            overlay(world, self.folder / "install")

    def _fingerprint(self) -> str:
        """A hash of the texts of the sources and of the times of what is installed: each build writes that anew."""
        sources = [f"{path}\n{_text(path)}" for path in sorted(_sources(self.package))]
        installed = [f"{path} {path.lstat().st_mtime_ns}" for path in sorted(_sources(self.folder / "install"))]
        return _hash("\n".join(sources + installed))

    # -- cells that write files --------------------------------------------------------------------------------------

    def write(self, file: Path, text: str, *, append: bool) -> str:
        """What `%%writefile` does with a file of the package. Returns the sentence that it prints.

        What this page or an earlier one wrote is replaced. A file with changes of the learner's own is left as it is the
        first time; the same cell, run again, replaces it and keeps a copy. A text that is to be appended and is there
        already changes nothing; a changed one takes the place of the part that begins by defining the same name.
        """
        path = file.relative_to(self.package).as_posix()
        now, shown, memory = _text(file), self._shown(file), self._memory()
        parts = [text]
        if now is not None and append:
            if text in now:
                return f"Appending to {shown}: this text is there already"
            parts = story.with_part(_parts(path, now, memory), text)
            text = "".join(parts)
        if now is not None and not _may_replace(path, now, text, memory):
            question = [path, _hash(now), _hash(text)]
            if memory.get("asked") != question:
                self._remember(memory | {"asked": question})
                return (
                    f"{shown} holds changes of your own, so it was left as it is. Run this cell once more to replace it; "
                    "a copy will be kept."
                )
            self._write(self._kept() / path, now)
        memory["files"][path] = [_hash(text), memory["page"]]
        memory["parts"] = memory.get("parts", {}) | {path: parts}
        memory.pop("asked", None)
        self._write(file, text)
        self._remember(memory)
        return f"{'Appending to' if append else 'Writing' if now is None else 'Overwriting'} {shown}"

    def _write(self, file: Path, text: str) -> None:
        """Write a file of the workspace. Raises PermissionError where a link leads out of the learner's folder."""
        files.write(files.check(file), text)

    def _kept(self) -> Path:
        """A new folder for copies: kept/1, kept/2, …"""
        folder = files.unused(lambda number: self.folder / "kept" / str(number))
        self._write(folder.parent / "COLCON_IGNORE", "")  # or the build would find the package twice
        return folder

    def _shown(self, path: Path) -> str:
        return path.relative_to(self.folder.parent).as_posix()

    def _memory(self) -> dict[str, Any]:
        try:
            memory = json.loads((self.folder / ".pages.json").read_text(encoding="utf-8"))
        except (OSError, ValueError):  # there is none, or it was damaged: then all files count as the learner's own
            memory = {}
        return {"page": story.PAGES[0], "files": {}} | (memory if isinstance(memory, dict) else {})

    def _remember(self, memory: dict[str, Any]) -> None:
        self._write(self.folder / ".pages.json", json.dumps(memory, indent=1) + "\n")


def _may_replace(path: str, now: str, text: str, memory: dict[str, Any]) -> bool:
    """Whether a file may get this text unasked: its own text is the same, published, or as a cell wrote it."""
    here = memory["page"]
    published = story.is_published(path, now, before=here) or (path, now) in story.versions(here)
    if now == text or published or _is_template(path, now):
        return True
    written, page = memory["files"].get(path, ["", ""])
    earlier = page == "" or story.PAGES.index(page) <= story.PAGES.index(here)
    return written == _hash(now) and earlier


def _parts(path: str, now: str, memory: dict[str, Any]) -> list[str]:
    """The parts in which cells wrote a file, on this page or an earlier one, with what was changed by hand since then."""
    known = (memory.get("parts", {}).get(path, []), story.parts_before(memory["page"]).get(path, ()))
    same = [list(parts) for parts in known if "".join(parts) == now]
    return same[0] if same else max((story.divided(now, parts) for parts in known), key=len)


def _sources(folder: Path) -> list[Path]:
    return [path for path in folder.rglob("*") if path.is_file() and "__pycache__" not in path.parts]


def _is_template(path: str, text: str) -> bool:
    """Whether a file is still as `ros2 pkg create` made it."""
    from ..ros.ament.create import TO_DO_DESCRIPTION, cmake_lists

    if path == "CMakeLists.txt":
        return text == cmake_lists(PACKAGE)
    return path == "package.xml" and TO_DO_DESCRIPTION in text


def _text(file: Path) -> str | None:
    return file.read_text(encoding="utf-8", errors="replace") if file.is_file() else None


def _hash(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def _with_installs(mine: str, published: str) -> str:
    """A CMakeLists.txt with the `install(…)` commands that another one has and it lacks, before `ament_package()`."""
    have = {" ".join(command.split()) for command in _INSTALL.findall(mine)}
    missing = [command for command in _INSTALL.findall(published) if " ".join(command.split()) not in have]
    if not missing or "ament_package()" not in mine:
        return mine
    head, end, tail = mine.rpartition("ament_package()")
    return "".join([head, *missing, "\n", end, tail])
