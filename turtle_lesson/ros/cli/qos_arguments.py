"""The `--qos-*` options, and quality of service as text."""

from __future__ import annotations

import sys
import warnings
from argparse import ArgumentParser, ArgumentTypeError, Namespace
from typing import TYPE_CHECKING, Any

from .arg_types import MOST
from .verb import expanded

if TYPE_CHECKING:
    from rclpy.node import Node
    from rclpy.qos import QoSProfile


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
