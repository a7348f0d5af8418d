"""`ros2 topic`: which topics there are, what comes along them, and how fast."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace

from . import topic_echo, topic_pub, topic_rates
from .parser import Verb
from .typed_values import print_names, print_types, unknown
from .verb import Command, add_node_arguments, direct_node, publishers, subscriptions, topics


def _list_arguments(parser: ArgumentParser) -> None:
    add_node_arguments(parser)
    parser.add_argument("-t", "--show-types", action="store_true", help="Show each topic's type beside it")
    parser.add_argument("-c", "--count-topics", action="store_true", help="Print only how many there are")
    parser.add_argument("--include-hidden-topics", action="store_true", help="Also list topics with a hidden name")
    parser.add_argument(
        "-v", "--verbose", action="store_true", help="Show types, and count publishers and subscriptions"
    )


def list_topics(args: Namespace) -> None:
    """`ros2 topic list`."""
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
    add_node_arguments(parser)
    parser.add_argument("topic_name", help="Full name of the topic, such as /turtle1/pose")
    parser.add_argument("--verbose", "-v", action="store_true", help="Show every publisher and subscription, with QoS")


def info(args: Namespace) -> None:
    """`ros2 topic info`."""
    with direct_node(args) as node:
        name, known = args.topic_name, topics(node, include_hidden=True)
        if name not in known:
            raise unknown("topic", name, known)
        types = known[name]
        end = "\n\n" if args.verbose else "\n"
        print(f"Type: {types[0] if len(types) == 1 else types}", end=end)
        for title, ends in (("Publisher", publishers(node, name)), ("Subscription", subscriptions(node, name))):
            print(f"{title} count: {len(ends)}", end=end)
            for each in ends if args.verbose else ():
                print(each, end="\n\n")


def _type_arguments(parser: ArgumentParser) -> None:
    add_node_arguments(parser)
    parser.add_argument("topic_name", help="Full name of the topic, such as /turtle1/pose")


def type_of(args: Namespace) -> None:
    """`ros2 topic type`."""
    with direct_node(args) as node:
        known = topics(node, include_hidden=True)
    print_types("topic", args.topic_name, known)


def _find_arguments(parser: ArgumentParser) -> None:
    add_node_arguments(parser)
    parser.add_argument("topic_type", help="Name of the type, such as geometry_msgs/msg/Twist")
    parser.add_argument("-c", "--count-topics", action="store_true", help="Print only how many there are")
    parser.add_argument("--include-hidden-topics", action="store_true", help="Also find topics with a hidden name")


def find(args: Namespace) -> None:
    """`ros2 topic find`."""
    with direct_node(args) as node:
        known = topics(node, args.include_hidden_topics)
    print_names(args.topic_type, "msg", known, count=args.count_topics)


VERBS: dict[str, Verb] = {
    "bw": Command("How many bytes a second arrive on a topic", topic_rates.bw_arguments, topic_rates.bw),
    "delay": Command(
        "How old the messages of a topic are when they arrive, judged by the stamp in their header",
        topic_rates.delay_arguments,
        topic_rates.delay,
    ),
    "echo": Command("Print the messages of a topic", topic_echo.arguments, topic_echo.echo),
    "find": Command("The topics of a type", _find_arguments, find),
    "hz": Command("How many messages a second arrive on a topic", topic_rates.hz_arguments, topic_rates.hz),
    "info": Command("A topic's type, its publishers and its subscriptions", _info_arguments, info),
    "list": Command("The names of the topics that are in use", _list_arguments, list_topics),
    "pub": Command("Publish a message on a topic", topic_pub.arguments, topic_pub.pub),
    "type": Command("A topic's type", _type_arguments, type_of),
}
