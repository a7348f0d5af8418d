"""Quality of service in a bag: what publishers offered, what a recorder asks for, what a player offers.

Facts: rosbag2_transport's qos.cpp (adapt_request_to_offers, adapt_offer_to_recorded_offers); rmw/types.h (numbers).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from rclpy.qos import DurabilityPolicy, HistoryPolicy, LivelinessPolicy, QoSProfile, ReliabilityPolicy

if TYPE_CHECKING:
    from rosbags.interfaces import Qos

INFINITE = (9_223_372_036, 854_775_807)
"""An endless duration, in s and ns, as rmw writes it: a deadline or lifespan that nobody has set."""

DEFAULT_DEPTH = 10


def request_for(qualities: Sequence[Any]) -> QoSProfile:
    """What a recorder asks for, so that it hears publishers that offer these (graph `Quality` values), every message.

    A real recorder keeps ten messages and loses the rest of a burst; this one keeps all.
    """
    reliable = all(quality.reliable for quality in qualities)
    latched = bool(qualities) and all(quality.latched for quality in qualities)
    return QoSProfile(
        history=HistoryPolicy.KEEP_ALL,
        reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE,
    )


def offer_of(profiles: Sequence[Qos]) -> QoSProfile:
    """What a player offers for a topic whose publishers offered `profiles`: the weakest that all of them kept to."""
    depths = [profile.depth for profile in profiles]
    reliable = all(profile.reliability.value != ReliabilityPolicy.BEST_EFFORT for profile in profiles)
    latched = bool(profiles) and all(each.durability.value == DurabilityPolicy.TRANSIENT_LOCAL for each in profiles)
    keep_all = any(profile.history.value == HistoryPolicy.KEEP_ALL for profile in profiles)
    return QoSProfile(
        history=HistoryPolicy.KEEP_ALL if keep_all else HistoryPolicy.KEEP_LAST,
        depth=max(depths, default=0) or DEFAULT_DEPTH,
        reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE,
    )


def as_recorded(profile: QoSProfile) -> Qos:
    """A publisher's profile as a bag holds it, with what it left open filled in."""
    from rosbags.interfaces import Qos, QosDurability, QosHistory, QosLiveliness, QosReliability, QosTime

    policies: dict[str, Any] = vars(profile)

    def duration(name: str) -> QosTime:
        nanoseconds = policies[name].nanoseconds
        return QosTime(*divmod(nanoseconds, 1_000_000_000)) if nanoseconds else QosTime(*INFINITE)

    def chosen(name: str, default: int) -> int:
        return int(policies[name]) or default

    return Qos(
        QosHistory(chosen("history", HistoryPolicy.KEEP_LAST)),
        policies["depth"],
        QosReliability(chosen("reliability", ReliabilityPolicy.RELIABLE)),
        QosDurability(chosen("durability", DurabilityPolicy.VOLATILE)),
        duration("deadline"),
        duration("lifespan"),
        QosLiveliness(chosen("liveliness", LivelinessPolicy.AUTOMATIC)),
        duration("liveliness_lease_duration"),
        policies["avoid_ros_namespace_conventions"],
    )
