"""`ros2 topic`: which topics there are, what is published on them, and publishing."""

from __future__ import annotations

import time
from argparse import ArgumentParser, Namespace
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from . import topic_listen
from .parser import Verb
from .typed_values import (
    Names,
    add_qos_arguments,
    message_class,
    populate,
    profile_of,
    read_yaml,
    stamp,
)
from .verb import (
    LONGEST,
    PATIENCE,
    Command,
    CommandError,
    add_duration,
    add_node_arguments,
    direct_node,
    end_of_stretch,
    expanded,
    flag,
    frequency,
    now,
    of_the_simulator,
    publishers,
    seconds,
    spin_for,
    stretch_of,
    subscriptions,
    suggest,
    topics,
    unsigned_int,
)

if TYPE_CHECKING:
    from rclpy.node import Node
    from rclpy.publisher import Publisher


# -- pub -------------------------------------------------------------------------------------------------------------

PRESET = "system_default"


def arguments(parser: ArgumentParser) -> None:
    """The arguments, in the real tool's order."""
    parser.add_argument("topic_name", help="Name of the topic, such as /turtle1/cmd_vel")
    parser.add_argument("message_type", help="Type of the message, such as geometry_msgs/msg/Twist")
    parser.add_argument("values", nargs="?", default="{}", help="Values for its fields, in YAML, as in '{data: hello}'")
    parser.add_argument("-r", "--rate", metavar="N", type=frequency, default=1.0, help="How often a second (1)")
    parser.add_argument("-p", "--print", metavar="N", type=int, default=1, help="Print only every N-th message (1)")
    group = parser.add_mutually_exclusive_group()
    flag(group, "-1 --once", "Publish one message")
    group.add_argument("-t", "--times", type=unsigned_int, default=0, help="Publish this many messages")
    parser.add_argument(
        "-w",
        "--wait-matching-subscriptions",
        type=unsigned_int,
        help="Wait for this many subscriptions first (1 with --once or --times, else 0)",
    )
    parser.add_argument(
        "--keep-alive",
        metavar="N",
        type=seconds,
        default=0.1,
        help="Stay for this many seconds after the last message (0.1)",
    )
    parser.add_argument("-n", "--node-name", help="Name of the node that publishes")
    add_qos_arguments(parser, "publish", PRESET, automatic=False)
    add_node_arguments(parser, daemon=False)
    add_duration(parser)


def pub(args: Namespace) -> None:
    """`ros2 topic pub`."""
    profile = profile_of(args, PRESET, reliability="reliable", durability="transient_local", history="keep_last")
    times = 1 if args.once else args.times
    needed = args.wait_matching_subscriptions
    if times / args.rate > LONGEST:
        raise CommandError(f"{times} messages at {args.rate:g} a second take longer than a day: publish fewer")
    with direct_node(args, args.node_name) as node:
        message, setters = _message(args.message_type, args.values)
        publisher = node.create_publisher(type(message), expanded(node, args.topic_name), profile)
        _wait_for_subscriptions(node, publisher, (1 if times else 0) if needed is None else needed)
        _publish(node, publisher, message, args, times, setters)


def _message(type_name: str, text: str) -> tuple[Any, list[Callable[[Any], None]]]:
    """The message as typed, and what sets its stamps. The real tool looks at fields only when somebody subscribes."""
    kind = message_class(type_name)
    values = read_yaml(text)
    if not isinstance(values, dict):
        raise CommandError("The passed value needs to be a dictionary in YAML format")
    message = kind()
    return message, populate(message, values)


def _wait_for_subscriptions(node: Node, publisher: Publisher, needed: int) -> None:
    begun, looks = now(), 0
    while _matched(node, publisher) < needed:
        if now() - begun > PATIENCE - 0.05:
            raise CommandError(*_why_too_few(node, publisher, needed))
        if looks % 10 == 0:
            print(f"Waiting for at least {needed} matching subscription(s)...")
        looks += 1
        time.sleep(0.1)


def _matched(node: Node, publisher: Publisher) -> int:
    """How many subscriptions get what is published, without the simulation's own, which always do."""
    ears = [
        each
        for each in node.get_subscriptions_info_by_topic(publisher.topic_name)
        if of_the_simulator(each.node_name) and each.topic_type == publisher.msg_type._TYPE_NAME  # type: ignore[attr-defined]
    ]
    return max(0, publisher.get_subscription_count() - len(ears))


def _why_too_few(node: Node, publisher: Publisher, needed: int) -> tuple[str, str]:
    """Why there are too few subscriptions, and a hint. The real tool waits forever."""
    name, kind = publisher.topic_name, publisher.msg_type._TYPE_NAME  # type: ignore[attr-defined]
    there = subscriptions(node, name)
    waited = f"Gave up after {PATIENCE:g} s of robot time"
    if not there:
        others = [each for each in topics(node, include_hidden=True) if subscriptions(node, each)]
        return f"{waited}: no node subscribes to {name}", suggest(
            name, others
        ) or "With -w 0 the command does not wait."
    types = sorted({each.topic_type for each in there})
    if kind not in types:
        return f"{waited}: the subscription of {name} is of type {', '.join(types)}, not {kind}", ""
    if not _matched(node, publisher):
        hint = f"`ros2 topic info -v {name}` shows it."
        return f"{waited}: the subscription of {name} requests another quality of service", hint
    return f"{waited}: {name} has {_matched(node, publisher)} subscription(s), not {needed}", ""


def _publish(
    node: Node,
    publisher: Publisher,
    message: Any,
    args: Namespace,
    times: int,
    setters: list[Callable[[Any], None]],
) -> None:
    """Publish so many times (0: without end), at a rate."""
    from rclpy.task import Future

    done, count = Future(), 0
    stretch = None if times else stretch_of(args)

    def publish() -> None:
        nonlocal count
        if done.done():
            return
        count += 1
        stamp(setters, node)
        if args.print and count % args.print == 0:
            print(f"publishing #{count}: {message!r}\n")
        publisher.publish(message)
        if count == times:
            done.set_result(True)

    print("publisher: beginning loop")
    publish()
    if times != 1:
        timer = node.create_timer(1 / args.rate, publish)
        if not spin_for(node, stretch, done) and stretch is not None:
            raise end_of_stretch(stretch)
        node.destroy_timer(timer)
    time.sleep(args.keep_alive)


# -- list, info, type, find ------------------------------------------------------------------------------------------


TOPICS = Names("topic", "msg", ("/turtle1/pose", "geometry_msgs/msg/Twist"), topics, add_node_arguments)


def _list_arguments(parser: ArgumentParser) -> None:
    TOPICS.list_arguments(parser)
    flag(parser, "-v --verbose", "Show types, and count publishers and subscriptions")


def list_topics(args: Namespace) -> None:
    """`ros2 topic list`; all that are hidden include those that only the simulation itself subscribes to."""
    with direct_node(args) as node:
        found = topics(node, args.include_hidden_topics, ears=args.include_hidden_topics)
        if args.count_topics:
            print(len(found))
        elif args.verbose:
            published = {name: len(publishers(node, name)) for name in found}
            subscribed = {name: len(subscriptions(node, name)) for name in found}
            _print_ends("Published", "publisher", found, published)
            _print_ends("Subscribed", "subscriber", found, subscribed)
        else:
            for name, types in found.items():
                print(f"{name} [{', '.join(types)}]" if args.show_types else name)


def _print_ends(title: str, what: str, found: dict[str, list[str]], counts: dict[str, int]) -> None:
    print(f"{title} topics:")
    for name, count in counts.items():
        if count:
            print(f" * {name} [{', '.join(found[name])}] {count} {what}{'s' if count > 1 else ''}")
    print()


def _info_arguments(parser: ArgumentParser) -> None:
    TOPICS.type_arguments(parser)
    flag(parser, "--verbose -v", "Show every publisher and subscription, with QoS")


def info(args: Namespace) -> None:
    """`ros2 topic info`."""
    with direct_node(args) as node:
        name, known = args.topic_name, topics(node, include_hidden=True)
        types = TOPICS.types_of(name, known)
        end = "\n\n" if args.verbose else "\n"
        print(f"Type: {types[0] if len(types) == 1 else types}", end=end)
        for title, ends in (("Publisher", publishers(node, name)), ("Subscription", subscriptions(node, name))):
            print(f"{title} count: {len(ends)}", end=end)
            for each in ends if args.verbose else ():
                print(each, end="\n\n")


VERBS: dict[str, Verb] = {
    "bw": Command("How many bytes a second arrive on a topic", topic_listen.bw_arguments, topic_listen.bw),
    "delay": Command(
        "How old the messages of a topic are when they arrive, judged by the stamp in their header",
        topic_listen.delay_arguments,
        topic_listen.delay,
    ),
    "echo": Command("Print the messages of a topic", topic_listen.arguments, topic_listen.echo),
    "find": Command("The topics of a type", TOPICS.find_arguments, TOPICS.print_found),
    "hz": Command("How many messages a second arrive on a topic", topic_listen.hz_arguments, topic_listen.hz),
    "info": Command("A topic's type, its publishers and its subscriptions", _info_arguments, info),
    "list": Command("The names of the topics that are in use", _list_arguments, list_topics),
    "pub": Command("Publish a message on a topic", arguments, pub),
    "type": Command("A topic's type", TOPICS.type_arguments, TOPICS.print_type),
}
