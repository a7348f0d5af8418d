"""The `ros2` command line: which commands and verbs there are, reading `ros2 <command> <verb> …`, and running it.

Each command runs as a simulated process, and answers as the real tool does. What commands in launch files need of the
terminal (`turtle_lesson/ros/launching/commands.py`) is here, too.
"""

from __future__ import annotations

import contextlib
import sys
from argparse import Namespace
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from importlib import import_module
from pathlib import Path
from textwrap import wrap
from typing import TextIO, cast

from ..ament.package import NotHereError
from ..idl.names import did_you_mean
from ..launching.commands import UnknownCommand
from ..runtime.world import World, current_process, wait_for_end
from ..sim.process import Output
from .arguments import WIDTH, Stop, cut
from .jobs import Errors, jobs, lasting
from .script import ShellSyntaxError, expand, pipelines, tokens
from .verb import INTERRUPTED, VERBS, Invocation, Verb


def run(
    world: World,
    words: Sequence[str],
    *,
    stdout: Output,
    stderr: Output,
    stdin: str | None = None,
    background: bool = False,
) -> int:
    """Run one command, such as `["ros2", "topic", "list"]`, and return its exit code.

    With `background` (`&`) it goes on while the world runs, and 0 is returned at once. Raises KeyboardInterrupt if the user
    stops it.
    """
    errors = Errors(stderr)
    try:
        verb, arguments = parse(words[1:])
    except Stop as stop:
        return stop.print(stdout, errors)
    if verb.in_cell:
        arguments.stdin = stdin
        with contextlib.redirect_stdout(cast("TextIO", stdout)), contextlib.redirect_stderr(cast("TextIO", errors)):
            return verb.main(arguments)

    def main() -> None:
        sys.exit(_work(verb, arguments))

    if background:
        out, error = lasting(stdout, world.sim), lasting(stderr, world.sim)
        process = world.spawn(main, name="ros2", argv=words, stdout=out, stderr=error)
        process.state(Invocation).background = True
        job = jobs(world).add(" ".join(words), process)
        print(f"[{job.number}] {process.pid}")
        world.sim.settle()
        return 0
    process = world.spawn(main, name="ros2", argv=words, stdout=stdout, stderr=errors)
    process.state(Invocation).shown = stdout is sys.stdout
    reason = wait_for_end(process, verb.prog)
    if reason:
        print(f"{verb.prog}: {reason}", file=errors)
    return process.exit_code or 0


def _work(verb: Verb, arguments: Namespace) -> int:
    """Do a verb's work in the running process; its exit code, also after Ctrl-C."""
    try:
        return verb.main(arguments)
    except KeyboardInterrupt:
        return INTERRUPTED


# -- commands in launch files --------------------------------------------------------------------------------------------


def run_here(words: Sequence[str]) -> int:
    """Run one command as part of the running process, as a launch file does; what has no end goes on until Ctrl-C."""
    try:
        verb, arguments = parse(words[1:])
    except Stop as stop:
        return stop.print(sys.stdout, sys.stderr)
    current_process().state(Invocation).background = True
    return _work(verb, arguments)


def commands_of_text(text: str) -> list[tuple[str, list[str]]]:
    """The commands of a shell's text, each with the sign before it.

    Raises UnknownCommand if there is none, or one that uses more of a shell than `&&`, `||` and `;`.
    """
    try:
        plan = list(pipelines(list(tokens(text))))
    except ShellSyntaxError as mistake:
        raise UnknownCommand(f"syntax error in the command {text!r}: {mistake}") from None
    found = []
    for sign, pipeline in plan:
        command = pipeline[0]
        if len(pipeline) > 1 or command.redirections or command.background:
            raise NotHereError(
                f"the command {text!r}",
                "it uses '|', '>' or '&', which launched commands cannot use here",
                "Only one command, or several with '&&' or ';' between them, can be run.",
            )
        found.append((sign, [part for word in command.words for part in expand(word, home=Path.home(), exit_code=0)]))
    if not found:
        raise UnknownCommand("there is no command in cmd=[…]")
    return found


def run_arguments(words: list[str]) -> Namespace:
    """The arguments of `ros2 run …`. UnknownCommand if it would complain about them."""
    try:
        return parse(words)[1]
    except Stop as stop:
        raise UnknownCommand(stop.text) from None


# -- which commands and verbs there are, and reading them --------------------------------------------------------------


@dataclass(frozen=True)
class Group:
    """A word that is followed by others: one of the commands, whose verbs are in a module, or `ros2` itself.

    `prog` are all the words up to it, `flag` is an option of its own and what that does.
    """

    prog: str
    help: str
    module: str = ""
    flag: tuple[str, str] = ("", "")

    @cached_property
    def members(self) -> Mapping[str, Group | Verb]:
        """Its commands or verbs by name, in alphabetical order; a verb without a name is the command itself."""
        if not self.module:
            return GROUPS
        import_module(f"{__package__}.group_{self.module}")
        return dict(sorted(VERBS[self.prog.removeprefix("ros2 ")].items()))

    def find(self, name: str) -> Group | Verb:
        """Its member of a name. Raises Stop if there is none."""
        if not self.module and name in NOT_HERE:
            raise Stop(f"ros2 {name}: not available in this simulation. A real ROS 2 has it.", 2)
        if name in self.members:
            return self.members[name]
        listed = ", ".join(map(repr, self.members))
        error = f"error: argument Call `{self.prog} <command> -h` for more detailed usage.: invalid choice"
        text = f"{self.usage}\n{self.prog}: {error}: {cut(repr(name), 200)} (choose from {listed})"
        raise Stop(f"{text}\n{did_you_mean(name[:100], self.members)}".rstrip("\n"), 2)

    def take_options(self, rest: list[str]) -> bool:
        """Take its options off the words after it; whether its own flag was among them. Raises Stop to print its help."""
        given = False
        while rest and rest[0].startswith("-"):
            option = rest.pop(0)
            if option in {"-h", "--help"}:
                if rest and not rest[0].startswith("-"):
                    # as in ros2cli/command/__init__.py, a wrong name is noticed before help is printed
                    self.find(rest[0])
                raise Stop(self.text, 0)
            if option != self.flag[0]:
                raise _unrecognized([option], ["-h", "--help", self.flag[0]])
            given = True
        if not rest:
            raise Stop(self.text, 0)
        return given

    @property
    def usage(self) -> str:
        """Its usage as argparse of Python 3.11 breaks it: a placeholder that is too long on a line of its own."""
        begin = f"usage: {self.prog} [-h]" + (f" [{self.flag[0]}]" if self.flag[0] else "")
        placeholder = f"Call `{self.prog} <command> -h` for more detailed usage. ..."
        if len(f"{begin} {placeholder}") <= WIDTH:
            return f"{begin} {placeholder}"
        indent = " " * len(f"usage: {self.prog} ")
        return "\n".join([begin, *wrap(placeholder, WIDTH, initial_indent=indent, subsequent_indent=indent)])

    @property
    def text(self) -> str:
        """Its help: what it prints when it stands alone."""
        lines = [self.usage, "", self.help, "", "options:", "  -h, --help            show this help and do nothing"]
        if self.flag[0]:
            lines += [f"  {self.flag[0]}", f"{'':24}{self.flag[1]}"]
        width = max(map(len, self.members))
        lines += ["", "Commands:", *(f"  {name:<{width}}  {each.help}" for name, each in self.members.items())]
        return "\n".join([*lines, "", f"  Call `{self.prog} <command> -h` for more detailed usage."])


def parse(words: Sequence[str]) -> tuple[Verb, Namespace]:
    """The verb that `ros2 <words>` asks for, and its arguments. Raises Stop if it asks for help, or is not understood."""
    found: Group | Verb = ROS2
    rest, given = list(words), {}
    while isinstance(found, Group):
        if "" not in found.members:
            given[found.flag[0]] = found.take_options(rest)
        found = found.find("" if "" in found.members else rest.pop(0))
    arguments, unknown = found.parser.parse_known_args(rest)
    if unknown:
        raise _unrecognized(unknown, found.parser.option_names(), hasattr(arguments, "values"))
    for option, value in given.items():
        name = option.lstrip("-").replace("-", "_")
        setattr(arguments, name, value or getattr(arguments, name, False))
    return found, arguments


def _unrecognized(words: Sequence[str], options: Iterable[str], takes_values: bool = False) -> Stop:
    lines = [ROS2.usage, f"ros2: error: unrecognized arguments: {cut(' '.join(words), 200)}"]
    if words[0].startswith("-"):
        name = words[0].partition("=")[0][:100]
        lines.append(did_you_mean(name, [option for option in options if len(option) > 2]))
    elif takes_values:
        lines.append('Put the values in quotes, so that they form one word: "{x: 5.0, y: 5.0}"')
    return Stop("\n".join(filter(None, lines)), 2)


_ABOUT = "ros2 is the command line of ROS 2: each command looks at, or changes, the system that is running."
ROS2 = Group("ros2", _ABOUT, flag=("--use-python-default-buffering", "accepted, but without effect here"))

_HIDDEN = "also count those with a hidden name"

GROUPS = {
    group.prog.removeprefix("ros2 "): group
    for group in (
        Group("ros2 action", "Find actions, and send them goals", "calls"),
        Group("ros2 bag", "Record messages, look at recordings, play them back", "bag"),
        Group("ros2 daemon", "The helper that remembers the graph between commands", "node"),
        Group("ros2 doctor", "Describe this simulation, what is running, and what looks wrong", "node"),
        Group("ros2 interface", "What messages, services and actions look like", "pkg"),
        Group("ros2 launch", "Start everything that a launch file describes", "run_launch"),
        Group("ros2 lifecycle", "Show managed nodes and their states, and trigger transitions", "node"),
        Group("ros2 node", "Which nodes there are, and what each one does", "node"),
        Group("ros2 param", "Read and change the parameters of nodes", "param"),
        Group("ros2 pkg", "Find packages, and create new ones", "pkg"),
        Group("ros2 run", "Start one program of a package", "run_launch"),
        Group("ros2 service", "Find services and call them", "calls", ("--include-hidden-services", _HIDDEN)),
        Group("ros2 topic", "Listen to, publish on and measure topics", "topic", ("--include-hidden-topics", _HIDDEN)),
    )
}

NOT_HERE = ("component", "control", "extension_points", "extensions", "multicast", "plugin", "security", "test")
"""Commands of a real ros2 that this simulation lacks."""
