"""Parameters' values as text and as YAML, and asking a node about its parameters: what the verbs of `ros2 param` share."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from typing import TYPE_CHECKING, Any

from .typed_values import Unparsable, read_yaml
from .verb import PATIENCE, CommandError, absolute, add_node_arguments, answer_of, node_names, suggest

if TYPE_CHECKING:
    from rclpy.node import Node


# -- param values -------------------------------------------------------------------------------------------------
# Parameters' values: from text as typed, to text, and to what YAML has.
# Which text becomes which type follows a recording of the real `ros2 param set`.

TYPES: tuple[tuple[str, str, str], ...] = (
    ("not set", "", "Parameter not set."),
    ("boolean", "bool_value", "Boolean value is:"),
    ("integer", "integer_value", "Integer value is:"),
    ("double", "double_value", "Double value is:"),
    ("string", "string_value", "String value is:"),
    ("byte array", "byte_array_value", "Byte values are:"),
    ("boolean array", "bool_array_value", "Boolean values are:"),
    ("integer array", "integer_array_value", "Integer values are:"),
    ("double array", "double_array_value", "Double values are:"),
    ("string array", "string_array_value", "String values are:"),
)
"""By number of rcl_interfaces/msg/ParameterType: the type's name, its field of a ParameterValue, and how it is shown."""

_SCALARS: tuple[tuple[type, int], ...] = ((bool, 1), (int, 2), (float, 3))
_ELEMENTS: tuple[tuple[type, int], ...] = ((bool, 6), (int, 7), (float, 8), (str, 9))


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

    kind = _kind_of(value)
    message = ParameterValue(type=kind)
    if kind == 4 and isinstance(value, list):
        value = text
    try:
        setattr(message, TYPES[kind][1], value)
    except (AssertionError, OverflowError) as error:
        raise CommandError(f"{text[:200]!r} is not a valid parameter value: {error}") from None
    return message


def _kind_of(value: Any) -> int:
    for type_, kind in _SCALARS:
        if isinstance(value, type_):
            return kind
    if isinstance(value, list):
        for type_, kind in _ELEMENTS:
            if all(isinstance(each, type_) for each in value):
                return kind
    return 4


def to_python(value: Any) -> Any:
    """What YAML has for a ParameterValue; None if it is not set."""
    if not 0 < value.type < len(TYPES):
        return None
    found = getattr(value, TYPES[value.type][1])
    return list(found) if TYPES[value.type][0].endswith("array") else found


def nested(names_and_values: list[tuple[str, Any]]) -> dict[str, Any]:
    """Parameters as nested dictionaries: `a.b` is `b` in `a`."""
    tree: dict[str, Any] = {}
    for name, value in names_and_values:
        place = tree
        *folders, last = name.split(".")
        for folder in folders:
            inner = place.setdefault(folder, {})
            if not isinstance(inner, dict):
                break
            place = inner
        place[last] = value
    return tree


def flat(tree: dict[Any, Any], prefix: str = "") -> list[tuple[str, Any]]:
    """Nested dictionaries as parameters' full names and values."""
    found: list[tuple[str, Any]] = []
    for name, value in tree.items():
        full_name = f"{prefix}{name}"
        found += flat(value, f"{full_name}.") if isinstance(value, dict) else [(full_name, value)]
    return found


# -- param calls --------------------------------------------------------------------------------------------------
# Asking a node about its parameters: what the verbs of `ros2 param` share.


def arguments_of_all(parser: ArgumentParser, *, optional_node: bool = False) -> None:
    """The arguments of every verb of `ros2 param`."""
    add_node_arguments(parser)
    parser.add_argument("node_name", nargs="?" if optional_node else None, help="Name of the node, such as /turtlesim")
    parser.add_argument("--include-hidden-nodes", action="store_true", help="Also use nodes with a hidden name")


def find_node(node: Node, args: Namespace) -> str:
    """The full name of the node that was named. Raises CommandError if it is not there."""
    name, known = absolute(args.node_name), node_names(node, args.include_hidden_nodes)
    if name not in known:
        raise CommandError("Node not found", suggest(name, known))
    return name


def ask(node: Node, node_name: str, service: str, **request: Any) -> Any:
    """The answer of a node's parameter service, such as GetParameters.

    Raises CommandError if there is none: the real tool waits forever for a node that is busy.
    """
    import rcl_interfaces.srv

    kind = getattr(rcl_interfaces.srv, service)
    words = "".join(f"_{letter.lower()}" if letter.isupper() else letter for letter in service).lstrip("_")
    client = node.create_client(kind, f"{node_name}/{words}")
    if not client.wait_for_service(timeout_sec=PATIENCE):
        raise CommandError(f"Wait for service timed out: {node_name} offers no {words}")
    response = answer_of(node, client.call_async(kind.Request(**request)), PATIENCE)
    if response is None:
        raise CommandError(
            f"No answer from {node_name} in {PATIENCE:g} s of robot time: is it busy in a callback, or not spinning?"
        )
    return response


def listed(node: Node, name: str, prefixes: list[str] | None = None) -> list[str]:
    """The names of a node's parameters, sorted."""
    return sorted(ask(node, name, "ListParameters", prefixes=prefixes or []).result.names)


def set_values(node: Node, node_name: str, names_and_values: list[tuple[str, Any]]) -> Any:
    """Ask a node to set parameters; how each went, as rcl_interfaces/msg/SetParametersResult."""
    from rcl_interfaces.msg import Parameter

    parameters = [Parameter(name=name, value=value) for name, value in names_and_values]
    return ask(node, node_name, "SetParameters", parameters=parameters).results


def with_reason(text: str, result: Any) -> str:
    """A text, and the reason that the node gave, if any."""
    return f"{text}: {result.reason}" if result.reason else text
