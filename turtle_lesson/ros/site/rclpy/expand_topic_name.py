"""`expand_topic_name`: from the name that a node uses to the full name."""

from turtle_lesson.ros.rmw.names import expand, namespace_flaw, node_name_flaw, topic_name_flaw


def expand_topic_name(topic_name: str, node_name: str, node_namespace: str) -> str:
    """The full name, such as `/robots/bob/chatter`. Raises ValueError for a bad name and for an unknown {…}."""
    for what, name, flaw_of in (
        ("topic name", topic_name, topic_name_flaw),
        ("node name", node_name, node_name_flaw),
        ("node namespace", node_namespace, namespace_flaw),
    ):
        if (flaw := flaw_of(name)) is not None:
            raise ValueError(f"{what} '{name}' is invalid: {flaw.reason}")
    return expand(topic_name, node_name, node_namespace)
