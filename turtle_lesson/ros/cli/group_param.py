"""`ros2 param`: read and change the parameters of nodes."""

from __future__ import annotations

import re
import sys
from argparse import Namespace
from collections.abc import Callable
from pathlib import Path
from typing import Any

import yaml
from rclpy.node import Node
from rclpy.parameter import Parameter, parameter_value_to_python

from ..runtime import files
from .arguments import HIDDEN_NODES, NODE, OF_NODE, arg, flag
from .typed_values import MAX_LENGTH, Unparsable, read_yaml
from .verb import CommandError, ask, find_node, graph_verb, node_names, spin_for, suggest

# -- parameters' values: from text as typed, to text, and to what YAML has ---------------------------------------------
# Which text becomes which type follows a recording of the real `ros2 param set`.

TYPES = (
    "not set", "boolean", "integer", "double", "string", "byte array", "boolean array", "integer array", "double array",
    "string array",
)  # fmt: skip
"""By number of rcl_interfaces/msg/ParameterType: the type's name."""


def from_text(text: str) -> Any:
    """The ParameterValue that a text means, read as YAML. Raises CommandError for what no parameter can be."""
    try:
        value = read_yaml(text, "The value")
    except Unparsable:
        value = text
    return from_python(value, text)


def from_python(value: Any, text: str) -> Any:
    """The ParameterValue of what YAML gave for a text."""
    from rcl_interfaces.msg import ParameterValue

    ending = "_ARRAY" if isinstance(value, list) else ""
    kinds = [Parameter.Type[name + ending] for name in ("BOOL", "INTEGER", "DOUBLE", "STRING")]
    kind = next((each for each in kinds if each.check(value)), Parameter.Type.STRING)
    message = ParameterValue(type=kind.value)
    try:
        setattr(message, f"{kind.name.lower()}_value", text if ending and kind is Parameter.Type.STRING else value)
    except (AssertionError, OverflowError) as error:
        raise CommandError(f"{text[:200]!r} is not a valid parameter value: {error}") from None
    return message


def nested(names_and_values: list[tuple[str, Any]]) -> dict[str, Any]:
    """Parameters as nested dictionaries: `a.b` is `b` in `a`."""
    tree: dict[str, Any] = {}
    for name, value in names_and_values:
        place = tree
        *folders, last = name.split(".")
        for folder in folders:
            place = place.setdefault(folder, {}) if isinstance(place.get(folder, {}), dict) else place
        place[last] = value
    return tree


def flat(tree: dict[Any, Any], prefix: str = "") -> list[tuple[str, Any]]:
    """Nested dictionaries as parameters' full names and values."""
    found: list[tuple[str, Any]] = []
    for name, value in tree.items():
        full_name = f"{prefix}{name}"
        found += flat(value, f"{full_name}.") if isinstance(value, dict) else [(full_name, value)]
    return found


# -- what the verbs share --------------------------------------------------------------------------------------------

PARAMETER = arg("parameter_name", "Name of the parameter")


def listed(node: Node, name: str) -> list[str]:
    """The names of a node's parameters, sorted."""
    return sorted(ask(node, name, "rcl_interfaces/srv/ListParameters").result.names)


def set_values(node: Node, node_name: str, values: dict[str, Any], done: str, failed: str) -> bool:
    """Have a node set parameters to ParameterValues, and say how each went and why; whether all were set.

    `{}` in what is said stands for a parameter's name.
    """
    from rcl_interfaces import msg

    parameters = [msg.Parameter(name=name, value=value) for name, value in values.items()]
    results = ask(node, node_name, "rcl_interfaces/srv/SetParameters", parameters=parameters).results
    for name, result in zip(values, results, strict=True):
        text = (done if result.successful else failed).format(name)
        stream = sys.stdout if result.successful else sys.stderr
        print(f"{text}: {result.reason}" if result.reason else text, file=stream)
    return all(result.successful for result in results)


@graph_verb(
    "param dump",
    *OF_NODE,
    arg("--output-dir", "Deprecated: write a file named after the node into this folder"),
    flag("--print", "Deprecated: print, as without --output-dir"),
)
def dump(args: Namespace, node: Node) -> None:
    """All parameters of a node, in the format that `load` reads."""
    if args.output_dir is not None and not Path(args.output_dir).is_dir():
        raise CommandError(f"'{args.output_dir}' is not a valid directory.")
    name = find_node(node, args)
    names = listed(node, name)
    values = ask(node, name, "rcl_interfaces/srv/GetParameters", names=names).values
    pairs = zip(names, map(parameter_value_to_python, values), strict=False)
    tree = {name: {"ros__parameters": nested(list(pairs))}}
    text = yaml.safe_dump(tree, default_flow_style=False, allow_unicode=True)
    if args.print:
        print("WARNING: '--print' is deprecated; this utility prints to stdout by default", file=sys.stderr)
    if args.print or args.output_dir is None:
        print(text)
        return
    print("WARNING: '--output-dir' is deprecated; use redirection to save to a file", file=sys.stderr)
    file = Path(args.output_dir, f"{name[1:].replace('/', '__')}.yaml")
    print("Saving to: ", file)
    try:
        files.save(file, text)
    except OSError as error:
        raise CommandError(f"cannot write {file}: {error.strerror}") from None


@graph_verb("param load", *OF_NODE, arg("parameter_file", "A file as `ros2 param dump` prints it"))
def load(args: Namespace, node: Node) -> None:
    """Set parameters from a file."""
    name = find_node(node, args)
    values = {each: from_python(value, str(value)) for each, value in _read_file(args.parameter_file, name).items()}
    set_values(node, name, values, "Set parameter {} successful", "Set parameter {} failed")


def _read_file(path: str, node_name: str) -> dict[str, Any]:
    """The parameters that a file has for all nodes (`/**`) and for this one. Raises CommandError if it has none."""
    file = Path(path)
    try:
        # Devices are not read, and of a file no more than YAML may have: some never end.
        if file.exists() and not file.is_file():
            raise CommandError(f"cannot read {path}: it is a folder or a device, not a file")
        with file.open(encoding="utf-8") as stream:
            content = read_yaml(stream.read(MAX_LENGTH + 1), path)
    except UnicodeDecodeError:
        raise CommandError(f"cannot read {path}: it is not text in UTF-8") from None
    except (OSError, ValueError) as error:
        raise CommandError(str(error)) from None
    if not isinstance(content, dict):
        raise CommandError(f"{path} is not a parameter file: it has no '{node_name}:' with ros__parameters below it")
    keys = [key for key in ("/**", node_name) if key in content]
    if not keys:
        raise CommandError(
            f"Param file does not contain parameters for {node_name},  only for nodes: {content.keys()}",
            suggest(node_name, map(str, content)) and f"Write the name with its slash: {node_name}",
        )
    found: dict[str, Any] = {}
    for key in keys:
        if not isinstance(content[key], dict) or not isinstance(content[key].get("ros__parameters"), dict):
            raise CommandError(
                f"Invalid structure of parameter file for node {key}expected same format as provided by ros2 param dump"
            )
        found.update(flat(content[key]["ros__parameters"]))
    return found


LIST_PATIENCE = 1.0
"""How long, in s, `param list` waits for each node, as the real one does."""


@graph_verb(
    "param list",
    *NODE,
    arg("node_name", "Name of the node, such as /turtlesim", nargs="?"),
    HIDDEN_NODES,
    arg("--param-prefixes", "Only parameters that begin with these", nargs="+", default=[]),
    flag("--param-type", "Show each parameter's type beside it"),
    arg("--filter", "Only names whose beginning this regular expression matches", default=""),
)
def list_parameters(args: Namespace, node: Node) -> None:
    """The names of the parameters."""
    from rcl_interfaces.srv import ListParameters

    try:
        wanted = re.compile(args.filter).match
    except (re.error, OverflowError, RecursionError) as error:
        raise CommandError(f"'{args.filter}' is not a regular expression: {error}") from None
    every = dict.fromkeys(node_names(node, args.include_hidden_nodes))
    futures = {}
    for name in [find_node(node, args)] if args.node_name else every:
        client = node.create_client(ListParameters, f"{name}/list_parameters")
        if client.service_is_ready():
            futures[name] = client.call_async(ListParameters.Request(prefixes=args.param_prefixes))
    for name, future in futures.items():
        if not spin_for(node, LIST_PATIENCE, future):
            print(f"Exception while calling service of node '{name}': None", file=sys.stderr)
            continue
        names = [each for each in sorted(future.result().result.names) if wanted(each)]
        if names and not args.node_name:  # as in ros2param/verb/list.py
            print(f"{name}:")
        types: dict[str, str] = {}
        if args.param_type and names:
            descriptors = ask(node, name, "rcl_interfaces/srv/DescribeParameters", names=names).descriptors
            types = {each.name: f" (type: {TYPES[each.type]})" for each in descriptors}
        for each in names:
            print(f"  {each}{types.get(each, '')}")


@graph_verb("param get", *OF_NODE, PARAMETER, flag("--hide-type", "Print only the value"))
def get(args: Namespace, node: Node) -> None:
    """A parameter's value."""
    name = find_node(node, args)
    values = ask(node, name, "rcl_interfaces/srv/GetParameters", names=[args.parameter_name]).values
    if not values:
        raise CommandError("Parameter not set", suggest(args.parameter_name, listed(node, name)))
    kind = Parameter.Type(values[0].type)
    what, _, array = TYPES[kind.value].partition(" ")
    label = f"{what.capitalize()} {'values are' if array else 'value is'}:"
    if kind is Parameter.Type.NOT_SET:
        print("" if args.hide_type else "Parameter not set.")
    else:
        print(*([] if args.hide_type else [label]), getattr(values[0], f"{kind.name.lower()}_value"))


@graph_verb("param set", *OF_NODE, PARAMETER, arg("value", "Its new value, in YAML: 1.5, true, fast, '[1, 2]'"))
def set_parameter(args: Namespace, node: Node) -> None:
    """Change a parameter."""
    _change(args, node, lambda: from_text(args.value), "Set parameter successful", "Setting parameter failed")


@graph_verb("param delete", *OF_NODE, PARAMETER)
def delete(args: Namespace, node: Node) -> None:
    """Delete a parameter."""
    from rcl_interfaces.msg import ParameterValue

    _change(args, node, ParameterValue, "Deleted parameter successfully", "Deleting parameter failed")


def _change(args: Namespace, node: Node, value: Callable[[], Any], done: str, failed: str) -> None:
    """Set a parameter. As in the real tool, the exit code is 0 also if the node refuses the value."""
    name = find_node(node, args)
    if set_values(node, name, {args.parameter_name: value()}, done, failed):
        return
    known = listed(node, name)
    if args.parameter_name not in known and (hint := suggest(args.parameter_name, known)):
        print(hint, file=sys.stderr)


@graph_verb("param describe", *OF_NODE, arg("parameter_names", "Names of the parameters", nargs="+"))
def describe(args: Namespace, node: Node) -> None:
    """What a parameter is for, its type and limits.

    If one of the parameters is unknown the real one says nothing, of any of them.
    """
    name = find_node(node, args)
    descriptors = ask(node, name, "rcl_interfaces/srv/DescribeParameters", names=args.parameter_names).descriptors
    for each in descriptors:
        print(f"Parameter name: {each.name}")
        print(f"  Type: {TYPES[each.type]}")
        if each.description:
            print(f"  Description: {each.description}")
        print("  Constraints:")
        if each.read_only:
            print("    Read only: true")
        for limits in [*each.floating_point_range, *each.integer_range][:1]:
            print(f"    Min value: {limits.from_value}")
            print(f"    Max value: {limits.to_value}")
            if limits.step:
                print(f"    Step: {limits.step}")
        if each.additional_constraints:
            print(f"    Additional constraints: {each.additional_constraints}")
    if not descriptors:
        known = listed(node, name)
        for each in args.parameter_names:
            if each not in known:
                print(f"{name} has no parameter '{each}'\n{suggest(each, known)}".rstrip(), file=sys.stderr)
