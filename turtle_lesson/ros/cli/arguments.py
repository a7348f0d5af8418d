"""The arguments of a verb: how they are declared, which numbers they may be, and how argparse reads and describes them."""

from __future__ import annotations

import argparse
import sys
from argparse import ArgumentTypeError
from collections.abc import Callable, Iterable
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from typing import Any, NoReturn

from ..idl.names import did_you_mean
from ..sim.process import Output

# The shape of usage and error texts follows recordings of ros2cli of Humble; help texts are our own words. Options
# that only this simulation has (`--for`) stand in the help of a verb, but not in its usage line.

OURS = ("--for",)
"""Options that the real tool does not have."""

WIDTH = 78


@dataclass(eq=False)
class Stop(Exception):
    """The words ask for no verb: a text is to be printed instead, help (code 0) or, on stderr, a usage error (code 2)."""

    text: str
    code: int

    def print(self, stdout: Output, stderr: Output) -> int:
        """Print the text where it belongs; returns the exit code."""
        print(self.text, file=stderr if self.code else stdout)
        return self.code


def cut(text: str, limit: int = 1500) -> str:
    """A text that is fit to be printed: not endless, and its control characters are named."""
    shown = "".join(char if char.isprintable() or char in "\n\t" else repr(char)[1:-1] for char in text[:limit])
    return shown if len(text) <= limit else f"{shown[:60]}… ({len(text)} characters)"


class _Formatter(argparse.HelpFormatter):
    """Help without the options that only we have in its usage line."""

    def add_usage(self, usage: Any, actions: Iterable[argparse.Action], groups: Any, prefix: Any = None) -> None:
        """The usage line."""
        real = [action for action in actions if not set(OURS) & set(action.option_strings)]
        super().add_usage(usage, real, groups, prefix)


class Parser(argparse.ArgumentParser):
    """An ArgumentParser that raises `Stop` instead of printing and exiting; its help has one width in all terminals."""

    def __init__(self, prog: str, description: str, arguments: Iterable[Argument]) -> None:
        more: dict[str, Any] = {"color": False} if sys.version_info >= (3, 14) else {}
        layout: Any = partial(_Formatter, width=WIDTH, max_help_position=24)
        super().__init__(prog=prog, description=description, formatter_class=layout, add_help=False, **more)
        self.add_argument("-h", "--help", action="help", help="show this help and do nothing")
        for add in arguments:
            add(self)

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
        text = f"invalid choice: {cut(repr(value))} (choose from {', '.join(map(repr, choices))})"
        raise argparse.ArgumentError(action, f"{text}\n{did_you_mean(cut(str(value)), choices)}".rstrip())

    def option_names(self) -> list[str]:
        """All its options."""
        return [name for action in self._actions for name in action.option_strings]

    @property
    def actions(self) -> list[argparse.Action]:
        """All its arguments, in order."""
        return list(self._actions)


# -- declaring arguments -----------------------------------------------------------------------------------------------

Argument = Callable[[Any], object]
"""Adds an argument, or several, to a parser."""


def arg(names: str, text: str, **more: Any) -> Argument:
    """An argument, or an option by all its spellings; `more` is what argparse's `add_argument` takes."""
    return lambda parser: parser.add_argument(*names.split(), help=text, **more)


def flag(names: str, text: str, **more: Any) -> Argument:
    """An option without a value, which is false unless it is given."""
    return arg(names, text, action="store_true", **more)


def either(*arguments: Argument) -> Argument:
    """Options of which only one may be given."""

    def add(parser: Any) -> None:
        group = parser.add_mutually_exclusive_group()
        for each in arguments:
            each(group)

    return add


# -- numbers, within what makes sense in a simulated world -------------------------------------------------------------

LONGEST = 86_400.0
"""How long, in s of robot time, a command can be told to go on: a day."""

MOST = 2**31 - 1
"""The greatest whole number that a command takes."""


def bounded(name: str, least: float, most: float, kind: type = float, refusal: str = "") -> Callable[[str], Any]:
    """A type of arguments, called `name` in errors as argparse does: numbers of a kind within these bounds.

    All else is refused with the text `refusal`, {} being the argument, or else with the bounds.
    """
    refusal = refusal or f"invalid {name} value: '{{}}'\nIt must be a number from {least:g} to {most:g}"

    def read(text: str) -> Any:
        with suppress(ValueError):
            if least <= (value := kind(text)) <= most:
                return value
        raise ArgumentTypeError(refusal.format(text))

    return read


seconds = bounded("float", 0.0, LONGEST)
"""A number of seconds."""

stretch = bounded("positive_float", 1e-9, LONGEST)
"""A stretch of time in s, of more than 0 s."""

frequency = bounded("positive_float", 1 / LONGEST, 10_000.0)
"""How often a second; more often than the most no robot could."""

positive_int = bounded("int", 1, MOST, int, "value must be a positive integer")
unsigned_int = bounded("int", 0, MOST, int, "value must be non-negative integer")
depth = bounded("int", -MOST, MOST, int, "invalid int value: '{}'")
"""The length of a queue; 0 or less is accepted, and without effect."""


# -- arguments that several verbs have ---------------------------------------------------------------------------------

STRETCH = 5.0
"""How long, in s of robot time, goes on what never ends in a terminal, unless `--for` tells otherwise."""

DISCOVERY = 0.1
"""How long, in s of robot time, a command looks around first, so that what was just started can appear."""


def duration(text: str = "") -> Argument:
    """`--for SECONDS`, for a verb that never ends in a terminal. The real tool has no such option."""
    usual = f"End after this many seconds of robot time (default: {STRETCH:g}; only here)"
    return arg("--for", text or usual, dest="seconds", type=stretch, metavar="SECONDS")


NODE_WITHOUT_DAEMON = (
    arg("--spin-time", f"Seconds of robot time to spend on discovery first (default: {DISCOVERY})", type=seconds),
    flag("-s --use-sim-time", "Accepted; all time here is simulated"),
)
NODE = (*NODE_WITHOUT_DAEMON, flag("--no-daemon", "Accepted; no daemon is needed here"))
"""Arguments of every verb that looks at the graph. A simulated world needs no daemon and no simulated clock."""

HIDDEN_NODES = flag("--include-hidden-nodes", "Also use nodes with a hidden name")
OF_NODE = (*NODE, arg("node_name", "Name of the node, such as /turtlesim"), HIDDEN_NODES)
"""Arguments of every verb that asks one node."""

ALL_NODES = flag("-a --all", "Also list nodes with a hidden name")
COUNT_NODES = flag("-c --count-nodes", "Print only how many there are")
