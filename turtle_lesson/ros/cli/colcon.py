"""`colcon`: its verbs `build` and `list`, their arguments, and what it says about wrong ones."""

from __future__ import annotations

import argparse
import os
import re
from pathlib import Path
from typing import TextIO

from ..ament.build import DEFAULTS, Builder
from ..ament.manifest import Found, build_type_hint, discover, in_order, needed_by
from ..ament.package import ColconError
from ..idl.names import did_you_mean
from ..runtime.world import World
from ..sim.simulation import NANOSECONDS
from .arguments import Argument, Parser, Stop, arg, either, flag

VERBS = (
    "build", "extension-points", "extensions", "graph", "info", "list", "metadata", "test", "test-result",
    "version-check",
)  # fmt: skip
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


def run(world: World, words: list[str], *, stdout: TextIO, stderr: TextIO, cwd: Path | None = None) -> int:
    """Carry out `colcon WORDS…` in a folder; return the exit code."""
    while words and words[0].partition("=")[0] in {"--log-base", "--log-level"}:
        words = words[1 if "=" in words[0] else 2 :]  # accepted, but without effect here
    if not words:
        stdout.write(_USAGE + "\n")
        stderr.write("Error: No verb provided\n")
        return 1
    verb = words[0]
    if verb in {"-h", "--help"}:
        stdout.write(_USAGE + _HELP)
        return 0
    if verb not in VERBS:
        choices = ", ".join(map(repr, VERBS))
        said = f"colcon: error: argument verb_name: invalid choice: {verb[:60]!r} (choose from {choices})\n"
        close = did_you_mean(verb[:60], VERBS)
        stderr.write(_USAGE + said + (f"{close}\n" if close else ""))
        return 2
    if verb not in _VERBS_HERE:
        tests = "; !python -m pytest src/<package>/test runs a package's tests" if verb.startswith("test") else ""
        stderr.write(f"colcon {verb} is not available here{tests or '; build and list are'}.\n")
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

    def _warn(self, text: str, module: str = "colcon.colcon_core.package_selection") -> None:
        self.err.write(f"[{self.clock()}s] WARNING:{module}:{text}\n")

    def run(self, words: list[str]) -> int:
        about, arguments = _VERBS_HERE[self.verb]
        parser = Parser(f"colcon {self.verb}", about, (*_SELECTION, *arguments))
        args, unknown = parser.parse_known_args(words)
        if getattr(args, "cmake_args", None) is not None:
            unknown = [word for word in unknown if not re.match("-[DGW]", word)]  # which CMake is to get
        if unknown:
            hint = did_you_mean(unknown[0].partition("=")[0][:60], parser.option_names())
            said = f"{_USAGE}colcon: error: unrecognized arguments: {' '.join(unknown)[:300]}"
            raise Stop(f"{said}\n{hint or f'{parser.prog} -h lists what it takes.'}", 2)
        found: dict[Path, Found] = {}
        for base in args.base_paths or ["."]:
            folder = (self.cwd / base).resolve()
            if os.path.isdir(folder):
                found |= {each.path: each for each in discover(folder, self.cwd)}
            else:
                self._warn(f"the base path '{base[:100]}' doesn't exist", "colcon.colcon_core.package_discovery")
        workspace = list(found.values())
        names = self._chosen(args, workspace)
        chosen = [each for each in workspace if each.name in names]
        return self._list(args, chosen) if self.verb == "list" else self._build(args, chosen, workspace)

    def _chosen(self, args: argparse.Namespace, workspace: list[Found]) -> set[str]:
        """The names of the packages that the options leave. Those of --packages-up-to must be there."""
        chosen = names = {each.name for each in workspace}
        for option in ("up_to", "select", "skip"):
            given = getattr(args, f"packages_{option}")
            spelt = f"--packages-{option.replace('_', '-')}"
            for name in given or ():
                if name in names:
                    continue
                there = f"There are: {', '.join(sorted(names))}."
                hint = f"\nHint: {did_you_mean(name, names) or there}" if names else ""
                if option == "up_to":
                    raise Stop(f"Package '{name[:80]}' specified with {spelt} was not found{hint}", 1)
                self._warn(f"ignoring unknown package '{name[:80]}' in {spelt}{hint}")
            if given is not None and option == "skip":
                chosen = chosen - set(given)
            elif given is not None:
                chosen = chosen & (needed_by(workspace, given) if option == "up_to" else set(given))
        return chosen

    def _list(self, args: argparse.Namespace, chosen: list[Found]) -> int:
        ordered = in_order(chosen)
        for each in ordered if args.topological_order else sorted(chosen, key=lambda each: each.name):
            line = f"{each.name}\t{each.shown}\t({each.kind})"
            self.out.write((each.name if args.names_only else each.shown if args.paths_only else line) + "\n")
        return 0

    def _build(self, args: argparse.Namespace, chosen: list[Found], workspace: list[Found]) -> int:
        for each in chosen:
            if not each.buildable:
                text = f"No task extension to 'build' a '{each.kind}' package"
                self._warn(text, "colcon.colcon_core.verb")
                place = f"{each.shown}/package.xml"
                self.err.write(f"Hint: {place}: the build_type is unknown. {build_type_hint(each.build_type)}\n")
        if not workspace:
            where = "Are you in the workspace's folder, which contains src/?"
            self.err.write(f"Hint: no folder here has a package.xml; ros2 pkg create makes one. {where}\n")
        builder = Builder(
            world=self.world,
            packages=chosen,
            install=self.cwd / args.install_base,
            build=self.cwd / args.build_base,
            log=self.cwd / "log",
            workspace=workspace,
            symlink=args.symlink_install,
            layout="merged" if args.merge_install else "isolated",
            go_on=args.continue_on_error,
            workers=1 if args.executor == "sequential" else max(1, args.parallel_workers),
            handlers=DEFAULTS | {word[:-1]: word.endswith("+") for word in args.event_handlers},
            out=self.out,
            err=self.err,
        )
        for folder in (builder.install, builder.build):
            if any(each.path.is_relative_to(folder.resolve() / each.name) for each in workspace):
                raise ColconError(f"{folder.name} is the folder of the sources; choose another folder")
        if self.cwd.name == "src" and workspace and not (self.cwd / "src").is_dir():
            self.err.write("Hint: install/ is made here, in src/; packages are usually built in the folder above.\n")
        return builder.run()


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
    arg(
        "--event-handlers",
        "e.g. console_direct+ shows all output",
        nargs="*",
        choices=[f"{name}{sign}" for name in DEFAULTS for sign in "+-"],
        default=[],
        metavar="NAME+",
    ),
    arg("--cmake-args", "accepted, but without effect here", nargs="*", metavar="*"),
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
