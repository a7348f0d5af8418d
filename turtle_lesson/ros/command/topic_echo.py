"""`ros2 topic echo`: print the messages of a topic."""

from __future__ import annotations

import sys
from argparse import ArgumentParser, Namespace
from array import array
from collections.abc import Callable
from typing import Any

from .amounts import unsigned_int
from .common import CommandError, add_duration, add_node_arguments, direct_node, expanded, suggest, topics
from .listening import class_of_topic, listen, not_published
from .quality import add_qos_arguments, is_chosen, matching_profile, profile_of
from .types import message_class

TRUNCATE = 128
PRESET = "sensor_data"


def arguments(parser: ArgumentParser) -> None:
    """The arguments, in the real tool's order."""
    add_node_arguments(parser)
    parser.add_argument("topic_name", help="Name of the topic, such as /turtle1/pose")
    parser.add_argument("message_type", nargs="?", help="Type of its messages, such as turtlesim/msg/Pose")
    add_qos_arguments(parser, "subscribe", PRESET, automatic=True)
    parser.add_argument("--csv", action="store_true", help="Print each message as one line, with commas between values")
    parser.add_argument("--field", help="Print only this field; a dot leads to a field of a field, as in header.stamp")
    parser.add_argument("--full-length", "-f", action="store_true", help="Do not cut off long arrays and texts")
    parser.add_argument(
        "--truncate-length",
        "-l",
        type=unsigned_int,
        default=TRUNCATE,
        help="How much of long arrays and texts is printed (default: %(default)s)",
    )
    parser.add_argument("--no-arr", action="store_true", help="Print the type and length of arrays instead of them")
    parser.add_argument("--no-str", action="store_true", help="Print the length of texts instead of them")
    parser.add_argument("--flow-style", action="store_true", help="Print an array in one line, in brackets")
    parser.add_argument("--lost-messages", action="store_true", help="Deprecated, and without effect")
    parser.add_argument("--no-lost-messages", action="store_true", help="Do not report lost messages")
    parser.add_argument("--raw", action="store_true", help="Print the bytes as they are sent")
    parser.add_argument(
        "--filter",
        dest="filter_expr",
        metavar="FILTER_EXPR",
        help="Print a message m only where this Python expression is true, as in 'm.x > 5'",
    )
    parser.add_argument("--once", action="store_true", help="End after the first message")
    add_duration(parser)


def echo(args: Namespace) -> None:
    """`ros2 topic echo`."""
    from rclpy.task import Future

    if args.lost_messages:
        print("WARNING: '--lost-messages' is deprecated; lost messages are reported by default", file=sys.stderr)
    done = Future() if args.once else None
    path = _path(args.field)
    wanted = filter_of(args.filter_expr)
    show = _printer(args)

    def print_message(message: Any) -> None:
        part = part_of(message, path)
        if not wanted(part):
            return
        show(part)
        if done is not None and not done.done():
            done.set_result(True)

    with direct_node(args) as node:
        kind, given = None, args.message_type
        profile = profile_of(args, PRESET) if is_chosen(args) else matching_profile(node, args.topic_name, PRESET)
        if given is None:
            kind = class_of_topic(node, args.topic_name)
            if kind is None:
                print(not_published(args.topic_name))
                hint = suggest(expanded(node, args.topic_name), topics(node, include_hidden=True))
                raise CommandError("Could not determine the type for the passed topic", hint)
        else:
            kind = message_class(given)
        lost = None if args.no_lost_messages else _say_what_was_lost
        listen(node, args.topic_name, kind, print_message, profile, args, raw=args.raw, done=done, lost=lost)


def _say_what_was_lost(event: Any) -> None:
    counts = f"total count change:{event.total_count_change}\n\ttotal count: {event.total_count}"
    print(f"A message was lost!!!\n\t{counts}", end="---\n")


def _path(field: str | None) -> list[str]:
    """The names that lead to the field to print."""
    path = [name for name in (field or "").split(".") if name]
    if field is not None and not path:
        raise CommandError(f"Invalid field value '{field}'")
    return path


def part_of(message: Any, path: list[str]) -> Any:
    """The field of a message that some names lead to. Raises CommandError with the real tool's sentence."""
    part = message
    for name in path:
        fields = list(getattr(part, "get_fields_and_field_types", dict)())
        if name not in fields:
            error = f"'{_type_name(part)}' object has no attribute '{name}'"
            raise CommandError(f"Invalid field '{'.'.join(path)}': {error}", suggest(name, fields))
        part = getattr(part, name)
    return part


def _type_name(part: Any) -> str:
    """The name of a value's type as in Python's own errors, which name the module of `array.array`."""
    return "array.array" if isinstance(part, array) else type(part).__name__


def filter_of(expression: str | None) -> Callable[[Any], bool]:
    """Whether a message m passes a Python expression as typed; everything passes if there is none."""
    if expression is None:
        return lambda message: True
    try:
        code = compile(expression.strip(), "--filter", "eval")
    except (SyntaxError, ValueError, MemoryError, RecursionError) as error:
        reason = getattr(error, "msg", None) or error
        raise CommandError(f"Invalid filter expression '{expression[:200]}': {reason}") from None

    def passes(message: Any) -> bool:
        try:
            return bool(eval(code, {"m": message}))
        except (Exception, SystemExit) as error:
            text = f"The filter expression '{expression[:200]}' failed: {type(error).__name__}: {error}"
            raise CommandError(text) from None

    return passes


def _printer(args: Namespace) -> Callable[[Any], None]:
    """What prints a message or a part of one."""
    from rosidl_runtime_py.convert import message_to_csv, message_to_yaml

    length = None if args.full_length else args.truncate_length
    style = {"truncate_length": length, "no_arr": args.no_arr, "no_str": args.no_str}

    def show(part: Any) -> None:
        is_message = hasattr(part, "get_fields_and_field_types")
        if args.csv:
            print(message_to_csv(part, **style) if is_message else part)
        elif not is_message:
            print(part, end="\n---\n")
        else:
            print(message_to_yaml(part, **style, flow_style=args.flow_style), end="---\n")

    return show
