"""What rclpy keeps of each process: its default context, its executors, and where its log lines go."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from turtle_lesson.ros.sim.strand import Strand

    from .context import Context
    from .executors import Executor
    from .impl.logging_severity import LoggingSeverity
    from .node import Node


@dataclass
class RclpyState:
    """The state of rclpy in one process: `process.state(RclpyState)`."""

    context: Context | None = None
    """The default context; None before the first look at it, and after a shutdown until the next."""
    contexts: list[Context] = field(default_factory=list)
    """The contexts that are up."""
    executor: Executor | None = None
    """The one that `rclpy.spin` and its kin use."""
    spinning: list[Strand] = field(default_factory=list)
    """The threads that are in `spin`."""
    workers: dict[Strand, Executor] = field(default_factory=dict)
    """The threads that only run the callbacks that an executor gives them."""
    log_to: Mapping[str, bool] = field(default_factory=dict)
    """Whether log lines go to "stdout" and "rosout"; they do where nothing is said."""
    log_format: str | None = None
    log_colorized: bool = False
    log_levels: dict[str, LoggingSeverity] = field(default_factory=dict)
    """The levels that were set, by logger name; "" is the default."""
    rosout: dict[str, Callable[..., None]] = field(default_factory=dict)
    """By logger name, what publishes its lines."""

    @property
    def nodes(self) -> list[Node]:
        """The nodes of the contexts that are up."""
        return [node for context in self.contexts for node in context._nodes]
