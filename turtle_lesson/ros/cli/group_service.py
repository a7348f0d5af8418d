"""`ros2 service`: which services there are, and calling them."""

from __future__ import annotations

import time
from argparse import ArgumentParser, Namespace
from typing import TYPE_CHECKING, Any

from .parser import Verb
from .typed_values import Names, populate, read_yaml, service_class, stamp
from .verb import (
    HIDDEN_PREFIX,
    PATIENCE,
    Command,
    CommandError,
    add_duration,
    direct_node,
    end_of_stretch,
    expanded,
    frequency,
    now,
    of_the_simulator,
    services,
    spin_for,
    stretch_of,
    suggest,
)

if TYPE_CHECKING:
    from rclpy.client import Client
    from rclpy.node import Node
    from rclpy.task import Future


LONGEST_ANSWER = 600.0
"""How long, in s of robot time, an answer may take unless `--for` tells otherwise. The real tool waits forever."""

LOOK_AGAIN = 1.0


SERVICES = Names("service", "srv", ("/spawn", "std_srvs/srv/Empty"), services)


def info(args: Namespace) -> None:
    """`ros2 service info`, which Humble lacks and newer releases have."""
    with direct_node(args) as node:
        known = services(node, include_hidden=True)
        name = args.service_name
        types = SERVICES.types_of(name, known)
        print(f"Type: {types[0] if len(types) == 1 else types}")
        print(f"Clients count: {node.count_clients(name) - _clients_of_the_simulator(node, name)}")
        print(f"Services count: {node.count_services(name)}")


def _clients_of_the_simulator(node: Node, service: str) -> int:
    known = [where for where in node.get_node_names_and_namespaces() if of_the_simulator(where[0])]
    return sum(service in dict(node.get_client_names_and_types_by_node(*where)) for where in known)


def _call_arguments(parser: ArgumentParser) -> None:
    parser.add_argument("service_name", help="Name of the service, such as /spawn")
    parser.add_argument("service_type", help="Its type, such as turtlesim/srv/Spawn")
    parser.add_argument("values", nargs="?", default="{}", help="Values for the request's fields, in YAML")
    parser.add_argument("-r", "--rate", metavar="N", type=frequency, help="Call repeatedly, this many times a second")
    add_duration(parser)


def call(args: Namespace) -> None:
    """`ros2 service call`."""
    kind = service_class(args.service_type)
    values = read_yaml(args.values)
    package, _, name = kind._TYPE_NAME.replace("/srv/", "/").partition("/")
    with direct_node(args, f"{HIDDEN_PREFIX}_requester_{package}_{name}") as node:
        client = node.create_client(kind, expanded(node, args.service_name, is_service=True))
        request = kind.Request()
        setters = populate(request, values)
        _wait_for_service(node, client)
        seconds = stretch_of(args) if args.rate else None
        deadline = None if seconds is None else now() + seconds
        while True:
            begun = now()
            stamp(setters, node)
            _ask(node, client, request, args.seconds or LONGEST_ANSWER)
            if args.rate is None:
                return
            following = begun + 1 / args.rate
            if deadline is not None and seconds is not None and following >= deadline:
                time.sleep(max(0.0, deadline - now()))
                raise end_of_stretch(seconds)
            time.sleep(max(0.0, following - now()))


def _wait_for_service(node: Node, client: Client) -> None:
    if client.service_is_ready():
        return
    print("waiting for service to become available...")
    if client.wait_for_service(timeout_sec=PATIENCE):
        return
    name, kind = client.service_name, client.srv_type._TYPE_NAME
    waited = f"Gave up after {PATIENCE:g} s of robot time"
    known = services(node, include_hidden=True)
    if name in known:
        raise CommandError(f"{waited}: {name} is of type {', '.join(known[name])}, not {kind}")
    hint = suggest(name, known)
    raise CommandError(
        f"{waited}: no node offers {name}",
        hint or "Is its node running (`ros2 node list`)? `ros2 service list` shows the services.",
    )


def _ask(node: Node, client: Client, request: Any, seconds: float) -> None:
    """Send the request and print the answer, or say why there is none within the time (s)."""

    print(f"requester: making request: {request!r}\n")
    future: Future = client.call_async(request)
    begun = now()
    while not spin_for(node, min(LOOK_AGAIN, begun + seconds - now()), future):
        if not client.service_is_ready():
            raise CommandError(
                f"{client.service_name} went away before it answered: did its node end, or did an error stop it?"
            )
        if now() >= begun + seconds - 1e-9:
            raise CommandError(
                f"No answer from {client.service_name} in {seconds:g} s of robot time: "
                "is its node busy with something else, or did an error end its callback?"
            )
    if future.exception() is not None:
        raise CommandError(f"Exception while calling service: {future.exception()!r}")
    print(f"response:\n{future.result()!r}\n")


VERBS: dict[str, Verb] = {
    "call": Command("Call a service and print its answer", _call_arguments, call),
    "find": Command("The services of a type", SERVICES.find_arguments, SERVICES.print_found),
    "info": Command("A service's type, and how many servers and clients it has", SERVICES.type_arguments, info),
    "list": Command("The names of the services that are offered", SERVICES.list_arguments, SERVICES.print_list),
    "type": Command("A service's type", SERVICES.type_arguments, SERVICES.print_type),
}
