"""Why nothing was heard on a topic, for those who look at a widget and may have no cell to type in."""

from __future__ import annotations

from .station import Station


def why_silent(station: Station, topic: str) -> str:
    """A sentence on why nothing came on a topic that the recorder hears, and what to try."""
    if station.node.count_publishers(topic):
        return f"No message has come on {topic} yet: messages come while robot time passes."
    return station.recorder.why_silent(topic)
