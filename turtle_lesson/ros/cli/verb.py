"""What the verbs of `ros2` share: their arguments, their node, their limits in robot time, and how they end.

Each command is a simulated process; a verb is ordinary blocking rclpy code in it. It prints to `sys.stdout` and
`sys.stderr` as the real tool does, and `main` returns the exit code: 0, 1 after an error, 2 for wrong usage and for
what would go on forever in a terminal (as after a Ctrl-C there).
"""

from __future__ import annotations

import sys
from argparse import ArgumentParser, ArgumentTypeError, Namespace
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from ..idl.names import did_you_mean, is_hidden
from ..runtime.world import current_process
from .parser import Invocation

if TYPE_CHECKING:
    from rclpy.node import Node
    from rclpy.task import Future
    from rclpy.topic_endpoint_info import TopicEndpointInfo


# -- numbers as arguments, within what makes sense in a simulated world ----------------------------------------------

LONGEST = 86_400.0
"""How long, in s of robot time, a command can be told to go on: a day."""

FASTEST = 10_000.0
"""How often a second a command can be told to do something."""

MOST = 2**31 - 1
"""The greatest whole number that a command takes."""


def positive_float(text: str) -> float:
    """An argument that is a number above 0."""
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 0 < value < float("inf"):
        raise ArgumentTypeError(f"'{text}' is not a number above 0")
    return value


def frequency(text: str) -> float:
    """An argument that says how often a second; more often than `FASTEST` no robot could.

    Anything but a number above 0 is refused in the words that argparse has for ros2topic's `positive_float`.
    """
    try:
        value = positive_float(text)
    except ArgumentTypeError as error:
        raise ArgumentTypeError(f"invalid positive_float value: '{text}'\n{error}") from None
    if value > FASTEST:
        raise ArgumentTypeError(f"'{text}' times a second is too often; at most {FASTEST:g}")
    if value < 1 / LONGEST:
        raise ArgumentTypeError(f"'{text}' times a second is too rare; at least once a day")
    return value


def seconds(text: str) -> float:
    """An argument that is a number of seconds, 0 or more, up to a day."""
    try:
        value = float(text)
    except ValueError:
        value = -1.0
    if not 0 <= value < float("inf"):
        raise ArgumentTypeError(f"'{text}' is not a number of seconds")
    if value > LONGEST:
        raise ArgumentTypeError(f"'{text}' is too long; at most {LONGEST:.0f} s, a day")
    return value


def stretch(text: str) -> float:
    """An argument that is a stretch of time: more than 0 s, up to a day."""
    positive_float(text)
    return seconds(text)


def positive_int(text: str) -> int:
    """An argument that is a whole number above 0."""
    if not text.isdigit() or not text.strip("0"):
        raise ArgumentTypeError("value must be a positive integer")
    return unsigned_int(text)


def unsigned_int(text: str) -> int:
    """An argument that is a whole number, 0 or above."""
    if not (text.isascii() and text.isdigit() and len(text) < 19):
        raise ArgumentTypeError("value must be non-negative integer")
    if int(text) > MOST:
        raise ArgumentTypeError(f"value must be at most {MOST}")
    return int(text)


STRETCH = 5.0
"""How long, in s of robot time, goes on what never ends in a terminal, unless `--for` tells otherwise."""

PATIENCE = 5.0
"""How long, in s of robot time, a command waits for what the real one waits for in silence, before it says so."""

DISCOVERY = 0.1
"""How long, in s of robot time, a command looks around first, so that what was just started can appear."""

HIDDEN_PREFIX = "_ros2cli"
INTERRUPTED = 2


class CommandError(Exception):
    """Ends a command: its text goes to stderr, and the exit code is 1. `hint` is a line below it."""

    def __init__(self, text: str, hint: str = "") -> None:
        super().__init__(f"{text}\n{hint}" if hint else text)


class Interrupted(Exception):
    """Ends a command as Ctrl-C does in a terminal: the exit code is 2. Its text, if any, is a remark, not an error."""


@dataclass(frozen=True)
class Command:
    """A verb made of two functions: one adds the arguments, one does the work and returns an exit code or None."""

    help: str
    arguments: Callable[[ArgumentParser], object]
    work: Callable[[Namespace], int | None]

    def add_arguments(self, parser: ArgumentParser) -> None:
        """Add what may be typed after the verb."""
        self.arguments(parser)

    def main(self, args: Namespace) -> int:
        """Do the work. Errors that the real tool tells in a sentence are told in one, on stderr."""
        from rclpy.exceptions import NameValidationException

        try:
            return self.work(args) or 0
        except (CommandError, NameValidationException) as error:
            print(error, file=sys.stderr)
            return 1
        except Interrupted as error:
            if str(error):
                remark(str(error))
            return INTERRUPTED


# -- arguments that several verbs have ---------------------------------------------------------------------------


def no_arguments(parser: ArgumentParser) -> None:
    """For a verb that takes none."""


def flag(parser: Any, options: str, text: str, **more: Any) -> None:
    """Add an option without a value, which is false unless it is given; `options` are its spellings."""
    parser.add_argument(*options.split(), action="store_true", help=text, **more)


def add_node_arguments(parser: ArgumentParser, *, daemon: bool = True) -> None:
    """Arguments of every verb that looks at the graph. A simulated world needs no daemon and no simulated clock."""
    parser.add_argument(
        "--spin-time",
        type=seconds,
        help=f"Seconds of robot time to spend on discovery first (default: {DISCOVERY})",
    )
    flag(parser, "-s --use-sim-time", "Accepted; all time here is simulated")
    if daemon:
        flag(parser, "--no-daemon", "Accepted; no daemon is needed here")


def add_duration(parser: ArgumentParser, text: str = "", kind: Callable[[str], float] = stretch) -> None:
    """`--for SECONDS`, for a verb that never ends in a terminal. The real tool has no such option."""
    usual = f"End after this many seconds of robot time (default: {STRETCH:g}; only here)"
    parser.add_argument("--for", dest="seconds", type=kind, metavar="SECONDS", help=text or usual)


# -- robot time --------------------------------------------------------------------------------------------------


def stretch_of(args: Namespace) -> float | None:
    """How long an endless verb goes on, in s; None, in live mode or in the background, until it is interrupted."""
    if args.seconds is not None:
        return args.seconds
    from ..runtime.run_world import live_rate

    process = current_process()
    endless = process.state(Invocation).background or live_rate(process.world) is not None
    return None if endless else STRETCH


def end_of_stretch(seconds: float) -> Interrupted:
    """What an endless verb raises when its stretch of robot time is over; its text is the verb's last line."""
    return Interrupted(f"(stopped after {seconds:g} s of robot time; --for SECONDS makes it longer or shorter)")


def remark(sentence: str) -> None:
    """Print a sentence of the lesson's own, below the output; on stderr where the output goes to a file or a pipe."""
    shown = current_process().state(Invocation).shown
    print(sentence, file=sys.stdout if shown else sys.stderr)


def now() -> float:
    """The robot time of the world, in s; looking costs nothing."""
    return current_process().simulation.now / 1e9


def answer_of(node: Node, future: Future, seconds: float | None = None) -> Any:
    """Spin the node until the future has a result, and return that; None if it has none within the time (s)."""
    import rclpy

    rclpy.spin_until_future_complete(node, future, timeout_sec=seconds)
    return future.result() if future.done() else None


def ask(node: Node, kind: Any, service: str, not_there: str, request: dict[str, Any]) -> Any:
    """The answer of a node's own service, such as /turtlesim/get_parameters.

    Raises CommandError, with `not_there` if the node has no such service: the real tool waits forever for a busy node.
    """
    client = node.create_client(kind, service)
    if not client.wait_for_service(timeout_sec=PATIENCE):
        raise CommandError(not_there)
    response = answer_of(node, client.call_async(kind.Request(**request)), PATIENCE)
    if response is None:
        name = service.rpartition("/")[0]
        raise CommandError(
            f"No answer from {name} in {PATIENCE:g} s of robot time: is it busy in a callback, or not spinning?"
        )
    return response


def spin_for(node: Node, seconds: float | None, done: Future | None = None) -> bool:
    """Spin the node for some robot time (s, or None forever) or until `done` is; whether `done` is."""
    import rclpy
    from rclpy.task import Future

    future = Future() if done is None else done
    rclpy.spin_until_future_complete(node, future, timeout_sec=seconds)
    return future.done()


# -- the command's own node --------------------------------------------------------------------------------------


@contextmanager
def direct_node(args: Namespace | None = None, name: str | None = None) -> Iterator[Node]:
    """A node for the length of a command, hidden unless it is given a name; it has looked around already."""
    import time

    import rclpy
    from rclpy.signals import SignalHandlerOptions

    rclpy.init(args=[], signal_handler_options=SignalHandlerOptions.SIGTERM)  # after Ctrl-C a goal is cancelled yet
    try:
        pid = current_process().pid
        node = rclpy.create_node(name or f"{HIDDEN_PREFIX}_{pid}", start_parameter_services=False)
        spin_time = getattr(args, "spin_time", None)
        time.sleep(DISCOVERY if spin_time is None else spin_time)
        yield node
    finally:
        rclpy.try_shutdown()


# -- what there is in the graph ----------------------------------------------------------------------------------


def node_names(node: Node, include_hidden: bool = False) -> list[str]:
    """The full names of the nodes that are there, sorted; one that is there twice is listed twice."""
    names = node.get_fully_qualified_node_names()
    return sorted(name for name in names if include_hidden or not name.rpartition("/")[2].startswith("_"))


def topics(node: Node, include_hidden: bool = False, *, ears: bool = False) -> dict[str, list[str]]:
    """The topics, sorted, with their types; with `ears` also those that only the simulation itself subscribes to."""
    return {
        name: types
        for name, types in node.get_topic_names_and_types()
        if (include_hidden or not is_hidden(name)) and (ears or publishers(node, name) or subscriptions(node, name))
    }


def publishers(node: Node, topic: str) -> list[TopicEndpointInfo]:
    """The publishers of a topic, without those that every node has, of the simulation's own nodes."""
    found = node.get_publishers_info_by_topic(topic)
    every_node_has = topic in ("/rosout", "/parameter_events")
    return [each for each in found if not (every_node_has and of_the_simulator(each.node_name))]


def subscriptions(node: Node, topic: str) -> list[TopicEndpointInfo]:
    """The subscriptions of a topic, without the ears of the simulation's own nodes, which draw what they hear."""
    return [each for each in node.get_subscriptions_info_by_topic(topic) if not of_the_simulator(each.node_name)]


def of_the_simulator(node_name: str) -> bool:
    """Whether a node of this name belongs to the simulation: a hidden one that no command line on a robot has."""
    return node_name.startswith("_") and not node_name.startswith(HIDDEN_PREFIX)


def services(node: Node, include_hidden: bool = False) -> dict[str, list[str]]:
    """The services, sorted, with their types."""
    return {name: types for name, types in node.get_service_names_and_types() if include_hidden or not is_hidden(name)}


def expanded(node: Node, name: str, *, is_service: bool = False) -> str:
    """The full name of a topic or service as typed.

    Raises NameValidationException where ROS allows no such name, and CommandError for `{what}` that it does not know.
    """
    from rclpy.expand_topic_name import expand_topic_name
    from rclpy.validate_full_topic_name import validate_full_topic_name
    from rclpy.validate_topic_name import validate_topic_name

    validate_topic_name(name, is_service=is_service)
    try:
        full_name = expand_topic_name(name, node.get_name(), node.get_namespace())
    except ValueError as error:
        raise CommandError(str(error).rstrip()) from None
    validate_full_topic_name(full_name, is_service=is_service)
    return node.resolve_service_name(name) if is_service else node.resolve_topic_name(name)


def absolute(node_name: str) -> str:
    """The full name of a node as typed: `navigator` is `/navigator`."""
    return node_name if node_name.startswith("/") else f"/{node_name}"


def suggest(name: str, known: Iterable[str]) -> str:
    """`Did you mean '/navigator'?`, or nothing if nothing known is like that; a missing slash is found as well."""
    known = list(known)
    for candidate in known:
        if candidate.lower().strip("/") == name.lower().strip("/") and candidate != name:
            return f"Did you mean '{candidate}'?"
    return did_you_mean(name, [each for each in known if each != name])


class CellCommand(Command):
    """A command that needs neither robot time nor a node: it runs in the cell itself, not as a process."""

    in_cell = True
