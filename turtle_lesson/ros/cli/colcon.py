"""`colcon`: its verbs `build` and `list`, their arguments, and what it says about wrong ones."""

from __future__ import annotations

import argparse
import os
from pathlib import Path
from typing import TYPE_CHECKING, TextIO

from ..ament.build import DEFAULTS, Plan, build
from ..ament.index import CMAKE_PACKAGES, PYTHON_PACKAGES
from ..ament.install_tree import needs_of, prefix_of
from ..ament.manifest import Found, build_type_hint, discover, in_order, needed_by
from ..ament.package import ColconError, filled
from ..idl.names import did_you_mean
from ..idl.registry import INSTALLED_SEPARATELY, Registry
from ..sim.errors import shown_path
from ..sim.simulation import NANOSECONDS
from .arguments import Argument, Parser, Stop, arg, either, flag

if TYPE_CHECKING:
    from ..runtime.world import World


VERBS = (
    "build", "extension-points", "extensions", "graph", "info", "list", "metadata", "test", "test-result",
    "version-check",
)  # fmt: skip
_INSTEAD = {
    "info": "colcon list shows the packages, and each package.xml says more about its package.",
    "test": "run a package's tests with pytest: !python -m pytest src/<package>/test",
    "test-result": "pytest itself says how the tests went.",
}
_USAGE = f"""\
usage: colcon [-h] [--log-base LOG_BASE] [--log-level LOG_LEVEL]
              {{{",".join(VERBS)}}}
              ...
"""
_HELP = """\

Build the packages of a workspace, each one after those that it depends on.

verbs:
  build   build packages and install them into install/ (colcon build -h says more)
  list    show the packages below this folder: name, place, type
"""
_ROS = "/opt/ros/humble"


_SILENT = {
    "compile_commands", "desktop_notification", "event_log", "log", "log_command", "status", "store_result",
    "terminal_title",
}  # fmt: skip
"""Event handlers that exist, and of which nothing is seen in a page."""


def run(world: World, words: list[str], *, stdout: TextIO, stderr: TextIO, cwd: Path | None = None) -> int:
    """Carry out `colcon WORDS…` in a folder; return the exit code."""
    while words and words[0].partition("=")[0] in {"--log-base", "--log-level"}:
        words = words[1 if "=" in words[0] else 2 :]  # accepted, but without effect here
    if not words:
        stdout.write(_USAGE + "\n")
        stderr.write("Error: No verb provided\n")
        return 1
    if words[0] in {"-h", "--help"}:
        stdout.write(_USAGE + _HELP)
        return 0
    verb = words[0]
    if verb not in VERBS:
        choices = ", ".join(map(repr, VERBS))
        said = f"colcon: error: argument verb_name: invalid choice: {verb[:60]!r} (choose from {choices})\n"
        close = did_you_mean(verb[:60], VERBS)
        stderr.write(_USAGE + said + (f"{close}\n" if close else ""))
        return 2
    if verb not in _VERBS_HERE:
        instead = _INSTEAD.get(verb, "build and list are.")
        stderr.write(f"colcon {verb} is not available here; {instead}\n")
        return 1
    command = _Command(world, verb, stdout, stderr, (cwd or Path.cwd()).resolve())
    try:
        return command.run(words[1:])
    except Stop as stop:
        return stop.print(stdout, stderr)
    except OSError as error:
        named = f": {str(error.filename)[:100]}" if error.filename else ""
        reason = f"{error.strerror or error}{named}"
    except (ColconError, ValueError, RuntimeError) as error:  # also an unusable folder, or a loop of links
        reason = str(error)
    stderr.write(f"[{command.clock()}s] ERROR:colcon:colcon {verb}: {reason}\n")
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
        chosen = self._chosen(args, found)
        if self.verb == "list":
            return self._list(args, chosen)
        return self._build(args, chosen, found)

    def _parse(self, words: list[str]) -> argparse.Namespace:
        about, arguments = _VERBS_HERE[self.verb]
        parser = Parser(f"colcon {self.verb}", about, (*_SELECTION, *arguments))
        args, unknown = parser.parse_known_args(_without_cmake_arguments(words, parser))
        if unknown:
            hint = did_you_mean(unknown[0].partition("=")[0][:60], parser.option_names())
            said = f"{_USAGE}colcon: error: unrecognized arguments: {' '.join(unknown)[:300]}"
            raise Stop(f"{said}\n{hint or f'{parser.prog} -h lists what it takes.'}", 2)
        return args

    def _warn(self, text: str, module: str = "colcon.colcon_core.package_selection") -> None:
        self.err.write(f"[{self.clock()}s] WARNING:{module}:{text}\n")

    def _found(self, args: argparse.Namespace) -> list[Found]:
        found: list[Found] = []
        for base in args.base_paths or ["."]:
            folder = (self.cwd / base).resolve()
            if not os.path.isdir(folder):
                self._warn(f"the base path '{base[:100]}' doesn't exist", "colcon.colcon_core.package_discovery")
                continue
            found += [each for each in discover(folder, self.cwd) if each.path not in {other.path for other in found}]
        return found

    def _chosen(self, args: argparse.Namespace, found: list[Found]) -> list[Found]:
        """The packages that the options leave."""
        names = {each.name for each in found}
        self._check_names(args, names)
        chosen = set(names)
        if args.packages_select is not None:
            chosen &= set(args.packages_select)
        if args.packages_up_to is not None:
            chosen &= needed_by(found, args.packages_up_to)
        chosen -= set(args.packages_skip or [])
        return [each for each in found if each.name in chosen]

    def _check_names(self, args: argparse.Namespace, names: set[str]) -> None:
        """Names of packages that are not there: some options need theirs, others do without."""
        there = f"There are: {', '.join(sorted(names))}."
        for option in ("up_to", "select", "skip"):
            given = getattr(args, f"packages_{option}") or []
            spelt = f"--packages-{option.replace('_', '-')}"
            for name in given:
                if name in names:
                    continue
                hint = f"\nHint: {did_you_mean(name, names) or there}" if names else ""
                if option in {"select", "skip"}:
                    self._warn(f"ignoring unknown package '{name[:80]}' in {spelt}{hint}")
                else:
                    raise Stop(f"Package '{name[:80]}' specified with {spelt} was not found{hint}", 1)

    def _list(self, args: argparse.Namespace, chosen: list[Found]) -> int:
        ordered = in_order(chosen)
        for each in ordered if args.topological_order else sorted(chosen, key=lambda each: each.name):
            line = f"{each.name}\t{each.shown}\t({each.kind})"
            self.out.write((each.name if args.names_only else each.shown if args.paths_only else line) + "\n")
        return 0

    def _build(self, args: argparse.Namespace, chosen: list[Found], found: list[Found]) -> int:
        for each in chosen:
            if not each.buildable:
                text = f"No task extension to 'build' a '{each.kind}' package"
                self._warn(text, "colcon.colcon_core.verb")
                place = f"{each.shown}/package.xml"
                self.err.write(f"Hint: {place}: the build_type is unknown. {build_type_hint(each.build_type)}\n")
        if not found:
            where = "its src/" if (self.cwd / "src").is_dir() else "it"
            above = self.cwd.parent / "src"
            hint = "Go to the workspace first: cd .." if above.is_dir() and above != self.cwd else ""
            text = f"Hint: no folder in {where} has a package.xml; ros2 pkg create makes one. {hint}".rstrip()
            self.err.write(f"{text}\n")
        if text := overridden(self.world, chosen, self.cwd / args.install_base, args.allow_overriding):
            self._warn(text)
        plan = Plan(
            packages=chosen,
            install=self.cwd / args.install_base,
            build=self.cwd / args.build_base,
            log=self.cwd / "log",
            workspace=found,
            symlink=args.symlink_install,
            merged=args.merge_install,
            go_on=args.continue_on_error,
            workers=1 if args.executor == "sequential" else max(1, args.parallel_workers),
            handlers=self._handlers(args.event_handlers or []),
        )
        for folder in (plan.install, plan.build):
            if folder.exists() and not folder.is_dir():
                raise ColconError(f"{folder.name} is a file; it must be a folder")
            if any(each.path.is_relative_to(folder.resolve() / each.name) for each in found):
                raise ColconError(f"{folder.name} is the folder of the sources; choose another folder")
        if self.cwd.name == "src" and found and not (self.cwd / "src").is_dir():
            self.err.write(
                "Hint: this is src/, so install/ is made in it. Packages are usually built in the folder above.\n"
            )
        return build(self.world, plan, stdout=self.out, stderr=self.err)

    def _handlers(self, words: list[str]) -> dict[str, bool]:
        handlers = {}
        for word in words:
            name, sign = word[:-1], word[-1:]
            known = sorted({*DEFAULTS, *_SILENT})
            if sign not in {"+", "-"} or name not in known:
                text = f"--event-handlers: '{word[:60]}' is not NAME+ or NAME-."
                hint = did_you_mean(name if sign in {"+", "-"} else word, known) or f"Known are {', '.join(known)}."
                raise ColconError(f"{text} {hint}")
            if name in DEFAULTS:
                handlers[name] = sign == "+"
        return handlers


_CMAKE_ARGUMENTS = {"--cmake-args", "--ament-cmake-args", "--catkin-cmake-args"}


def _without_cmake_arguments(words: list[str], parser: Parser) -> list[str]:
    """The words without what CMake is to get, such as `-DCMAKE_BUILD_TYPE=Release` after `--cmake-args`."""
    options = {option for action in parser.actions for option in action.option_strings}
    kept: list[str] = []
    for_cmake = False
    for word in words:
        for_cmake = word in _CMAKE_ARGUMENTS or (for_cmake and word not in options)
        if not for_cmake:
            kept.append(word)
    return kept


_WITHOUT_EFFECT = "accepted, but without effect here"
_SELECTION = (
    arg("--base-paths", "folders to look for packages in (default: .)", nargs="*", metavar="PATH"),
    arg("--packages-up-to", "these packages and all that they depend on", nargs="*", metavar="PKG_NAME"),
    arg("--packages-select", "only these packages", nargs="*", metavar="PKG_NAME"),
    arg("--packages-skip", "all packages except these", nargs="*", metavar="PKG_NAME"),
)
_BUILD: tuple[Argument, ...] = (
    arg("--build-base", "folder for intermediate files (default: build)", default="build"),
    arg("--install-base", "folder for installed files (default: install)", default="install"),
    flag("--merge-install", "one folder for all packages instead of one for each"),
    flag("--symlink-install", "link to the files in src/, so that an edit takes effect at once"),
    flag("--continue-on-error", "continue with the packages that do not depend on a failed one"),
    arg("--executor", "whether to build several packages at a time", choices=["parallel", "sequential"]),
    arg("--parallel-workers", "how many packages to build at a time", type=int, default=4, metavar="NUMBER"),
    arg("--event-handlers", "e.g. console_direct+ shows all output", nargs="*", metavar="NAME+"),
    *(arg(option, _WITHOUT_EFFECT, nargs="*", metavar="*") for option in sorted(_CMAKE_ARGUMENTS)),
    arg("--allow-overriding", "of an underlay", nargs="+", default=[], metavar="PKG_NAME"),
    *(flag(f"--cmake-{what}", _WITHOUT_EFFECT) for what in ("clean-first", "clean-cache", "force-configure")),
)
_LIST: tuple[Argument, ...] = (
    either(flag("--names-only -n", "show only the names"), flag("--paths-only -p", "show only the places")),
    flag("-t --topological-order", "order them so that each comes after those it depends on"),
)
_VERBS_HERE = {
    "build": ("Build the packages below this folder, and install them into install/.", _BUILD),
    "list": ("Show the packages below this folder.", _LIST),
}
"""What each verb does, and its own arguments."""


def overridden(world: World, chosen: list[Found], install: Path, allowed: list[str]) -> str:
    """The warning about packages that are built although an underlay has them, and other packages there need them.

    It is empty where there are none. The last package of a chain, on which nothing else depends (such as robot_controller), may
    be overridden without a word. Facts: colcon-override-check 0.0.1, which comes with ROS 2.
    """
    built_in = {*CMAKE_PACKAGES, *PYTHON_PACKAGES, *Registry().packages()} - INSTALLED_SEPARATELY
    install = install.resolve()
    outside = {  # in other install folders
        each.name: each.prefix
        for each in world.packages
        if each.prefix and each.prefix not in {install, prefix_of(install, each.prefix.name)}
    }
    needed = {
        other: shown_path(str(outside[other]))
        for name, prefix in outside.items()
        for other in needs_of(prefix, name)
        if other in outside
    }
    places: dict[str, str] = {}
    for found in chosen:
        if found.name in allowed:
            continue
        if found.name in built_in:
            places[found.name] = _ROS
        elif found.name in needed:
            places[found.name] = needed[found.name]
    where = "\n\t".join(f"'{name}' is in: {place}" for name, place in places.items())
    if not places:
        return ""
    return filled("colcon: what is overridden", where=where, names=" ".join(sorted(places))).removesuffix("\n")
