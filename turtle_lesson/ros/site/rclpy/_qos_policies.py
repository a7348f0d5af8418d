"""The policies of a quality of service, as enumerations. Their numbers are those of rmw's types.h."""

from __future__ import annotations

import warnings
from enum import IntEnum
from typing import Any


class QoSPolicyEnum(IntEnum):
    """Base class: what all policies can do."""

    @property
    def short_key(self) -> str:
        """The policy's name as the command line has it."""
        return self.name.lower()

    @classmethod
    def short_keys(cls) -> list[str]:
        """All names as the command line has them."""
        return [policy.name.lower() for policy in cls]

    @classmethod
    def get_from_short_key(cls, name: str) -> int:
        """The number of the policy of a name, in whatever case."""
        return cls[name.upper()].value


class _OldName:
    """A policy's name of before Foxy: it still works, and says what to write instead."""

    def __init__(self, old: str, name: str) -> None:
        self._old, self._name = old, name

    def __get__(self, owner: object, kind: Any) -> Any:
        advice = f"Use {kind.__name__}.{self._name} instead."
        warnings.warn(f"{kind.__name__}.{self._old} is deprecated. {advice}", stacklevel=2)
        return kind[self._name]


def _with_old_names(kind: Any, prefix: str) -> None:
    for policy in list(kind):
        old = f"RMW_QOS_POLICY_{prefix}_{policy.name}"
        setattr(kind, old, _OldName(old, policy.name))


class HistoryPolicy(QoSPolicyEnum):
    """How many messages a queue keeps."""

    SYSTEM_DEFAULT = 0
    KEEP_LAST = 1
    KEEP_ALL = 2
    UNKNOWN = 3


class ReliabilityPolicy(QoSPolicyEnum):
    """Whether a lost message is sent again."""

    SYSTEM_DEFAULT = 0
    RELIABLE = 1
    BEST_EFFORT = 2
    UNKNOWN = 3


class DurabilityPolicy(QoSPolicyEnum):
    """Whether late subscriptions get earlier messages."""

    SYSTEM_DEFAULT = 0
    TRANSIENT_LOCAL = 1
    VOLATILE = 2
    UNKNOWN = 3


class LivelinessPolicy(QoSPolicyEnum):
    """How a publisher shows that it lives: its process does it, or the program itself."""

    SYSTEM_DEFAULT = 0
    AUTOMATIC = 1
    MANUAL_BY_TOPIC = 3
    UNKNOWN = 4


for _kind, _prefix in (
    (HistoryPolicy, "HISTORY"),
    (ReliabilityPolicy, "RELIABILITY"),
    (DurabilityPolicy, "DURABILITY"),
    (LivelinessPolicy, "LIVELINESS"),
):
    _with_old_names(_kind, _prefix)


class QoSPolicyKind(IntEnum):
    """Which policy is meant. The numbers are those of rmw's qos_policy_kind.h."""

    INVALID = 1 << 0
    DURABILITY = 1 << 1
    DEADLINE = 1 << 2
    LIVELINESS = 1 << 3
    RELIABILITY = 1 << 4
    HISTORY = 1 << 5
    LIFESPAN = 1 << 6
    DEPTH = 1 << 7
    LIVELINESS_LEASE_DURATION = 1 << 8
    AVOID_ROS_NAMESPACE_CONVENTIONS = 1 << 9


def qos_policy_name_from_kind(policy_kind: QoSPolicyKind | int) -> str:
    """The name of a policy, such as `RELIABILITY`."""
    return QoSPolicyKind(policy_kind).name
