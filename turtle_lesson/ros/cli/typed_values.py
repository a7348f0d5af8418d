"""From what was typed to types, messages, names in the graph and quality of service, or to a sentence that helps."""

from __future__ import annotations

import sys
from argparse import Namespace
from collections.abc import Callable
from typing import Any

import yaml
from rclpy import qos
from rclpy.node import Node
from rosidl_runtime_py import utilities
from rosidl_runtime_py.set_message import set_message_fields

from ..idl.model import InvalidDefinition
from ..idl.names import did_you_mean
from ..idl.registry import FOLDERS, registry
from ..runtime.bounded_yaml import safe_load
from .arguments import Argument, arg, depth, flag
from .verb import CommandError, expanded, graph_verb, print_names, suggest, with_types

# -- types -----------------------------------------------------------------------------------------------------------


def class_of(name: str, folder: str) -> Any:
    """The class of a message ("msg"), a service ("srv") or an action ("action").

    Raises CommandError with the real tool's sentence, and what was meant perhaps.
    """
    kind = {"msg": "message", "srv": "service"}.get(folder, folder)
    found = _find(getattr(utilities, f"get_{kind}"), name)
    if found is not None:
        return found
    is_other = folder == "srv" and name.count("/") == 2 and _find(utilities.get_interface, name) is not None
    sentence = "The passed type is not a service" if is_other else f"The passed {kind} type is invalid"
    raise CommandError(sentence, suggest_type(name, folder))


def _find(get: Callable[[str], Any], name: str) -> Any:
    """The class of a name, or None; a definition that is refused says why."""
    parts = name.split("/")
    if len(parts) > 3 or (len(parts) == 3 and parts[1] not in FOLDERS) or not all(map(str.isidentifier, parts)):
        return None
    try:
        return get(name)
    except InvalidDefinition:
        raise
    except (AttributeError, ImportError, ValueError):
        return None


def suggest_type(name: str, folder: str = "") -> str:
    """`Did you mean 'std_msgs/msg/String'?`, or nothing if no type is like that.

    Of several types with this last name, the likeliest one of the folder is named, or up to three of all folders.
    """
    known = [each for each in interface_names() if each != name and f"/{folder}" in each]
    package, _, last = name.replace(".", "/").rpartition("/")
    same_name = [each for each in known if each.rpartition("/")[2].lower() == last.lower()]
    if same_name and not registry.knows(package.partition("/")[0]):
        likely = sorted(same_name, key=lambda each: not each.startswith("std_"))[: 1 if folder else 3]
        return f"Did you mean {' or '.join(map(repr, likely))}?"
    return did_you_mean(f"{package}/{folder}/{last}" if package and "/" not in package else name, known)


def interface_names() -> list[str]:
    """The full names of all interfaces."""
    return [
        f"{package}/{name}" for package in registry.packages() for name in registry.package(package).interface_names()
    ]


# -- values ----------------------------------------------------------------------------------------------------------

MAX_LENGTH = 100_000
"""How many characters of YAML are read at most."""


class Unparsable(CommandError):
    """The brackets, commas or colons of a text make no YAML; `ros2 param set` takes such a text as it is."""


def read_yaml(text: str, what: str = "The passed value") -> Any:
    """The value of a YAML text. Raises CommandError, in one line, for anything that is none or could be a trap."""
    if len(text) > MAX_LENGTH:
        raise CommandError(f"{what} is too long: at most {MAX_LENGTH} characters of YAML are read")
    try:
        return safe_load(text)
    except (yaml.YAMLError, ValueError, OverflowError) as error:
        reason = str(error)
        if isinstance(error, yaml.MarkedYAMLError):
            reason = ", ".join(filter(None, (error.context, error.problem)))
            if mark := error.problem_mark:
                reason += f" (line {mark.line + 1}, column {mark.column + 1})"
        kind = Unparsable if isinstance(error, yaml.parser.ParserError) else CommandError
        raise kind(f"{what} is not valid YAML: {' '.join(reason.split())}") from None


def populate(message: Any, values: Any, *, is_goal: bool = False) -> list[Callable[[Any], None]]:
    """Set the fields of a message, a request or a goal to values as YAML gives them, or raise CommandError with a sentence.

    Returns functions that want the time of sending, for what was typed as `header: auto` or `stamp: now`; none for a goal.
    """
    try:
        return set_message_fields(message, values, expand_header_auto=not is_goal, expand_time_now=not is_goal)
    except (TypeError, AttributeError, ValueError, AssertionError, OverflowError, RecursionError) as error:
        what = f"message fields: {error!r}" if is_goal else f"field: {error}"
        notes = getattr(error, "__notes__", ()) if isinstance(error, (AttributeError, TypeError)) else ()
        raise CommandError(f"Failed to populate {what}", "\n".join(notes)) from None


def stamp(setters: list[Callable[[Any], None]], node: Node) -> None:
    """Have the stamps that `populate` left open be the time of now."""
    if setters:
        now = node.get_clock().now().to_msg()
        for set_stamp in setters:
            set_stamp(now)


# -- names in the graph ----------------------------------------------------------------------------------------------

Known = Callable[[Node, bool], dict[str, list[str]]]
"""All names of a kind that are there with their types, also hidden ones if wanted."""


def name_argument(kind: str, example: str) -> Argument:
    """The argument that names a topic, service or action which is there."""
    return arg(f"{kind}_name", f"Full name of the {kind}, such as {example}")


def list_arguments(kind: str, use: str = "list") -> tuple[Argument, ...]:
    """The arguments with which `list` and `find` count names, and include hidden ones; there are no hidden actions."""
    count = flag(f"-c --count-{kind}s", "Print only how many there are")
    hidden = flag(f"--include-hidden-{kind}s", f"Also {use} {kind}s with a hidden name")
    return (count,) if kind == "action" else (count, hidden)


def types_of(kind: str, name: str, known: dict[str, list[str]]) -> list[str]:
    """The types of a name. Raises CommandError if there is no such name."""
    if name not in known:
        raise CommandError(f"Unknown {kind} '{name}'", suggest(name, known))
    return known[name]


def add_verbs(
    kind: str, folder: str, examples: tuple[str, str], known: Known, *common: Argument, of_list: str = ""
) -> None:
    """Add the verbs `type`, `find` and perhaps `list` of topics, services or actions (`kind`).

    Args:
        folder: the kind of their types: "msg", "srv" or "action".
        examples: the name of one, and of a type.
        common: arguments that `type` and `find` have beside their own.
        of_list: the help of `list`; without one it is not added.
    """
    article = "An" if kind == "action" else "A"

    def chosen(args: Namespace, node: Node) -> dict[str, list[str]]:
        return known(node, getattr(args, f"include_hidden_{kind}s", False))

    if of_list:
        types = flag("-t --show-types", f"Show each {kind}'s type beside it")

        @graph_verb(f"{kind} list", types, *list_arguments(kind), help_text=of_list)
        def print_known(args: Namespace, node: Node) -> None:
            lines = with_types(chosen(args, node), shown=args.show_types)
            print_names(lines, count=getattr(args, f"count_{kind}s"))

    @graph_verb(f"{kind} type", *common, name_argument(kind, examples[0]), help_text=f"{article} {kind}'s type")
    def print_type(args: Namespace, node: Node) -> None:
        """For an unknown name the real tool says nothing, and ends with exit code 1."""
        print_names(types_of(kind, getattr(args, f"{kind}_name"), known(node, True)))

    wanted = arg(f"{kind}_type", f"Name of the type, such as {examples[1]}")

    @graph_verb(f"{kind} find", *common, wanted, *list_arguments(kind, "find"), help_text=f"The {kind}s of a type")
    def print_found(args: Namespace, node: Node) -> None:
        type_name = getattr(args, f"{kind}_type")
        found = [name for name, types in chosen(args, node).items() if type_name in types]
        count = getattr(args, f"count_{kind}s")
        print_names(found, count=count)
        if found or count:
            return
        if (
            type_name.count("/") != 2 or _find(utilities.get_interface, type_name) is None
        ):  # none, or typed in its short form
            hint = suggest_type(type_name, folder)
            print(f"There is no type '{type_name}'\n{hint}".rstrip(), file=sys.stderr)


# -- quality of service ----------------------------------------------------------------------------------------------

PRESETS = (
    "unknown", "system_default", "sensor_data", "services_default", "parameters", "parameter_events",
    "action_status_default",
)  # fmt: skip
HISTORIES = ("system_default", "keep_last", "keep_all", "unknown")
RELIABILITIES = ("system_default", "reliable", "best_effort", "unknown")
DURABILITIES = ("system_default", "transient_local", "volatile", "unknown")

FALL_BACK = (
    "Some, but not all, publishers are offering {policy}.{strong}. Falling back to {policy}.{weak} as it will connect "
    "to all publishers"
)


def qos_arguments(preset: str, reliability: str, durability: str) -> tuple[Argument, ...]:
    """The options, whose help names these defaults."""
    again = f"Whether lost messages are sent again (default: {reliability})"
    late = f"Whether late subscriptions get earlier messages (default: {durability})"
    return (
        arg("--qos-profile", f"Profile whose policies the other options change (default: {preset})", choices=PRESETS),
        arg("--qos-depth", "Length of the queue", metavar="N", type=depth),
        arg("--qos-history", "Which messages the queue keeps (default: keep_last)", choices=HISTORIES),
        arg("--qos-reliability", again, choices=RELIABILITIES),
        arg("--qos-durability", late, choices=DURABILITIES),
    )


def profile_of(args: Namespace, preset: str, **defaults: str) -> qos.QoSProfile:
    """The profile that the options ask for; `defaults` are policies by short name, used if no preset was given."""
    profile = qos.QoSProfile(**vars(qos.QoSPresetProfiles.get_from_short_key(args.qos_profile or preset)))
    if (args.qos_depth or 0) > 0:
        profile.depth = args.qos_depth
    for policy in (qos.HistoryPolicy, qos.ReliabilityPolicy, qos.DurabilityPolicy):
        name = policy.__name__.removesuffix("Policy").lower()
        chosen = getattr(args, f"qos_{name}") or (defaults.get(name) if args.qos_profile is None else None)
        if chosen:
            setattr(profile, name, policy.get_from_short_key(chosen))
    return profile


def matching_profile(node: Node, topic: str, args: Namespace, preset: str) -> qos.QoSProfile:
    """What the options ask for; without any, the preset, changed so that a subscription hears every publisher that is there.

    A policy is the strong one if all of them offer it, else the weak one, which is said where some offer the strong one.
    """
    profile = profile_of(args, preset)
    if any(value is not None for name, value in vars(args).items() if name.startswith("qos_")):
        return profile
    offers = [info.qos_profile for info in node.get_publishers_info_by_topic(expanded(node, topic))]
    for name, strong, weak in (
        ("reliability", qos.ReliabilityPolicy.RELIABLE, qos.ReliabilityPolicy.BEST_EFFORT),
        ("durability", qos.DurabilityPolicy.TRANSIENT_LOCAL, qos.DurabilityPolicy.VOLATILE),
    ):
        offered = {getattr(each, name) for each in offers}
        if offered:
            setattr(profile, name, strong if offered == {strong} else weak)
        if strong in offered and offered != {strong}:
            print(FALL_BACK.format(policy=f"QoS{type(strong).__name__}", strong=strong.name, weak=weak.name))
    return profile
