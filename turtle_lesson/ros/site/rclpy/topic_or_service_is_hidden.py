"""`topic_or_service_is_hidden`: whether tools leave a name out of their lists."""

from __future__ import annotations

from turtle_lesson.ros.idl.names import is_hidden

HIDDEN_TOPIC_PREFIX = "_"
TOPIC_SEPARATOR_STRING = "/"


def topic_or_service_is_hidden(name: str) -> bool:
    """Whether a part of the name begins with an underscore."""
    return is_hidden(name)
