"""Where the checks look in a world of this notebook: the lab's hidden node, and a clock that also runs the cells' nodes."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

from .ros.core import NANOSECONDS
from .ros.core.driving import drive
from .ros.core.errors import NeverReturns, SimulationError, WorldClosed

if TYPE_CHECKING:
    from .lab.obstacle_board import ObstacleBoard
    from .ros.core.strand import Strand
    from .ros.world import World


class ExamPlace:
    """A `Place` (see lab/checks/exam.py).

    A node that was made in a cell is only alive while that cell spins it. While a check looks, such nodes are spun; what
    their callbacks raise is kept in `errors`, and they go on.
    """

    def __init__(self, world: World, node: Any, board: ObstacleBoard) -> None:
        self._world = world
        self.node = node
        self._board = board
        self._errors: list[tuple[str, Exception]] = []
        self._executor: Any = None  # one for all steps: it keeps the coroutines that wait from one step to the next

    @property
    def now(self) -> float:
        """Robot time: seconds since the world began."""
        return self._world.now / NANOSECONDS

    @property
    def ended(self) -> bool:
        """Whether a newer `start()` has taken this world's place."""
        return self._world.sim.closed

    @property
    def errors(self) -> list[tuple[str, Exception]]:
        """What callbacks of the cells' nodes have raised while a check looked, and what ended programs, with their names."""
        programs = [(each.name, each.error) for each in self._world.processes]
        return [*self._errors, *((name, error) for name, error in programs if isinstance(error, Exception))]

    @property
    def strands(self) -> list[Strand]:
        """The lines of execution of all processes that wait somewhere."""
        processes = [*self._world.processes, self._world.notebook]
        return [each for process in processes if process.alive for each in process.strands if each.parked]

    @property
    def obstacles(self) -> tuple[Any, ...]:
        """The obstacles in the world."""
        return self._board.obstacles

    def put(self, obstacles: Iterable[Any]) -> None:
        """Replace them."""
        self._board.put(obstacles)

    def call(self, function: Callable[..., Any], *arguments: Any) -> Any:
        """Call a function of the learner's as a cell would: it may sleep, and is stopped if it computes without end."""
        return drive(self._world.sim, self._world.notebook, function, *arguments)

    def step(self, seconds: float) -> None:
        """Let robot time pass. Raises KeyboardInterrupt, and SimulationError where the world itself cannot go on."""
        end = self._world.now + round(seconds * NANOSECONDS)
        while self._world.now < end:
            try:
                if not self._spin_cells(end):
                    self._world.sim.run_until(end)
            except Exception as error:
                if type(error) in (SimulationError, WorldClosed):
                    raise  # the world itself cannot go on; the other kinds are of a callback
                self._errors.append(("", error))
                if isinstance(error, NeverReturns):
                    return

    def _spin_cells(self, end: int) -> bool:
        """Spin the nodes of the notebook's cells until `end` (ns); whether there are any."""
        nodes = self._cell_nodes()
        if not nodes:
            return False
        from rclpy.executors import SingleThreadedExecutor
        from rclpy.task import Future

        executor = next((node._ros_executor for node in nodes if node._ros_executor is not None), None)
        if executor is None:
            executor = self._executor = self._executor or SingleThreadedExecutor()
        added = [node for node in nodes if node._ros_executor is None and executor.add_node(node)]
        try:
            before = self._world.now
            executor.spin_until_future_complete(Future(), (end - before) / NANOSECONDS)
            return self._world.now > before  # an executor that was shut down lets no time pass
        finally:
            for node in added:
                executor.remove_node(node)

    def _cell_nodes(self) -> list[Any]:
        """The nodes that live in the notebook itself."""
        context = self._world.notebook.locals.get("rclpy.context")
        return list(context._nodes) if context is not None and context.ok() else []
