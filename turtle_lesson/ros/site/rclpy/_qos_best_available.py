"""BEST_AVAILABLE (since Iron): policies that are chosen when a publisher or subscription is made.

They suit everybody who is on the topic at that moment, and are as strict as that allows. Facts: rmw_dds_common's qos.cpp.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from turtle_lesson.ros.graph import Quality

from ._qos_policies import DurabilityPolicy, LivelinessPolicy, ReliabilityPolicy
from .duration import Duration

if TYPE_CHECKING:
    from .qos import QoSProfile

BEST_AVAILABLE_SPAN = Duration(nanoseconds=2**63 - 2)
"""The deadline or lease that stands for "the best available": RMW_QOS_DEADLINE_BEST_AVAILABLE in rmw's types.h."""


def is_left_open(profile: QoSProfile) -> bool:
    """Whether anything in a profile is to be chosen when it is used."""
    policies = (profile.reliability, profile.durability, profile.liveliness)
    spans = (profile.deadline, profile.liveliness_lease_duration)
    return any(policy.name == "BEST_AVAILABLE" for policy in policies) or BEST_AVAILABLE_SPAN in spans


def choose_for_subscription(profile: QoSProfile, offers: Sequence[Quality]) -> None:
    """Fill in what a subscription's profile leaves to the publishers that are there."""
    if profile.reliability == ReliabilityPolicy.BEST_AVAILABLE:
        reliable = all(offer.reliable for offer in offers)
        profile.reliability = ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT
    if profile.durability == DurabilityPolicy.BEST_AVAILABLE:
        latched = all(offer.latched for offer in offers)
        profile.durability = DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE
    _choose_liveliness(profile, all(offer.manual for offer in offers))
    _choose_spans(profile, [offer.deadline for offer in offers], [offer.lease for offer in offers], max)


def choose_for_publisher(profile: QoSProfile, requests: Sequence[Quality]) -> None:
    """Fill in what a publisher's profile leaves to the subscriptions that are there."""
    if profile.reliability == ReliabilityPolicy.BEST_AVAILABLE:
        profile.reliability = ReliabilityPolicy.RELIABLE
    if profile.durability == DurabilityPolicy.BEST_AVAILABLE:
        profile.durability = DurabilityPolicy.TRANSIENT_LOCAL
    _choose_liveliness(profile, any(request.manual for request in requests))
    _choose_spans(profile, [each.deadline for each in requests], [each.lease for each in requests], min)


def _choose_liveliness(profile: QoSProfile, manual: bool) -> None:
    if profile.liveliness == LivelinessPolicy.BEST_AVAILABLE:
        profile.liveliness = LivelinessPolicy.MANUAL_BY_TOPIC if manual else LivelinessPolicy.AUTOMATIC


def _choose_spans(
    profile: QoSProfile, deadlines: list[int | None], leases: list[int | None], pick: Callable[[list[int]], int]
) -> None:
    for name, spans in (("deadline", deadlines), ("liveliness_lease_duration", leases)):
        if getattr(profile, name) == BEST_AVAILABLE_SPAN:
            known = [span for span in spans if span is not None]
            setattr(profile, name, Duration(nanoseconds=pick(known) if known else 0))
