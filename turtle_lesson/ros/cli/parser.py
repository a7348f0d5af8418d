"""Reading `ros2 <command> <verb> …`: which commands and verbs there are, their usage, and their arguments."""

from __future__ import annotations

import argparse
import sys
from argparse import ArgumentParser, Namespace
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cache, cached_property, partial
from importlib import import_module
from typing import Any, NoReturn, Protocol

from ..idl.names import did_you_mean

# The shape of usage and error texts follows recordings of ros2cli of Humble; help texts are our own words. Options
# that only this simulation has (`--for`) stand in the help of a verb, but not in its usage line.

OURS = ("--for",)
"""Options that the real tool does not have."""

WIDTH = 78


@dataclass
class Invocation:
    """How the command of a process is run."""

    background: bool = False
    """Whether it goes on in the background: its verb never ends by itself."""
    shown: bool = False
    """Whether its output is shown in the cell: it goes to no file and to no pipe."""


class Stop(Exception):
    """The words ask for no verb: a help text or a usage error is to be printed instead.

    Attributes:
        text: what to print, without the last line end.
        code: the exit code: 0 for help, which goes to stdout, 2 for a mistake, which goes to stderr.
    """

    def __init__(self, text: str, code: int) -> None:
        super().__init__(text, code)
        self.text = text
        self.code = code


class Formatter(argparse.HelpFormatter):
    """Help without the options that only we have in its usage line, and with an option's value once for each spelling."""

    def add_usage(self, usage: Any, actions: Iterable[argparse.Action], groups: Any, prefix: Any = None) -> None:
        """The usage line."""
        real = [action for action in actions if not set(OURS) & set(action.option_strings)]
        super().add_usage(usage, real, groups, prefix)

    def _format_action_invocation(self, action: argparse.Action) -> str:
        if not action.option_strings or action.nargs == 0:
            return super()._format_action_invocation(action)
        value = self._format_args(action, action.dest.upper())
        return ", ".join(f"{option} {value}" for option in action.option_strings)


_LAYOUT: Any = partial(Formatter, width=WIDTH, max_help_position=24)
"""Help as argparse of Python 3.11 lays it out, 80 columns wide, whatever the Python and the terminal."""


class Parser(argparse.ArgumentParser):
    """An ArgumentParser that raises `Stop` instead of printing and exiting."""

    def __init__(self, prog: str, description: str) -> None:
        more: dict[str, Any] = {"color": False} if sys.version_info >= (3, 14) else {}
        super().__init__(prog=prog, description=description, formatter_class=_LAYOUT, add_help=False, **more)
        self.add_argument("-h", "--help", action="help", help="show this help and do nothing")

    def print_help(self, file: Any = None) -> NoReturn:
        """Ask for the help to be printed."""
        raise Stop(self.format_help().rstrip("\n"), 0)

    def error(self, message: str) -> NoReturn:
        """Say what is wrong with the arguments."""
        raise Stop(f"{self.format_usage().rstrip()}\n{self.prog}: error: {cut(message)}", 2)

    def _check_value(self, action: argparse.Action, value: Any) -> None:
        if action.choices is None or value in action.choices:
            return
        choices = [str(choice) for choice in action.choices]
        listed = ", ".join(map(repr, choices))
        hint = did_you_mean(cut(str(value)), choices)
        text = f"invalid choice: {cut(repr(value))} (choose from {listed})"
        raise argparse.ArgumentError(action, "\n".join(filter(None, (text, hint))))

    def option_names(self) -> list[str]:
        """All its options."""
        shown = [action for action in self._actions if action.help != argparse.SUPPRESS]
        return [name for action in shown for name in action.option_strings]

    @property
    def actions(self) -> list[argparse.Action]:
        """All its arguments, in order."""
        return list(self._actions)


def cut(text: str, limit: int = 1500) -> str:
    """A text that is fit to be printed: not endless, and without control characters."""
    shown = "".join(char if char.isprintable() or char in "\n\t" else repr(char)[1:-1] for char in text[:limit])
    return shown if len(text) <= limit else f"{shown[:60]}… ({len(text)} characters)"


@dataclass
class Call:
    """A verb, and the arguments to run it with."""

    verb: Verb
    arguments: argparse.Namespace
    prog: str


def parse(words: Sequence[str]) -> Call:
    """Find what `ros2 <words>` asks for.

    Raises:
        Stop: if it asks for help, or is not understood.
    """
    rest = list(words)
    while rest and rest[0].startswith("-"):
        option = rest.pop(0)
        if option in {"-h", "--help"}:
            if rest and not rest[0].startswith("-"):
                _group(rest[0])  # as in ros2cli/command/__init__.py, a wrong name is noticed before help is printed
            raise Stop(top_help(), 0)
        if option != "--use-python-default-buffering":
            raise _unrecognized([option], ["-h", "--help", "--use-python-default-buffering"])
    if not rest:
        raise Stop(top_help(), 0)
    return _parse_group(_group(rest[0]), rest[1:])


def _group(name: str) -> Group:
    if name in GROUPS:
        return GROUPS[name]
    if name == "wtf":
        return GROUPS["doctor"]
    if name in NOT_HERE:
        raise Stop(f"ros2 {name}: not available in this simulation: {NOT_HERE[name]}. A real ROS 2 has it.", 2)
    raise _invalid_choice("ros2", top_usage(), "command", name, GROUPS)


def _parse_group(group: Group, rest: list[str]) -> Call:
    prog = f"ros2 {group.name}"
    alone = group.alone
    if alone is not None:
        return _parse_verb(alone, prog, rest)
    flags = set()
    while rest and rest[0].startswith("-"):
        option = rest.pop(0)
        if option in {"-h", "--help"}:
            if rest and not rest[0].startswith("-"):
                _verb(group, rest[0])
            raise Stop(group_help(group), 0)
        if group.flag is None or option != group.flag[0]:
            raise _unrecognized([option], ["-h", "--help", *(group.flag or ())[:1]])
        flags.add(option.lstrip("-").replace("-", "_"))
    if not rest:
        raise Stop(group_help(group), 0)
    call = _parse_verb(_verb(group, rest[0]), f"{prog} {rest[0]}", rest[1:])
    if group.flag is not None:
        name = group.flag[0].lstrip("-").replace("-", "_")
        setattr(call.arguments, name, name in flags or getattr(call.arguments, name, False))
    return call


def _verb(group: Group, name: str) -> Verb:
    verbs = group.verbs
    if name not in verbs:
        raise _invalid_choice(f"ros2 {group.name}", group_usage(group), "command", name, verbs)
    return verbs[name]


@cache
def verb_parser(verb: Verb, prog: str) -> Parser:
    """The parser of a verb's arguments; it is made once."""
    parser = Parser(prog, verb.help)
    verb.add_arguments(parser)
    return parser


def _parse_verb(verb: Verb, prog: str, words: list[str]) -> Call:
    parser = verb_parser(verb, prog)
    arguments, unknown = parser.parse_known_args(words)
    if unknown:
        raise _unrecognized(unknown, parser.option_names(), hasattr(arguments, "values"))
    return Call(verb, arguments, prog)


# -- mistakes ----------------------------------------------------------------------------------------------------------


def _invalid_choice(prog: str, usage: str, what: str, name: str, known: Iterable[str]) -> Stop:
    names = list(known)
    listed = ", ".join(map(repr, names))
    lines = [
        usage,
        f"{prog}: error: argument Call `{prog} <{what}> -h` for more detailed usage.: "
        f"invalid choice: {cut(repr(name), 200)} (choose from {listed})",
        did_you_mean(name[:100], names),
    ]
    return Stop("\n".join(filter(None, lines)), 2)


def _unrecognized(words: Sequence[str], options: Sequence[str], takes_values: bool = False) -> Stop:
    lines = [top_usage(), f"ros2: error: unrecognized arguments: {cut(' '.join(words), 200)}"]
    if words[0].startswith("-"):
        name = words[0].partition("=")[0][:100]
        lines.append(did_you_mean(name, [option for option in options if len(option) > 2]))
    elif takes_values:
        lines.append('Put the values in quotes, so that they form one word: "{x: 5.0, y: 5.0}"')
    return Stop("\n".join(filter(None, lines)), 2)


# -- usage --------------------------------------------------------------------------------------------------------
# Usage and help texts of `ros2` and of its commands. Those of the verbs are made by argparse.


def _usage(prog: str, options: str) -> str:
    """A usage text as argparse of Python 3.11 breaks it: a placeholder that is too long on a line of its own."""
    indent = " " * len(f"usage: {prog} ")
    placeholder = f"Call `{prog} <command> -h` for more detailed usage. ..."
    whole = f"usage: {prog} {options} {placeholder}"
    if len(whole) <= WIDTH:
        return whole
    words = placeholder.split()
    lines, line = [f"usage: {prog} {options}"], indent[:-1]
    for word in words:
        if len(line) + 1 + len(word) > WIDTH:
            lines.append(line)
            line = indent[:-1]
        line += f" {word}"
    return "\n".join([*lines, line])


def top_usage() -> str:
    """The usage of `ros2`."""
    return _usage("ros2", "[-h] [--use-python-default-buffering]")


def group_usage(group: Group) -> str:
    """The usage of a command with verbs."""
    return _usage(f"ros2 {group.name}", "[-h]" + (f" [{group.flag[0]}]" if group.flag else ""))


def top_help() -> str:
    """What `ros2` alone prints."""
    about = "ros2 is the command line of ROS 2: each command looks at, or changes, the system that is running."
    buffering = ("--use-python-default-buffering", "accepted, but without effect here")
    return _help(top_usage(), about, [buffering], {group.name: group.help for group in GROUPS.values()}, "ros2")


def group_help(group: Group) -> str:
    """What a command alone prints: its verbs."""
    verbs = {name: verb.help for name, verb in group.verbs.items()}
    return _help(group_usage(group), group.help, [group.flag] if group.flag else [], verbs, f"ros2 {group.name}")


def _help(usage: str, about: str, options: list[tuple[str, str]], commands: dict[str, str], prog: str) -> str:
    lines = [usage, "", about, "", "options:"]
    for option, text in [("-h, --help", "show this help and do nothing"), *options]:
        lines += [f"  {option:<20}  {text}"] if len(option) <= 20 else [f"  {option}", f"{'':24}{text}"]
    width = max(map(len, commands))
    lines += ["", "Commands:", *(f"  {name:<{width}}  {text}" for name, text in commands.items())]
    return "\n".join([*lines, "", f"  Call `{prog} <command> -h` for more detailed usage."])


# -- the commands, and where their verbs are -------------------------------------------------------------------------


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

    def __hash__(self) -> int: ...


@dataclass(frozen=True)
class Group:
    """One command of `ros2`: the module of its verbs, and what it is for. Without verbs it is a verb itself."""

    name: str
    help: str
    flag: tuple[str, str] | None = None

    @cached_property
    def module(self) -> Any:
        """Its module."""
        return import_module(f"{__package__}.group_{_MODULES.get(self.name, self.name)}")

    @property
    def alone(self) -> Verb | None:
        """The verb that the command itself is, if it has no verbs."""
        found: Verb | None = getattr(self.module, "COMMANDS", {}).get(self.name)
        return found

    @property
    def verbs(self) -> dict[str, Verb]:
        """Its verbs by name, in alphabetical order."""
        return dict(sorted(self.module.VERBS.items()))


_MODULES = {"daemon": "doctor", "launch": "run_launch", "run": "run_launch"}

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
