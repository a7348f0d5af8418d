"""Signals and the end of a program: handlers of its own, `atexit`, and what a simulated process cannot have."""

from __future__ import annotations

import _thread
import atexit
import os
import signal
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from turtle_lesson.ros.runtime.world import World

Run = Callable[..., list[Any]]
Capture = pytest.CaptureFixture[str]
SECOND = 1_000_000_000


def test_a_handler_is_called_where_the_main_program_waits_and_the_waiting_goes_on(world: World) -> None:
    log: list[Any] = []

    def program() -> None:
        signal.signal(signal.SIGINT, lambda number, frame: log.append((number, world.now / SECOND)))
        threading.Thread(target=time.sleep, args=(1,)).start()
        time.sleep(3)
        log.append(world.now / SECOND)

    before = signal.getsignal(signal.SIGINT)
    process = world.spawn(program, name="program")
    world.sim.run_until(2 * SECOND)
    process.interrupt()
    assert log == [(signal.SIGINT, 2.0)]
    world.sim.run_until(5 * SECOND)
    assert log[1:] == [3.0] and process.exit_code == 0
    assert signal.getsignal(signal.SIGINT) is before


def test_a_handler_may_end_the_program(world: World) -> None:
    log: list[str] = []

    def program() -> None:
        signal.signal(signal.SIGTERM, lambda *_: sys.exit(7))
        try:
            time.sleep(100)
        finally:
            log.append("cleaned up")

    process = world.spawn(program, name="program")
    world.sim.run_until(SECOND)
    process.send_signal(signal.SIGTERM)
    assert process.exit_code == 7 and log == ["cleaned up"]


def test_without_a_handler_signals_do_what_they_do(world: World) -> None:
    processes = [world.spawn(lambda: time.sleep(100), name="program") for _ in range(2)]
    world.sim.run_until(SECOND)
    processes[0].interrupt()
    processes[1].send_signal(signal.SIGTERM)
    assert [process.exit_code for process in processes] == [-2, -15]


def test_getsignal_knows_what_was_set(run: Run) -> None:
    def handler(number: int, frame: object) -> None:
        pass

    def program(found: list[Any]) -> None:
        assert signal.signal(signal.SIGINT, handler) is signal.default_int_handler
        assert signal.getsignal(signal.SIGINT) is handler
        assert signal.signal(signal.SIGINT, signal.SIG_IGN) is handler
        assert signal.signal(signal.SIGINT, signal.default_int_handler) is signal.SIG_IGN
        assert signal.getsignal(signal.SIGTERM) is signal.SIG_DFL
        assert signal.signal(signal.SIGINT, signal.SIG_DFL) is signal.default_int_handler
        assert signal.signal(signal.SIGINT, signal.default_int_handler) is signal.SIG_DFL
        with pytest.raises(TypeError, match="signal handler must be"):
            signal.signal(signal.SIGINT, "no handler")
        with pytest.raises(ValueError):
            signal.signal(4711, handler)

        def elsewhere() -> None:
            with pytest.raises(ValueError, match="signal only works in main thread of the main interpreter"):
                signal.signal(signal.SIGINT, handler)
            found.append("refused")

        threading.Thread(target=elsewhere).start()

    assert run(program) == ["refused"]


def test_a_program_may_signal_itself(world: World) -> None:
    log: list[str] = []

    def program() -> None:
        signal.signal(signal.SIGUSR1, lambda number, _: log.append(signal.Signals(number).name))
        signal.raise_signal(0)
        signal.raise_signal(signal.SIGUSR1)

    world.spawn(program, name="program")
    world.sim.run_until(SECOND)
    assert log == ["SIGUSR1"]


def test_a_program_from_a_file_may_kill_itself(world: World, tmp_path: Path, capsys: Capture) -> None:
    file = tmp_path / "program.py"
    file.write_text(
        "import os, signal, time\n"
        "signal.signal(signal.SIGUSR1, lambda *_: print('hit'))\n"
        "os.kill(os.getpid(), signal.SIGUSR1)\n"
        "os.kill(os.getpid(), signal.SIGINT)\n"
    )
    process = world.spawn(file, name="program")
    world.sim.run_until(SECOND)
    assert process.exit_code == -2
    assert capsys.readouterr().out == "hit\n"


def test_what_is_registered_for_the_end_is_called_last_thing_first(
    world: World, tmp_path: Path, capsys: Capture
) -> None:
    file = tmp_path / "program.py"
    file.write_text(
        "import atexit, threading, time\n"
        "atexit.register(print, 'first')\n"
        "@atexit.register\n"
        "def second():\n"
        "    print('second', time.time())\n"
        "gone = atexit.register(print, 'never')\n"
        "atexit.unregister(gone)\n"
        "atexit.register(lambda: 1 / 0)\n"
        "threading.Thread(target=time.sleep, args=(1,)).start()\n"
        "print('main')\n"
    )
    process = world.spawn(file, name="program")
    world.sim.run_until(5 * SECOND)
    said = capsys.readouterr()
    # print is print: unregistering it has taken out both
    assert said.out.splitlines() == ["main", "second 1800000001.000001"]
    assert said.err.startswith("Exception ignored in atexit callback:\nTraceback")
    assert process.exit_code == 0


def test_outside_of_programs_atexit_is_pythons(run: Run) -> None:
    count = atexit._ncallbacks()
    atexit.register(print)
    assert atexit._ncallbacks() == count + 1
    atexit.unregister(print)
    count = atexit._ncallbacks()  # until Python 3.13, what was unregistered still counts
    assert run(lambda found: atexit.register(found.append, "at the end")) == ["at the end"]
    assert atexit._ncallbacks() == count


@pytest.mark.skipif(not hasattr(os, "fork"), reason="there is no os.fork() on this system")
def test_other_processes_of_the_computer_are_refused(run: Run) -> None:
    def program(found: list[Any]) -> None:
        with pytest.raises(NotImplementedError, match=r"os.fork\(\) is not possible here: .* Threads can be"):
            os.fork()
        with pytest.raises(NotImplementedError, match=r"signal.setitimer\(\) is not possible here"):
            signal.setitimer(signal.ITIMER_REAL, 1)
        with pytest.raises(NotImplementedError, match=r"_thread.start_new_thread\(\) is not possible here"):
            _thread.start_new_thread(print, ())
        found.append("refused")

    assert run(program) == ["refused"]


def test_so_is_multiprocessing(world: World, tmp_path: Path, capsys: Capture) -> None:
    file = tmp_path / "program.py"
    file.write_text(
        "import multiprocessing\n"
        "from concurrent.futures import ProcessPoolExecutor\n"
        "for wish in (multiprocessing.Process(target=print).start, lambda: ProcessPoolExecutor().submit(print)):\n"
        "    try:\n"
        "        wish()\n"
        "    except NotImplementedError as error:\n"
        "        print(error)\n"
    )
    world.spawn(file, name="program")
    world.sim.run_until(SECOND)
    said = capsys.readouterr().out.splitlines()
    assert len(said) == 2 and all(line.startswith("multiprocessing is not possible here") for line in said)


def test_ways_to_end_a_program_end_that_alone(world: World, tmp_path: Path, capsys: Capture) -> None:
    codes = {}
    for end in ("exit(3)", "quit()", "os._exit(4)", "sys.exit('no')"):
        file = tmp_path / "program.py"
        file.write_text(
            "import atexit, os, sys, threading, time\n"
            "threading.Thread(target=time.sleep, args=(1,), daemon=True).start()\n"
            f"try:\n    {end}\nfinally:\n    print('cleaned up', {end!r})\n"
        )
        process = world.spawn(file, name="program")
        world.sim.run_until(world.now + SECOND)
        codes[end] = process.exit_code
    assert list(codes.values()) == [3, 0, 4, 1]
    assert "os._exit" not in capsys.readouterr().out


def test_pythons_own_log_shows_robot_time(world: World, tmp_path: Path, capsys: Capture) -> None:
    file = tmp_path / "program.py"
    file.write_text(
        "import logging, sys, time\n"
        "log = logging.getLogger('robot')\n"
        "handler = logging.StreamHandler(sys.stdout)\n"
        "handler.setFormatter(logging.Formatter('%(asctime)s %(threadName)s %(message)s'))\n"
        "log.addHandler(handler)\n"
        "time.sleep(61)\n"
        "log.warning('battery low')\n"
        "log.removeHandler(handler)\n"
    )
    world.spawn(file, name="program")
    world.sim.run_until(100 * SECOND)
    assert capsys.readouterr().out == "2027-01-15 08:01:01,000 MainThread battery low\n"
