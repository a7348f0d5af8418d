"""Ctrl-C during an import waits until the import is done."""

from __future__ import annotations

import gc
import signal
import subprocess
import sys
import threading

import pytest

from turtle_lesson.ros.sim.defer_sigint import defer_sigint


def test_an_interrupt_comes_when_the_block_is_over() -> None:
    done = []
    with pytest.raises(KeyboardInterrupt), defer_sigint():
        signal.raise_signal(signal.SIGINT)
        done.append("the rest")
    assert done == ["the rest"]


def test_what_was_there_before_is_there_again() -> None:
    before = signal.getsignal(signal.SIGINT)
    with pytest.raises(ZeroDivisionError), defer_sigint():
        raise ZeroDivisionError
    assert signal.getsignal(signal.SIGINT) is before


@pytest.mark.parametrize("on", [True, False])
def test_the_garbage_collector_waits_and_is_then_as_it_was(on: bool) -> None:
    before = gc.isenabled()
    try:
        (gc.enable if on else gc.disable)()
        with defer_sigint():
            assert not gc.isenabled()
        assert gc.isenabled() is on
    finally:
        (gc.enable if before else gc.disable)()


def test_a_thread_that_is_not_the_main_one_just_goes_on() -> None:
    done: list[str] = []

    def work() -> None:
        with defer_sigint():
            done.append("work")

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert done == ["work"]


FIRST_PICTURE = """
import os, signal, sys, threading, time
from turtle_lesson.lab import drawing

def press():
    while "matplotlib" not in sys.modules:
        time.sleep(0.001)
    time.sleep({delay})
    os.kill(os.getpid(), signal.SIGINT)

threading.Thread(target=press).start()
try:
    with drawing.applied():
        time.sleep(2)
except KeyboardInterrupt:
    print("interrupted")
with drawing.applied():
    print(drawing.card(2, 1))
"""


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no such signals")
@pytest.mark.parametrize("delay", [0.0, 0.05])
def test_the_first_picture_can_be_drawn_after_it_was_interrupted(delay: float) -> None:
    program = FIRST_PICTURE.replace("{delay}", str(delay))
    ended = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=540, check=False)
    assert ended.stdout.split("\n")[:2] == ["interrupted", "Figure(200x100)"], ended.stderr
