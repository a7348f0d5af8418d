"""The commands of `ros2`: which there are, where their verbs are, and what a verb is."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from dataclasses import dataclass
from importlib import import_module
from typing import Any, Protocol


class Verb(Protocol):
    """One verb of a command, such as `list` of `ros2 topic`.

    A verb's `main` runs as a simulated process, as ordinary blocking rclpy code; one with `in_cell = True`, which needs
    neither time nor a node, runs in the cell itself. It returns the exit code and prints to sys.stdout and sys.stderr.
    """

    @property
    def help(self) -> str:
        """One line on what it does."""

    def add_arguments(self, parser: ArgumentParser) -> None:
        """Declare its arguments."""

    def main(self, args: Namespace) -> int:
        """Do it; returns the exit code."""


@dataclass(frozen=True)
class Group:
    """One command of `ros2`: the module of its verbs, and what it is for. Without verbs it is a verb itself."""

    name: str
    help: str
    flag: tuple[str, str] | None = None

    @property
    def module(self) -> Any:
        """Its module."""
        return import_module(f"{__package__}.group_{_MODULES.get(self.name, self.name)}")

    @property
    def alone(self) -> Verb | None:
        """The verb that the command itself is, if it has no verbs."""
        found = getattr(self.module, "COMMANDS", {}).get(self.name)
        return None if found is None else _instance(found)

    @property
    def verbs(self) -> dict[str, Verb]:
        """Its verbs by name, in alphabetical order."""
        return {name: _instance(verb) for name, verb in sorted(self.module.VERBS.items())}


def _instance(verb: Any) -> Verb:
    return verb() if isinstance(verb, type) else verb


_MODULES = {"run": "run_launch", "launch": "run_launch"}

GROUPS = {
    group.name: group
    for group in (
        Group("action", "Find actions, and send them goals"),
        Group("bag", "Record messages, look at recordings, play them back"),
        Group("daemon", "The helper that remembers the graph between commands"),
        Group("doctor", "Describe this simulation, what is running, and what looks wrong"),
        Group("interface", "What messages, services and actions look like"),
        Group("launch", "Start everything that a launch file describes"),
        Group("lifecycle", "Show managed nodes and their states, and trigger transitions"),
        Group("node", "Which nodes there are, and what each one does"),
        Group("param", "Read and change the parameters of nodes"),
        Group("pkg", "Find packages, and create new ones"),
        Group("run", "Start one program of a package"),
        Group(
            "service",
            "Find services and call them",
            ("--include-hidden-services", "also count services with a hidden name"),
        ),
        Group(
            "topic",
            "Listen to topics, publish on them, measure them",
            ("--include-hidden-topics", "also count topics with a hidden name"),
        ),
    )
}

NOT_HERE = {
    "component": "there are no composable nodes here",
    "control": "there is no ros2_control here",
    "extension_points": "its commands cannot be extended",
    "extensions": "its commands cannot be extended",
    "multicast": "there is no network between the nodes here",
    "plugin": "there are no plugins here",
    "security": "there is no network between the nodes here",
    "test": "write tests with pytest instead",
}
"""Commands of a real ros2 that this simulation lacks, and why."""
