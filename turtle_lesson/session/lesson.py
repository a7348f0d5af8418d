"""`start()` makes a fresh world; a `Lesson` runs it, launches programs in it and shows what happened."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cached_property, partial
from importlib.util import find_spec
from pathlib import Path
from random import Random
from typing import TYPE_CHECKING, Any

from ..learner.story import FINISHED, HERE, page_named
from ..learner.workspace import Workspace, workspace
from ..ros.ament.package import Package
from ..ros.ament.source import use_source
from ..ros.distro import chosen_release
from ..ros.idl.registry import registry
from ..ros.rmw.network import Conditions, set_conditions
from ..ros.runtime import files
from ..ros.runtime.world import World, open_world
from ..ros.sim.keyboard import key_named
from ..ros.sim.run_blocking import DRIVE_LIMIT, drive
from ..ros.sim.simulation import EPOCH, NANOSECONDS
from ..ros.sim.strand import running_strand
from ..ros.tools import demo_packages, program, tf2_packages
from .live import Player, SimBackend, start_simulator
from .robot import real_ros
from .views import Inspection

if TYPE_CHECKING:
    from ..lab.recorder import Recorder
    from ..ros.ament.source import Exported
    from ..ros.bags.recorder import Recording
    from ..ros.launching.service import LaunchHandle
    from ..turtlesim.obstacles import Obstacle

LONGEST_RUN = 1e9
"""Seconds of robot time that one run may take: thirty years are enough for every mistake."""


def start(
    seed: int = 0,
    package: str | Path | None = "finished",
    simulator: bool = True,
    *,
    page: str | None = None,
    distro: str | None = None,
    start_order: str = "as written",
) -> Lesson:
    """Make a fresh world, in which nothing of an earlier one goes on, and return the `Lesson` that runs it.

    Its terminal is fresh, too: commands work in the notebook's own folder again, whatever `cd` did before.

    Args:
        seed: decides about all random numbers in the world; the same seed gives the same run.
        package: "finished" (the lesson's own robot_controller), "mine" (the learner's own in `workspace`: built if its
            sources have changed, and sourced, as the start-up file of a terminal may do), None (no such package, as before
            it is built), or the folder of another package's source.
        simulator: whether the turtle simulator runs from the beginning.
        page: a page of the lesson, such as "04_status_monitor": what the pages before it would have left in the learner's
            package is brought where it is missing, and listed; the package that results is "mine" unless another is asked for.
        distro: the release of ROS 2 that the world behaves as where releases differ: "humble", "iron", "jazzy" or "kilted".
            None is what the environment variable ROS_DISTRO says, or else "humble".
        start_order: in which order the programs of a launch file come up: "as written" in it, or "shuffled", an order that
            the seed decides. Nothing promises an order on a robot.

    Raises RuntimeError where a real ROS 2 is sourced, ValueError for anything else as `package`, `page`, `distro` or
    `start_order`.
    """
    if place := real_ros():
        raise RuntimeError(
            f"a real ROS 2 is sourced here (rclpy is {place}), and the simulated one never replaces it. "
            "turtle_lesson.connect() shows its robot with the same widgets. For a simulated world, start Jupyter from a "
            "terminal in which no setup file was sourced."
        )
    if not isinstance(seed, int):
        raise ValueError(f"seed must be a whole number, got {seed!r}: try start(seed=0)")
    page = None if page is None else page_named(page)
    package = "mine" if page and package == "finished" else package
    source = check_world(package, distro, start_order)
    files.begin_terminal()
    if page is not None:
        print(workspace().prepare(page).state())
    mine = workspace() if package == "mine" else None
    if mine is not None and (mine.package / "package.xml").exists() and not mine.is_built:
        build_world = _fresh_world(seed, distro)  # building takes robot time, and the lesson's world begins at 0 s
        if said := mine.build(build_world):
            print(f"{said.rstrip()}\nThe package was not built, so an earlier build of it is used, if there is one.")
    world = _fresh_world(seed, distro)
    if start_order == "shuffled":
        world.start_order = Random(f"{seed}/start order")
    if "robot_controller" in registry.packages():
        registry.remove("robot_controller")
    if source is not None:
        use_source(world, source)
    if mine is not None:
        mine.source(world)
    return Lesson(world, simulator=simulator)


def _fresh_world(seed: int, distro: str | None) -> World:
    world = open_world(seed, distro)
    for each in underlay_packages():
        world.packages.add(each)
    return world


def check_seconds(call: str, seconds: object) -> None:
    """Raise ValueError unless this is a number of seconds that a call such as "lesson.run" can take."""
    if isinstance(seconds, bool) or not isinstance(seconds, (int, float)) or not 0 <= seconds <= LONGEST_RUN:
        raise ValueError(
            f"seconds must be a number of seconds from 0 to {LONGEST_RUN:.0e}, got {seconds!r}: try {call}(5)"
        )


class Lesson(Inspection):
    """A running world, and what a page does with it. Times are in seconds of robot time."""

    def __init__(self, world: World, *, simulator: bool = True) -> None:
        self._world = world
        self._player = Player(world)
        world.player = self._player
        self._launched: dict[tuple[Path, str], LaunchHandle] = {}
        self._recorder: Recorder | None = None
        world.keep_trace()
        world.spawn(self._lab, name="lab", argv=["lab"])
        if simulator:
            start_simulator(world)
        world.sim.settle()

    def __repr__(self) -> str:
        return f"<Lesson at {self.now:.3f} s of robot time>"

    @property
    def now(self) -> float:
        """The robot time: seconds since this world began."""
        return self._world.now / NANOSECONDS

    def run(self, seconds: float, *, input: Iterable[str] = ()) -> None:
        """Let `seconds` of robot time pass, as fast as the computer can.

        `input` holds lines for the programs that call `input()`, in the order in which they ask; when there is none left,
        the cell itself asks. An interrupt (the stop button) pauses the world; the next run goes on from there.
        """
        check_seconds("lesson.run", seconds)
        lines = input.splitlines() if isinstance(input, str) else list(input)
        if not all(isinstance(line, str) for line in lines):
            raise TypeError(f'input must be lines of text, got {lines!r}: try lesson.run(5, input=["3", "yes"])')
        self._world.sim.keyboard.lines.extend(lines)
        self._world.sim.run_until(self._world.now + round(seconds * NANOSECONDS))

    def press(self, *keys: str, every: float = 0.5) -> None:
        """Press keys for the program that reads keys, and let `every` seconds of robot time pass with each of them.

        A key is one character, or a name such as "up", "space", "enter", "esc" or "ctrl+c". Of several programs, the one
        that began last gets them. Raises ValueError if there is no such key, RuntimeError if no program reads keys.
        """
        check_seconds("lesson.press", every)
        keyboard = self._world.sim.keyboard
        keyboard.has_keys = True
        for key in [key_named(key) for key in keys]:
            if not keyboard.reader:
                raise RuntimeError(
                    f"no running program reads keys, so {key!r} was not pressed: start one first (ros2 run …), and let it "
                    "begin (lesson.run(1)). input() reads lines: lesson.run(1, input=['3'])"
                )
            keyboard.press(key)
            self.run(every)
            keyboard.press(key, down=False)
            self._world.sim.settle()

    def spin(self, seconds: float, *nodes: Any) -> None:
        """Let `seconds` of robot time pass, and have the callbacks of nodes that live in this notebook called meanwhile.

        It is `rclpy.spin` with an end, on one thread: for the nodes that are named, or else for all that were made in cells.
        """
        from rclpy._state import RclpyState
        from rclpy.executors import SingleThreadedExecutor
        from rclpy.task import Future

        check_seconds("lesson.spin", seconds)
        context = self._world.notebook.state(RclpyState).context
        if context is None or not context.ok():
            self.run(seconds)  # no node lives in a cell
            return
        executor = SingleThreadedExecutor(context=context)
        for node in nodes or list(context._nodes):
            executor.add_node(node)
        spin = partial(executor.spin_until_future_complete, Future(), float(seconds))
        try:
            if running_strand() is not None:  # a thread of the notebook spins
                spin()
            else:
                drive(self._world.notebook, spin, limit=round(seconds * NANOSECONDS) + DRIVE_LIMIT)
        finally:
            executor.shutdown()

    def play(self, rate: float = 1.0) -> None:
        """Let robot time go on by itself, `rate` times as fast as real time, until `pause()`. Other cells work on.

        Nodes that were made in cells are spun meanwhile, as `spin` does it. `math.inf` is as fast as possible.
        """
        self._player.play(rate)

    def pause(self) -> None:
        """Stop what `play` began."""
        self._player.pause()

    def network(
        self,
        topic: str | None = "",
        *,
        latency: float | None = None,
        jitter: float | None = None,
        loss: float | None = None,
    ) -> dict[str, Conditions]:
        """Have the messages of a topic travel through a network that is as bad as this says, from now on.

        Best-effort messages that are lost are gone. Reliable ones are sent again, 10 ms and two ways later and as long as
        the publisher still has them, and arrive in their order. A service of that name is treated so, too, and is always
        reliable. What is lost is chance, and the same in each run of the same world.

        Args:
            topic: a full name such as "/scan", or a pattern such as "/turtle*/pose"; it need not be used yet. A name goes
                before patterns, a later pattern before an earlier one.
            latency: how long a transmission takes (s); at least the 0.1 ms that it always takes.
            jitter: up to how much longer it takes (s), each time anew; best-effort messages that are overtaken are lost.
            loss: the share of transmissions that is lost, from 0 to 1; with 1, nothing comes through.

        With none of the three, what was said about this name is forgotten; `network(None)` forgets everything. Returns
        what holds now, for all names; `network()` does nothing else. Raises ValueError or TypeError.
        """
        return set_conditions(self._world.graph, topic, latency, jitter, loss)

    @property
    def workspace(self) -> Workspace:
        """The learner's own workspace: `.state()` tells what is in it, `.reset("05")` puts it back as page 05 finds it."""
        return workspace()

    def launch(self, package: str, launch_file: str, **arguments: Any) -> LaunchHandle:
        """Start what a package's launch file says: `ros2 launch package launch_file name:=value …`.

        Its Python programs come up one after the other, 0.3 s of robot time each; this returns when all are up. Launched
        again with the same arguments, it is stopped first, so that a cell can be run twice. Returns a handle
        whose `stop()` is Ctrl-C. Raises LaunchError, which says what is wrong and where.
        """
        from ..ros.launching import errors, service

        for name, value in (("package", package), ("launch_file", launch_file)):
            if not isinstance(value, str):
                raise TypeError(
                    f'{name} must be a name such as "robot_controller" or "start_system.launch.py", got {value!r}'
                )
        path = errors.find_launch_file(self._world, package, launch_file)
        again = self._launched.get((path, repr(sorted(arguments.items()))))
        if again is not None and again.running:
            again.stop()  # or a cell that is run twice would double the robot
        handle = service.launch_file(self._world, path, arguments)
        self._launched[path, repr(sorted(arguments.items()))] = handle
        handle.wait_until_up()
        return handle

    def record(self, path: str | Path, topics: Iterable[str] | None = None, storage: str = "mcap") -> Recording:
        """Record topics into a bag, a new folder at `path`, until `stop()` or the end of a `with` block.

        Args:
            path: the folder to make; nothing is ever overwritten.
            topics: the names of the topics; None records all but the hidden ones.
            storage: "mcap" or "sqlite3".

        Raises BagError, a ValueError, if the folder is there already, or for an unknown storage.
        """
        from ..ros.bags.recorder import Recording

        return Recording(self._world, path, topics, storage)

    def export(self, package: str | Path, to: str | Path, *, overwrite: bool = False) -> Exported:
        """Write a package to take to a robot: into `to`/src, with a README of the commands that build it there.

        `package` is a name ("robot_controller": the learner's, or else the finished one) or a folder. It is checked with
        every rule of the build first. Raises PackageError, which says what a real build would refuse and where.
        """
        from ..ros.ament.source import export_package

        return export_package(self._world, package, to, overwrite=overwrite)

    def place(self, *obstacles: Obstacle) -> None:
        """Put obstacles (`Circle`, `Box`) into the world. They are published on /world/obstacles."""
        self._board.put([*self._board.obstacles, *obstacles])

    def set_obstacles(self, obstacles: Iterable[Obstacle] | str) -> None:
        """Replace all obstacles, by a list of them or by the name of a ready-made world."""
        self._board.put(obstacles)

    @property
    def obstacles(self) -> tuple[Obstacle, ...]:
        """The obstacles in the world."""
        return self._board.obstacles

    def _lab(self) -> None:
        """The lab's own process: a node with a hidden name that listens, and publishes the obstacles."""
        import rclpy

        from ..lab.recorder import Recorder

        rclpy.init()
        node = rclpy.create_node("_lab", start_parameter_services=False, enable_rosout=False)
        self._recorder = Recorder(node, origin=EPOCH)
        rclpy.spin(node)

    @property
    def _recording(self) -> Recorder:
        if self._recorder is None:
            raise RuntimeError(
                "the lesson's own node, /_lab, did not come up (an error above says why), and it draws and checks from what "
                "it hears. Run the cell with lesson = start(…) once more"
            )
        return self._recorder

    @cached_property
    def _backend(self) -> SimBackend:
        return SimBackend(self._world, self._recording, self._player, self._board)


# -- the packages of a world -------------------------------------------------------------------------------------------


def underlay_packages() -> list[Package]:
    """The packages of a fresh ROS 2 whose programs `ros2 run` and launch files find: turtlesim, tf2, demos, xacro."""
    names = ("draw_square", "mimic", "turtle_teleop_key")
    programs = {name: program("turtle_lesson.turtlesim.tutorials", name) for name in names}
    programs = {"turtlesim_node": program("turtle_lesson.turtlesim.node"), **programs}
    packages = [Package("turtlesim", HERE / "turtlesim", executables={**programs}), *tf2_packages(), *demo_packages()]
    xacro = find_spec("xacro")  # a package of PyPI, which may be installed
    if xacro is not None and xacro.origin is not None:
        packages.append(Package("xacro", Path(xacro.origin).parent, executables={"xacro": program("xacro")}))
    return packages


def check_world(package: str | Path | None, distro: str | None, start_order: str) -> Path | None:
    """The source folder of the package that `start` is asked for; None for none, and for the learner's own.

    Raises ValueError where it is not there, and for a release or an order that does not exist.
    """
    chosen_release(distro)
    if start_order not in ("as written", "shuffled"):
        raise ValueError(f'start_order must be "as written" or "shuffled", got {start_order!r}')
    if package in (None, "mine"):
        return None
    if package == "finished":
        return FINISHED
    if isinstance(package, (str, Path)) and Path(package).is_dir():
        return Path(package).resolve()
    raise ValueError(
        f'package must be "finished", "mine", None or the folder of a package, got {package!r}, which is not a folder here'
    )
