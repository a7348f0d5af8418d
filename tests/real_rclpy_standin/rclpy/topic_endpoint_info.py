"""What the graph tells of the end of a topic: here a `SimpleNamespace` of the same fields (see node.py)."""

from types import SimpleNamespace as TopicEndpointInfo  # noqa: F401
