"""The terminal's own words, beside ros2, colcon and source: those for folders and files, for texts, and for jobs."""

from __future__ import annotations

import os
import re
import shutil
from collections.abc import Iterable
from errno import EINVAL, EISDIR
from pathlib import Path

from ..idl.names import did_you_mean
from ..launching.service import LaunchHandle
from ..runtime import files
from ..runtime.world import run_for
from ..sim.process import Process
from .jobs import SIGNALS, Builtin, Terminal, export, jobs, options, printenv, send, unset

# -- folders -----------------------------------------------------------------------------------------------------------


def cd(terminal: Terminal, words: list[str]) -> int:
    """`cd folder`, `cd ..`, `cd`: change the current folder."""
    if len(words) > 1:
        raise ValueError("too many arguments: a folder's name with a space in it needs quotes")
    target = Path(words[0]) if words else files.home()
    if not target.is_dir():
        what, close = "Not a directory" if target.exists() else "No such file or directory", ""
        if len(str(target)) <= 200 and target.parent.is_dir():
            close = did_you_mean(target.name, [path.name for path in target.parent.iterdir() if path.is_dir()])
        raise ValueError(f"{words[0]}: {what}. {close}".rstrip(" ."))
    os.chdir(target)
    files.last_cd = Path.cwd()
    return 0


def pwd(terminal: Terminal, words: list[str]) -> int:
    """`pwd`: print the current folder."""
    return terminal.say(str(Path.cwd()))


def mkdir(terminal: Terminal, words: list[str]) -> int:
    """`mkdir [-p] folder…`: make folders."""
    letters, names = options(["-p" if word == "--parents" else word for word in words], "pv", "mkdir -p turtle_ws/src")

    def make(path: Path) -> None:
        try:
            files.check(path).mkdir(parents="p" in letters, exist_ok="p" in letters)
        except FileNotFoundError as error:
            error.strerror = "No such file or directory. mkdir -p also makes the folders above"
            raise

    return terminal.for_each(names, make, "mkdir: cannot create directory")


# -- files -------------------------------------------------------------------------------------------------------------


def ls(terminal: Terminal, words: list[str]) -> int:
    """`ls [-a] [-1] [name…]`: list folders, one name a line."""
    letters, names = options(words, "1aAdFhlrst")

    def show(place: Path) -> None:
        place.stat()
        if not place.is_dir():
            terminal.say(place)
            return
        inside = sorted(path for path in place.iterdir() if "a" in letters or not path.name.startswith("."))
        terminal.say(*([f"{place}:"] if len(names) > 1 else []), *(path.name for path in inside))

    return terminal.for_each(names or ["."], show, "ls: cannot access")


def touch(terminal: Terminal, words: list[str]) -> int:
    """`touch file…`: make empty files."""
    _, names = options(words, "", "touch notes.txt")
    return terminal.for_each(names, lambda path: files.check(path).touch(), "touch: cannot touch")


def chmod(terminal: Terminal, words: list[str]) -> int:
    """`chmod +x file…`: make files executable."""
    if len(words) < 2 or words[0] not in {"+x", "a+x", "u+x", "755", "0755"}:
        raise ValueError("here it makes files executable: chmod +x file")
    return terminal.for_each(
        words[1:], lambda path: files.check(path).chmod(path.stat().st_mode | 0o111), "chmod: cannot access"
    )


def rm(terminal: Terminal, words: list[str]) -> int:
    """`rm [-r] [-f] name…`: delete files, and with -r folders."""
    letters, names = options(words, "rRfiv", "rm -r build install log")

    def delete(path: Path) -> None:
        if "f" in letters and not os.path.lexists(path):
            return
        path.lstat()
        files.check(path, removes=True)
        if path.is_symlink() or not path.is_dir():
            path.unlink()
        elif letters & {"r", "R"}:
            shutil.rmtree(path)
        else:
            raise IsADirectoryError(EISDIR, "Is a directory. rm -r deletes a folder and everything in it")

    return terminal.for_each(names, delete, "rm: cannot remove")


def cp(terminal: Terminal, words: list[str]) -> int:
    """`cp [-r] from… to`: copy files, and with -r folders."""
    letters, names = options(words, "rRafpv", "cp old.py new.py", least=2)

    def copy(source: Path) -> None:
        source.stat()
        target = _target(source, names[-1])
        if not source.is_dir():
            files.check(target)
            shutil.copy(str(source), str(target))
        elif not letters & {"r", "R", "a"}:
            raise IsADirectoryError(EISDIR, "Is a directory. cp -r copies a folder and everything in it")
        elif Path(os.path.realpath(target)).is_relative_to(source.resolve()):
            raise OSError(EINVAL, f"a folder cannot be copied into itself, '{target}'")
        else:
            files.copy(source.resolve(), target)

    return terminal.for_each(names[:-1], copy, "cp: cannot copy")


def mv(terminal: Terminal, words: list[str]) -> int:
    """`mv from… to`: rename or move files and folders."""
    _, names = options(words, "fiv", "mv old.py new.py", least=2)

    def move(source: Path) -> None:
        source.stat()
        target = _target(source, names[-1])
        files.check(source, removes=True)
        files.check(target, follow=False)
        os.replace(source, target)

    return terminal.for_each(names[:-1], move, "mv: cannot move")


def _target(source: Path, to: str) -> Path:
    """Where a file goes: into a folder that is there, or else to the name itself."""
    place = Path(to)
    return place / os.path.basename(os.path.realpath(source)) if place.is_dir() else place


# -- texts, and what a pipe leads to ---------------------------------------------------------------------------------


def _texts(terminal: Terminal, names: Iterable[str]) -> list[str]:
    """The files of these names, or else what a pipe gives."""
    found = [Path(name).read_text(encoding="utf-8", errors="replace") for name in names]
    return found or [terminal.given or ""]


def _lines(terminal: Terminal, names: Iterable[str]) -> list[str]:
    return [line for text in _texts(terminal, names) for line in text.splitlines()]


def cat(terminal: Terminal, words: list[str]) -> int:
    """`cat file…`: print files."""
    if not words and terminal.given is None:
        raise ValueError("name the files to print")
    terminal.stdout.write("".join(_texts(terminal, words)))
    return 0


def echo(terminal: Terminal, words: list[str]) -> int:
    """`echo [-n] [-e] words`: print words; -n without a line end, -e with `\\n` and its kin as what they stand for."""
    signs = ""
    while words and re.fullmatch("-[neE]+", words[0]):
        signs, words = signs + words[0], words[1:]
    text = " ".join(words)
    if "e" in signs:
        text = re.sub(r"\\([ntr\\])", lambda found: {"n": "\n", "t": "\t", "r": "\r"}.get(found[1], found[1]), text)
    terminal.stdout.write(text + ("" if "n" in signs else "\n"))
    return 0


def grep(terminal: Terminal, words: list[str]) -> int:
    """`… | grep [-i] [-v] [-c] pattern`: the lines with a pattern in them."""
    letters, [wanted, *names] = options(words, "civqE", "ros2 topic list | grep pose")
    pattern = re.compile(wanted if "E" in letters else re.escape(wanted), re.IGNORECASE if "i" in letters else 0)
    found = [line for line in _lines(terminal, names) if bool(pattern.search(line)) != ("v" in letters)]
    if "q" not in letters:
        terminal.say(*([len(found)] if "c" in letters else found))
    return 0 if found else 1


def head(terminal: Terminal, words: list[str]) -> int:
    """`… | head [-n number]`: the first lines."""
    count, names = 10, []
    following = iter(words)
    for word in following:
        if found := re.fullmatch(r"-n|-n?(\d+)", word):
            count = int(found[1] or next(following, 0))
        else:
            names.append(word)
    return terminal.say(*_lines(terminal, names)[:count])


def wc(terminal: Terminal, words: list[str]) -> int:
    """`… | wc -l`: how many lines."""
    _, rest = options(words, "l")
    return terminal.say(sum(text.count("\n") for text in _texts(terminal, rest)))


# -- jobs, kill, sleep -----------------------------------------------------------------------------------------------


def list_jobs(terminal: Terminal, words: list[str]) -> int:
    """`jobs`: what goes on."""
    for job in jobs(terminal.world).running:
        terminal.say(f"[{job.number}]  Running                 {job.words} &")
    return 0


def sleep(terminal: Terminal, words: list[str]) -> int:
    """`sleep SECONDS`: let robot time pass, in which the programs go on."""
    if len(words) != 1 or not re.fullmatch(r"\d{1,6}(\.\d{1,9})?s?", words[0]):
        raise ValueError("how long? Write it in seconds of robot time, as in sleep 0.5")
    run_for(terminal.world, float(words[0].rstrip("s")))
    return 0


def kill(terminal: Terminal, words: list[str]) -> int:
    """`kill [-INT] %1`, `kill [-INT] 1004`: end a job or a process."""
    name = "TERM"
    if words and words[0].startswith("-"):
        name = words[0].lstrip("-").removeprefix("SIG")
        name, words = next((sign for sign, number in SIGNALS.items() if name == str(number)), name), words[1:]
    if name not in SIGNALS:
        raise ValueError(f"{name}: invalid signal specification; there are {', '.join(SIGNALS)}")
    if not words:
        raise ValueError("which one? `jobs` lists what is running; kill -INT %1 is Ctrl-C for the first")
    missing = []
    for word in words:
        running: dict[str, Process | LaunchHandle] = {
            f"%{job.number}": job.what for job in jobs(terminal.world).running
        }
        running |= {str(process.pid): process for process in terminal.world.processes if process.alive}
        if word in running:
            send(running[word], name)
            terminal.world.sim.settle()
        else:
            missing.append(word[:60])
    if missing:
        raise ValueError(f"{', '.join(missing)}: no such job or process. `jobs` lists what is running")
    return 0


_WORDS = (
    cat, cd, chmod, cp, echo, export, grep, head, kill, ls, mkdir, mv, printenv, pwd, rm, sleep, touch, unset, wc,
)  # fmt: skip
BUILTINS: dict[str, Builtin] = {"jobs": list_jobs, **{word.__name__: word for word in _WORDS}}
