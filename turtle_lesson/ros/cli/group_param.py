"""`ros2 param`: read and change the parameters of nodes."""

from __future__ import annotations

import sys
from argparse import ArgumentParser, Namespace
from typing import TYPE_CHECKING, Any

from . import param_files, param_values
from .param_values import TYPES, arguments_of_all, ask, find_node, listed, set_values, with_reason
from .parser import Verb
from .verb import Command, CommandError, answer_of, direct_node, node_names, suggest

if TYPE_CHECKING:
    from rclpy.node import Node


LIST_PATIENCE = 1.0
"""How long, in s, `param list` waits for each node, as the real one does."""


def _hint(node: Node, node_name: str, parameter: str) -> str:
    """What may have been meant by a parameter that a node does not have."""
    return suggest(parameter, listed(node, node_name))


# -- list --------------------------------------------------------------------------------------------------------


def _list_arguments(parser: ArgumentParser) -> None:
    arguments_of_all(parser, optional_node=True)
    parser.add_argument("--param-prefixes", nargs="+", default=[], help="Only parameters that begin with these")
    parser.add_argument("--param-type", action="store_true", help="Show each parameter's type beside it")
    parser.add_argument("--filter", metavar="FILTER", help="Only names whose beginning this regular expression matches")


def list_parameters(args: Namespace) -> None:
    """`ros2 param list`. A node of which nothing is listed is left out (ros2param/verb/list.py)."""
    wanted = _name_filter(args.filter)
    with direct_node(args) as node:
        every = dict.fromkeys(node_names(node, args.include_hidden_nodes))
        nodes = [find_node(node, args)] if args.node_name else list(every)
        for name, response in _ask_all(node, nodes, args.param_prefixes):
            if response is None:
                print(f"Exception while calling service of node '{name}': None", file=sys.stderr)
                continue
            names = [each for each in sorted(response.result.names) if wanted(each)]
            if names and not args.node_name:
                print(f"{name}:")
            _print_names(node, name, names, args.param_type)


def _name_filter(pattern: str | None) -> Any:
    import re

    try:
        return re.compile(pattern or "").match
    except (re.error, OverflowError, RecursionError) as error:
        raise CommandError(f"'{pattern}' is not a regular expression: {error}") from None


def _ask_all(node: Node, names: list[str], prefixes: list[str]) -> list[tuple[str, Any]]:
    """What each node that has parameters answers; None for one that does not within the time."""
    from rcl_interfaces.srv import ListParameters

    futures = []
    for name in names:
        client = node.create_client(ListParameters, f"{name}/list_parameters")
        if client.service_is_ready():
            futures.append((name, client.call_async(ListParameters.Request(prefixes=prefixes))))
    return [(name, answer_of(node, future, LIST_PATIENCE)) for name, future in futures]


def _print_names(node: Node, node_name: str, names: list[str], with_types: bool) -> None:
    types: dict[str, str] = {}
    if with_types and names:
        descriptors = ask(node, node_name, "DescribeParameters", names=names).descriptors
        types = {each.name: f" (type: {TYPES[each.type][0]})" for each in descriptors}
    for name in names:
        print(f"  {name}{types.get(name, '')}")


# -- get, set, delete, describe ----------------------------------------------------------------------------------


def _get_arguments(parser: ArgumentParser) -> None:
    arguments_of_all(parser)
    parser.add_argument("parameter_name", help="Name of the parameter")
    parser.add_argument("--hide-type", action="store_true", help="Print only the value")


def get(args: Namespace) -> None:
    """`ros2 param get`."""
    with direct_node(args) as node:
        name = find_node(node, args)
        values = ask(node, name, "GetParameters", names=[args.parameter_name]).values
        if not values:
            raise CommandError("Parameter not set", _hint(node, name, args.parameter_name))
    _, field, label = TYPES[values[0].type]
    if not field:
        print(label if not args.hide_type else None)
        return
    print(*([] if args.hide_type else [label]), getattr(values[0], field))


def _set_arguments(parser: ArgumentParser) -> None:
    arguments_of_all(parser)
    parser.add_argument("parameter_name", help="Name of the parameter")
    parser.add_argument("value", help="Its new value, in YAML: 1.5, true, fast, '[1, 2]'")


def set_parameter(args: Namespace) -> None:
    """`ros2 param set`. As in the real tool, the exit code is 0 also if the node refuses the value."""
    with direct_node(args) as node:
        name = find_node(node, args)
        value = param_values.from_text(args.value)
        [result] = set_values(node, name, [(args.parameter_name, value)])
        if result.successful:
            print(with_reason("Set parameter successful", result))
            return
        print(with_reason("Setting parameter failed", result), file=sys.stderr)
        _print_hint(node, name, args.parameter_name, result)


def _print_hint(node: Node, node_name: str, parameter: str, result: Any) -> None:
    known = listed(node, node_name)
    if parameter not in known and (hint := suggest(parameter, known)):
        print(hint, file=sys.stderr)


def _delete_arguments(parser: ArgumentParser) -> None:
    arguments_of_all(parser)
    parser.add_argument("parameter_name", help="Name of the parameter")


def delete(args: Namespace) -> None:
    """`ros2 param delete`."""
    from rcl_interfaces.msg import ParameterValue

    with direct_node(args) as node:
        name = find_node(node, args)
        [result] = set_values(node, name, [(args.parameter_name, ParameterValue())])
        if result.successful:
            print(with_reason("Deleted parameter successfully", result))
            return
        print(with_reason("Deleting parameter failed", result), file=sys.stderr)
        _print_hint(node, name, args.parameter_name, result)


def _describe_arguments(parser: ArgumentParser) -> None:
    arguments_of_all(parser)
    parser.add_argument("parameter_names", nargs="+", help="Names of the parameters")


def describe(args: Namespace) -> None:
    """`ros2 param describe`. If one of the parameters is unknown the real one says nothing, of any of them."""
    with direct_node(args) as node:
        name = find_node(node, args)
        descriptors = ask(node, name, "DescribeParameters", names=args.parameter_names).descriptors
        for descriptor in descriptors:
            _print_descriptor(descriptor)
        if not descriptors:
            known = listed(node, name)
            for each in args.parameter_names:
                if each not in known:
                    print(f"{name} has no parameter '{each}'\n{suggest(each, known)}".rstrip(), file=sys.stderr)


def _print_descriptor(descriptor: Any) -> None:
    print(f"Parameter name: {descriptor.name}")
    print(f"  Type: {TYPES[descriptor.type][0]}")
    if descriptor.description:
        print(f"  Description: {descriptor.description}")
    print("  Constraints:")
    if descriptor.read_only:
        print("    Read only: true")
    for limits in [*descriptor.floating_point_range, *descriptor.integer_range][:1]:
        print(f"    Min value: {limits.from_value}")
        print(f"    Max value: {limits.to_value}")
        if limits.step:
            print(f"    Step: {limits.step}")
    if descriptor.additional_constraints:
        print(f"    Additional constraints: {descriptor.additional_constraints}")


VERBS: dict[str, Verb] = {
    "delete": Command("Delete a parameter", _delete_arguments, delete),
    "describe": Command("What a parameter is for, its type and limits", _describe_arguments, describe),
    "dump": Command(
        "All parameters of a node, in the format that `load` reads", param_files.dump_arguments, param_files.dump
    ),
    "get": Command("A parameter's value", _get_arguments, get),
    "list": Command("The names of the parameters", _list_arguments, list_parameters),
    "load": Command("Set parameters from a file", param_files.load_arguments, param_files.load),
    "set": Command("Change a parameter", _set_arguments, set_parameter),
}
