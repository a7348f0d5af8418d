"""`ros2 service` and `ros2 action`: which ones there are, which nodes offer and use them, calling them and sending goals.

Texts are those of ros2service and ros2action of Humble.
"""

from __future__ import annotations

import sys
import time
from argparse import Namespace
from collections.abc import Callable
from math import inf
from typing import Any

from rclpy.action import ActionClient
from rclpy.action.client import ClientGoalHandle
from rclpy.node import Node
from rclpy.task import Future

from .arguments import arg, duration, flag, frequency
from .typed_values import add_verbs, class_of, name_argument, populate, read_yaml, stamp, types_of
from .verb import (
    HIDDEN_PREFIX,
    PATIENCE,
    CommandError,
    Interrupted,
    direct_node,
    end_of_stretch,
    expanded,
    graph_verb,
    now,
    of_the_simulator,
    services,
    spin_for,
    stretch_of,
    suggest,
    verb,
)

LONGEST_ANSWER = 600.0
"""How long, in s of robot time, an answer may take unless `--for` tells otherwise. The real tools wait forever."""

LOOK_AGAIN = 1.0

SERVICES = ("/spawn", "std_srvs/srv/Empty")
ACTIONS = ("/turtle1/rotate_absolute", "turtlesim/action/RotateAbsolute")


# -- waiting for a server, and for what it answers -----------------------------------------------------------------------


def _not_offered(what: str, name: str, own: str, known: dict[str, list[str]]) -> CommandError:
    """The error for a service or action (`what`) that no node has offered in time with its `own` type, among those `known`.

    The real tools wait forever.
    """
    waited = f"Gave up after {PATIENCE:g} s of robot time"
    others = [each for each in known.get(name, []) if each != own]
    if others:
        return CommandError(f"{waited}: {name} is of type {', '.join(others)}, not {own}")
    hint = suggest(name, known) or f"Is its node running (`ros2 node list`)? `ros2 {what} list` shows the {what}s."
    return CommandError(f"{waited}: no node offers {name}", hint)


def _outcome(node: Node, future: Future, doing: str, name: str, is_there: Callable[[], bool], until: float) -> Any:
    """What a future brings, or None if it has not come by a time (`until`, s of robot time).

    Meanwhile, look whether the server of this name is still there. `doing` is what fails if the future has an exception.
    """
    while not spin_for(node, min(LOOK_AGAIN, until - now()), future):
        if not is_there():
            raise CommandError(f"{name} went away before it answered: did its node end, or did an error stop it?")
        if now() >= until - 1e-9:
            return None
    if future.exception() is not None:
        raise CommandError(f"Exception while {doing}: {future.exception()!r}")
    return future.result()


add_verbs("service", "srv", SERVICES, services, of_list="The names of the services that are offered")


@graph_verb("service info", name_argument("service", SERVICES[0]))
def service_info(args: Namespace, node: Node) -> None:
    """A service's type, and how many servers and clients it has.

    Humble lacks this verb, and newer releases have it.
    """
    name = args.service_name
    types = types_of("service", name, services(node, include_hidden=True))
    ours = [where for where in node.get_node_names_and_namespaces() if of_the_simulator(where[0])]
    clients = sum(name in dict(node.get_client_names_and_types_by_node(*where)) for where in ours)
    print(f"Type: {types[0] if len(types) == 1 else types}")
    print(f"Clients count: {node.count_clients(name) - clients}")
    print(f"Services count: {node.count_services(name)}")


@verb(
    "service call",
    arg("service_name", "Name of the service, such as /spawn"),
    arg("service_type", "Its type, such as turtlesim/srv/Spawn"),
    arg("values", "Values for the request's fields, in YAML", nargs="?", default="{}"),
    arg("-r --rate", "Call repeatedly, this many times a second", metavar="N", type=frequency),
    duration(),
)
def call(args: Namespace) -> None:
    """Call a service and print its answer."""
    kind = class_of(args.service_type, "srv")
    values = read_yaml(args.values)
    package, _, base = kind._TYPE_NAME.replace("/srv/", "/").partition("/")
    with direct_node(args, f"{HIDDEN_PREFIX}_requester_{package}_{base}") as node:
        client = node.create_client(kind, expanded(node, args.service_name, is_service=True))
        name, request, longest = client.service_name, kind.Request(), args.seconds or LONGEST_ANSWER
        setters = populate(request, values)
        if not client.service_is_ready():
            print("waiting for service to become available...")
            if not client.wait_for_service(timeout_sec=PATIENCE):
                raise _not_offered("service", name, kind._TYPE_NAME, services(node, include_hidden=True))
        seconds = stretch_of(args) or inf
        deadline = now() + seconds
        while True:
            begun = now()
            stamp(setters, node)
            print(f"requester: making request: {request!r}\n")
            future = client.call_async(request)
            answer = _outcome(node, future, "calling service", name, client.service_is_ready, begun + longest)
            if answer is None:
                why = "is its node busy with something else, or did an error end its callback?"
                raise CommandError(f"No answer from {name} in {longest:g} s of robot time: {why}")
            print(f"response:\n{answer!r}\n")
            if args.rate is None:
                return
            following = begun + 1 / args.rate
            time.sleep(max(0.0, min(following, deadline) - now()))
            if following >= deadline:
                raise end_of_stretch(seconds)


# -- action ------------------------------------------------------------------------------------------------------------


def actions(node: Node, include_hidden: bool = False) -> dict[str, list[str]]:
    """The actions that are there, with their types; none of them is hidden."""
    return dict(node.get_action_names_and_types())


add_verbs("action", "action", ACTIONS, actions, of_list="The names of the actions that nodes offer or use")


@graph_verb(
    "action info",
    arg("action_name", f"Name of the action, such as {ACTIONS[0]}"),
    flag("-t --show-types", "Also show each node's type of the action"),
    flag("-c --count", "Print only how many clients and servers there are"),
)
def action_info(args: Namespace, node: Node) -> None:
    """Which nodes offer and use an action.

    Of an action that does not exist the real one says that no node offers or uses it.
    """
    name = expanded(node, args.action_name)
    known = actions(node)
    clients, servers = _ends(node, name, "client"), _ends(node, name, "server")
    print(f"Action: {args.action_name}")
    for title, ends in (("clients", clients), ("servers", servers)):
        print(f"Action {title}: {len(ends)}")
        for node_name, types in ends if not args.count else ():
            print(f"    {node_name} [{', '.join(types)}]" if args.show_types else f"    {node_name}")
    if name not in known and (hint := suggest(name, known)):
        print(hint, file=sys.stderr)


def _ends(node: Node, action: str, role: str) -> list[tuple[str, list[str]]]:
    """The nodes that are this for an action: "client" or "server"."""
    look = getattr(node, f"get_action_{role}_names_and_types_by_node")
    found = []
    for name, namespace in node.get_node_names_and_namespaces():
        types = dict(look(name, namespace)).get(action)
        if types is not None:
            found.append((f"{namespace.rstrip('/')}/{name}", types))
    return found


@verb(
    "action send_goal",
    arg("action_name", f"Name of the action, such as {ACTIONS[0]}"),
    arg("action_type", f"Its type, such as {ACTIONS[1]}"),
    arg("values", "Values for the goal's fields, in YAML", metavar="goal"),
    flag("-f --feedback", "Print the feedback messages, too"),
    duration(f"Cancel the goal after this many seconds of robot time (default: {LONGEST_ANSWER:g}; only here)"),
)
def send_goal(args: Namespace) -> None:
    """Send a goal and print its outcome."""
    from rosidl_runtime_py.convert import message_to_yaml

    def print_feedback(message: Any) -> None:
        print(f"Feedback:\n    {message_to_yaml(message.feedback)}")

    kind = class_of(args.action_type, "action")
    values = read_yaml(args.values)
    with direct_node(args, f"{HIDDEN_PREFIX}_send_goal_{args.action_type.replace('/', '_')}") as node:
        client = ActionClient(node, kind, expanded(node, args.action_name, is_service=True))
        goal, name = kind.Goal(), client._name
        populate(goal, values, is_goal=True)
        print("Waiting for an action server to become available...")
        if not client.wait_for_server(timeout_sec=PATIENCE):
            raise _not_offered("action", name, kind._TYPE_NAME, actions(node))
        print(f"Sending goal:\n     {message_to_yaml(goal)}")
        until = now() + (args.seconds or LONGEST_ANSWER)
        future = client.send_goal_async(goal, print_feedback if args.feedback else None)
        handle = _outcome(node, future, "sending goal", name, client.server_is_ready, until)
        if handle is None:
            raise CommandError("No answer to the goal: is the server's node busy with something else?")
        if not handle.accepted:
            print("Goal was rejected.")
            return
        print(f"Goal accepted with ID: {bytes(handle.goal_id.uuid).hex()}\n")
        future = handle.get_result_async()
        try:
            with_result = _outcome(node, future, "getting result", name, client.server_is_ready, until)
        except KeyboardInterrupt:
            print("Canceling goal...")
            handle.cancel_goal_async()  # nothing can wait for the answer any more
            raise
        if with_result is None:
            raise _cancelled(node, handle)
        print(f"Result:\n    {message_to_yaml(with_result.result)}")
        # as in GoalStatus
        names = ("UNKNOWN", "ACCEPTED", "EXECUTING", "CANCELING", "SUCCEEDED", "CANCELED", "ABORTED")
        print(f"Goal finished with status: {names[with_result.status]}")


def _cancelled(node: Node, handle: ClientGoalHandle) -> Exception:
    """Cancel a goal that takes too long; how that ended is the exception to raise."""
    print("Canceling goal...")
    future = handle.cancel_goal_async()
    if not spin_for(node, PATIENCE, future):
        return CommandError("No answer to the cancel request: is the server's node busy with something else?")
    if not future.result().goals_canceling:
        return CommandError("Failed to cancel goal", "The server continues: its cancel_callback refused the request.")
    print("Goal canceled.")
    return Interrupted("(the goal took too long; --for SECONDS gives it more robot time, or less)")
