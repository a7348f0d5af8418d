"""Checks of the debugging lab: whether the trouble that was brought in on purpose is mended."""

from __future__ import annotations

from ..troubles import current_expectations, expectations_of
from .registry import Expectation, check

LIMIT = 600


@check("trouble", points=1, limit=LIMIT)
def trouble() -> list[Expectation]:
    """A system that works again as specified."""
    return current_expectations()


@check(
    "topic_case",
    points=3,
    limit=LIMIT,
    learnt="A topic has a publisher, a name and a rate, and a command for each of them.",
)
def topic_case() -> list[Expectation]:
    """A dashboard that gets ten messages a second."""
    return expectations_of(9, "topic silent")


@check(
    "service_case",
    points=3,
    limit=LIMIT,
    learnt="A call needs a node, a service of the same name, and a callback that is called.",
)
def service_case() -> list[Expectation]:
    """A navigator that answers its calls."""
    return expectations_of(9, "service times out")


@check(
    "message_case",
    points=3,
    limit=LIMIT,
    learnt="A message type is named in CMakeLists.txt, built and sourced, in this order.",
)
def message_case() -> list[Expectation]:
    """A message type that programs can use."""
    return expectations_of(12, "message not found")


@check(
    "turtle_case",
    points=3,
    limit=LIMIT,
    learnt="A command can be followed from the node that sends it to the robot that obeys it.",
)
def turtle_case() -> list[Expectation]:
    """A turtle that gets where it is sent."""
    return expectations_of(1, "turtle stands still")
