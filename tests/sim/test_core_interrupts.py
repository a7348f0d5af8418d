"""Interrupts, and code that holds up robot time: what is ended, and what is left alone, however busy the machine is.

The clocks by which the watchdog goes are set by hand here, so nothing in these tests takes or waits for real time.
"""

from __future__ import annotations

import _imp
import contextlib
import io
import socket
import sys
import sysconfig
import threading
import time
from collections.abc import Callable
from importlib.machinery import ModuleSpec, SourceFileLoader
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest
import rclpy

from turtle_lesson import start
from turtle_lesson.lab import recorder
from turtle_lesson.ros.runtime.world import World
from turtle_lesson.ros.sim import errors, interrupts
from turtle_lesson.ros.sim.errors import NeverReturns
from turtle_lesson.ros.sim.process import Process

SECOND = 1_000_000_000
LIBRARY = f"{sysconfig.get_path('purelib')}/slow_library.py"
"""The file of a library that was installed; it need not be there."""


class Watchdog(interrupts.Watchdog):
    """One that looks when a test tells it to, and sees as much time pass as the test says.

    Attributes:
        real: what the wall clock shows, s.
        work: how much CPU time the main thread has used, s.
    """

    real = work = 0.0

    def start(self) -> None:
        """There is no thread."""

    @property
    def noted(self) -> bool:
        """Whether the main thread has noted that the run is to stop."""
        return self._guard is not None and self._guard.interrupted

    def wait(self, seconds: float, *, computing: bool) -> None:
        """Let real time pass, in which the main thread computes all the time or does nothing."""
        for _ in range(round(seconds * 4)):
            self.tick(computing)
            self.look()

    def tick(self, computing: bool) -> None:
        """Let a quarter of a second pass."""
        self.real += 0.25
        self.work += 0.25 * computing


@pytest.fixture
def watchdog(monkeypatch: pytest.MonkeyPatch) -> Watchdog:
    """The watchdog of all runs of this test."""
    watchdog = Watchdog()
    monkeypatch.setattr(interrupts, "watchdog", watchdog)
    monkeypatch.setattr(interrupts, "_monotonic", lambda: watchdog.real)
    monkeypatch.setattr(interrupts, "work_done", lambda: watchdog.work)
    return watchdog


def press_stop() -> None:
    """Ctrl-C, or the stop button of Jupyter."""
    interrupts._interrupt_main_thread()  # within a program, os.kill() and the like would signal that program


def in_a_file(path: str, source: str, **names: Any) -> dict[str, Any]:
    """Run code as if it stood in some file; returns its names."""
    exec(compile(source, path, "exec"), names)
    return names


# -- computing -------------------------------------------------------------------------------------------------------------


def test_a_callback_that_computes_is_ended_by_its_own_cpu_time(world: World, watchdog: Watchdog) -> None:
    log = []

    def computes() -> None:
        watchdog.wait(9, computing=True)
        log.append("nine seconds")
        watchdog.wait(2, computing=True)
        log.append("eleven")

    process = world.spawn(computes, name="computes")
    world.sim.run_until(SECOND)
    assert isinstance(process.error, NeverReturns) and log == ["nine seconds"]
    assert str(process.error).startswith(
        "computes has computed for 10 s without letting any time pass, so nothing else"
    )


def test_so_is_a_librarys_function_that_a_learners_node_calls(world: World, watchdog: Watchdog) -> None:
    source = "def compute():\n    for _ in range(200): tick(True), look()"
    library = in_a_file(LIBRARY, source, tick=watchdog.tick, look=watchdog.look)

    def spins() -> None:
        rclpy.init()
        node = rclpy.create_node("computes")
        node.create_timer(0.1, library["compute"])
        rclpy.spin(node)

    process = world.spawn(spins, name="computes")
    world.spawn(lambda: time.sleep(0.5), name="sleeps")  # between two programs, turns are taken on a stack of their own
    world.sim.run_until(SECOND)
    assert isinstance(process.error, NeverReturns)


def test_a_busy_machine_ends_nothing(world: World, watchdog: Watchdog) -> None:
    """The program computes for 8 s, which takes 80: of ten quarters of a second it gets one."""

    def computes() -> None:
        for _ in range(32):
            watchdog.wait(2.25, computing=False)
            watchdog.wait(0.25, computing=True)

    process = world.spawn(computes, name="computes")
    world.sim.run_until(SECOND)
    assert process.exit_code == 0


def test_cpu_time_is_that_of_the_main_thread_on_every_system(monkeypatch: pytest.MonkeyPatch) -> None:
    def compute() -> None:
        before = interrupts.time.thread_time()
        while interrupts.time.thread_time() - before < 0.2:
            pass

    thread = threading.Thread(target=compute)
    thread.start()
    thread.join()
    compute()
    done = interrupts.work_done()
    assert done == pytest.approx(interrupts.time.thread_time(), abs=0.05)
    monkeypatch.delattr(interrupts.time, "pthread_getcpuclockid", raising=False)
    assert interrupts.work_done() == pytest.approx(done, abs=0.05)  # the system counts in hundredths of a second


# -- importing -------------------------------------------------------------------------------------------------------------


@pytest.fixture
def slow_library(watchdog: Watchdog, monkeypatch: pytest.MonkeyPatch) -> dict[str, str]:
    """`import slow_library` runs the code that a test puts under "module"; "search" is run while it is looked for.

    The code may call `compute()`, for a quarter of a second, and `press_stop()`.
    """
    texts = {"module": "", "search": ""}

    class Loader(SourceFileLoader):
        def get_code(self, fullname: str) -> Any:
            return compile(texts["module"], LIBRARY, "exec")

        def create_module(self, spec: ModuleSpec) -> ModuleType:
            module = ModuleType(spec.name)
            vars(module).update(names)
            return module

    def found(name: str) -> ModuleSpec | None:
        return ModuleSpec(name, Loader(name, LIBRARY)) if name == "slow_library" else None

    names = {"tick": watchdog.tick, "look": watchdog.look, "press_stop": press_stop}
    names |= in_a_file(LIBRARY, "def compute():\n    tick(True)\n    look()", **names)
    finder = (
        "class Finder:\n    def find_spec(name, path=None, target=None):\n"
        "        spec = found(name)\n        if spec: exec(compile(texts['search'], __file__, 'exec'))\n        return spec"
    )
    made = in_a_file(LIBRARY, finder, found=found, texts=texts, __file__=LIBRARY, **names)
    monkeypatch.setattr(sys, "meta_path", [made["Finder"], *sys.meta_path])
    monkeypatch.delitem(sys.modules, "slow_library", raising=False)
    return texts


def imports_it() -> None:
    import slow_library  # type: ignore[import-not-found]  # noqa: F401


def test_an_import_of_eleven_seconds_is_waited_for(
    world: World, watchdog: Watchdog, slow_library: dict[str, str], capsys: pytest.CaptureFixture[str]
) -> None:
    slow_library["module"] = "for _ in range(44): compute()"
    process = world.spawn(lambda: (imports_it(), watchdog.wait(9, computing=True)), name="imports")
    world.sim.run_until(SECOND)
    assert process.exit_code == 0 and capsys.readouterr().err == ""


def test_so_is_one_that_waits_for_a_slow_disk(
    world: World, slow_library: dict[str, str], capsys: pytest.CaptureFixture[str]
) -> None:
    slow_library["search"] = "for _ in range(44): tick(False), look()"
    process = world.spawn(imports_it, name="imports")
    world.sim.run_until(SECOND)
    assert process.exit_code == 0 and capsys.readouterr().err == ""


@pytest.mark.parametrize("part", ["module", "search"])
def test_an_interrupted_import_goes_on_to_its_end(world: World, slow_library: dict[str, str], part: str) -> None:
    """While a module is looked for, Python holds a lock that Jupyter's threads may need, too."""
    slow_library[part] = "press_stop()\nfor _ in range(16): compute()"
    log = []
    world.spawn(lambda: (imports_it(), log.append("imported")), name="imports")
    with pytest.raises(KeyboardInterrupt):
        world.sim.run_until(SECOND)
    assert log == ["imported"] and "slow_library" in sys.modules
    assert not _imp.lock_held()


@pytest.fixture
def importing(
    world: World, watchdog: Watchdog, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> Callable[[str], Process]:
    """Returns `importing(source)`: a program of the learner's that imports a module of theirs with this source."""
    monkeypatch.setattr(sys, "watchdog", watchdog, raising=False)
    monkeypatch.setattr(sys, "press_stop", press_stop, raising=False)

    def importing(source: str) -> Process:
        (tmp_path / "mine.py").write_text(f"import sys\n{source}\n")
        (tmp_path / "main.py").write_text("import mine\n")
        return world.spawn(tmp_path / "main.py", name="main")

    return importing


def test_a_learners_own_module_that_computes_without_end_is_found(
    world: World, importing: Callable[[str], Process]
) -> None:
    process = importing("sys.watchdog.wait(11, computing=True)")
    world.sim.run_until(SECOND)
    assert isinstance(process.error, NeverReturns)


def test_the_stop_button_ends_it(world: World, importing: Callable[[str], Process]) -> None:
    """Frozen in its middle, it would keep the lock of its module."""
    process = importing("sys.press_stop()\nsys.watchdog.wait(5, computing=True)")
    with pytest.raises(KeyboardInterrupt):
        world.sim.run_until(SECOND)
    assert process.exit_code == -2


# -- waiting for something outside -----------------------------------------------------------------------------------------


class Said(io.StringIO):
    """What a program says on its stderr; a thread can wait until it has said something."""

    def __init__(self) -> None:
        super().__init__()
        self.something = threading.Event()

    def write(self, text: str) -> int:
        """Keep it."""
        self.something.set()
        return super().write(text)


def test_a_program_that_waits_for_a_socket_is_told_once_and_goes_on(world: World, watchdog: Watchdog) -> None:
    here, there = socket.socketpair()
    said, heard = Said(), []

    def program() -> None:
        for _ in range(2):
            heard.append(here.recv(1))

    def other_computer() -> None:
        for _ in range(2):
            while not said.something.is_set():
                watchdog.wait(1, computing=False)
            watchdog.wait(60, computing=False)
            there.send(b"x")

    process = world.spawn(program, name="listener", stderr=said)
    thread = threading.Thread(target=other_computer)
    thread.start()
    with here, there:
        world.sim.run_until(SECOND)
        thread.join()
    assert heard == [b"x", b"x"] and process.exit_code == 0
    assert said.getvalue() == (
        "listener has been waiting for something outside the simulation (a socket, a file, another program) for 10 s. Robot "
        "time stands still until that is over; the stop button (Ctrl-C) interrupts it.\n"
    )


@pytest.mark.parametrize("kind", ["socket", "lock"])
def test_the_stop_button_ends_what_would_wait_for_ever(world: World, watchdog: Watchdog, kind: str) -> None:
    here, there = socket.socketpair()
    lock = threading.Lock()
    lock.acquire()
    here.settimeout(0.01)  # a signal that comes just before a wait begins is seen by Python when that wait is over

    def program() -> None:
        waits.set()
        while True:
            with contextlib.suppress(TimeoutError):
                lock.acquire(timeout=0.01) if kind == "lock" else here.recv(1)

    def user() -> None:
        waits.wait()
        press_stop()
        while not watchdog.noted:
            pass
        watchdog.wait(2, computing=False)

    waits = threading.Event()
    process = world.spawn(program, name="waits")
    thread = threading.Thread(target=user)
    thread.start()
    with here, there:
        with pytest.raises(KeyboardInterrupt):
            world.sim.run_until(SECOND)
        thread.join()
    assert process.exit_code == -2
    world.sim.run_until(2 * SECOND)
    assert world.now == 2 * SECOND


# -- the stop button -------------------------------------------------------------------------------------------------------


def test_an_interrupt_freezes_a_computation_and_the_next_run_goes_on(world: World, watchdog: Watchdog) -> None:
    log: list[str] = []

    def computes() -> None:
        press_stop()
        watchdog.wait(2, computing=True)
        log.append("done")

    world.spawn(computes, name="computes")
    with pytest.raises(KeyboardInterrupt):
        world.sim.run_until(SECOND)
    assert log == []
    world.sim.run_until(SECOND)
    assert log == ["done"]


def test_a_second_one_at_the_same_instant_ends_it(world: World, watchdog: Watchdog) -> None:
    """It may wait for something outside in many short waits, which looks as if it computed."""

    def polls() -> None:
        while True:
            press_stop()
            watchdog.wait(2, computing=True)

    process = world.spawn(polls, name="polls")
    for alive in (True, False):
        with pytest.raises(KeyboardInterrupt):
            world.sim.run_until(SECOND)
        assert process.alive == alive
    world.sim.run_until(SECOND)


def test_what_the_cell_itself_computes_can_be_interrupted(world: World, watchdog: Watchdog) -> None:
    world.sim.call_later(1, lambda: (press_stop(), watchdog.wait(9, computing=True)))
    with pytest.raises(KeyboardInterrupt):
        world.sim.run_until(SECOND)
    assert watchdog.real < 2
    world.sim.run_until(SECOND)


@pytest.mark.parametrize("inner", ["compute()", "json.dumps(Late())"])
def test_what_jupyter_does_with_its_locks_is_not_frozen(world: World, watchdog: Watchdog, inner: str) -> None:
    """As it would be if a print were frozen: Jupyter's thread would wait for ever for the lock that the print holds."""
    source = "def compute():\n    for _ in range(8): tick(True), look()\ndef late(each): compute()"
    library = in_a_file(f"{errors.LIBRARY_FOLDER}json/encoder.py", source, tick=watchdog.tick, look=watchdog.look)
    call = "late(None)" if "json" in inner else "compute()"
    jupyter = in_a_file(LIBRARY, f"def flush(): {call}", __name__="ipykernel.iostream", **library)
    log: list[str] = []
    world.spawn(lambda: (press_stop(), jupyter["flush"](), log.append("flushed")), name="prints")
    with pytest.raises(KeyboardInterrupt):
        world.sim.run_until(SECOND)
    assert log == ["flushed"]


# -- the lesson's own nodes ------------------------------------------------------------------------------------------------


def test_the_lessons_own_nodes_are_never_ended(world: World, watchdog: Watchdog) -> None:
    said = Said()
    source = "def main():\n    for _ in range(200): tick(True), look()"
    node = in_a_file(f"{errors.OUR_FOLDER}turtlesim/node.py", source, tick=watchdog.tick, look=watchdog.look)
    process = world.spawn(node["main"], name="turtlesim", stderr=said)
    world.sim.run_until(SECOND)
    assert process.exit_code == 0
    assert said.getvalue() == (
        "turtlesim has been computing for 10 s. Robot time stands still until that is over; the stop button (Ctrl-C) "
        "interrupts it.\n"
    )


def test_a_lab_that_could_not_begin_says_what_to_do(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def fails(*arguments: Any, **keywords: Any) -> None:
        raise MemoryError("no room")

    monkeypatch.setattr(recorder.Recorder, "__init__", fails)
    lesson = start(package=None)
    with pytest.raises(RuntimeError, match=r"/_lab, did not come up .* lesson = start\(…\)"):
        lesson.plot_path()
    assert "MemoryError: no room" in capsys.readouterr().err
