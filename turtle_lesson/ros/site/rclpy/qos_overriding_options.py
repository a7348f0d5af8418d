"""Parameters by which the caller that starts a node may override the quality of service of its publishers and subscriptions.

They are called `qos_overrides./chatter.publisher.reliability` and the like, are declared when the publisher or
subscription is made, and are read-only.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

from rcl_interfaces.msg import ParameterDescriptor, SetParametersResult

from ._mistakes import did_you_mean
from ._qos_policies import QoSPolicyEnum
from .duration import Duration
from .exceptions import ParameterAlreadyDeclaredException
from .publisher import Publisher
from .qos import QoSPolicyKind, QoSProfile
from .subscription import Subscription

if TYPE_CHECKING:
    from .node import Node

__all__ = ["InvalidQosOverridesError", "QoSOverridingOptions", "QosCallbackResult", "QosCallbackType"]

QosCallbackResult = SetParametersResult
"""What a callback that checks a profile returns: `successful`, and a `reason` if it is not."""

QosCallbackType = Callable[[QoSProfile], SetParametersResult]


class InvalidQosOverridesError(Exception):
    """The program refuses a profile with what was overridden in it."""


class QoSOverridingOptions:
    """Which policies may be overridden, and `callback(profile)`, which looks at the result.

    An `entity_id` tells several publishers (or subscriptions) of one node on one topic apart.
    """

    def __init__(
        self,
        policy_kinds: Iterable[QoSPolicyKind],
        *,
        callback: QosCallbackType | None = None,
        entity_id: str | None = None,
    ) -> None:
        self._policy_kinds = policy_kinds
        self._callback = callback
        self._entity_id = entity_id

    @property
    def policy_kinds(self) -> Iterable[QoSPolicyKind]:
        """Which policies become parameters."""
        return self._policy_kinds

    @property
    def callback(self) -> QosCallbackType | None:
        """What looks at the profile in the end."""
        return self._callback

    @property
    def entity_id(self) -> str | None:
        """What tells it from others of the same node and topic."""
        return self._entity_id

    @classmethod
    def with_default_policies(
        cls, *, callback: QosCallbackType | None = None, entity_id: str | None = None
    ) -> QoSOverridingOptions:
        """History, depth and reliability may be overridden."""
        kinds = (QoSPolicyKind.HISTORY, QoSPolicyKind.DEPTH, QoSPolicyKind.RELIABILITY)
        return cls(policy_kinds=kinds, callback=callback, entity_id=entity_id)


def _declare_qos_parameters(
    entity_type: type[Publisher] | type[Subscription],
    node: Node,
    topic_name: str,
    qos: QoSProfile,
    options: QoSOverridingOptions,
) -> None:
    """Declare the parameters, and set what they say in the profile.

    Raises InvalidQosOverridesError, or RuntimeError for a value that no policy has.
    """
    if not issubclass(entity_type, (Publisher, Subscription)):
        raise TypeError("Argument `entity_type` should be a subclass of Publisher or Subscription")
    word = "publisher" if issubclass(entity_type, Publisher) else "subscription"
    suffix = "" if options.entity_id is None else f"_{options.entity_id}"
    whose = f"for {word} `{topic_name}` with id `{options.entity_id}`"
    for kind in options.policy_kinds:
        if kind == QoSPolicyKind.LIFESPAN and word == "subscription":
            continue  # only publishers have one
        name = f"qos_overrides.{topic_name}.{word}{suffix}.{kind.name.lower()}"
        descriptor = ParameterDescriptor(description=f"{kind.name.lower()} {whose}", read_only=True)
        try:
            parameter = node.declare_parameter(name, _as_parameter(qos, kind), descriptor)
        except ParameterAlreadyDeclaredException:
            parameter = node.get_parameter(name)
        _override(qos, kind, parameter.value)
    _ask(options.callback, qos, whose)


def _as_parameter(qos: QoSProfile, kind: QoSPolicyKind) -> str | int | bool:
    """A policy as the value of a parameter: a word, a number of nanoseconds, a depth."""
    value = getattr(qos, kind.name.lower())
    if isinstance(value, QoSPolicyEnum):
        if value.name == "UNKNOWN":
            raise ValueError("User provided QoS profile is invalid")
        return value.name.lower()
    return value.nanoseconds if isinstance(value, Duration) else value


def _override(qos: QoSProfile, kind: QoSPolicyKind, value: Any) -> None:
    """Set a policy to what its parameter says."""
    name = kind.name.lower()
    now = getattr(qos, name)
    if isinstance(now, QoSPolicyEnum):
        words = type(now).short_keys()
        if str(value).lower() not in words:
            error = RuntimeError(f"Unexpected QoS override for policy `{name}`: `{value}`")
            error.add_note(f"It is one of {', '.join(words)}{did_you_mean(str(value).lower(), words)}")
            raise error
        value = type(now)[value.upper()]
    elif isinstance(now, Duration):
        value = Duration(nanoseconds=value)
    setattr(qos, name, value)


def _ask(callback: QosCallbackType | None, qos: QoSProfile, whose: str) -> None:
    """Let the program refuse the profile. Humble's first callbacks returned a bool."""
    if callback is None:
        return
    result = callback(qos)
    if not getattr(result, "successful", result):
        reason = getattr(result, "reason", "")
        raise InvalidQosOverridesError(
            f"Provided QoS overrides {whose}, are not valid" + (f": {reason}" if reason else "")
        )
