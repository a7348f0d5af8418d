"""The rules for names in ROS 2, and what a name in a program becomes in the graph.

Facts: rmw's validate_node_name.c, validate_namespace.c, validate_full_topic_name.c, rcl's validate_topic_name.c and
expand_topic_name.c; https://design.ros2.org/articles/topic_and_service_names.html. Each check answers None for a good
name, or the reason and the index of the first bad character.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple

UNBALANCED = "topic name must not have unmatched (unbalanced) curly braces '{}'"

Rules = tuple[tuple[str, str], ...]
"""Patterns of what is not allowed, the first one that is found counts, with the words of ROS."""

_NODE_NAME: Rules = (
    (r"\A\Z", "node name must not be empty"),
    (r"\W", "node name must not contain characters other than alphanumerics or '_'"),
    (r"\A\d", "node name must not start with a number"),
    (r"(?<=\A.{254}).(?=.)", "node name length should not exceed '255'"),
)
_NAMESPACE: Rules = (
    (r"\A\Z", "namespace must not be empty"),
    (r"\A[^/]", "namespace must be absolute, it must lead with a '/'"),
    (r"(?<=.)/\Z", "namespace must not end with a '/', unless only a '/'"),
    (r"[^\w/]", "namespace must not contain characters other than alphanumerics, '_', or '/'"),
    (r"(?<=/)/", "namespace must not contain repeated '/'"),
    (r"(?<=/)\d", "namespace must not have a token that starts with a number"),
    (r"(?<=\A.{244}).(?=.)", "namespace should not exceed '245'"),
)
_FULL_TOPIC_NAME: Rules = (
    (r"\A\Z", "topic name must not be empty"),
    (r"\A[^/]", "topic name must be absolute, it must lead with a '/'"),
    (r"/\Z", "topic name must not end with a '/'"),
    (r"[^\w/]", "topic name must not contain characters other than alphanumerics, '_', or '/'"),
    (r"(?<=/)/", "topic name must not contain repeated '/'"),
    (r"(?<=/)\d", "topic name must not have a token that starts with a number"),
    (r"(?<=\A.{246}).(?=.)", "topic length should not exceed '247'"),
)
_ENDS_OF_TOPIC_NAME: Rules = (
    (r"\A\Z", "topic name must not be empty string"),
    (r"\A\d", "topic name token must not start with a number"),
    (r"/\Z", "topic name must not end with a forward slash"),
)
_TOKENS_OF_TOPIC_NAME: Rules = (
    # rcl overlooks this in names of two letters
    (r"(?<=\A~)[^/](?=.)", "topic name must not have a tilde '~' that is not followed by a forward slash '/'"),
    (r"(?<=/)\d", "topic name token must not start with a number"),
)


class Flaw(NamedTuple):
    """Why a name is not allowed, and at which character it goes wrong."""

    reason: str
    place: int


class Remap(NamedTuple):
    """One remapping rule, as in `-r chatter:=/news`; `node` limits it to the node of that name.

    `is_service` limits it to services (`rosservice://…`), or to topics (`rostopic://…`).
    """

    match: str
    replacement: str
    node: str | None = None
    is_service: bool | None = None


def _flaw(name: str, rules: Rules) -> Flaw | None:
    for pattern, reason in rules:
        if found := re.search(pattern, name, re.ASCII | re.DOTALL):
            return Flaw(reason, found.start())
    return None


@lru_cache(maxsize=1000)  # a program that counts publishers once a second names the same node and topics
def node_name_flaw(name: str) -> Flaw | None:
    """What is wrong with a node's name."""
    return _flaw(name, _NODE_NAME)


@lru_cache(maxsize=1000)
def namespace_flaw(namespace: str) -> Flaw | None:
    """What is wrong with a full namespace such as `/robots/bob`."""
    return _flaw(namespace, _NAMESPACE)


@lru_cache(maxsize=1000)
def topic_name_flaw(name: str) -> Flaw | None:
    """What is wrong with a topic's or service's name as a program gives it (`~`, `{node}` and relative names allowed)."""
    return _flaw(name, _ENDS_OF_TOPIC_NAME) or _letters_flaw(name) or _flaw(name, _TOKENS_OF_TOPIC_NAME)


@lru_cache(maxsize=1000)
def full_topic_name_flaw(name: str) -> Flaw | None:
    """What is wrong with a topic's or service's full name, as it is in the graph."""
    return _flaw(name, _FULL_TOPIC_NAME)


def _letters_flaw(name: str) -> Flaw | None:
    """The first letter that cannot be where it is; braces stand around the name of a substitution."""
    good = re.match(r"~?([\w/]|\{([a-z_]\w*)?\})*", name, re.ASCII | re.IGNORECASE)
    place = good.end() if good else 0
    if place == len(name):
        return None
    if name[place] == "{" and (inner := re.match(r"(\d)|\w*(\W)", name[place + 1 :], re.ASCII)):
        bad = place + inner.end()
        if inner[1]:
            return Flaw("substitution name must not start with a number", bad)
        if inner[2] != "~":
            return Flaw("substitution name must not contain characters other than alphanumerics or '_'", bad)
        place = bad
    if name[place] == "~":
        return Flaw("topic name must not have tilde '~' unless it is the first character", place)
    if name[place] in "{}":
        return Flaw(UNBALANCED, place)
    what = "topic name must not contain characters other than alphanumerics, '_', '~', '{', or '}'"
    return Flaw(what, place)


def flaw_text(kind: str, name: str, flaw: Flaw) -> str:
    """The sentence with a caret under the bad character, as rclpy's exceptions print it."""
    return f"Invalid {kind}: {flaw.reason}:\n  '{name}'\n   {' ' * flaw.place}^"


def expand(name: str, node: str, namespace: str) -> str:
    """The full name of a (valid) topic or service that a node in a namespace calls `name`."""
    known = {"node": node, "ns": namespace, "namespace": namespace}
    for word in re.findall(r"\{(.*?)\}", name):
        if word not in known:
            raise ValueError(
                f"topic name '{name}' is invalid: unknown substitution: {{{word}}} (known are {{node}} and {{namespace}})"
            )
        name = name.replace(f"{{{word}}}", known[word])
    base = "" if namespace == "/" else namespace
    if name.startswith("~"):
        return f"{base}/{node}{name[1:]}"
    return name if name.startswith("/") else f"{base}/{name}"


def remap(name: str, node: str, namespace: str, rules: Sequence[Remap], *, is_service: bool = False) -> str:
    """The full name after the first remapping rule that matches it, if any does."""
    for rule in rules:
        if rule.match.startswith("__") or rule.node not in (None, node) or rule.is_service not in (None, is_service):
            continue
        if expand(rule.match, node, namespace) == name:
            return expand(rule.replacement, node, namespace)
    return name
