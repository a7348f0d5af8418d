"""`colcon build`: takes the packages in order, several at a time, installs what each one comes to, and prints what happens.

The time that a build takes is robot time, the same on every computer. Facts on what is printed: the event handlers of
colcon-core 0.10 and colcon-output 0.2.
"""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, TextIO

from ..idl.names import LOWER_CASE
from ..idl.registry import Registry, registry
from ..runtime import files
from ..sim.errors import shown_path
from ..sim.simulation import NANOSECONDS
from ..sim.strand import running_strand
from .ament_cmake import build_ament_cmake
from .ament_python import build_ament_python
from .install_tree import (
    Environment,
    Outcome,
    install_package,
    installed_names,
    prefix_of,
    prepare,
    read_installed,
    write_setup_files,
)
from .interfaces import definitions
from .manifest import Found, in_order, needed_by
from .source import resource

if TYPE_CHECKING:
    from ..runtime.world import World


_BEGIN, _END = 0.1, 0.1
"""What colcon takes before its first package and after its last, in s."""
DEFAULTS = {
    "console_cohesion": False,
    "console_direct": False,
    "console_package_list": False,
    "console_start_end": True,
    "console_stderr": True,
    "summary": True,
}
OTHERS = {
    "compile_commands", "desktop_notification", "event_log", "log", "log_command", "status", "store_result",
    "terminal_title",
}  # fmt: skip
"""Handlers that exist, and of which nothing is seen in a page."""


@dataclass
class Plan:
    """What one `colcon build` was asked for."""

    base: Path
    packages: list[Found]
    workspace: list[Found]
    install: Path
    build: Path
    log: Path
    symlink: bool = False
    merged: bool = False
    go_on: bool = False
    workers: int = 4
    handlers: dict[str, bool] = field(default_factory=dict)


@dataclass
class _Job:
    found: Found
    outcome: Outcome
    began: float

    @property
    def ends(self) -> float:
        return self.began + self.outcome.seconds


def build(world: World, plan: Plan, *, stdout: TextIO, stderr: TextIO) -> int:
    """Build the plan's packages; return colcon's exit code."""
    return _Builder(world, plan, Console(plan.handlers, stdout, stderr)).run()


class _Builder:
    """One run of `colcon build`."""

    def __init__(self, world: World, plan: Plan, console: Console) -> None:
        self.world = world
        self.plan = plan
        self.console = console
        self.now = 0.0
        self.code = 0
        self.log: dict[str, Outcome] = {}
        self.waiting = [found for found in in_order(plan.packages) if found.buildable]
        self.running: list[_Job] = []
        self.done: set[str] = set()

    def run(self) -> int:
        layout = "merged" if self.plan.merged else "isolated"
        prepare(self.plan.install, self.plan.build, self.plan.log, layout)
        queued = len(self.waiting)
        self._pass(_BEGIN)
        self.console.queued([found.name for found in self.waiting])
        while self.waiting or self.running:
            self._start()
            if not self.running:
                break  # what is left depends on what failed
            self._end(min(self.running, key=lambda job: job.ends))
            if self.code and not self.plan.go_on:
                for job in self.running:
                    self.console.aborted(job.found.name, self.now - job.began + 0.05)
                break
        write_setup_files(self.plan.install, installed_names(self.plan.install))
        self._pass(_END)
        self.console.summary(self.now, queued)
        self._warn_of_cpp()
        self._write_log()
        return self.code

    def _pass(self, seconds: float) -> None:
        self.now += seconds
        pass_time(self.world, seconds)

    def _start(self) -> None:
        own = {found.name for found in self.plan.packages if found.buildable}
        for found in list(self.waiting):
            if len(self.running) >= self.plan.workers:
                return
            if set(found.dependencies) & own - {found.name} <= self.done:
                self.waiting.remove(found)
                self.console.started(found.name)
                self.running.append(_Job(found, self._outcome(found), self.now))

    def _outcome(self, found: Found) -> Outcome:
        if missing := self._missing(found):
            return Outcome(1, seconds=0.01, colcon_error=missing)
        environment = self._environment(found)
        return (build_ament_python if found.is_python else build_ament_cmake)(found, environment)

    def _missing(self, found: Found) -> str:
        """What colcon says where packages of this workspace are needed and neither built nor sourced."""
        needed = needed_by(self.plan.workspace, [found.name]) - {found.name, *self.world.packages.names()}
        order = [each.name for each in self.plan.workspace if each.name in needed]
        there = set(installed_names(self.plan.install))
        lacking = [name for name in order if name not in there]
        if not lacking:
            return ""
        files = [shown_path(str(prefix_of(self.plan.install, name) / f"share/{name}/package.sh")) for name in lacking]
        text = "\n- ".join(["Failed to find the following files:", *files])
        text += "\n- ".join(["\nCheck that the following packages have been built:", *lacking])
        return f"{text}\nHint: colcon build --packages-up-to {found.name} builds them first."

    def _end(self, job: _Job) -> None:
        self._pass(max(0.0, job.ends - self.now))
        self.running.remove(job)
        found, outcome = job.found, job.outcome
        if outcome.code == 0:
            self._install(found, outcome)
        self.log[found.name] = outcome
        self.code = self.code or outcome.code
        if outcome.colcon_error:
            task = "python" if found.is_python else "cmake"
            where = f"colcon.colcon_{'cmake' if task == 'cmake' else 'core'}.task.{task}.build"
            self.console.error(f"[{self.now + _BEGIN:.3f}s] ERROR:{where}:{outcome.colcon_error}")
        self.console.finished(found.name, outcome.seconds, outcome.code, outcome.stdout, outcome.stderr)

    def _install(self, found: Found, outcome: Outcome) -> None:
        environment = self._environment(found)
        try:
            outcome.stdout += install_package(found, outcome, environment)
        except OSError as error:
            outcome.code = 1
            outcome.stderr += f"error: {found.name} cannot be installed: {error.strerror or error}: {error.filename}\n"
            return
        self.done.add(found.name)
        resource(self.world, self.plan.install, found.name)

    def _warn_of_cpp(self) -> None:
        """Name in one warning all that was left out because it is C++, and the packages that depend on it."""
        lines = []
        for name, outcome in sorted(self.log.items()):
            if outcome.left_out or outcome.lacking:
                needing = [found.name for found in self.plan.workspace if name in found.dependencies]
                parts = [
                    _listed("without", outcome.left_out),
                    _listed("needs", outcome.lacking) + (", not here" if outcome.lacking else ""),
                    _listed("needed by", needing if outcome.left_out else []),
                ]
                lines.append(f"  {name}: {'; '.join(filter(None, parts))}")
        if lines:
            head = "Warning: C++ is not compiled here. All else of these packages was built"
            self.console.error("\n".join([f"{head} (interfaces, launch files, parameters, Python programs):", *lines]))

    def _environment(self, found: Found) -> Environment:
        """What the package may use: what is sourced, and those of this workspace that package.xml names."""
        installed = set(installed_names(self.plan.install))
        needed = _recursive(found, self.plan.install, installed)
        packages = [read_installed(self.plan.install, name) for name in sorted(needed)]
        types = types_for(
            found, {each.name: (each.share, tuple(each.interfaces)) for each in packages if each.interfaces}
        )
        # Packages that are sourced are found, too, but not an older build of the package itself.
        findable = frozenset({*self.world.packages.names(), *needed} - {found.name})
        return Environment(self.plan.install, self.plan.build, findable, types, self.plan.symlink)

    def _write_log(self) -> None:
        stamp = time.strftime("%Y-%m-%d_%H-%M-%S", time.gmtime(1_800_000_000 + self.world.now // NANOSECONDS))
        folder = self.plan.log / f"build_{stamp}"
        for name, outcome in self.log.items():
            stdout = "".join(f"{line}\n" for line in outcome.stdout)
            for file, text in (
                ("stdout", stdout),
                ("stderr", outcome.stderr),
                ("stdout_stderr", stdout + outcome.stderr),
            ):
                files.save(folder / name / f"{file}.log", text)
        summary = "".join(f"{name}: exit code {outcome.code}\n" for name, outcome in self.log.items())
        files.save(folder / "logger_all.log", summary)
        for name in ("latest", "latest_build"):
            _point(self.plan.log / name, folder.name)


def _listed(word: str, names: list[str]) -> str:
    """`without talker, listener`, of many names the first ones; nothing without names."""
    more = f" and {len(names) - 8} more" if len(names) > 8 else ""
    return f"{word} {', '.join(names[:8])}{more}" if names else ""


def _point(link: Path, target: str) -> None:
    try:
        link.unlink(missing_ok=True)
        link.symlink_to(target)
    except OSError:  # a computer without links
        link.write_text(target, encoding="utf-8")


def _recursive(found: Found, install: Path, installed: set[str]) -> set[str]:
    needed: set[str] = set()
    waiting = list(found.dependencies)
    while waiting:
        name = waiting.pop()
        if name in installed and name not in needed and name != found.name:
            needed.add(name)
            file = prefix_of(install, name) / "share" / "colcon-core" / "packages" / name
            waiting += file.read_text(encoding="utf-8").split(":") if file.is_file() else []
    return needed


def types_for(found: Found, others: Mapping[str, tuple[Path, tuple[str, ...] | None]]) -> Registry:
    """The interfaces that a package's build sees: the built-in ones, what is sourced, `others`, and its own files."""
    built_in = Registry().packages()
    sourced = [registry.package(name) for name in registry.packages() if name not in built_in]
    places = {package.name: (package.directory, package.files) for package in sourced} | dict(others)
    places.pop(found.name, None)
    files = tuple(definitions(found.path))
    if files and LOWER_CASE.fullmatch(found.name):
        places[found.name] = (found.path, files)
    types = Registry()
    for name, place in places.items():
        types.add(name, *place)
    return types


def pass_time(world: World, seconds: float) -> None:
    """Let robot time pass, in a simulated process as well as in a cell."""
    if running_strand() is not None:
        time.sleep(seconds)
    else:
        world.sim.run_until(world.now + round(seconds * NANOSECONDS))


def as_seconds(seconds: float) -> str:
    """A duration as colcon writes it: `5.90s`, `1min 2s`."""
    if seconds < 60:
        return f"{seconds:.2f}s"
    minutes, rest = divmod(round(seconds), 60)
    return f"{minutes}min {rest}s"


@dataclass
class Ended:
    """The packages by how their build ended."""

    finished: list[str] = field(default_factory=list)
    failed: list[str] = field(default_factory=list)
    aborted: list[str] = field(default_factory=list)
    with_stderr: list[str] = field(default_factory=list)


class Console:
    """Prints what happens. `handlers` says which of colcon's event handlers are on."""

    def __init__(self, handlers: dict[str, bool], out: TextIO, err: TextIO) -> None:
        self.handlers = {**DEFAULTS, **handlers}
        self.out, self.err = out, err
        self.ended = Ended()

    def _say(self, handler: str, text: str, stream: TextIO | None = None) -> None:
        if self.handlers[handler]:
            print(text, file=stream or self.out)

    def queued(self, names: list[str]) -> None:
        """All that will be built."""
        if self.handlers["console_package_list"]:
            self._say("console_package_list", "Topological order")
            for name in names:
                self._say("console_package_list", f"- {name}")

    def started(self, name: str) -> None:
        """A package's build begins."""
        self._say("console_start_end", f"Starting >>> {name}")

    def error(self, text: str) -> None:
        """What colcon itself finds wrong."""
        print(text, file=self.err)

    def finished(self, name: str, seconds: float, code: int, stdout: list[str], stderr: str) -> None:
        """A package's build ended, with what it printed."""
        self._output(name, stdout, stderr)
        if stderr:
            self.ended.with_stderr.append(name)
        if code:
            self.ended.failed.append(name)
            text = f"Failed   <<< {name} [{as_seconds(seconds)}, exited with code {code}]"
            self._say("console_start_end", text, self.err)
        else:
            self.ended.finished.append(name)
            self._say("console_start_end", f"Finished <<< {name} [{as_seconds(seconds)}]")

    def _output(self, name: str, stdout: list[str], stderr: str) -> None:
        for line in stdout:
            self._say("console_direct", line)
        if stderr:
            self._say("console_direct", stderr, self.err)
        if self.handlers["console_cohesion"]:
            text = "\n".join([f"--- output: {name}", *stdout, *([stderr] if stderr else []), "---"])
            self._say("console_cohesion", text)
        elif stderr and not self.handlers["console_direct"]:
            self._say("console_stderr", f"--- stderr: {name}\n{stderr}\n---", self.err)

    def aborted(self, name: str, seconds: float) -> None:
        """A package's build was given up because another failed."""
        self.ended.aborted.append(name)
        self._say("console_start_end", f"Aborted  <<< {name} [{as_seconds(seconds)}]")

    def summary(self, seconds: float, queued: int) -> None:
        """What came of it all."""
        ended = self.ended
        lines = [f"\nSummary: {_packages(len(ended.finished))} finished [{as_seconds(seconds)}]"]
        for how, names in (
            ("failed", ended.failed),
            ("aborted", ended.aborted),
            ("had stderr output", ended.with_stderr),
        ):
            if names:
                lines.append(f"  {_packages(len(names))} {how}: {' '.join(sorted(names))}")
        left = queued - len(ended.finished) - len(ended.failed) - len(ended.aborted)
        if left:
            lines.append(f"  {_packages(left)} not processed")
        self._say("summary", "\n".join(lines))


def _packages(count: int) -> str:
    return "1 package" if count == 1 else f"{count} packages"
