"""The rules for names in ROS 2, and what a name in a program becomes in the graph.

Facts: rmw's validate_node_name.c, validate_namespace.c, validate_full_topic_name.c, rcl's validate_topic_name.c and
expand_topic_name.c; https://design.ros2.org/articles/topic_and_service_names.html. Each check answers None for a good
name, or the reason and the index of the first bad character.
"""

from __future__ import annotations

import re
import string
from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple

WORD = frozenset(string.ascii_letters + string.digits + "_")
MAX_NODE_NAME = 255
MAX_NAMESPACE = 245
MAX_TOPIC_NAME = 247
UNBALANCED = "topic name must not have unmatched (unbalanced) curly braces '{}'"


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


def node_name_flaw(name: str) -> Flaw | None:
    """What is wrong with a node's name."""
    if not name:
        return Flaw("node name must not be empty", 0)
    for index, letter in enumerate(name):
        if letter not in WORD:
            return Flaw("node name must not contain characters other than alphanumerics or '_'", index)
    if name[0] in string.digits:
        return Flaw("node name must not start with a number", 0)
    if len(name) > MAX_NODE_NAME:
        return Flaw(f"node name length should not exceed '{MAX_NODE_NAME}'", MAX_NODE_NAME - 1)
    return None


def namespace_flaw(namespace: str) -> Flaw | None:
    """What is wrong with a full namespace such as `/robots/bob`."""
    if not namespace:
        return Flaw("namespace must not be empty", 0)
    if not namespace.startswith("/"):
        return Flaw("namespace must be absolute, it must lead with a '/'", 0)
    if namespace == "/":
        return None
    if namespace.endswith("/"):
        return Flaw("namespace must not end with a '/', unless only a '/'", len(namespace) - 1)
    for index, letter in enumerate(namespace):
        if letter not in WORD and letter != "/":
            return Flaw("namespace must not contain characters other than alphanumerics, '_', or '/'", index)
    if "//" in namespace:
        return Flaw("namespace must not contain repeated '/'", namespace.index("//") + 1)
    if match := re.search(r"/\d", namespace):
        return Flaw("namespace must not have a token that starts with a number", match.start() + 1)
    if len(namespace) > MAX_NAMESPACE:
        return Flaw(f"namespace should not exceed '{MAX_NAMESPACE}'", MAX_NAMESPACE - 1)
    return None


@lru_cache(maxsize=1000)  # a program that counts publishers once a second names the same topics
def topic_name_flaw(name: str) -> Flaw | None:
    """What is wrong with a topic's or service's name as a program gives it (`~`, `{node}` and relative names allowed)."""
    if not name:
        return Flaw("topic name must not be empty string", 0)
    if name[0] in string.digits:
        return Flaw("topic name token must not start with a number", 0)
    if name.endswith("/"):
        return Flaw("topic name must not end with a forward slash", len(name) - 1)
    return _letters_flaw(name) or _tokens_flaw(name)


@lru_cache(maxsize=1000)
def full_topic_name_flaw(name: str) -> Flaw | None:
    """What is wrong with a topic's or service's full name, as it is in the graph."""
    if not name:
        return Flaw("topic name must not be empty", 0)
    if not name.startswith("/"):
        return Flaw("topic name must be absolute, it must lead with a '/'", 0)
    if name.endswith("/"):
        return Flaw("topic name must not end with a '/'", len(name) - 1)
    for index, letter in enumerate(name):
        if letter not in WORD and letter != "/":
            return Flaw("topic name must not contain characters other than alphanumerics, '_', or '/'", index)
    if "//" in name:
        return Flaw("topic name must not contain repeated '/'", name.index("//") + 1)
    if match := re.search(r"/\d", name):
        return Flaw("topic name must not have a token that starts with a number", match.start() + 1)
    if len(name) > MAX_TOPIC_NAME:
        return Flaw(f"topic length should not exceed '{MAX_TOPIC_NAME}'", MAX_TOPIC_NAME - 1)
    return None


def _letters_flaw(name: str) -> Flaw | None:
    opened: int | None = None  # where the brace is that is open
    for index, letter in enumerate(name):
        if letter == "~":
            if index:
                return Flaw("topic name must not have tilde '~' unless it is the first character", index)
        elif letter == "}":
            if opened is None:
                return Flaw(UNBALANCED, index)
            opened = None
        elif opened is not None:
            if letter not in WORD:
                return Flaw("substitution name must not contain characters other than alphanumerics or '_'", index)
            if letter in string.digits and index == opened + 1:
                return Flaw("substitution name must not start with a number", index)
        elif letter == "{":
            opened = index
        elif letter not in WORD and letter != "/":
            what = "topic name must not contain characters other than alphanumerics, '_', '~', '{', or '}'"
            return Flaw(what, index)
    return None if opened is None else Flaw(UNBALANCED, opened)


def _tokens_flaw(name: str) -> Flaw | None:
    if name.startswith("~") and len(name) > 2 and name[1] != "/":  # rcl overlooks it in names of two letters
        return Flaw("topic name must not have a tilde '~' that is not followed by a forward slash '/'", 1)
    if match := re.search(r"/\d", name):
        return Flaw("topic name token must not start with a number", match.start() + 1)
    return None


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
