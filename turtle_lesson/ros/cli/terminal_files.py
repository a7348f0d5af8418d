"""The terminal's words for folders and files: cd, pwd, mkdir, ls, touch, chmod, rm, cp, mv."""

from __future__ import annotations

import os
import shutil
from pathlib import Path

from ..idl.names import did_you_mean
from ..runtime import files
from ..sim.errors import shown_path
from .terminal_io import Terminal, options

last_cd: Path | None = None
"""Where the last `cd` went, or None."""


# -- folders -----------------------------------------------------------------------------------------------------------


def cd(terminal: Terminal, words: list[str]) -> int:
    """`cd folder`, `cd ..`, `cd -`, `cd`: change the current folder."""
    global last_cd
    if len(words) > 1:
        return terminal.fail("cd: too many arguments: a folder's name with a space in it needs quotes")
    target = Path(words[0]) if words else files.home()
    if words == ["-"]:
        target = Path(os.environ.get("OLDPWD", "."))
        terminal.say(shown_path(str(target)))
    before = Path.cwd()
    if not target.is_dir():
        what = "Not a directory" if target.exists() else "No such file or directory"
        return terminal.fail(f"cd: {words[0]}: {what}. {_beside(target)}".rstrip(" ."))
    os.chdir(target)
    os.environ["OLDPWD"] = str(before)
    last_cd = Path.cwd()
    return 0


def _beside(target: Path) -> str:
    """A folder of a similar name in the same place."""
    place = target.parent
    if len(str(target)) > 200 or not place.is_dir():
        return ""
    return did_you_mean(target.name, [path.name for path in place.iterdir() if path.is_dir()])


def pwd(terminal: Terminal, words: list[str]) -> int:
    """`pwd`: print the current folder."""
    return terminal.say(str(Path.cwd()))


def mkdir(terminal: Terminal, words: list[str]) -> int:
    """`mkdir [-p] folder…`: make folders."""
    letters, names = options(words)
    if letters - {"p", "v"} or any(name.startswith("--") and name != "--parents" for name in names):
        return terminal.fail(
            "mkdir: the only option here is -p, which also makes the folders above and accepts folders that exist"
        )
    parents = "p" in letters or "--parents" in names
    names = [name for name in names if name != "--parents"]
    if not names:
        return terminal.fail("mkdir: missing operand: name the folders to make, as in mkdir -p turtle_ws/src")
    code = 0
    for name in names:
        try:
            if not parents and os.path.lexists(name):
                raise FileExistsError
            files.check(Path(name)).mkdir(parents=parents, exist_ok=parents)  # not by way of other folders: new/../../x
        except FileExistsError:
            code = terminal.fail(f"mkdir: cannot create directory '{name}': File exists")
        except FileNotFoundError:
            code = terminal.fail(
                f"mkdir: cannot create directory '{name}': No such file or directory. mkdir -p also makes the folders above"
            )
    return code


# -- files -------------------------------------------------------------------------------------------------------------


def ls(terminal: Terminal, words: list[str]) -> int:
    """`ls [-a] [-1] [-R] [name…]`: list folders, one name a line."""
    letters, names = options(words)
    code = 0
    places = [Path(name) for name in names or ["."]]
    for place in places:
        if not place.exists():
            code = terminal.fail(f"ls: cannot access '{place}': No such file or directory", 2)
        elif place.is_file():
            terminal.say(str(place))
        else:
            _list_folder(terminal, place, letters, headed=len(places) > 1 or "R" in letters)
    return code


def _list_folder(terminal: Terminal, place: Path, letters: set[str], *, headed: bool) -> None:
    inside = sorted(path for path in place.iterdir() if "a" in letters or not path.name.startswith("."))
    if headed:
        terminal.say(f"{place}:")
    for path in inside:
        terminal.say(path.name)
    if "R" in letters:
        for path in inside:
            if path.is_dir():
                terminal.say("")
                _list_folder(terminal, path, letters, headed=True)


def touch(terminal: Terminal, words: list[str]) -> int:
    """`touch file…`: make empty files."""
    for name in words:
        files.check(name)
        Path(name).touch()
    return 0 if words else terminal.fail("touch: name the files to make")


def chmod(terminal: Terminal, words: list[str]) -> int:
    """`chmod +x file…`: make files executable."""
    modes, names = words[:1], words[1:]
    if not names or modes[0] not in {"+x", "a+x", "u+x", "755", "0755"}:
        return terminal.fail("chmod: here it makes files executable: chmod +x file")
    for name in names:
        path = Path(name)
        files.check(path)
        path.chmod(path.stat().st_mode | 0o111)
    return 0


# -- rm, cp, mv ------------------------------------------------------------------------------------------------------


def rm(terminal: Terminal, words: list[str]) -> int:
    """`rm [-r] [-f] name…`: delete files, and with -r folders."""
    letters, names = options(words)
    if not names and "f" not in letters:
        return terminal.fail("rm: missing operand: name the files to delete, as in rm -r build install log")
    return max((_delete(terminal, name, letters) for name in names), default=0)


def _delete(terminal: Terminal, name: str, letters: set[str]) -> int:
    path = Path(name)
    if not path.exists() and not path.is_symlink():
        return 0 if "f" in letters else terminal.fail(f"rm: cannot remove '{name}': No such file or directory")
    try:
        files.check(path, removes=True)
    except PermissionError as refusal:
        return terminal.fail(f"rm: '{name}' stays where it is: {refusal.strerror}")
    if path.is_symlink() or not path.is_dir():
        path.unlink()
    elif letters & {"r", "R"}:
        shutil.rmtree(path)
    else:
        return terminal.fail(f"rm: cannot remove '{name}': Is a directory. rm -r deletes a folder and everything in it")
    return 0


def cp(terminal: Terminal, words: list[str]) -> int:
    """`cp [-r] from… to`: copy files, and with -r folders."""
    letters, names = options(words)
    if len(names) < 2:
        return terminal.fail("cp: name what to copy, and where to: cp old.py new.py")
    return max(_copy(terminal, name, _target(name, names[-1]), letters) for name in names[:-1])


def _copy(terminal: Terminal, name: str, target: Path, letters: set[str]) -> int:
    source = Path(name)
    if not source.exists():
        return terminal.fail(f"cp: cannot stat '{name}': No such file or directory")
    if not source.is_dir():
        files.check(target)
        shutil.copy(source, target)
    elif not letters & {"r", "R", "a"}:
        return terminal.fail(f"cp: -r not specified; omitting directory '{name}'")
    elif Path(os.path.realpath(target)).is_relative_to(source.resolve()):
        return terminal.fail(f"cp: cannot copy a directory, '{name}', into itself, '{target}'")
    else:
        files.copy(source.resolve(), target)
    return 0


def mv(terminal: Terminal, words: list[str]) -> int:
    """`mv from… to`: rename or move files and folders."""
    _, names = options(words)
    if len(names) < 2:
        return terminal.fail("mv: name what to move, and where to: mv old.py new.py")
    return max(_move(terminal, name, _target(name, names[-1])) for name in names[:-1])


def _move(terminal: Terminal, name: str, target: Path) -> int:
    source = Path(name)
    if not source.exists():
        return terminal.fail(f"mv: cannot stat '{name}': No such file or directory")
    try:
        files.check(source, removes=True)
    except PermissionError as refusal:
        return terminal.fail(f"mv: '{name}' stays where it is: {refusal.strerror}")
    files.check(target, follow=False)
    os.replace(source, target)
    return 0


def _target(name: str, to: str) -> Path:
    """Where a file goes: into a folder that is there, or else to the name itself."""
    place = Path(to)
    return place / os.path.basename(os.path.realpath(name)) if place.is_dir() else place
