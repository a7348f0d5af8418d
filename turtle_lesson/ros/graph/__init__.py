"""The ROS graph of one world: nodes, topics, services, who is matched with whom, and what names mean."""

from .graph import Graph, NodeEntry
from .quality import Quality
from .service import ClientEnd, ServerEnd
from .topic import Reader, Topic, Writer

__all__ = ["ClientEnd", "Graph", "NodeEntry", "Quality", "Reader", "ServerEnd", "Topic", "Writer"]
