"""What `colcon build` prints: colcon's event handlers (facts: colcon-core 0.10 and colcon-output 0.2)."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TextIO

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
