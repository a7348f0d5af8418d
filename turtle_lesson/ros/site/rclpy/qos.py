"""Quality of service profiles. Numbers and presets are those of rclpy and rmw of Humble (rmw's qos_profiles.h)."""

from __future__ import annotations

from collections.abc import Mapping
from enum import Enum, IntEnum
from typing import TYPE_CHECKING, Any

from turtle_lesson.ros.rmw.endpoint import Quality

from ._hints import did_you_mean, explain_missing
from .duration import Duration, Infinite
from .exceptions import RCLError


class _ShortKeys:
    """Base class of policies and presets: their names as the command line has them."""

    __members__: Mapping[str, Any]
    name: str

    @property
    def short_key(self) -> str:
        """The name as the command line has it."""
        return self.name.lower()

    @classmethod
    def short_keys(cls) -> list[str]:
        """All names as the command line has them."""
        return [name.lower() for name in cls.__members__]

    @classmethod
    def get_from_short_key(cls, name: str) -> Any:
        """The number of the policy, or the preset, of a name in whatever case."""
        return cls.__members__[name.upper()].value


class QoSPolicyEnum(_ShortKeys, IntEnum):
    """Base class of the policies."""


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


for _kind in (HistoryPolicy, ReliabilityPolicy, DurabilityPolicy, LivelinessPolicy):
    for _policy in list(_kind):
        _old = f"RMW_QOS_POLICY_{_kind.__name__.removesuffix('Policy').upper()}_{_policy.name}"
        setattr(_kind, _old, _policy)  # what it was called before Foxy


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


QoSHistoryPolicy = HistoryPolicy
QoSReliabilityPolicy = ReliabilityPolicy
QoSDurabilityPolicy = DurabilityPolicy
QoSLivelinessPolicy = LivelinessPolicy


class InvalidQoSProfileException(Exception):
    """A profile contradicts itself or lacks something."""

    def __init__(self, *args: object) -> None:
        super().__init__("Invalid QoSProfile", *args)


_MEANT: dict[str, QoSPolicyEnum] = {
    "reliability": ReliabilityPolicy.RELIABLE,
    "durability": DurabilityPolicy.VOLATILE,
    "history": HistoryPolicy.KEEP_LAST,
    "liveliness": LivelinessPolicy.AUTOMATIC,
}
"""What `system default` stands for."""


class QoSProfile:
    """The policies of a publisher, subscription, service or client, as keyword arguments and attributes."""

    history: HistoryPolicy = HistoryPolicy.KEEP_LAST
    depth: int = 10
    reliability: ReliabilityPolicy = ReliabilityPolicy.RELIABLE
    durability: DurabilityPolicy = DurabilityPolicy.VOLATILE
    lifespan: Duration = Duration()
    deadline: Duration = Duration()
    liveliness: LivelinessPolicy = LivelinessPolicy.SYSTEM_DEFAULT
    liveliness_lease_duration: Duration = Duration()
    avoid_ros_namespace_conventions: bool = False

    def __init__(self, **policies: Any) -> None:
        known = QoSProfile.__annotations__
        unknown = set(policies) - set(known)
        hint = "".join(did_you_mean(name, known) for name in sorted(unknown))
        assert not unknown, f"Invalid arguments passed to constructor: {', '.join(sorted(unknown))}{hint}"
        if "history" not in policies:
            if "depth" not in policies:
                raise InvalidQoSProfileException("History and/or depth settings are required.")
            policies["history"] = HistoryPolicy.KEEP_LAST
        if policies["history"] == HistoryPolicy.KEEP_LAST and "depth" not in policies:
            raise InvalidQoSProfileException("History set to KEEP_LAST without a depth setting.")
        for name in known:
            setattr(self, name, policies.get(name, getattr(QoSProfile, name)))

    def __setattr__(self, name: str, value: Any) -> None:
        if name not in QoSProfile.__annotations__:
            raise AttributeError(f"QoSProfile has no policy {name!r}; it has {', '.join(QoSProfile.__annotations__)}")
        kind = type(getattr(QoSProfile, name))
        if issubclass(kind, QoSPolicyEnum) and isinstance(value, int):
            value = kind(value)
        if not isinstance(value, kind):
            text = f"QoS policy {name!r} must be of type {kind.__name__}, got {value!r}"
            if issubclass(kind, QoSPolicyEnum):
                keys = list(kind.__members__)
                close = [key for key in keys if str(value).upper().endswith(key)]
                text += f": try {name}={kind.__name__}.{(close or keys[1:])[0]}"
            raise AssertionError(text)
        if name == "depth" and value < 0:
            raise ValueError("history depth must be greater than or equal to zero")
        object.__setattr__(self, name, value)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, QoSProfile) and vars(self) == vars(other)

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        def shown(value: Any) -> Any:
            if isinstance(value, Duration):
                return f"{value.nanoseconds} nanoseconds"
            return int(value) if isinstance(value, QoSPolicyEnum) else value

        return f"QoSProfile({', '.join(f'{name}={shown(value)}' for name, value in vars(self).items())})"

    __str__ = __repr__

    def quality(self, what: str) -> Quality:
        """What of this profile decides about delivery. Raises RCLError if no publisher or subscription (`what`) can have it."""
        policies = vars(self)
        for name, value in policies.items():
            if value.nanoseconds < 0 if isinstance(value, Duration) else getattr(value, "name", "") == "UNKNOWN":
                raise RCLError(f"Failed to create {what}: the {name} of its QoS profile cannot be {value!r}")
        keep_all = policies["history"] == HistoryPolicy.KEEP_ALL
        return Quality(
            depth=None if keep_all else max(1, policies["depth"]),
            reliable=policies["reliability"] != ReliabilityPolicy.BEST_EFFORT,
            latched=policies["durability"] == DurabilityPolicy.TRANSIENT_LOCAL,
            deadline=self._limit("deadline"),
            lifespan=self._limit("lifespan"),
            manual=policies["liveliness"] == LivelinessPolicy.MANUAL_BY_TOPIC,
            lease=self._limit("liveliness_lease_duration"),
        )

    def _limit(self, name: str) -> int | None:
        """A span in ns; None if it has no end, which is also what 0, the default, stands for."""
        nanoseconds = getattr(self, name).nanoseconds
        return None if nanoseconds in (0, Infinite.nanoseconds) else nanoseconds

    def _as_used(self) -> QoSProfile:
        """This profile as the graph shows it: with what it leaves open filled in, as Cyclone DDS does."""
        policies = dict(vars(self))
        for name, meant in _MEANT.items():
            if policies[name].name == "SYSTEM_DEFAULT":
                policies[name] = meant
        for name in ("lifespan", "deadline", "liveliness_lease_duration"):
            policies[name] = policies[name] if policies[name].nanoseconds else Infinite
        policies["depth"] = max(1, policies["depth"])
        return QoSProfile(**policies)


def checked_profile(profile: Any) -> QoSProfile:
    """A profile from what a program gives: a QoSProfile, or an int that means "keep the last n"."""
    if isinstance(profile, QoSProfile):
        return profile
    if isinstance(profile, int) and not isinstance(profile, bool):
        if profile < 0:
            raise ValueError("history depth must be greater than or equal to zero")
        return QoSProfile(depth=profile, history=HistoryPolicy.KEEP_LAST)
    error = TypeError(f"Expected QoSProfile or int, but received {type(profile)}")
    if callable(profile):
        error.add_note(
            "The order is create_subscription(type, topic, callback, qos), create_publisher(type, topic, qos)."
        )
    raise error


def _keep_last(depth: int, reliability: ReliabilityPolicy = ReliabilityPolicy.RELIABLE) -> QoSProfile:
    return QoSProfile(history=HistoryPolicy.KEEP_LAST, depth=depth, reliability=reliability)


qos_profile_system_default = QoSProfile(
    history=HistoryPolicy.SYSTEM_DEFAULT,
    depth=0,
    reliability=ReliabilityPolicy.SYSTEM_DEFAULT,
    durability=DurabilityPolicy.SYSTEM_DEFAULT,
)
qos_profile_unknown = QoSProfile(
    history=HistoryPolicy.UNKNOWN,
    depth=0,
    reliability=ReliabilityPolicy.UNKNOWN,
    durability=DurabilityPolicy.UNKNOWN,
    liveliness=LivelinessPolicy.UNKNOWN,
)
qos_profile_sensor_data = _keep_last(5, ReliabilityPolicy.BEST_EFFORT)
qos_profile_services_default = _keep_last(10)
qos_profile_parameters = _keep_last(1000)
qos_profile_parameter_events = _keep_last(1000)
qos_profile_default = _keep_last(10)
qos_profile_rosout_default = QoSProfile(
    depth=1000, durability=DurabilityPolicy.TRANSIENT_LOCAL, lifespan=Duration(seconds=10)
)
qos_profile_action_status_default = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class QoSPresetProfiles(_ShortKeys, Enum):
    """The presets by name."""

    UNKNOWN = qos_profile_unknown
    DEFAULT = qos_profile_default
    SYSTEM_DEFAULT = qos_profile_system_default
    SENSOR_DATA = qos_profile_sensor_data
    SERVICES_DEFAULT = qos_profile_services_default
    PARAMETERS = qos_profile_parameters
    PARAMETER_EVENTS = qos_profile_parameter_events
    ACTION_STATUS_DEFAULT = qos_profile_action_status_default
    ROSOUT_DEFAULT = qos_profile_rosout_default


if not TYPE_CHECKING:
    __getattr__ = explain_missing(__name__)
