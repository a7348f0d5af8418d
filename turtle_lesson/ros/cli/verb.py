"""What a verb of `ros2` is, and what verbs share: their node, their limits in robot time, and how they end.

Each command is a simulated process; a verb is ordinary blocking rclpy code in it. It prints to `sys.stdout` and
`sys.stderr` as the real tool does. The exit code is 0, 1 after an error, 2 for wrong usage and for what would go on
forever in a terminal (as after a Ctrl-C there).
"""

from __future__ import annotations

import sys
import time
from argparse import Namespace
from collections.abc import Callable, Collection, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property, wraps
from typing import Any

import rclpy
from rclpy.exceptions import NameValidationException
from rclpy.expand_topic_name import expand_topic_name
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from rclpy.task import Future
from rclpy.topic_endpoint_info import TopicEndpointInfo
from rclpy.validate_full_topic_name import validate_full_topic_name
from rclpy.validate_topic_name import validate_topic_name

from ..idl.names import did_you_mean, is_hidden, module_name, nearest
from ..idl.registry import registry
from ..runtime.world import current_process, live_rate
from .arguments import DISCOVERY, STRETCH, Argument, Parser, cut

PATIENCE = 5.0
"""How long, in s of robot time, a command waits for what the real one waits for in silence, before it says so."""

HIDDEN_PREFIX = "_ros2cli"

INTERRUPTED = 2
"""The exit code of a `ros2` command that was ended by Ctrl-C."""


class CommandError(Exception):
    """Ends a command: its text goes to stderr, and the exit code is 1. `hint` is a line below it."""

    def __init__(self, text: str, hint: str = "") -> None:
        super().__init__(f"{text}\n{hint}" if hint else text)


class Interrupted(Exception):
    """Ends a command as Ctrl-C does in a terminal: the exit code is 2. Its text, if any, is a remark, not an error."""


@dataclass
class Invocation:
    """How the command of a process is run."""

    background: bool = False
    """Whether it goes on in the background: its verb never ends by itself."""
    shown: bool = False
    """Whether its output is shown in the cell: it goes to no file and to no pipe."""


Work = Callable[[Namespace], int | None]
GraphWork = Callable[[Namespace, Node], int | None]
"""What does a verb's work; one that looks at the graph is given a node. It returns an exit code, or None for 0."""


@dataclass(frozen=True)
class Verb:
    """One verb of a command, such as `list` of `ros2 topic`; or a command without verbs, such as `ros2 run`.

    Attributes:
        words: the words by which it is called, such as "topic list".
        arguments: what adds its arguments to a parser, in the real tool's order.
        work: does it, and returns an exit code or None.
        in_cell: whether it needs neither robot time nor a node, and so runs in the cell itself, not as a process.
    """

    words: str
    help: str
    arguments: tuple[Argument, ...]
    work: Work
    in_cell: bool = False

    @property
    def prog(self) -> str:
        """How it is called, from the first word on."""
        return f"ros2 {self.words}"

    @cached_property
    def parser(self) -> Parser:
        """The parser of its arguments."""
        return Parser(self.prog, self.help, self.arguments)

    def main(self, args: Namespace) -> int:
        """Do the work. Errors that the real tool tells in a sentence are told in one, on stderr, and so are all others."""
        try:
            return self.work(args) or 0
        except Interrupted as error:
            if str(error):
                remark(str(error))
            return INTERRUPTED
        except (CommandError, NameValidationException) as error:
            print(error, file=sys.stderr)
        except Exception as error:
            print(f"{self.prog}: {type(error).__name__}: {cut(str(error))}", file=sys.stderr)
        return 1


VERBS: dict[str, dict[str, Verb]] = {}
"""The verbs of the modules that are imported, by command and name. A command without verbs has one without a name."""


def verb(words: str, *arguments: Argument, help_text: str = "", in_cell: bool = False) -> Callable[[Work], Work]:
    """Make a function that does a verb's work known by the words that call it; the function stays as it is.

    Its help is `help_text`, or else the first line of the function's docstring.
    """

    def add(work: Work) -> Work:
        command, _, name = words.partition(" ")
        about = help_text or (work.__doc__ or "").partition("\n")[0].rstrip(".")
        VERBS.setdefault(command, {})[name] = Verb(words, about, arguments, work, in_cell)
        return work

    return add


def graph_verb(words: str, *arguments: Argument, help_text: str = "") -> Callable[[GraphWork], Work]:
    """As `verb`, for work that looks at the graph: it is also given a node, which has discovered the graph already."""

    def add(work: GraphWork) -> Work:
        @wraps(work)
        def with_node(args: Namespace) -> int | None:
            with direct_node(args) as node:
                return work(args, node)

        return verb(words, *arguments, help_text=help_text)(with_node)

    return add


# -- robot time --------------------------------------------------------------------------------------------------------


def stretch_of(args: Namespace) -> float | None:
    """How long an endless verb goes on, in s; None, in live mode or in the background, until it is interrupted."""
    if args.seconds is not None:
        return args.seconds
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


def print_names(names: Collection[str], *, count: bool = False) -> None:
    """Print names, one a line; or only how many there are."""
    if count:
        print(len(names))
    elif names:
        print(*names, sep="\n")


def with_types(known: dict[str, list[str]], *, shown: bool = True) -> list[str]:
    """Names, each with its types if these are to be shown."""
    return [f"{name} [{', '.join(types)}]" if shown else name for name, types in known.items()]


def now() -> float:
    """The robot time of the world, in s; looking costs nothing."""
    return current_process().simulation.now / 1e9


def spin_for(node: Node, seconds: float | None, done: Future | None = None) -> bool:
    """Spin the node for some robot time (s, or None forever) or until `done` is; whether `done` is."""
    future = Future() if done is None else done
    rclpy.spin_until_future_complete(node, future, timeout_sec=seconds)
    return future.done()


# -- asking other nodes ------------------------------------------------------------------------------------------------


def ask(node: Node, name: str, kind: str, service: str = "", **request: Any) -> Any:
    """The answer of a node's own service, such as get_parameters, the name of its type rcl_interfaces/srv/GetParameters.

    Raises CommandError if the node has no such service, and where the real tool waits forever for a busy node.
    """
    made, service = registry.get(kind), service or module_name(kind.rpartition("/")[2]).lstrip("_")
    client = node.create_client(made, f"{name}/{service}")
    if not client.wait_for_service(timeout_sec=PATIENCE):
        raise CommandError(f"Wait for service timed out: {name} offers no {service}")
    future = client.call_async(made.Request(**request))
    if not spin_for(node, PATIENCE, future):
        raise CommandError(f"No answer from {name} in {PATIENCE:g} s of robot time: is it busy, or not spinning?")
    return future.result()


# -- the command's own node --------------------------------------------------------------------------------------------


@contextmanager
def direct_node(args: Namespace | None = None, name: str | None = None) -> Iterator[Node]:
    """A node for the length of a command, hidden unless it is given a name; it has discovered the graph already."""
    rclpy.init(args=[], signal_handler_options=SignalHandlerOptions.SIGTERM)  # after Ctrl-C a goal is cancelled yet
    try:
        pid = current_process().pid
        node = rclpy.create_node(name or f"{HIDDEN_PREFIX}_{pid}", start_parameter_services=False)
        spin_time = getattr(args, "spin_time", None)
        time.sleep(DISCOVERY if spin_time is None else spin_time)
        yield node
    finally:
        rclpy.try_shutdown()


# -- what there is in the graph ----------------------------------------------------------------------------------------


def node_names(node: Node, include_hidden: bool = False) -> list[str]:
    """The full names of the nodes that are there, sorted; one that is there twice is listed twice."""
    names = node.get_fully_qualified_node_names()
    return sorted(name for name in names if include_hidden or not name.rpartition("/")[2].startswith("_"))


def find_node(node: Node, args: Namespace, known: list[str] | None = None) -> str:
    """The full name of the node that was named. Raises CommandError if it is not among those known, or there at all."""
    name, names = absolute(args.node_name), node_names(node, args.include_hidden_nodes)
    known = names if known is None else known
    if name in known:
        return name
    raise CommandError("Node not found", f"{name} is not a managed node." if name in names else suggest(name, known))


def topics(node: Node, include_hidden: bool = False, *, unused: bool = False) -> dict[str, list[str]]:
    """The topics, sorted, with their types; those to which only the simulation itself subscribes count as `unused`."""
    return {
        name: types
        for name, types in node.get_topic_names_and_types()
        if (include_hidden or not is_hidden(name)) and (unused or publishers(node, name) or subscriptions(node, name))
    }


def publishers(node: Node, topic: str) -> list[TopicEndpointInfo]:
    """The publishers of a topic; of the simulation's own nodes, those that every node has are left out."""
    found = node.get_publishers_info_by_topic(topic)
    every_node_has = topic in ("/rosout", "/parameter_events")
    return [each for each in found if not (every_node_has and of_the_simulator(each.node_name))]


def subscriptions(node: Node, topic: str) -> list[TopicEndpointInfo]:
    """The subscriptions of a topic, without those of the simulation's own nodes, which draw what they receive."""
    return [each for each in node.get_subscriptions_info_by_topic(topic) if not of_the_simulator(each.node_name)]


def of_the_simulator(node_name: str) -> bool:
    """Whether a node of this name belongs to the simulation: a hidden one that no command line on a robot has."""
    return node_name.startswith("_") and not node_name.startswith(HIDDEN_PREFIX)


def services(node: Node, include_hidden: bool = False) -> dict[str, list[str]]:
    """The services, sorted, with their types."""
    return {name: types for name, types in node.get_service_names_and_types() if include_hidden or not is_hidden(name)}


def expanded(node: Node, name: str, *, is_service: bool = False) -> str:
    """The full name of a topic or service as typed.

    Raises NameValidationException where ROS allows no such name, and CommandError for an unknown substitution such as `{x}`.
    """
    validate_topic_name(name, is_service=is_service)
    try:
        full_name = expand_topic_name(name, node.get_name(), node.get_namespace())
    except ValueError as error:
        raise CommandError(str(error).rstrip()) from None
    validate_full_topic_name(full_name, is_service=is_service)
    return full_name


def absolute(node_name: str) -> str:
    """The full name of a node as typed: `navigator` is `/navigator`."""
    return node_name if node_name.startswith("/") else f"/{node_name}"


def suggest(name: str, known: Iterable[str]) -> str:
    """`Did you mean '/navigator'?`, or nothing if nothing known is like that; a missing slash is found as well."""
    known = [each for each in known if each != name]
    same = nearest(name, known, 1.0)
    return f"Did you mean '{same}'?" if same else did_you_mean(name, known)
