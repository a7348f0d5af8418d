"""The terminal's own words, beside ros2, colcon and source: those for folders and files, for texts, and for jobs."""

from __future__ import annotations

import os
import re
import shutil
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..idl.names import did_you_mean
from ..runtime import files
from ..runtime.world import run_for
from ..sim.errors import shown_path
from .jobs import SIGNALS, Builtin, Job, Terminal, export, jobs, options, printenv, send, unset

if TYPE_CHECKING:
    from ..sim.process import Process

# -- folders -----------------------------------------------------------------------------------------------------------


def cd(terminal: Terminal, words: list[str]) -> int:
    """`cd folder`, `cd ..`, `cd -`, `cd`: change the current folder."""
    if len(words) > 1:
        return terminal.fail("cd: too many arguments: a folder's name with a space in it needs quotes")
    target = Path(words[0]) if words else files.home()
    if words == ["-"]:
        target = Path(os.environ.get("OLDPWD", "."))
        terminal.say(shown_path(str(target)))
    before = Path.cwd()
    if not target.is_dir():
        what, close = "Not a directory" if target.exists() else "No such file or directory", ""
        if len(str(target)) <= 200 and target.parent.is_dir():
            close = did_you_mean(target.name, [path.name for path in target.parent.iterdir() if path.is_dir()])
        return terminal.fail(f"cd: {words[0]}: {what}. {close}".rstrip(" ."))
    os.chdir(target)
    os.environ["OLDPWD"] = str(before)
    files.last_cd = Path.cwd()
    return 0


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
        return terminal.fail("cat: name the files to print")
    terminal.stdout.write("".join(_texts(terminal, words)))
    return 0


def echo(terminal: Terminal, words: list[str]) -> int:
    """`echo [-n] [-e] words`: print words; -n without a line end, -e with `\\n` and its kin as what they stand for."""
    signs = ""
    while words and re.fullmatch("-[neE]+", words[0]):
        signs, words = signs + words[0], words[1:]
    text = " ".join(words)
    terminal.stdout.write((_unescaped(text) if "e" in signs else text) + ("" if "n" in signs else "\n"))
    return 0


def printf(terminal: Terminal, words: list[str]) -> int:
    """`printf FORMAT words`: print a text in which `\\n` is a line end and %s a word; further words use it once more."""
    if not words:
        return terminal.fail("printf: usage: printf format [arguments]", 2)
    shape, rest = _unescaped(words[0]), iter(words[1:])
    places = len(re.findall("%[sdi]", shape.replace("%%", "")))
    left = max(1, -(-len(words[1:]) // places)) if places else 1
    for _ in range(left):
        filled = re.sub("%([sdi%])", lambda found: "%" if found[1] == "%" else next(rest, ""), shape)
        terminal.stdout.write(filled)
    return 0


def _unescaped(text: str) -> str:
    return re.sub(r"\\([ntr\\])", lambda found: {"n": "\n", "t": "\t", "r": "\r"}.get(found[1], found[1]), text)


def grep(terminal: Terminal, words: list[str]) -> int:
    """`… | grep [-i] [-v] [-c] pattern`: the lines with a pattern in them."""
    letters, rest = options(words)
    if unknown := sorted(set(letters) - set("civqE")):
        return terminal.fail(
            f"grep: this terminal's knows -i, -v, -c, -q and -E, but no -{unknown[0]}: leave it out", 2
        )
    if not rest:
        return terminal.fail("grep: name the pattern to look for", 2)
    pattern = re.compile(rest[0] if "E" in letters else re.escape(rest[0]), re.IGNORECASE if "i" in letters else 0)
    lines = _lines(terminal, rest[1:])
    found = [line for line in lines if bool(pattern.search(line)) != ("v" in letters)]
    if "c" in letters:
        terminal.say(len(found))
    elif "q" not in letters:
        terminal.say(*found)
    return 0 if found else 1


def head(terminal: Terminal, words: list[str]) -> int:
    """`… | head [-n number]`: the first lines."""
    count, rest = _count(words)
    return terminal.say(*_lines(terminal, rest)[:count])


def tail(terminal: Terminal, words: list[str]) -> int:
    """`… | tail [-n number]`: the last lines."""
    count, rest = _count(words)
    lines = _lines(terminal, rest)
    return terminal.say(*lines[max(0, len(lines) - count) :])


def _count(words: list[str]) -> tuple[int, list[str]]:
    """The number behind `-n` or `-`, and the other words."""
    count, rest = 10, []
    waiting = iter(words)
    for word in waiting:
        found = re.fullmatch(r"-n?(\d+)", word)
        if word == "-n" or found:
            count = int(found[1] if found else next(waiting, 0))
        else:
            rest.append(word)
    return count, rest


def sort(terminal: Terminal, words: list[str]) -> int:
    """`… | sort [-r] [-u]`: the lines in order."""
    letters, rest = options(words)
    lines = _lines(terminal, rest)
    return terminal.say(*sorted(set(lines) if "u" in letters else lines, reverse="r" in letters))


def wc(terminal: Terminal, words: list[str]) -> int:
    """`… | wc -l`: how many lines."""
    _, rest = options(words)
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
        return terminal.fail("sleep: how long? Write it in seconds of robot time, as in sleep 0.5")
    run_for(terminal.world, float(words[0].rstrip("s")))
    return 0


def kill(terminal: Terminal, words: list[str]) -> int:
    """`kill [-INT] %1`, `kill [-INT] 1004`: end a job or a process."""
    name = "TERM"
    rest = list(words)
    while rest and rest[0].startswith("-"):
        name = rest.pop(0).lstrip("-").removeprefix("SIG")
        if name == "s" and rest:
            name = rest.pop(0).removeprefix("SIG")
        name = next((sign for sign, number in SIGNALS.items() if name == str(number)), name)
    if name not in SIGNALS:
        return terminal.fail(f"kill: {name}: invalid signal specification; there are {', '.join(SIGNALS)}")
    if not rest:
        return terminal.fail("kill: which one? `jobs` lists what is running; kill -INT %1 is Ctrl-C for the first")
    return max(_kill_one(terminal, word, name) for word in rest)


def _kill_one(terminal: Terminal, word: str, name: str) -> int:
    target: Job | Process | None = None
    if re.fullmatch(r"%\d{1,9}", word):
        target = next((job for job in jobs(terminal.world).running if job.number == int(word[1:])), None)
    elif re.fullmatch(r"\d{1,9}", word):
        target = next((each for each in terminal.world.processes if each.alive and each.pid == int(word)), None)
    else:
        return terminal.fail(f"kill: {word[:60]}: arguments must be process or job IDs, such as 1004 or %1")
    if target is None:
        what = "no such job" if word.startswith("%") else "No such process"
        return terminal.fail(f"kill: {word}: {what}. `jobs` lists what is running")
    if isinstance(target, Job):
        target.signal(name)
    else:
        send(target, name)
    terminal.world.sim.settle()
    return 0


_WORDS: tuple[Any, ...] = (
    cat, cd, chmod, cp, echo, export, grep, head, kill, ls, mkdir, mv, printenv, printf, pwd, rm, sleep, sort, tail, touch,
    unset, wc,
)  # fmt: skip
BUILTINS: dict[str, Builtin] = {"jobs": list_jobs, **{word.__name__: word for word in _WORDS}}
