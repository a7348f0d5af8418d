"""Turns: what strands that spin do each time that they are woken, on the stack of a carrier."""

from __future__ import annotations

import gc
import traceback
from collections.abc import Callable
from contextvars import ContextVar
from typing import Any

import pytest

from turtle_lesson.ros.runtime.world import World
from turtle_lesson.ros.sim.process import Process
from turtle_lesson.ros.sim.simulation import Simulation
from turtle_lesson.ros.sim.strand import Carrier, Strand, running_greenlet, running_strand

MS = 1_000_000


def started(simulation: Simulation, name: str, program: Callable[[Strand], None]) -> Process:
    """A process that runs `program(strand)`."""
    process = Process(simulation, name, pid=len(name), seed=name, world=World())

    def main() -> None:
        strand = running_strand()
        assert strand is not None
        program(strand)

    process.start(main)
    return process


def every(milliseconds: int, work: Callable[[], object], rounds: int = 3) -> Callable[[Strand], None]:
    """A program that is woken so often, and does its work in each of its turns but the first."""

    def program(strand: Strand) -> None:
        simulation, done = strand.simulation, -1

        def turn() -> bool:
            nonlocal done
            done += 1
            if done:
                work()
            simulation.at(simulation.now + milliseconds * MS, simulation.wake, strand)
            return done < rounds

        simulation.take_turns(strand, turn)

    return program


def test_turns_of_two_strands_are_taken_on_one_stack() -> None:
    simulation, log, stacks = Simulation(), [], set()

    def work() -> None:
        strand = running_strand()
        assert strand is not None
        log.append((simulation.now // MS, strand.process.name))
        stacks.add(running_greenlet())

    for name, pause in (("quick", 2), ("slow", 3)):
        started(simulation, name, every(pause, work))
    simulation.run_until(20 * MS)
    assert log == [(2, "quick"), (3, "slow"), (4, "quick"), (6, "slow"), (6, "quick"), (9, "slow")]
    assert len(stacks) == 1


def test_a_turn_that_waits_holds_up_only_its_own_strand() -> None:
    simulation, log = Simulation(), []

    def sleep() -> None:
        strand = running_strand()
        log.append((simulation.now // MS, "begins"))
        simulation.sleep_until(simulation.now + 5 * MS)
        assert running_strand() is strand
        log.append((simulation.now // MS, "ends"))

    started(simulation, "sleeper", every(1, sleep, rounds=1))
    started(simulation, "other", every(2, lambda: log.append((simulation.now // MS, "other"))))
    simulation.run_until(20 * MS)
    assert log == [(1, "begins"), (2, "other"), (4, "other"), (6, "ends"), (6, "other")]


def test_what_a_turn_raises_is_raised_where_the_strand_waits() -> None:
    simulation, log = Simulation(), []

    def fail() -> None:
        raise ValueError("no such place")

    def program(strand: Strand) -> None:
        try:
            every(1, fail)(strand)
        except ValueError as error:
            log.append(
                (running_greenlet() is strand, [each.name for each in traceback.extract_tb(error.__traceback__)])
            )

    process = started(simulation, "driver", program)
    simulation.run_until(5 * MS)
    [(on_its_own_stack, calls)] = log
    assert on_its_own_stack and calls[0] == "program" and calls[-2:] == ["turn", "fail"]
    assert process.exit_code == 0


def test_an_error_thrown_into_a_turn_that_waits_ends_the_program() -> None:
    simulation, log = Simulation(), []

    def sleep() -> None:
        try:
            simulation.sleep_until(simulation.now + 5 * MS)
        finally:
            log.append("the turn is left")

    def program(strand: Strand) -> None:
        try:
            every(1, sleep)(strand)
        finally:
            log.append("the program is left")

    process = started(simulation, "sleeper", program)
    simulation.run_until(2 * MS)
    process.kill()
    assert log == ["the turn is left", "the program is left"] and process.exit_code == -9
    simulation.run_until(20 * MS)


def test_a_turn_has_the_context_variables_of_its_strand() -> None:
    simulation, variable, log = Simulation(), ContextVar("mode", default="none"), []

    def note() -> None:
        log.append(variable.get())
        variable.set(variable.get() + "!")

    def program(mode: str) -> Callable[[Strand], None]:
        def set_and_go(strand: Strand) -> None:
            variable.set(mode)
            every(2, note, rounds=2)(strand)
            log.append(variable.get())

        return set_and_go

    for mode in ("a", "b"):
        started(simulation, mode, program(mode))
    simulation.run_until(20 * MS)
    assert log == ["a", "b", "a!", "a!!", "b!", "b!!"]
    assert variable.get() == "none"


def test_what_waits_within_a_turn_takes_turns_on_the_same_stack() -> None:
    simulation, log = Simulation(), []

    def nested() -> None:
        strand = running_strand()
        assert strand is not None
        outer = running_greenlet()
        every(1, lambda: log.append(running_greenlet() is outer), rounds=2)(strand)
        log.append("done")

    started(simulation, "nesting", every(10, nested, rounds=1))
    simulation.run_until(30 * MS)
    assert log == [True, True, "done"]


@pytest.mark.parametrize("asleep", [False, True])
def test_a_closed_simulation_leaves_no_carrier(asleep: bool) -> None:
    simulation = Simulation()
    work: Callable[[], Any] = (lambda: simulation.sleep_until(simulation.now + 50 * MS)) if asleep else (lambda: None)
    for name in ("a", "bb"):
        started(simulation, name, every(1, work, rounds=100))
    simulation.run_until(20 * MS)
    carriers = [each for each in gc.get_objects() if type(each) is Carrier and each in simulation._carriers]
    assert carriers
    simulation.close()
    assert all(carrier.dead for carrier in carriers)
