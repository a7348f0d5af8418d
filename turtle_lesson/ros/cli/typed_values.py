"""From what was typed to types, messages, names in the graph and quality of service, or to a sentence that helps."""

from __future__ import annotations

import sys
import warnings
from argparse import ArgumentParser, ArgumentTypeError, Namespace
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from ..idl.model import InvalidDefinition
from ..idl.names import did_you_mean
from ..idl.registry import FOLDERS, registry
from .verb import MOST, CommandError, direct_node, expanded, flag, suggest

if TYPE_CHECKING:
    from rclpy.node import Node
    from rclpy.qos import QoSProfile


# -- types -----------------------------------------------------------------------------------------------------------


def message_class(name: str) -> Any:
    """The class of a message. Raises CommandError with the real tool's sentence, and what was meant perhaps."""
    from rosidl_runtime_py.utilities import get_message

    return _found(get_message, name, "The passed message type is invalid", "msg")


def service_class(name: str) -> Any:
    """The class of a service. Raises CommandError with the real tool's sentence, and what was meant perhaps."""
    from rosidl_runtime_py.utilities import get_interface, get_service

    is_other = name.count("/") == 2 and _find(get_interface, name) is not None
    sentence = "The passed type is not a service" if is_other else "The passed service type is invalid"
    return _found(get_service, name, sentence, "srv")


def action_class(name: str) -> Any:
    """The class of an action. Raises CommandError with the real tool's sentence, and what was meant perhaps."""
    from rosidl_runtime_py.utilities import get_action

    return _found(get_action, name, "The passed action type is invalid", "action")


def _found(get: Callable[[str], Any], name: str, sentence: str, folder: str) -> Any:
    found = _find(get, name)
    if found is None:
        raise CommandError(sentence, suggest_type(name, folder))
    return found


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


def unknown_type(name: str, folder: str) -> str:
    """A line about a type that does not exist, or that was typed in its short form; nothing for one that does."""
    from rosidl_runtime_py.utilities import get_interface

    if name.count("/") == 2 and _find(get_interface, name) is not None:
        return ""
    return f"There is no type '{name}'\n{suggest_type(name, folder)}".rstrip()


def suggest_type(name: str, folder: str) -> str:
    """`Did you mean 'std_msgs/msg/String'?`, or nothing if no type is like that."""
    known = [
        f"{package}/{interface}"
        for package in registry.packages()
        for interface in registry.interface_names(package)
        if interface.startswith(f"{folder}/")
    ]
    package, _, last = name.replace(".", "/").rpartition("/")
    same_name = [each for each in known if each.rpartition("/")[2].lower() == last.lower() and each != name]
    if same_name and not registry.knows(package.partition("/")[0]):
        return f"Did you mean '{sorted(same_name, key=lambda each: not each.startswith('std_'))[0]}'?"
    full = f"{package}/{folder}/{last}" if package and "/" not in package else name
    return did_you_mean(full, [each for each in known if each != name])


# -- values ----------------------------------------------------------------------------------------------------------

MAX_LENGTH = 100_000
"""How many characters of YAML are read at most."""


class NoYaml(CommandError):
    """A text is no YAML that can be read."""


class Unparsable(NoYaml):
    """The brackets, commas or colons of a text make no YAML; `ros2 param set` takes such a text as it is."""


def read_yaml(text: str, what: str = "The passed value") -> Any:
    """The value of a YAML text. Raises NoYaml, in one line, for anything that is none or could be a trap."""
    import yaml

    from ..runtime.files import safe_load

    if len(text) > MAX_LENGTH:
        raise NoYaml(f"{what} is too long: at most {MAX_LENGTH} characters of YAML are read")
    try:
        return safe_load(text)
    except yaml.MarkedYAMLError as error:
        kind = Unparsable if isinstance(error, yaml.parser.ParserError) else NoYaml
        raise kind(f"{what} is not valid YAML: {_in_one_line(error)}") from None
    except (yaml.YAMLError, ValueError, OverflowError) as error:
        raise NoYaml(f"{what} is not valid YAML: {' '.join(str(error).split())}") from None


def _in_one_line(error: Any) -> str:
    parts = [part for part in (error.context, error.problem) if part]
    mark = error.problem_mark
    place = f" (line {mark.line + 1}, column {mark.column + 1})" if mark else ""
    return ", ".join(" ".join(part.split()) for part in parts) + place


def populate(message: Any, values: Any) -> list[Callable[[Any], None]]:
    """Set the fields of a message (or request) to values as YAML gives them, or raise CommandError with a sentence.

    Returns:
        Functions that want the time of sending: they set what was typed as `header: auto` or `stamp: now`.
    """
    from rosidl_runtime_py.set_message import set_message_fields

    try:
        return set_message_fields(message, values, expand_header_auto=True, expand_time_now=True)
    except (TypeError, AttributeError, ValueError, AssertionError, OverflowError, RecursionError) as error:
        notes = getattr(error, "__notes__", []) if isinstance(error, (AttributeError, TypeError)) else []
        raise CommandError(f"Failed to populate field: {error}", "\n".join(notes)) from None


def stamp(setters: list[Callable[[Any], None]], node: Node) -> None:
    """Have the stamps that `populate` left open be the time of now."""
    if setters:
        now = node.get_clock().now().to_msg()
        for set_stamp in setters:
            set_stamp(now)


# -- names in the graph ---------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Names:
    """The names of one kind in the graph, such as topics: what their `list`, `type` and `find` have alike.

    Attributes:
        kind: "topic", "service" or "action".
        folder: the kind of their types: "msg", "srv" or "action".
        examples: the name of one, and of a type.
        known: all that are there with their types, also hidden ones if wanted.
        common: adds the arguments that each of the verbs has.
    """

    kind: str
    folder: str
    examples: tuple[str, str]
    known: Callable[[Node, bool], dict[str, list[str]]]
    common: Callable[[ArgumentParser], object] = lambda parser: None

    def list_arguments(self, parser: ArgumentParser) -> None:
        """The arguments of `list`."""
        self.common(parser)
        flag(parser, "-t --show-types", f"Show each {self.kind}'s type beside it")
        self._add_count(parser, "list")

    def _add_count(self, parser: ArgumentParser, verb: str) -> None:
        flag(parser, f"-c --count-{self.kind}s", "Print only how many there are")
        if self.kind != "action":
            flag(parser, f"--include-hidden-{self.kind}s", f"Also {verb} {self.kind}s with a hidden name")

    def _chosen(self, args: Namespace) -> tuple[dict[str, list[str]], bool]:
        """The names that `list` and `find` look through, and whether only their number is wanted."""
        with direct_node(args) as node:
            known = self.known(node, getattr(args, f"include_hidden_{self.kind}s", False))
        return known, getattr(args, f"count_{self.kind}s")

    def print_list(self, args: Namespace) -> None:
        """Print the names, or how many there are."""
        found, count = self._chosen(args)
        if count:
            print(len(found))
            return
        for name, types in found.items():
            print(f"{name} [{', '.join(types)}]" if args.show_types else name)

    def type_arguments(self, parser: ArgumentParser) -> None:
        """The arguments of `type`."""
        self.common(parser)
        parser.add_argument(f"{self.kind}_name", help=f"Full name of the {self.kind}, such as {self.examples[0]}")

    def print_type(self, args: Namespace) -> None:
        """Print the types of a name. For an unknown one the real tool says nothing, and ends with exit code 1."""
        with direct_node(args) as node:
            known = self.known(node, True)
        print(*self.types_of(getattr(args, f"{self.kind}_name"), known), sep="\n")

    def types_of(self, name: str, known: dict[str, list[str]]) -> list[str]:
        """The types of a name. Raises CommandError if there is no such name."""
        if name not in known:
            raise CommandError(f"Unknown {self.kind} '{name}'", suggest(name, known))
        return known[name]

    def find_arguments(self, parser: ArgumentParser) -> None:
        """The arguments of `find`."""
        self.common(parser)
        parser.add_argument(f"{self.kind}_type", help=f"Name of the type, such as {self.examples[1]}")
        self._add_count(parser, "find")

    def print_found(self, args: Namespace) -> None:
        """Print the names that have a type, or how many these are."""
        known, count = self._chosen(args)
        wanted = getattr(args, f"{self.kind}_type")
        found = [name for name, types in known.items() if wanted in types]
        if count:
            print(len(found))
        elif found:
            print(*found, sep="\n")
        elif about := unknown_type(wanted, self.folder):
            print(about, file=sys.stderr)


# -- quality of service ----------------------------------------------------------------------------------------------

PRESETS = (
    "unknown",
    "system_default",
    "sensor_data",
    "services_default",
    "parameters",
    "parameter_events",
    "action_status_default",
)
HISTORIES = ("system_default", "keep_last", "keep_all", "unknown")
RELIABILITIES = ("system_default", "reliable", "best_effort", "unknown")
DURABILITIES = ("system_default", "transient_local", "volatile", "unknown")

FALL_BACK = (
    "Some, but not all, publishers are offering {policy}.{strong}. Falling back to {policy}.{weak} as it will connect "
    "to all publishers"
)


def add_qos_arguments(parser: ArgumentParser, verb: str, preset: str, automatic: bool) -> None:
    """Add the options. `verb`: subscribe or publish; `automatic`: defaults follow the publishers that are there."""
    reliability, durability = ("as the publishers offer",) * 2 if automatic else ("reliable", "transient_local")
    parser.add_argument("--qos-profile", choices=PRESETS, help=f"Profile to {verb} with (default: {preset})")
    parser.add_argument("--qos-depth", metavar="N", type=_depth, help="Length of the queue; overrides the profile's")
    parser.add_argument("--qos-history", choices=HISTORIES, help="Which messages the queue keeps (default: keep_last)")
    parser.add_argument(
        "--qos-reliability",
        choices=RELIABILITIES,
        help=f"Whether lost messages are sent again; overrides the profile's (default: {reliability})",
    )
    parser.add_argument(
        "--qos-durability",
        choices=DURABILITIES,
        help=f"Whether late subscriptions get earlier messages; overrides the profile's (default: {durability})",
    )


def _depth(text: str) -> int:
    """A length; a negative one is accepted, and without effect."""
    try:
        depth = int(text)
    except ValueError:
        raise ArgumentTypeError(f"invalid int value: '{text}'") from None
    if depth > MOST:
        raise ArgumentTypeError(f"value must be at most {MOST}")
    return depth


def is_chosen(args: Namespace) -> bool:
    """Whether any of the options was given."""
    names = ("qos_profile", "qos_depth", "qos_history", "qos_reliability", "qos_durability")
    return any(getattr(args, name) is not None for name in names)


def profile_of(args: Namespace, preset: str, **defaults: str) -> QoSProfile:
    """The profile that the options ask for; `defaults` are policies by short name, used if no preset was given."""
    from rclpy.qos import QoSDurabilityPolicy, QoSHistoryPolicy, QoSPresetProfiles, QoSReliabilityPolicy

    profile = _copy(QoSPresetProfiles.get_from_short_key(args.qos_profile or preset))
    if args.qos_profile is not None:
        defaults = {}
    if args.qos_depth is not None and args.qos_depth >= 0:
        _set_depth(profile, args.qos_depth)
    policies = {
        "history": QoSHistoryPolicy,
        "reliability": QoSReliabilityPolicy,
        "durability": QoSDurabilityPolicy,
    }
    for name, policy in policies.items():
        chosen = getattr(args, f"qos_{name}") or defaults.get(name)
        if chosen:
            setattr(profile, name, policy.get_from_short_key(chosen))
    return profile


def _set_depth(profile: QoSProfile, depth: int) -> None:
    """Set the depth; rclpy's warning of a depth of 0 becomes a line that names no file of ours."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        profile.depth = depth
    for warning in caught:
        print(f"WARNING: {warning.message}", file=sys.stderr)


def matching_profile(node: Node, topic: str, preset: str) -> QoSProfile:
    """The preset, changed so that a subscription hears every publisher that is there."""
    from rclpy.qos import QoSDurabilityPolicy, QoSPresetProfiles, QoSReliabilityPolicy

    profile = _copy(QoSPresetProfiles.get_from_short_key(preset))
    offers = [info.qos_profile for info in node.get_publishers_info_by_topic(expanded(node, topic))]
    if offers:
        reliability, durability = QoSReliabilityPolicy, QoSDurabilityPolicy
        weak, strong = reliability.BEST_EFFORT, reliability.RELIABLE
        profile.reliability = _common([each.reliability for each in offers], strong, weak)
        weak_durability, latched = durability.VOLATILE, durability.TRANSIENT_LOCAL
        profile.durability = _common([each.durability for each in offers], latched, weak_durability)
    return profile


def _common(offered: list[Any], strong: Any, weak: Any) -> Any:
    """The strong policy if all offer it, else the weak one, said where some do."""
    if all(each == strong for each in offered):
        return strong
    if strong in offered:
        print(FALL_BACK.format(policy=f"QoS{type(strong).__name__}", strong=strong.name, weak=weak.name))
    return weak


def _copy(profile: QoSProfile) -> QoSProfile:
    from rclpy.qos import QoSProfile

    return QoSProfile(**vars(profile))
