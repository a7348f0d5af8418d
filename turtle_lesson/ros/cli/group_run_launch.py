"""`ros2 run` and `ros2 launch`: they start programs and return once these are up; the programs run while the world runs.

In a terminal both go on until Ctrl-C. Here a last line says how to end them, and `--for SECONDS` lets robot time pass first.
"""

from __future__ import annotations

import sys
from argparse import REMAINDER, ArgumentParser, Namespace
from collections.abc import Sequence
from io import StringIO
from pathlib import Path

from ..ament.index import changed_since_built
from ..ament.package import ExecutableNotFoundError
from ..launching.errors import LaunchError, find_launch_file
from ..launching.service import LaunchHandle, launch_file, show_arguments
from ..runtime.files import FileOutput
from ..runtime.world import current_world, run_for
from ..sim.errors import shown_path
from ..sim.process import Process
from .arguments import Argument, arg, cut, duration, either, flag
from .group_pkg import not_found, path_of
from .jobs import jobs, lasting
from .verb import CommandError, verb

LET_PASS = "let this much robot time pass before {} returns (only here)"
SIGNAL_TEXTS = {-2: "Interrupt", -9: "Killed", -15: "Terminated"}


def _words(name: str, text: str, nargs: str) -> Argument:
    """The words that go on to a program or a launch file; the usage has them as Python 3.11's, whatever the Python."""

    def add(parser: ArgumentParser) -> None:
        parser.add_argument(name, nargs=nargs, help=text).required = True

    return add


@verb(
    "run",
    arg("--prefix", "a program to run it with: accepted, but without effect here"),
    duration(LET_PASS.format("ros2 run")),
    arg("package_name", "package that the program belongs to"),
    arg("executable_name", "name of the program"),
    _words("argv", "arguments of the program itself, such as --ros-args -p a:=1", REMAINDER),
    in_cell=True,
)
def _run(args: Namespace) -> int:
    """Start a program of a package."""
    world = current_world()
    name = args.executable_name
    if args.package_name not in world.packages:
        raise not_found(args.package_name)
    package = world.packages.get(args.package_name)
    try:
        target = world.packages.executable(args.package_name, name)
    except ExecutableNotFoundError as error:
        raise CommandError("No executable found", error.hint if len(name) < 100 else "") from None
    if isinstance(target, Path) and not target.is_file():
        raise CommandError("No executable found", f"{target} no longer exists: build again.")
    if changed := changed_since_built(package):
        new = "was changed after the build: run colcon build to use the new version."
        print(shown_path(str(changed)), new, file=sys.stderr)
    process = world.spawn(
        target,
        name=name,
        argv=[str(path_of(package, name)), *args.argv],
        stdin=reader_of(getattr(args, "stdin", None)),
        stdout=lasting(sys.stdout, world.sim),
        stderr=lasting(sys.stderr, world.sim),
        on_exit=_say_how_it_ended,
    )
    return leave(process, " ".join(["ros2 run", args.package_name, name, *args.argv]), args.seconds)


def reader_of(text: str | None) -> StringIO | None:
    """What a program reads that is given a text as its input; None if it is given none."""
    return None if text is None else StringIO(text)


def _say_how_it_ended(process: Process) -> None:
    if code := process.exit_code:
        failure = f"Process exited with failure {code}"
        print(f"[ros2run]: {failure if code > 0 else SIGNAL_TEXTS.get(code, f'Signal {-code}')}", file=process.stdout)


NOTHING = "accepted, but without effect here"


@verb(
    "launch",
    flag("-n --noninteractive", NOTHING),
    flag("-d --debug", NOTHING),
    either(
        flag("-p --print --print-description", "not available here", dest="print"),
        flag("-s --show-args --show-arguments", "list the arguments it takes", dest="show"),
    ),
    flag("-a --show-all-subprocesses-output", "show all that programs print, whatever the file says", dest="all"),
    arg("--launch-prefix", NOTHING),
    arg("--launch-prefix-filter", NOTHING),
    duration(LET_PASS.format("ros2 launch")),
    arg("package_name", "package that the launch file belongs to, or the path of a launch file"),
    arg("launch_file_name", "name of the launch file", nargs="?"),
    _words("launch_arguments", "values for its arguments, as name:=value", "*"),
    in_cell=True,
)
def _launch(args: Namespace) -> int:
    """Start everything that a launch file describes."""
    world = current_world()
    try:
        path, words = _find(args)
        given = _pairs(words)
    except LaunchError as error:
        raise CommandError(error.reason, error.hint) from None
    try:
        if args.show:
            print(show_arguments(world, path))
            return 0
        if args.print:
            raise CommandError("--print is not available here", "--show-args lists what the launch file takes.")
        handle = launch_file(world, path, given, show_all_output=args.all)
    except LaunchError as error:
        print("\n".join(filter(None, (error.console, error.advice))))
        return 1
    typed = ["ros2 launch", args.package_name, args.launch_file_name or "", *args.launch_arguments]
    return leave(handle, " ".join(typed), args.seconds)


def _find(args: Namespace) -> tuple[Path, list[str]]:
    """The launch file that is meant, and the words after it."""
    name, file_name, words = args.package_name, args.launch_file_name, args.launch_arguments
    if len(name) < 1000 and Path(name).is_file():
        return Path(name), [*filter(None, [file_name]), *words]
    if "/" in name or name.endswith((".py", ".launch.xml", ".launch.yaml", ".launch.yml")):
        hint = "Name the package before the launch file, or give the path of a file that is there."
        raise CommandError(f"'{cut(name, 100)}' is not a valid package name", hint)
    return find_launch_file(current_world(), cut(name, 100), cut(str(file_name), 100)), words


def _pairs(words: Sequence[str]) -> dict[str, str]:
    """`name:=value` taken apart; of several for one name the last one counts."""
    given = {}
    for word in words:
        name, sign, value = word.partition(":=")
        if not sign or not name:
            hint = f"Did you mean '{word.replace('=', ':=', 1)}'?" if "=" in word and len(word) < 100 else ""
            raise CommandError(f"malformed launch argument '{cut(word, 100)}', expected format '<name>:=<value>'", hint)
        given[name] = value
    return given


def leave(what: Process | LaunchHandle, words: str, seconds: float | None) -> int:
    """Let it begin, say how to end it if it goes on, and leave it running."""
    world = current_world()
    job = jobs(world).add(words.strip(), what)
    simulators = len(world.graph.servers("/spawn"))
    if seconds is not None:
        world.sim.settle()
        run_for(world, seconds)
    elif isinstance(what, Process):
        world.sim.settle()
    else:
        what.wait_until_up()
    sys.stdout.flush()
    if job.running:
        cell = sys.stdout.instead_of if isinstance(sys.stdout, FileOutput) else sys.stdout
        stop = f"To stop it, as Ctrl-C would: kill -INT %{job.number}"
        print(f"[{job.number}] {cut(job.words, 200)} is still running. {stop}", file=cell)
        for twin in (each for each in jobs(world).running if each is not job and each.words == job.words):
            twice = f"The same command is running as [{twin.number}], so everything in it exists twice now."
            print(f"{twice} To stop that one: kill -INT %{twin.number}", file=cell)
        servers = world.graph.servers("/spawn")
        if len(servers) > simulators and any(each.node.process.name == "turtlesim" for each in servers):  # by start()
            twins = "Two simulators are running now, and both follow every command: start(simulator=False) starts none."
            print(twins, file=cell)
        return 0
    if not isinstance(what, Process):
        return 0  # that of `ros2 launch`, however its programs ended
    code = what.exit_code or 0
    return code if code >= 0 else 256 + code
