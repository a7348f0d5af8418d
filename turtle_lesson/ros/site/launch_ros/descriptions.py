"""Composable nodes, as launch files describe them, and the parameters that are given to nodes."""

from __future__ import annotations

from typing import Any

from .parameter_descriptions import ParameterFile, ParameterValue

__all__ = ["ComposableLifecycleNode", "ComposableNode", "ParameterFile", "ParameterValue"]


class ComposableNode:
    """A C++ node that is to be loaded into a container; containers are left out here, with what is in them."""

    def __init__(self, **described: Any) -> None:
        self.described = described


class ComposableLifecycleNode(ComposableNode):
    """The same for a managed node."""
