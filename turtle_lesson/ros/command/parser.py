"""Reading `ros2 <command> <verb> …`: from words to a verb and its arguments, or to a usage text as the real tool prints it.

The shape of usage and error texts follows recordings of ros2cli of Humble; help texts are our own words. Options that only
this simulation has (`--for`) stand in the help of a verb, but not in its usage line.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any, NoReturn

from ..workspace.errors import did_you_mean
from .groups import GROUPS, NOT_HERE, Group, Verb
from .usage import WIDTH, group_help, group_usage, top_help, top_usage

OURS = ("--for",)
"""Options that the real tool does not have."""


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
    """Help as argparse of Python 3.11 lays it out, 80 columns wide, whatever the Python and the terminal."""

    def __init__(self, prog: str, **keywords: Any) -> None:
        super().__init__(prog, width=WIDTH, max_help_position=24, **keywords)

    def add_usage(self, usage: Any, actions: Iterable[argparse.Action], groups: Any, prefix: Any = None) -> None:
        """The usage line, without the options that only we have."""
        real = [action for action in actions if not set(OURS) & set(action.option_strings)]
        super().add_usage(usage, real, groups, prefix)

    def _format_action_invocation(self, action: argparse.Action) -> str:
        if not action.option_strings or action.nargs == 0:
            return super()._format_action_invocation(action)
        value = self._format_args(action, action.dest.upper())
        return ", ".join(f"{option} {value}" for option in action.option_strings)


class Parser(argparse.ArgumentParser):
    """An ArgumentParser that raises `Stop` instead of printing and exiting."""

    def __init__(self, prog: str, description: str) -> None:
        more: dict[str, Any] = {"color": False} if sys.version_info >= (3, 14) else {}
        super().__init__(prog=prog, description=description, formatter_class=Formatter, add_help=False, **more)
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
                _check_verb(group, rest[0])
            raise Stop(group_help(group), 0)
        if group.flag is None or option != group.flag[0]:
            raise _unrecognized([option], ["-h", "--help", *(group.flag or ())[:1]])
        flags.add(option.lstrip("-").replace("-", "_"))
    if not rest:
        raise Stop(group_help(group), 0)
    _check_verb(group, rest[0])
    call = _parse_verb(group.verbs[rest[0]], f"{prog} {rest[0]}", rest[1:])
    if group.flag is not None:
        name = group.flag[0].lstrip("-").replace("-", "_")
        setattr(call.arguments, name, name in flags or getattr(call.arguments, name, False))
    return call


def _check_verb(group: Group, name: str) -> None:
    if name not in group.verbs:
        raise _invalid_choice(f"ros2 {group.name}", group_usage(group), "command", name, group.verbs)


def verb_parser(verb: Verb, prog: str) -> Parser:
    """The parser of a verb's arguments."""
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
