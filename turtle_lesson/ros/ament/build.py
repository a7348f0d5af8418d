"""`colcon build`: takes the packages in order, several at a time, installs what each one comes to, and prints what happens.

The time that a build takes is robot time, the same on every computer. Facts on what is printed: the event handlers of
colcon-core 0.10 and colcon-output 0.2.
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from pathlib import Path
from typing import TextIO

from ..runtime import files
from ..runtime.world import World
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
    needs_of,
    prefix_of,
    prepare,
    read_installed,
    write_setup_files,
)
from .manifest import Found, in_order, needed_by, reached
from .source import resource, types_for

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
"""Colcon's event handlers, and whether each is on without a word."""


@dataclass
class _Job:
    found: Found
    environment: Environment
    outcome: Outcome
    ends: float


@dataclass
class Builder:
    """One run of `colcon build`, and what it was asked for."""

    world: World
    packages: list[Found]
    workspace: list[Found]
    install: Path
    build: Path
    log: Path
    symlink: bool
    layout: str
    go_on: bool
    workers: int
    handlers: dict[str, bool]
    out: TextIO
    err: TextIO

    def __post_init__(self) -> None:
        self.now = 0.0
        self.code = 0
        self.outcomes: dict[str, Outcome] = {}
        self.waiting = [found for found in in_order(self.packages) if found.buildable]
        self.running: list[_Job] = []
        self.ended: dict[str, list[str]] = {"finished": [], "failed": [], "aborted": [], "had stderr output": []}

    def run(self) -> int:
        """Build the packages; return colcon's exit code."""
        prepare(self.install, self.build, self.log, self.layout)
        self._pass(_BEGIN)
        self._say("console_package_list", "\n- ".join(["Topological order", *(found.name for found in self.waiting)]))
        while self.waiting or self.running:
            self._start()
            if not self.running:
                break  # what is left depends on what failed
            self._end(min(self.running, key=lambda job: job.ends))
            if self.code and not self.go_on:
                for job in self.running:
                    self.ended["aborted"].append(job.found.name)
                    seconds = self.now - job.ends + job.outcome.seconds + 0.05
                    self._say("console_start_end", f"Aborted  <<< {job.found.name} [{seconds:.2f}s]")
                break
        write_setup_files(self.install)
        self._pass(_END)
        self._summarise()
        self._warn_of_cpp()
        return self.code

    def _pass(self, seconds: float) -> None:
        """Let robot time pass, in a simulated process as well as in a cell."""
        self.now += seconds
        if running_strand() is not None:
            time.sleep(seconds)
        else:
            self.world.sim.run_until(self.world.now + round(seconds * NANOSECONDS))

    def _say(self, handler: str, text: str, stream: TextIO | None = None) -> None:
        if self.handlers[handler]:
            print(text, file=stream or self.out)

    # -- one package -----------------------------------------------------------------------------------------------

    def _start(self) -> None:
        own = {found.name for found in self.packages if found.buildable}
        for found in list(self.waiting):
            if len(self.running) >= self.workers:
                return
            if set(found.dependencies) & own - {found.name} <= {*self.ended["finished"]}:
                self.waiting.remove(found)
                self._say("console_start_end", f"Starting >>> {found.name}")
                environment = self._environment(found)
                if missing := self._missing(found):
                    outcome = Outcome(1, seconds=0.01, colcon_error=missing)
                else:
                    outcome = (build_ament_python if found.is_python else build_ament_cmake)(found, environment)
                self.running.append(_Job(found, environment, outcome, self.now + outcome.seconds))

    def _missing(self, found: Found) -> str:
        """What colcon says where packages of this workspace are needed and neither built nor sourced."""
        there = {found.name, *self.world.packages.names(), *installed_names(self.install)}
        needed = needed_by(self.workspace, [found.name]) - there
        lacking = [each.name for each in self.workspace if each.name in needed]
        if not lacking:
            return ""
        scripts = [shown_path(str(prefix_of(self.install, name) / f"share/{name}/package.sh")) for name in lacking]
        text = "\n- ".join(["Failed to find the following files:", *scripts])
        text += "\n- ".join(["\nCheck that the following packages have been built:", *lacking])
        return f"{text}\nHint: colcon build --packages-up-to {found.name} builds them first."

    def _environment(self, found: Found) -> Environment:
        """What the package may use: what is sourced, and those of this workspace that package.xml names."""
        install = self.install
        installed = {*installed_names(install)} - {found.name}
        needed = reached(
            installed.intersection(found.dependencies),
            lambda name: installed.intersection(needs_of(install, name)),
        )
        types = types_for(found, [read_installed(install, name) for name in sorted(needed)])
        # Packages that are sourced are found, too, but not an older build of the package itself.
        findable = frozenset({*self.world.packages.names(), *needed} - {found.name})
        return Environment(install, self.build, findable, types, self.symlink)

    def _end(self, job: _Job) -> None:
        self._pass(max(0.0, job.ends - self.now))
        self.running.remove(job)
        name, outcome = job.found.name, job.outcome
        if outcome.code == 0:
            try:
                outcome.stdout += install_package(job.found, outcome, job.environment)
            except OSError as error:
                outcome.code = 1
                outcome.stderr += f"error: {name} cannot be installed: {error.strerror or error}: {error.filename}\n"
            else:
                resource(self.world, self.install, name)
        self.outcomes[name] = outcome
        self.code = self.code or outcome.code
        if outcome.colcon_error:
            task = "core.task.python" if job.found.is_python else "cmake.task.cmake"
            where = f"{self.now + _BEGIN:.3f}s] ERROR:colcon.colcon_{task}.build"
            print(f"[{where}:{outcome.colcon_error}", file=self.err)
        self._show_output(name, outcome)
        if outcome.stderr:
            self.ended["had stderr output"].append(name)
        self.ended["failed" if outcome.code else "finished"].append(name)
        if outcome.code:
            text = f"Failed   <<< {name} [{outcome.seconds:.2f}s, exited with code {outcome.code}]"
            self._say("console_start_end", text, self.err)
        else:
            self._say("console_start_end", f"Finished <<< {name} [{outcome.seconds:.2f}s]")

    def _show_output(self, name: str, outcome: Outcome) -> None:
        stdout, stderr = outcome.stdout, outcome.stderr
        log = self.log / "latest_build" / name / "stdout_stderr.log"
        files.save(log, "".join(f"{line}\n" for line in stdout) + stderr)
        for line in stdout:
            self._say("console_direct", line)
        if stderr:
            self._say("console_direct", stderr, self.err)
        lines = [f"--- output: {name}", *stdout, *([stderr] if stderr else []), "---"]
        self._say("console_cohesion", "\n".join(lines))
        if stderr and not self.handlers["console_cohesion"] and not self.handlers["console_direct"]:
            self._say("console_stderr", f"--- stderr: {name}\n{stderr}\n---", self.err)

    # -- at the end ------------------------------------------------------------------------------------------------

    def _summarise(self) -> None:
        finished, *others = self.ended.items()
        lines = [f"\nSummary: {_packages(len(finished[1]))} finished [{self.now:.2f}s]"]
        lines += [f"  {_packages(len(names))} {how}: {' '.join(sorted(names))}" for how, names in others if names]
        if self.waiting:
            lines.append(f"  {_packages(len(self.waiting))} not processed")
        self._say("summary", "\n".join(lines))

    def _warn_of_cpp(self) -> None:
        """Name in one warning all that was left out because it is C++, and the packages that depend on it."""
        lines = []
        for name, outcome in sorted(self.outcomes.items()):
            if outcome.left_out or outcome.lacking:
                needing = [found.name for found in self.workspace if name in found.dependencies and outcome.left_out]
                lacking = [*outcome.lacking, "not here"] if outcome.lacking else []
                parts = {"without": outcome.left_out, "needs": lacking, "needed by": needing}
                said = "; ".join(f"{word} {', '.join(names)}" for word, names in parts.items() if names)
                lines.append(f"  {name}: {said}")
        if lines:
            head = "Warning: C++ is not compiled here. All else of these packages was built"
            print(f"{head} (interfaces, launch files, parameters, Python programs):", *lines, sep="\n", file=self.err)


def _packages(count: int) -> str:
    return "1 package" if count == 1 else f"{count} packages"
