"""`colcon`: its verbs `build`, `list` and `graph`, their arguments, and what it says about wrong ones."""

from __future__ import annotations

import argparse
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, NoReturn, TextIO

from ..core import NANOSECONDS
from .build import Plan, build
from .console import DEFAULTS, OTHERS
from .discover import ColconError, Found, build_type_hint, discover, in_order, needed_by
from .errors import did_you_mean

if TYPE_CHECKING:
    from ..world import World

VERBS = (
    "build", "extension-points", "extensions", "graph", "info", "list", "metadata", "test", "test-result",
    "version-check",
)  # fmt: skip
_HERE = ("build", "graph", "list")
_USAGE = (
    "usage: colcon [-h] [--log-base LOG_BASE] [--log-level LOG_LEVEL]\n              {{{verbs}}}\n              ...\n"
)
_HELP = """\

Build the packages of a workspace, each after those it needs.

verbs:
  build   build packages and install them into install/ (colcon build -h says more)
  list    show the packages below this folder: name, place, type
  graph   show which package depends on which
"""


class _Exit(Exception):
    """The command ends with this exit code."""

    def __init__(self, code: int) -> None:
        super().__init__(code)
        self.code = code


class _Parser(argparse.ArgumentParser):
    """An argument parser that prints to the command's own streams."""

    out: TextIO
    err: TextIO

    def _print_message(self, message: str, file: object = None) -> None:
        self.out.write(message)

    def exit(self, status: int = 0, message: str | None = None) -> NoReturn:
        """End the command."""
        if message:
            self.err.write(message)
        raise _Exit(status)

    def error(self, message: str) -> NoReturn:
        """Say what is wrong with the arguments."""
        self.err.write(f"{self.format_usage()}{self.prog}: error: {message[:300]}\n{self._advice(message)}")
        raise _Exit(2)

    def _advice(self, message: str) -> str:
        _, _, given = message.partition("unrecognized arguments: ")
        options = [option for action in self._actions for option in action.option_strings if option.startswith("--")]
        hint = did_you_mean(given.split()[0][:60], options) if given.strip() else ""
        return f"{hint}\n" if hint else ""


def run(world: World, words: list[str], *, stdout: TextIO, stderr: TextIO, cwd: Path | None = None) -> int:
    """Carry out `colcon WORDS…` in a folder; return the exit code."""
    usage = _USAGE.format(verbs=",".join(VERBS))
    while words[:1] in (["--log-base"], ["--log-level"]):
        words = words[2:]  # taken, and without effect here
    if not words:
        stdout.write(usage + "\n")
        stderr.write("Error: No verb provided\n")
        return 1
    if words[0] in {"-h", "--help"}:
        stdout.write(usage + _HELP)
        return 0
    verb = words[0]
    if verb not in VERBS:
        choices = ", ".join(map(repr, VERBS))
        said = f"colcon: error: argument verb_name: invalid choice: {verb[:60]!r} (choose from {choices})\n"
        close = did_you_mean(verb[:60], VERBS)
        stderr.write(usage + said + (f"{close}\n" if close else ""))
        return 2
    if verb not in _HERE:
        stderr.write(f"colcon {verb} is not there in this classroom; build, list and graph are.\n")
        return 1
    command = _Command(world, verb, stdout, stderr, (cwd or Path.cwd()).resolve())
    try:
        return command.run(words[1:])
    except _Exit as end:
        return end.code
    except ColconError as error:
        stderr.write(f"[{command.clock()}s] ERROR:colcon:colcon {verb}: {error}\n")
        return 1
    except (OSError, ValueError) as error:  # a folder that cannot be read, written or even named
        reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        named = f": {str(error.filename)[:100]}" if isinstance(error, OSError) and error.filename else ""
        stderr.write(f"[{command.clock()}s] ERROR:colcon:colcon {verb}: {reason}{named}\n")
        return 1


class _Command:
    """One `colcon` command."""

    def __init__(self, world: World, verb: str, out: TextIO, err: TextIO, cwd: Path) -> None:
        self.world = world
        self.verb = verb
        self.out, self.err = out, err
        self.cwd = cwd
        self.began = world.now

    def clock(self) -> str:
        """What colcon writes before its warnings: the seconds since it began."""
        return f"{(self.world.now - self.began) / NANOSECONDS + 0.2:.3f}"

    def run(self, words: list[str]) -> int:
        args = self._parse(words)
        found = self._found(args)
        chosen = self._choose(args, found)
        if self.verb == "list":
            return self._list(args, chosen)
        if self.verb == "graph":
            return self._graph(chosen)
        return self._build(args, chosen, found)

    def _parse(self, words: list[str]) -> argparse.Namespace:
        parser = _Parser(
            f"colcon {self.verb}",
            description=_DESCRIPTIONS[self.verb],
            allow_abbrev=False,
            formatter_class=lambda prog: argparse.HelpFormatter(prog, width=80),
        )
        parser.out, parser.err = self.out, self.err
        _add_selection(parser)
        if self.verb == "build":
            _add_build(parser)
        elif self.verb == "list":
            parser.add_argument("-n", "--names-only", action="store_true", help="show the names alone")
            parser.add_argument("-p", "--paths-only", action="store_true", help="show the places alone")
            parser.add_argument("-t", "--topological-order", action="store_true", help="each after those it needs")
        return parser.parse_args(_without_cmake_arguments(words, parser))

    def _warn(self, text: str, module: str = "colcon.colcon_core.package_selection") -> None:
        self.err.write(f"[{self.clock()}s] WARNING:{module}:{text}\n")

    def _found(self, args: argparse.Namespace) -> list[Found]:
        found: list[Found] = []
        for base in args.base_paths or ["."]:
            folder = (self.cwd / base).resolve()
            if not folder.is_dir():
                self._warn(f"the base path '{base}' doesn't exist", "colcon.colcon_core.package_discovery")
                continue
            found += [each for each in discover(folder, self.cwd) if each.path not in {other.path for other in found}]
        return found

    def _choose(self, args: argparse.Namespace, found: list[Found]) -> list[Found]:
        names = {each.name for each in found}
        for option in ("packages_select", "packages_up_to", "packages_skip", "packages_ignore"):
            for name in getattr(args, option) or []:
                if name not in names:
                    flag = "--" + option.replace("_", "-")
                    self._warn(f"ignoring unknown package '{name[:80]}' in {flag}")
                    self._suggest(name, names)
        chosen = set(names)
        if args.packages_select:
            chosen &= set(args.packages_select)
        if args.packages_up_to:
            chosen &= needed_by(found, args.packages_up_to)
        chosen -= set(args.packages_skip or []) | set(args.packages_ignore or [])
        return [each for each in found if each.name in chosen]

    def _suggest(self, name: str, names: Iterable[str]) -> None:
        hint = did_you_mean(name, names) or (f"There are: {', '.join(sorted(names))}." if names else "")
        if hint:
            self.err.write(f"Hint: {hint}\n")

    def _list(self, args: argparse.Namespace, chosen: list[Found]) -> int:
        ordered = in_order(chosen) if args.topological_order else sorted(chosen, key=lambda each: each.name)
        for each in ordered:
            line = f"{each.name}\t{each.shown}\t({each.kind})"
            self.out.write((each.name if args.names_only else each.shown if args.paths_only else line) + "\n")
        return 0

    def _graph(self, chosen: list[Found]) -> int:
        ordered = in_order(chosen)
        width = max((len(each.name) for each in ordered), default=0)
        for place, each in enumerate(ordered):
            marks = ["*" if each.name in other.dependencies else "." for other in ordered[place + 1 :]]
            self.out.write(
                f"{each.name.ljust(width)}{' ' * (place + 1)}+{''.join(marks).replace('.', ' ')}".rstrip() + "\n"
            )
        return 0

    def _build(self, args: argparse.Namespace, chosen: list[Found], found: list[Found]) -> int:
        for each in chosen:
            if not each.buildable:
                text = f"No task extension to 'build' a '{each.kind}' package"
                self._warn(text, "colcon.colcon_core.verb")
                place = f"{each.shown}/package.xml"
                self.err.write(f"Hint: {place}: the build_type is unknown. {build_type_hint(each.build_type)}\n")
        if not found:
            self._nothing()
        plan = Plan(
            base=self.cwd,
            packages=chosen,
            install=self.cwd / args.install_base,
            build=self.cwd / args.build_base,
            log=self.cwd / "log",
            symlink=args.symlink_install,
            go_on=args.continue_on_error,
            workers=1 if args.executor == "sequential" else max(1, args.parallel_workers),
            handlers=self._handlers(args.event_handlers or []),
        )
        for folder in (plan.install, plan.build):
            if folder.exists() and not folder.is_dir():
                raise ColconError(f"{folder.name} is a file; it must be a folder")
            if any(each.path.is_relative_to(folder.resolve() / each.name) for each in found):
                raise ColconError(f"{folder.name} is where the source lies; choose another folder")
        if self.cwd.name == "src" and found and not (self.cwd / "src").is_dir():
            self.err.write("Hint: this is src/, so install/ is made in it. Usually one builds in the folder above.\n")
        return build(self.world, plan, stdout=self.out, stderr=self.err)

    def _nothing(self) -> None:
        where = "its src/" if (self.cwd / "src").is_dir() else "it"
        above = self.cwd.parent / "src"
        hint = "Go to the workspace first: cd .." if above.is_dir() and above != self.cwd else ""
        text = f"Hint: no folder in {where} has a package.xml; ros2 pkg create makes one. {hint}".rstrip()
        self.err.write(f"{text}\n")

    def _handlers(self, words: list[str]) -> dict[str, bool]:
        handlers = {}
        for word in words:
            name, sign = word[:-1], word[-1:]
            if sign not in {"+", "-"} or name not in {*DEFAULTS, *OTHERS}:
                known = sorted({*DEFAULTS, *OTHERS})
                text = f"--event-handlers: '{word[:60]}' is not NAME+ or NAME-."
                hint = did_you_mean(name if sign in {"+", "-"} else word, known) or f"Known are {', '.join(known)}."
                raise ColconError(f"{text} {hint}")
            if name in DEFAULTS:
                handlers[name] = sign == "+"
        return handlers


_DESCRIPTIONS = {
    "build": "Build the packages below this folder, and install them into install/.",
    "list": "Show the packages below this folder.",
    "graph": "Show which package depends on which: a * where the one above needs that one.",
}


def _without_cmake_arguments(words: list[str], parser: argparse.ArgumentParser) -> list[str]:
    """The words without what CMake is to get, such as `-DCMAKE_BUILD_TYPE=Release` after `--cmake-args`."""
    options = {option for action in parser._actions for option in action.option_strings}
    kept: list[str] = []
    for_cmake = False
    for word in words:
        for_cmake = word == "--cmake-args" or (for_cmake and word not in options)
        if not for_cmake:
            kept.append(word)
    return kept


def _add_selection(parser: argparse.ArgumentParser) -> None:
    many = {"nargs": "*", "metavar": "PKG_NAME"}
    parser.add_argument("--base-paths", nargs="*", metavar="PATH", help="folders to look for packages in (default: .)")
    parser.add_argument("--packages-select", help="these packages alone", **many)  # type: ignore[arg-type]
    parser.add_argument("--packages-up-to", help="these and all that they need", **many)  # type: ignore[arg-type]
    parser.add_argument("--packages-skip", help="all but these", **many)  # type: ignore[arg-type]
    parser.add_argument("--packages-ignore", help="as if these were not there", **many)  # type: ignore[arg-type]


def _add_build(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--build-base", default="build", help="folder for what is made on the way (default: build)")
    parser.add_argument("--install-base", default="install", help="folder for what is installed (default: install)")
    parser.add_argument(
        "--symlink-install", action="store_true", help="link to the files in src/, so that an edit counts at once"
    )
    parser.add_argument("--continue-on-error", action="store_true", help="go on with packages that need no failed one")
    parser.add_argument("--executor", choices=["parallel", "sequential"], default="parallel", help="several at a time?")
    parser.add_argument("--parallel-workers", type=int, default=4, metavar="NUMBER", help="how many at a time")
    parser.add_argument("--event-handlers", nargs="*", metavar="NAME+", help="e.g. console_direct+ shows all output")
    parser.add_argument("--cmake-args", nargs="*", metavar="*", help="taken, and without effect here")
    parser.add_argument("--cmake-clean-cache", action="store_true", help="taken, and without effect here")
    parser.add_argument("--cmake-force-configure", action="store_true", help="taken, and without effect here")
