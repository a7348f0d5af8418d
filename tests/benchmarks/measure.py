"""Measuring: rounds in which each work has its turn, and instructions, which other work on the machine does not change."""

from __future__ import annotations

import os
import re
import shutil
import statistics
import subprocess
import time
from collections.abc import Callable

cpu_clock: Callable[[], float] = time.process_time


def interleaved(works: list[Callable[[], object]], rounds: int, clock: Callable[[], float]) -> list[list[float]]:
    """Seconds that each work takes in each round, by a clock, after a round that does not count.

    Each round runs all of them, one after the other, so that what disturbs the machine disturbs all.
    """
    times: list[list[float]] = [[] for _ in works]
    for number in range(rounds + 1):
        for work, seconds in zip(works, times, strict=True):
            began = clock()
            work()
            if number:
                seconds.append(clock() - began)
    return times


def ratio(ours: list[float], others: list[float]) -> float:
    """How many times as long as the other a work takes: the median of the rounds."""
    return statistics.median(one / other for one, other in zip(ours, others, strict=True))


COUNTERS = {
    "perf": (["perf", "stat", "-x,", "-e", "instructions:u"], r"^(\d+),[^\n]*instructions"),
    "valgrind": (
        ["valgrind", "--tool=cachegrind", "--cache-sim=no", "--cachegrind-out-file=/dev/null"],
        r"I +refs: +([\d,]+)",
    ),
}


def find_counter() -> str | None:
    """What counts instructions here: perf, or else valgrind, which takes fifty times as long; None if neither does."""
    return next((name for name in COUNTERS if shutil.which(name) and _count(name, ["true"]) is not None), None)


def _count(counter: str, command: list[str]) -> int | None:
    prefix, pattern = COUNTERS[counter]
    # or each run would have dictionaries of its own, and numpy's threads, which wait busily at first
    environment = {**os.environ, "PYTHONHASHSEED": "0", "OPENBLAS_NUM_THREADS": "1"}
    ended = subprocess.run([*prefix, *command], capture_output=True, text=True, env=environment)
    found = re.search(pattern, ended.stderr, re.MULTILINE)
    if ended.returncode:
        raise RuntimeError(f"{' '.join(command)} ended with {ended.returncode}:\n{ended.stderr}")
    return int(found[1].replace(",", "")) if found else None


def instructions(counter: str, command: list[str], short: int, long: int) -> float:
    """Instructions for each unit of a command's last argument: the difference between a long run and a short one."""
    few, many = (_count(counter, [*command, str(length)]) for length in (short, long))
    assert few is not None and many is not None
    return (many - few) / (long - short)
