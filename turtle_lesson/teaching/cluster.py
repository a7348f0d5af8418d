"""Runs copies on the workers of a Dask cluster (https://distributed.dask.org): notebooks travel as bytes, and come back as what
was seen. A worker runs them by the same code as this machine does, and takes part only if it has the same lesson installed.
"""

from __future__ import annotations

import hashlib
import secrets
import time
from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import contextmanager, suppress
from functools import lru_cache
from importlib import import_module
from importlib.metadata import version
from typing import TYPE_CHECKING

from .copies import Copy
from .pages import PageError
from .runner import Runner, Seen, installed, run_all

if TYPE_CHECKING:
    from distributed import Client, Future

CONNECTING = 10
"""Seconds of waiting for the scheduler, a first worker, and an answer."""

LOOK = 0.2
"""How often, in seconds of real time, it is looked whether a copy is done."""

HERE = "turtle_lesson.teaching.cluster"
"""This module, which workers import by its name: Dask waits for ever for one that cannot import what it was sent."""

DIED = "the worker that ran it died, and so did the others that tried again"
GONE = "the cluster's scheduler was gone before it was done"


def run_on_cluster(copies: Sequence[Copy], timeout: float, memory: float, address: str) -> Generator[tuple[int, Seen]]:
    """Run copies on the cluster whose scheduler has this address; gives the number of each that is done, and what was seen.

    As many are sent at once as its workers have threads, so a worker that dies takes no copy with it that waits. Ended before
    all are done, it stops those that still run. Raises PageError if there is no cluster, or if a worker has no lesson, or
    another one than this machine.
    """
    with _connected(address) as client:
        lesson, name = fingerprint(installed()), f"turtle-lesson-{secrets.token_hex(8)}"
        _check_workers(client, lesson)
        from distributed import Event

        def run(content: bytes, stopped: Callable[[], bool]) -> Seen:
            with suppress(Exception):  # the scheduler has gone
                given = (content, name, timeout, memory, lesson)
                future = client.submit(lambda *given: import_module(HERE).run_copy(*given), *given, pure=False)
                while not (stopped() or future.done()) and client.status == "running":
                    time.sleep(LOOK)
                if future.done():
                    return _outcome(future)
                Event(name, client=client).set()
                future.cancel()
            return Seen(GONE)

        yield from run_all(copies, run, max(sum(client.nthreads().values()), 1))


def _outcome(future: Future) -> Seen:
    """What was seen of a copy that is done."""
    from distributed import KilledWorker

    if future.status in {"cancelled", "lost"}:
        return Seen(GONE)
    try:
        found: Seen = future.result(timeout=CONNECTING)
        return found
    except KilledWorker:
        return Seen(DIED)
    except Exception as error:
        return Seen(f"it could not be run on the cluster: {error}")


@contextmanager
def _connected(address: str) -> Iterator[Client]:
    """A client of the cluster. What experiments say of a cluster that cannot be used is raised as PageError."""
    from ..experiments.one_run import ExperimentError
    from ..experiments.pools import connected

    client = None
    try:
        client, _ = connected(address, CONNECTING)
        yield client
    except ExperimentError as error:
        raise PageError(str(error)) from None
    finally:
        with suppress(Exception):  # there is none, or its scheduler is gone
            client.close(timeout=CONNECTING)  # type: ignore[union-attr]


def _check_workers(client: Client, lesson: str) -> None:
    """Raise PageError unless there are workers, all with this lesson."""
    from ..experiments.pools import answers

    own = own_lesson()[0]
    for worker, found in sorted(answers(client, lambda: import_module(HERE).own_lesson(), CONNECTING).items()):
        if isinstance(found, Exception):
            other = f"answers: {found}"
        elif found != (own, lesson):
            other = f"has version {found[0]}" if found[0] != own else "has other files of the same version"
        else:
            continue
        raise PageError(f"each worker needs the lesson that is installed here, version {own}, but {worker} {other}")


# -- on a worker --------------------------------------------------------------------------------------------------------


def fingerprint(files: dict[str, bytes]) -> str:
    """What tells one installed lesson from another, whatever the machine and its Python are."""
    digest = hashlib.sha256()
    for name, of_file in sorted(files.items()):
        digest.update(name.encode() + b"\0" + of_file)
    return digest.hexdigest()


def own_lesson() -> tuple[str, str]:
    """The version and fingerprint of the lesson that is installed where this runs."""
    return version("turtle-lesson"), fingerprint(installed())


@lru_cache(maxsize=1)
def _runner(timeout: float, memory: float) -> Runner:
    """What runs the copies of one grading: what it remembers of the installed lesson is what was there before the first one."""
    return Runner(timeout, memory)


def run_copy(content: bytes, name: str, timeout: float, memory: float, lesson: str) -> Seen:
    """Run one copy on this worker. `name` is that of the event that ends it."""
    from distributed import Event

    runner = _runner(timeout, memory)
    if fingerprint(runner.installed) != lesson:
        _runner.cache_clear()
        return Seen("it was sent to a worker that has another version of the lesson")
    return runner.run(content, Event(name).is_set)
