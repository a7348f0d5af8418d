"""What checks observe in a world of this notebook: the lab's hidden node, and a clock that also runs the cells' nodes."""

from __future__ import annotations

import io
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, redirect_stdout
from typing import TYPE_CHECKING, Any

from ..ros.rmw.network import set_conditions
from ..ros.sim.errors import DriveTimeout, NeverReturns, SimulationError, WorldClosed
from ..ros.sim.interrupts import work_done
from ..ros.sim.run_blocking import drive
from ..ros.sim.simulation import NANOSECONDS
from .live import LONGEST_CALLBACK, CellNodes, OfWorld

if TYPE_CHECKING:
    from ..lab.recorder import ObstacleBoard, Recorder
    from ..ros.runtime.world import World
    from ..ros.sim.strand import Strand


class CheckTarget(OfWorld):
    """What a `Probe` of a check (see lab/checks/probe.py) looks at.

    A node that was made in a cell is only alive while that cell spins it. While a check looks, such nodes are spun; what
    their callbacks raise is kept in `errors`, and they go on.
    """

    def __init__(self, world: World, recording: Recorder, board: ObstacleBoard) -> None:
        super().__init__(world)
        self.recording = recording
        self.node = recording.node
        self.board = board
        self._errors: list[tuple[str, Exception]] = []
        self._cells = CellNodes(world)

    @property
    def errors(self) -> list[tuple[str, Exception]]:
        """What callbacks of the cells' nodes have raised while a check looked, and what ended programs, with their names."""
        programs = [(each.name, each.error) for each in self._world.processes]
        return [*self._errors, *((name, error) for name, error in programs if isinstance(error, Exception))]

    @property
    def strands(self) -> list[Strand]:
        """The strands of all processes that wait somewhere."""
        processes = [*self._world.processes, self._world.notebook]
        return [each for process in processes if process.alive for each in process.strands if each.parked]

    def limit_work(self, seconds: float | None) -> None:
        """Stop the learner's code once it has used this much more CPU time (s); None lifts that limit."""
        self._world.sim.suspect = None
        self._world.sim.work_until = None if seconds is None else work_done() + seconds

    def runs(self, program: str) -> bool:
        """Whether a program of this name is running."""
        return any(each.name == program and each.alive for each in self._world.processes)

    @property
    def commands(self) -> list[list[str]]:
        """The command lines of the programs that run, each as its words: what `ps` shows."""
        return [list(each.argv) for each in self._world.processes if each.alive and each.argv]

    @contextmanager
    def launched(
        self, package: str, file_name: str, namespace: str, renamed: Mapping[str, str], arguments: Mapping[str, object]
    ) -> Iterator[None]:
        """Within this block a launch file runs once more, its nodes in a namespace, with some names replaced.

        Raises LaunchError if it cannot be carried out.
        """
        from launch import LaunchDescription
        from launch.actions import GroupAction, IncludeLaunchDescription
        from launch.launch_description_sources import AnyLaunchDescriptionSource
        from launch_ros.actions import PushRosNamespace, SetRemap

        from ..ros.launching import errors, service

        source = AnyLaunchDescriptionSource(str(errors.find_launch_file(self._world, package, file_name)))
        given = [(name, str(value)) for name, value in arguments.items()]
        apart = [PushRosNamespace(namespace), *(SetRemap(old, new) for old, new in renamed.items())]
        group = GroupAction([*apart, IncludeLaunchDescription(source, launch_arguments=given)])
        with self.ending_programs():
            service.launch_description(self._world, LaunchDescription([group])).wait_until_up()
            yield

    @contextmanager
    def ending_programs(self) -> Iterator[None]:
        """Programs that are started within this block are interrupted at its end, as by Ctrl-C."""
        before = list(self._world.processes)
        try:
            yield
        finally:
            with redirect_stdout(io.StringIO()):  # what programs say when they are interrupted
                for each in list(self._world.processes):
                    if each.alive and all(each is not old for old in before):
                        each.interrupt()
                self.step(0.1)

    @contextmanager
    def network(self, topic: str, latency: float | None = None, loss: float | None = None) -> Iterator[None]:
        """Within this block the messages of a topic travel like this (see `Lesson.network`); after it, all travel as before."""
        graph = self._world.graph
        before = set_conditions(graph, "", None, None, None)
        set_conditions(graph, topic, latency, None, loss)
        try:
            yield
        finally:
            set_conditions(graph, None, None, None, None)
            for name, conditions in before.items():
                graph.set_network(name, conditions)

    def published(self, topic: str, by: str) -> int:
        """How many messages a node's newest publisher of a topic has sent so far; 0 if there is none."""
        trace = self._world.trace
        if trace is None or (topic, by) not in trace.published:
            return 0
        since = trace.made[topic, by]
        return sum(time >= since for time in trace.published[topic, by])

    def call(self, function: Callable[..., Any], *arguments: Any) -> Any:
        """Call a function of the learner's as a cell would: it may sleep, and is stopped if it computes without end."""
        return drive(self._world.notebook, function, *arguments, limit=LONGEST_CALLBACK)

    def step(self, seconds: float) -> None:
        """Let robot time pass. Raises KeyboardInterrupt, and SimulationError where the world itself cannot go on."""
        end = self._world.now + round(seconds * NANOSECONDS)
        while self._world.now < end:
            try:
                self._cells.run_until(end)
            except Exception as error:
                if type(error) in (SimulationError, WorldClosed):
                    raise  # the world itself cannot go on; the other kinds are of a callback
                self._errors.append(("", error))
                if isinstance(error, (NeverReturns, DriveTimeout)):
                    return
