"""Live mode: robot time goes on by itself, paced to the wall clock, while other cells can be run; and the widgets' backend."""

from __future__ import annotations

import asyncio
from collections import deque
from typing import TYPE_CHECKING

from ..ros.runtime.files import CellOutput
from ..ros.sim.errors import print_error
from ..ros.sim.run_blocking import drive
from ..ros.sim.simulation import NANOSECONDS
from ..ros.stdlib.clocks import real_monotonic

if TYPE_CHECKING:
    from rclpy.executors import SingleThreadedExecutor

    from ..lab.recorder import ObstacleBoard, Recorder
    from ..ros.runtime.world import World

STEP = 1 / 30
LONGEST_WORK = 0.03
"""How long a step may keep the notebook busy, in seconds; a rate that needs more is as fast as the computer can."""

BREATH = 0.004
"""Seconds that the notebook has to itself, to answer and to draw, after a step that was cut short."""

LONGEST_STEP = 0.25
"""After a cell that computed for long, live mode does not rush to catch up: at most this many seconds a step."""

PIECE = NANOSECONDS // 10
"""A step is run in pieces of so much robot time, between which the wall clock is looked at."""

MOST = 1e6
"""Seconds of robot time in one step at most; an infinite rate, which is as fast as possible, never gets there."""


LONGEST_CALLBACK = 150 * NANOSECONDS
"""Robot time, in ns, for which a callback or function of a cell may hold a check or live mode up."""


class OfWorld:
    """What looks at a world of this notebook."""

    def __init__(self, world: World) -> None:
        self._world = world

    @property
    def now(self) -> float:
        """Robot time: seconds since the world began."""
        return self._world.now / NANOSECONDS

    @property
    def ended(self) -> bool:
        """Whether a newer `start()` has taken this world's place."""
        return self._world.sim.closed


def start_simulator(world: World) -> None:
    """Start the turtle simulator, which prints to the cell that runs."""
    out, target = CellOutput(world.sim), world.packages.executable("turtlesim", "turtlesim_node")
    world.spawn(target, name="turtlesim", argv=["turtlesim_node"], stdout=out, stderr=out)


class CellNodes:
    """Lets robot time pass, and has the callbacks of the nodes that were made in the notebook's cells called meanwhile."""

    def __init__(self, world: World) -> None:
        self._world = world
        # one for all steps: it keeps the coroutines that wait from one step to the next
        self._executor: SingleThreadedExecutor | None = None

    def run_until(self, end: int) -> None:
        """Go on until `end` (ns of robot time). Raises what a callback raises; then not all of that time has passed."""
        if self._world.sim.stepped is not None or not self._spin(end):  # what is stepped spins its nodes itself
            self._world.sim.run_until(end)

    def _spin(self, end: int) -> bool:
        """Spin the nodes until `end`; whether there are any, and time has passed."""
        from rclpy._state import RclpyState

        context = self._world.notebook.state(RclpyState).context
        nodes = list(context._nodes) if context is not None and context.ok() else []
        if not nodes:
            return False
        from rclpy.executors import SingleThreadedExecutor
        from rclpy.task import Future

        executor = next(filter(None, (node._ros_assignment.executor for node in nodes)), None)
        if executor is None:
            executor = self._executor = self._executor or SingleThreadedExecutor()
        added = [node for node in nodes if node._ros_assignment.executor is None and executor.add_node(node)]
        try:
            before = self._world.now
            seconds = (end - before) / NANOSECONDS
            spin = executor.spin_until_future_complete
            drive(self._world.notebook, spin, Future(), seconds, limit=LONGEST_CALLBACK)
            return self._world.now > before  # an executor that was shut down lets no time pass
        finally:
            for node in added:
                executor.remove_node(node)


class Player:
    """Plays a world in the notebook's event loop; for widgets it is the clock. Nodes of cells are spun meanwhile."""

    def __init__(self, world: World) -> None:
        self._simulation = world.sim
        self._cells = CellNodes(world)
        self._task: asyncio.Task[None] | None = None
        self._rate = 1.0
        self._watch = Stopwatch()

    @property
    def playing(self) -> bool:
        """Whether robot time goes on by itself."""
        return self._task is not None and not self._task.done()

    @property
    def rate(self) -> float:
        """How many times as fast as real time; `math.inf` is as fast as possible. Can be changed at any time."""
        return self._rate

    @rate.setter
    def rate(self, rate: float) -> None:
        if isinstance(rate, bool) or not isinstance(rate, (int, float)) or not rate > 0:
            raise ValueError(
                f"rate must be a number above 0, got {rate!r}: 1.0 is real time, 10 is ten times faster, "
                "math.inf as fast as possible"
            )
        self._rate = float(rate)

    @property
    def wall_seconds(self) -> float:
        """Seconds of real time for which it has played since `play()`."""
        return self._watch.seconds

    @property
    def speed(self) -> float:
        """How many times as fast as real time it really went in the last second; 0 while it stands still."""
        return self._watch.speed if self.playing else 0.0

    def play(self, rate: float) -> None:
        """Go on by itself at `rate` times real time; if it does so already, only change the rate."""
        self.rate = rate
        if self.playing:
            return
        try:
            loop = asyncio.get_running_loop()
        except RuntimeError:
            raise RuntimeError(
                "play() needs a notebook, whose event loop runs between cells; in a script use lesson.run(seconds)"
            ) from None
        self._watch = Stopwatch(real_monotonic())
        self._task = loop.create_task(self._play())

    def pause(self) -> None:
        """Stop."""
        if self._task is not None:
            self._task.cancel()
            self._task = None

    def step(self, seconds: float) -> None:
        """Let some seconds of robot time pass at once."""
        self._simulation.run_until(self._simulation.now + round(seconds * NANOSECONDS))

    async def _play(self) -> None:
        simulation = self._simulation
        last, done = real_monotonic(), True
        while not simulation.closed:
            await asyncio.sleep(STEP if done else BREATH)
            now = real_monotonic()
            step = min(max(min(now - last, LONGEST_STEP), BREATH) * self.rate, MOST)
            last, begun = now, simulation.now
            if simulation.closed:
                return
            try:
                done = self._run(begun + round(step * NANOSECONDS))
            except KeyboardInterrupt:  # which would end Jupyter's event loop, and with it the kernel
                self._task = None
                print("Live mode was interrupted; lesson.play() continues it.")
                return
            except Exception as error:
                self._task = None
                print("Live mode has stopped because of this error; lesson.play() continues it.")
                print_error(error)
                return
            self._watch.mark(real_monotonic(), simulation.now - begun)

    def _run(self, until: int) -> bool:
        """Run towards `until` (ns), but at most for `LONGEST_WORK` of real time, so that cells stay usable at any rate.

        Returns whether it got there.
        """
        simulation = self._simulation
        simulation.keyboard.live = True
        deadline = real_monotonic() + LONGEST_WORK
        try:
            while simulation.now < until and real_monotonic() < deadline:
                self._cells.run_until(min(until, simulation.now + PIECE))
        finally:
            simulation.keyboard.live = False
        return simulation.now >= until


class Stopwatch:
    """Real time since a moment (s), and how fast robot time went by in its last second."""

    WINDOW = 1.0

    def __init__(self, now: float = 0.0) -> None:
        self._began = now
        self._marks: deque[tuple[float, int]] = deque([(now, 0)])

    def mark(self, now: float, played: int) -> None:
        """Note how much more robot time (ns) went by until this moment (s)."""
        self._marks.append((now, self._marks[-1][1] + played))
        while len(self._marks) > 2 and self._marks[1][0] < now - self.WINDOW:
            self._marks.popleft()

    @property
    def seconds(self) -> float:
        """Real time from the start to the last mark, s."""
        return self._marks[-1][0] - self._began

    @property
    def speed(self) -> float:
        """Robot time by real time in the last second; 0 before there is a second mark."""
        (first, before), (last, after) = self._marks[0], self._marks[-1]
        return (after - before) / NANOSECONDS / max(last - first, 1e-9)


class SimBackend(OfWorld):
    """What the widgets see (`Link` in lab/widgets/backend.py) of a world of this notebook, with its player as the clock."""

    def __init__(self, world: World, recorder: Recorder, player: Player, board: ObstacleBoard) -> None:
        from ..lab.widgets.backend import Loop

        super().__init__(world)
        self.recorder = recorder
        self.board = board
        self.node = recorder.node
        self.clock = player
        self.keyboard = world.sim.keyboard
        self.loop = Loop()
        self.at_close = world.at_close
