"""`expand_topic_name`: from the name that a node uses to the full name."""

from turtle_lesson.ros.graph.names import expand

from .validate_namespace import validate_namespace
from .validate_node_name import validate_node_name
from .validate_topic_name import validate_topic_name


def expand_topic_name(topic_name: str, node_name: str, node_namespace: str) -> str:
    """The full name, such as `/robots/bob/chatter`; raises the validation errors, ValueError for an unknown {…}."""
    validate_topic_name(topic_name)
    validate_node_name(node_name)
    validate_namespace(node_namespace)
    return expand(topic_name, node_name, node_namespace)
