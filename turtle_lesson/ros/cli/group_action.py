"""`ros2 action`: which actions there are, which nodes offer and use them, and sending a goal."""

from __future__ import annotations

import sys
from argparse import ArgumentParser, Namespace
from typing import TYPE_CHECKING, Any

from .parser import Verb
from .typed_values import Names, action_class, read_yaml
from .verb import (
    HIDDEN_PREFIX,
    PATIENCE,
    Command,
    CommandError,
    Interrupted,
    add_duration,
    direct_node,
    expanded,
    flag,
    now,
    spin_for,
    suggest,
)

if TYPE_CHECKING:
    from rclpy.action import ActionClient
    from rclpy.action.client import ClientGoalHandle
    from rclpy.node import Node
    from rclpy.task import Future


# -- send_goal: texts are those of ros2action of Humble --------------------------------------------------------------

LONGEST_GOAL = 600.0
"""How long, in s of robot time, a goal may take unless `--for` tells otherwise. The real tool waits forever."""

LOOK_AGAIN = 1.0


def add_arguments(parser: ArgumentParser) -> None:
    """Declare what may be typed after `send_goal`."""
    parser.add_argument("action_name", help="Name of the action, such as /turtle1/rotate_absolute")
    parser.add_argument("action_type", help="Its type, such as turtlesim/action/RotateAbsolute")
    parser.add_argument("values", metavar="goal", help="Values for the goal's fields, in YAML")
    flag(parser, "-f --feedback", "Print the feedback messages, too")
    add_duration(
        parser, f"Cancel the goal after this many seconds of robot time (default: {LONGEST_GOAL:g}; only here)"
    )


def send_goal(args: Namespace) -> None:
    """`ros2 action send_goal`."""
    from rosidl_runtime_py.convert import message_to_yaml

    kind = action_class(args.action_type)
    values = read_yaml(args.values)
    with direct_node(args, f"{HIDDEN_PREFIX}_send_goal_{args.action_type.replace('/', '_')}") as node:
        from rclpy.action import ActionClient

        client = ActionClient(node, kind, expanded(node, args.action_name, is_service=True))
        goal = kind.Goal()
        _populate(goal, values)
        _wait_for_server(node, client, kind)
        print(f"Sending goal:\n     {message_to_yaml(goal)}")
        until = now() + (args.seconds or LONGEST_GOAL)
        future = client.send_goal_async(goal, _print_feedback if args.feedback else None)
        handle = _outcome(node, client, future, until, None)
        if not handle.accepted:
            print("Goal was rejected.")
            return
        print(f"Goal accepted with ID: {bytes(handle.goal_id.uuid).hex()}\n")
        with_result = _outcome(node, client, handle.get_result_async(), until, handle)
        print(f"Result:\n    {message_to_yaml(with_result.result)}")
        print(f"Goal finished with status: {_status(with_result.status)}")


def _populate(goal: Any, values: Any) -> None:
    from rosidl_runtime_py.set_message import set_message_fields

    try:
        set_message_fields(goal, values)
    except (TypeError, AttributeError, ValueError, AssertionError, OverflowError, RecursionError) as error:
        notes = getattr(error, "__notes__", []) if isinstance(error, AttributeError) else []
        raise CommandError(f"Failed to populate message fields: {error!r}", "\n".join(notes)) from None


def _print_feedback(message: Any) -> None:
    from rosidl_runtime_py.convert import message_to_yaml

    print(f"Feedback:\n    {message_to_yaml(message.feedback)}")


def _status(status: int) -> str:
    from action_msgs.msg import GoalStatus

    names = ("ACCEPTED", "EXECUTING", "CANCELING", "SUCCEEDED", "CANCELED", "ABORTED")
    return next((name for name in names if getattr(GoalStatus, f"STATUS_{name}") == status), "UNKNOWN")


def _wait_for_server(node: Node, client: ActionClient, kind: Any) -> None:
    print("Waiting for an action server to become available...")
    if client.wait_for_server(timeout_sec=PATIENCE):
        return
    known = dict(node.get_action_names_and_types())
    name, own = client._name, kind._TYPE_NAME
    waited = f"Gave up after {PATIENCE:g} s of robot time"
    others = [each for each in known.pop(name, []) if each != own]
    if others:
        raise CommandError(f"{waited}: {name} is of type {', '.join(others)}, not {own}")
    hint = suggest(name, known)
    raise CommandError(
        f"{waited}: no node offers {name}",
        hint or "Is its node running (`ros2 node list`)? `ros2 action list` shows the actions.",
    )


def _outcome(node: Node, client: ActionClient, future: Future, until: float, handle: ClientGoalHandle | None) -> Any:
    """What a future brings; until then, look whether the server is still there. A goal that takes too long is cancelled.

    Raises CommandError, or Interrupted when the time (s of robot time) is over.
    """
    try:
        while not spin_for(node, min(LOOK_AGAIN, until - now()), future):
            if not client.server_is_ready():
                raise CommandError(
                    f"{client._name} went away before it answered: did its node end, or did an error stop it?"
                )
            if now() >= until - 1e-9:
                raise _too_long(node, handle)
    except KeyboardInterrupt:
        if handle is not None:  # nothing can wait for the answer any more
            print("Canceling goal...")
            handle.cancel_goal_async()
        raise
    if future.exception() is not None:
        what = "sending goal" if handle is None else "getting result"
        raise CommandError(f"Exception while {what}: {future.exception()!r}")
    return future.result()


def _too_long(node: Node, handle: ClientGoalHandle | None) -> Exception:
    if handle is None:
        return CommandError(
            "The server has not said whether it accepts the goal: is its node busy with something else?"
        )
    print("Canceling goal...")
    future = handle.cancel_goal_async()
    if not spin_for(node, PATIENCE, future):
        return CommandError("No answer to the cancel request: is the server's node busy with something else?")
    if not future.result().goals_canceling:
        return CommandError(
            "Failed to cancel goal", "The server continues: its cancel_callback did not accept the cancel request."
        )
    print("Goal canceled.")
    return Interrupted("(the goal took too long; --for SECONDS gives it more robot time, or less)")


# -- list, info, type, find ------------------------------------------------------------------------------------------


def actions(node: Node, include_hidden: bool = False) -> dict[str, list[str]]:
    """The actions that are there, with their types; none of them is hidden."""
    return dict(node.get_action_names_and_types())


ACTIONS = Names("action", "action", ("/turtle1/rotate_absolute", "turtlesim/action/RotateAbsolute"), actions)


def _info_arguments(parser: ArgumentParser) -> None:
    parser.add_argument("action_name", help="Name of the action, such as /turtle1/rotate_absolute")
    flag(parser, "-t --show-types", "Also show each node's type of the action")
    flag(parser, "-c --count", "Print only how many clients and servers there are")


def info(args: Namespace) -> None:
    """`ros2 action info`. Of an action that does not exist the real one says that no node offers or uses it."""
    with direct_node(args) as node:
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


VERBS: dict[str, Verb] = {
    "find": Command("The actions of a type", ACTIONS.find_arguments, ACTIONS.print_found),
    "info": Command("Which nodes offer and use an action", _info_arguments, info),
    "list": Command("The names of the actions that nodes offer or use", ACTIONS.list_arguments, ACTIONS.print_list),
    "send_goal": Command("Send a goal and print its outcome", add_arguments, send_goal),
    "type": Command("An action's type", ACTIONS.type_arguments, ACTIONS.print_type),
}
