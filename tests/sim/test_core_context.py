"""Context variables: each line of execution has its own, and what it prints goes to the cell that runs it."""

from __future__ import annotations

import contextvars
import decimal
import threading
import time
from collections.abc import Callable
from typing import Any

import numpy
import pytest

from turtle_lesson.ros.runtime.world import World

Run = Callable[..., list[Any]]
SECOND = 1_000_000_000


def test_numpys_error_state_is_each_programs_own(run: Run) -> None:
    def careful(found: list[Any]) -> None:
        with numpy.errstate(divide="raise"):
            time.sleep(2)
            found.append(("careful", numpy.geterr()["divide"]))

    def careless(found: list[Any]) -> None:
        time.sleep(1)
        found.append(("careless", numpy.geterr()["divide"]))

    assert run(careful, careless) == [("careless", "warn"), ("careful", "raise")]


def test_decimal_contexts_are_each_threads_own(run: Run) -> None:
    def program(found: list[Any]) -> None:
        def work(digits: int) -> None:
            with decimal.localcontext() as context:
                context.prec = digits
                time.sleep(1)
                found.append(str(1 / decimal.Decimal(3)))

        workers = [threading.Thread(target=work, args=(digits,)) for digits in (2, 5)]
        for worker in workers:
            worker.start()
        for worker in workers:
            worker.join()

    assert run(program) == ["0.33", "0.33333"]


def test_a_state_that_is_held_across_two_cells_is_given_back(world: World) -> None:
    log: list[Any] = []

    def program() -> None:
        with numpy.errstate(divide="ignore"):
            time.sleep(1.5)
        log.append(numpy.geterr()["divide"])

    world.spawn(program, name="program")
    for _ in range(3):
        world.sim.run_until(world.now + SECOND)
    assert log == ["warn"]
    assert numpy.geterr()["divide"] == "warn"


@pytest.mark.parametrize("way", ["plain", "in a context of its own"])
def test_what_a_later_cell_changed_reaches_those_who_wait(world: World, way: str) -> None:
    cell = contextvars.ContextVar("cell", default="none")
    log: list[Any] = []

    def ticks() -> None:
        for _ in range(3):
            log.append(cell.get())
            time.sleep(1)

    world.spawn(ticks if way == "plain" else lambda: contextvars.copy_context().run(ticks), name="program")
    for name in ("first", "second", "third"):
        cell.set(name)
        world.sim.run_until(world.now + SECOND)
    assert log == ["first", "second", "third"]


def test_what_a_program_has_set_itself_stays(world: World) -> None:
    cell = contextvars.ContextVar("cell", default="none")
    log: list[Any] = []

    def program() -> None:
        cell.set("my own")
        time.sleep(1.5)
        log.append(cell.get())

    world.spawn(program, name="program")
    for name in ("first", "second"):
        cell.set(name)
        world.sim.run_until(world.now + SECOND)
    assert log == ["my own"]
    assert cell.get() == "second"
