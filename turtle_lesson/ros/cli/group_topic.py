"""`ros2 topic`: which topics there are, what is published on them, and publishing."""

from __future__ import annotations

import time
from argparse import Namespace

from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.task import Future

from . import topic_listen  # noqa: F401 - echo, hz, bw and delay are verbs of this command
from .arguments import LONGEST, NODE, NODE_WITHOUT_DAEMON, arg, duration, either, flag, frequency, seconds, unsigned_int
from .typed_values import (
    add_verbs,
    class_of,
    list_arguments,
    name_argument,
    populate,
    profile_of,
    qos_arguments,
    read_yaml,
    stamp,
    types_of,
)
from .verb import (
    PATIENCE,
    CommandError,
    direct_node,
    end_of_stretch,
    expanded,
    graph_verb,
    of_the_simulator,
    print_names,
    publishers,
    spin_for,
    stretch_of,
    subscriptions,
    suggest,
    topics,
    verb,
    with_types,
)

PRESET = "system_default"
TIMES = arg("-t --times", "Publish this many messages", type=unsigned_int, default=0)


@verb(
    "topic pub",
    arg("topic_name", "Name of the topic, such as /turtle1/cmd_vel"),
    arg("message_type", "Type of the message, such as geometry_msgs/msg/Twist"),
    arg("values", "Values for its fields, in YAML, as in '{data: hello}'", nargs="?", default="{}"),
    arg("-r --rate", "How often a second (1)", metavar="N", type=frequency, default=1.0),
    arg("-p --print", "Print only every N-th message (1)", metavar="N", type=int, default=1),
    either(flag("-1 --once", "Publish one message"), TIMES),
    arg("-w --wait-matching-subscriptions", "Wait for so many first (1 with -1 or -t, else 0)", type=unsigned_int),
    arg("--keep-alive", "Seconds to stay after the last message (0.1)", metavar="N", type=seconds, default=0.1),
    arg("-n --node-name", "Name of the node that publishes"),
    *qos_arguments(PRESET, "reliable", "transient_local"),
    *NODE_WITHOUT_DAEMON,
    duration(),
)
def pub(args: Namespace) -> None:
    """Publish a message on a topic."""
    profile = profile_of(args, PRESET, reliability="reliable", durability="transient_local", history="keep_last")
    times = 1 if args.once else args.times
    needed = args.wait_matching_subscriptions
    if times / args.rate > LONGEST:
        raise CommandError(f"{times} messages at {args.rate:g} a second take longer than a day: publish fewer")
    with direct_node(args, args.node_name) as node:
        kind = class_of(args.message_type, "msg")
        values = read_yaml(args.values)
        if not isinstance(values, dict):
            raise CommandError("The passed value needs to be a dictionary in YAML format")
        message = kind()
        setters = populate(message, values)  # the real tool looks at fields only when somebody subscribes
        publisher = node.create_publisher(kind, expanded(node, args.topic_name), profile)
        _wait_for_subscriptions(node, publisher, (1 if times else 0) if needed is None else needed)
        done, count = Future(), 0
        endless = None if times else stretch_of(args)

        def publish() -> None:
            nonlocal count
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
            if not spin_for(node, endless, done) and endless is not None:
                raise end_of_stretch(endless)
            node.destroy_timer(timer)
        time.sleep(args.keep_alive)


def _wait_for_subscriptions(node: Node, publisher: Publisher, needed: int) -> None:
    """Wait for subscriptions; raise CommandError with the reason if there are too few. The real tool waits forever."""
    for look in range(round(PATIENCE * 10)):
        if _matched(node, publisher) >= needed:
            return
        if look % 10 == 0:
            print(f"Waiting for at least {needed} matching subscription(s)...")
        time.sleep(0.1)
    name, kind = publisher.topic_name, publisher.msg_type._TYPE_NAME  # type: ignore[attr-defined]
    types = sorted({each.topic_type for each in subscriptions(node, name)})
    waited = f"Gave up after {PATIENCE:g} s of robot time"
    if not types:
        others = [each for each in topics(node, include_hidden=True) if subscriptions(node, each)]
        hint = suggest(name, others) or "With -w 0 the command does not wait."
        raise CommandError(f"{waited}: no node subscribes to {name}", hint)
    if kind not in types:
        raise CommandError(f"{waited}: the subscription of {name} is of type {', '.join(types)}, not {kind}")
    if matched := _matched(node, publisher):
        raise CommandError(f"{waited}: {name} has {matched} subscription(s), not {needed}")
    hint = f"`ros2 topic info -v {name}` shows it."
    raise CommandError(f"{waited}: the subscription of {name} requests another quality of service", hint)


def _matched(node: Node, publisher: Publisher) -> int:
    """How many subscriptions get what is published, without the simulation's own, which always do."""
    own = [
        each
        for each in node.get_subscriptions_info_by_topic(publisher.topic_name)
        if of_the_simulator(each.node_name) and each.topic_type == publisher.msg_type._TYPE_NAME  # type: ignore[attr-defined]
    ]
    return max(0, publisher.get_subscription_count() - len(own))


EXAMPLES = ("/turtle1/pose", "geometry_msgs/msg/Twist")

add_verbs("topic", "msg", EXAMPLES, topics, *NODE)


@graph_verb(
    "topic list",
    *NODE,
    flag("-t --show-types", "Show each topic's type beside it"),
    *list_arguments("topic"),
    flag("-v --verbose", "Show types, and count publishers and subscriptions"),
)
def list_topics(args: Namespace, node: Node) -> None:
    """The names of the topics that are in use.

    With hidden ones, those are included that only the simulation itself subscribes to.
    """
    found = topics(node, args.include_hidden_topics, unused=args.include_hidden_topics)
    if args.count_topics or not args.verbose:
        print_names(with_types(found, shown=args.show_types), count=args.count_topics)
        return
    for title, what, ends in (("Published", "publisher", publishers), ("Subscribed", "subscriber", subscriptions)):
        print(f"{title} topics:")
        for name, line in zip(found, with_types(found), strict=True):
            if count := len(ends(node, name)):
                print(f" * {line} {count} {what}{'s' if count > 1 else ''}")
        print()


@graph_verb("topic info", *NODE, name_argument("topic", EXAMPLES[0]), flag("--verbose -v", "Show each end, with QoS"))
def info(args: Namespace, node: Node) -> None:
    """A topic's type, its publishers and its subscriptions."""
    name = args.topic_name
    types = types_of("topic", name, topics(node, include_hidden=True))
    end = "\n\n" if args.verbose else "\n"
    print(f"Type: {types[0] if len(types) == 1 else types}", end=end)
    for title, ends in (("Publisher", publishers(node, name)), ("Subscription", subscriptions(node, name))):
        print(f"{title} count: {len(ends)}", end=end)
        for each in ends if args.verbose else ():
            print(each, end="\n\n")
