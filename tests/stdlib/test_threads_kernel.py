"""Threads in a real Jupyter kernel: a cell's own live in robot time, Jupyter's and those of libraries stay real."""

from __future__ import annotations

from collections.abc import Iterator

import kernels
import pytest
from kernels import Ask

SET_UP = (
    "from turtle_lesson import start\nlesson = start(seed=0)",
    "import asyncio, queue, threading, time\nimport rclpy",
)


@pytest.fixture(scope="module")
def ask(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Ask]:
    """Runs a cell in a kernel, stops it after some seconds if told so, and returns what it printed and its error."""
    folder = tmp_path_factory.mktemp("notebook")
    with kernels.running(folder, SET_UP, lambda content: content.get("ename", "")) as ask:
        yield ask


def test_a_node_spins_in_a_thread_and_prints_to_the_cell_that_runs_it(ask: Ask) -> None:
    assert ask(
        """
        lesson = start(package=None, simulator=False)
        rclpy.init()
        node = rclpy.create_node("n")
        node.create_timer(0.5, lambda: print(f"tick at {lesson.now:.1f}"))
        thread = threading.Thread(target=rclpy.spin, args=(node,), daemon=True)
        thread.start()
        print(thread.name, thread.is_alive(), threading.current_thread().name)
        """
    ) == ("Thread-1 (spin) True MainThread\n", "")
    assert ask("lesson.run(1.2)") == ("tick at 0.5\ntick at 1.0\n", "")
    assert ask("rate = node.create_rate(1)\nrate.sleep()\nprint('slept')") == ("tick at 1.5\ntick at 2.0\nslept\n", "")


def test_a_wait_in_a_cell_can_be_stopped(ask: Ask) -> None:
    out, error = ask(
        """
        gate = threading.Event()
        def slow():
            while not gate.is_set():
                time.sleep(0.001)
        threading.Thread(target=slow, daemon=True).start()
        print(gate.wait(80000))
        """,
        stop_after=0.5,
    )
    assert error == "KeyboardInterrupt" and "False" not in out
    assert ask("print(gate.wait(0.1))\ngate.set()")[0].endswith("False\n")


def test_threads_live_on_in_live_mode(ask: Ask) -> None:
    out, error = ask(
        """
        seen = queue.Queue()
        threading.Thread(target=lambda: (time.sleep(0.2), seen.put(threading.current_thread().name)), name="live").start()
        lesson.play(rate=10)
        await asyncio.sleep(0.3)
        lesson.pause()
        print(seen.get_nowait())
        """
    )
    assert (out.splitlines()[-1], error) == ("live", "")


def test_jupyters_own_loop_and_threads_are_real(ask: Ask) -> None:
    out, error = ask(
        """
        import concurrent.futures, inspect, ipykernel, tornado.ioloop, zmq
        loop = asyncio.get_running_loop()
        name = await asyncio.to_thread(lambda: threading.current_thread().name)
        began = time.monotonic()
        await asyncio.sleep(0.05)
        io = await tornado.ioloop.IOLoop.current().run_in_executor(None, lambda: type(threading.Lock()).__module__)
        real = [each.name for each in threading.enumerate() if each.name.startswith(("IOPub", "Heartbeat", "Control"))]
        print(type(loop).__module__, name, io, time.monotonic() - began > 0.04, bool(real))
        """
    )
    assert (out, error) == ("asyncio.unix_events asyncio_0 _thread True True\n", "")


def test_widgets_and_pictures_work_as_ever(ask: Ask) -> None:
    out, error = ask(
        """
        import ipywidgets
        slider = ipywidgets.IntSlider(value=3)
        slider.observe(lambda change: print("now", change["new"]), "value")
        slider.value = 5
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
        FigureCanvasAgg(Figure(figsize=(1, 1))).draw()
        from hypothesis import given, settings, strategies
        @settings(max_examples=5, database=None)
        @given(strategies.integers())
        def test(number):
            assert isinstance(number, int)
        test()
        """
    )
    assert (out, error) == ("now 5\n", "")


def test_an_error_in_a_thread_is_shown_in_its_cell(ask: Ask) -> None:
    out, error = ask("def work():\n    raise ValueError('boom')\nthreading.Thread(target=work).start()\nprint('on')")
    assert error == ""
    assert "on\n" in out and "ValueError: boom\n" in out  # they go to two streams
    assert "a cell of this notebook" in out and "core" not in out


def test_the_kernel_ends_although_a_thread_lives(ask: Ask) -> None:
    out, error = ask(
        """
        import subprocess, sys, textwrap
        program = textwrap.dedent('''
            import sys; sys.path[:0] = %r
            from concurrent.futures import ThreadPoolExecutor
            from turtle_lesson import start
            import threading, time
            lesson = start(package=None, simulator=False)
            pool = ThreadPoolExecutor(2)
            pool.submit(time.sleep, 1000)
            threading.Thread(target=time.sleep, args=(1000,)).start()
            lesson.run(1)
            print("ends")
        ''' % (sys.path,))
        done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=100)
        print(done.stdout, done.stderr, done.returncode)
        """
    )
    assert (out, error) == ("ends\n  0\n", "")
