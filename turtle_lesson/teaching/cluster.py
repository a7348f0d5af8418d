"""Runs copies on the workers of a Dask cluster (https://distributed.dask.org): notebooks travel as bytes, and come back as what
was seen. A worker runs them by the same code as this machine does, and takes part only if it has the same lesson installed.
"""

from __future__ import annotations

import hashlib
import logging
import secrets
import time
from collections.abc import Generator, Iterator, Sequence
from contextlib import contextmanager, suppress
from functools import lru_cache
from importlib import import_module
from importlib.metadata import version
from typing import Any

from .copies import Copy
from .pages import PageError
from .runner import Runner, Seen, installed

STARTS = 2
"""How often a copy is begun at most: once more after the worker that ran it has died."""

SENT = 5
"""How often it is sent at most. A copy that only waits on a worker which dies is sent again, and is not blamed."""

CONNECTING, ALONE = 10, 60.0
"""Seconds of waiting for the scheduler and a first worker, and for another one when all are gone."""

HERE = "turtle_lesson.teaching.cluster"
"""This module, which workers import by its name: Dask waits for ever for one that cannot import what it was sent."""

DIED = "the worker that ran it died, and so did the one that tried again"
LOST = "no worker of the cluster was left to run it"
GONE = "the cluster's scheduler was gone before it was done"


def run_on_cluster(copies: Sequence[Copy], timeout: float, memory: float, address: str) -> Generator[tuple[int, Seen]]:
    """Run copies on the cluster whose scheduler has this address; gives the number of each that is done, and what was seen.

    Raises PageError if there is no cluster, or if a worker has no lesson, or another one than this machine.
    """
    with _connected(address) as client:
        lesson = fingerprint(installed())
        _check_workers(client, lesson)
        yield from _Run(client, copies, (timeout, memory, lesson)).all()


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
    """Run one copy on this worker. `name` is that of the copy's count of starts; with "-stop", of the event that ends it."""
    from distributed import Event, Variable

    runner = _runner(timeout, memory)
    if fingerprint(runner.installed) != lesson:
        _runner.cache_clear()
        return Seen("it was sent to a worker that has another version of the lesson")
    starts = Variable(name)
    begun = starts.get(timeout=CONNECTING)
    if begun >= STARTS:
        return Seen(DIED)
    starts.set(begun + 1)
    return runner.run(content, _Stopped(Event(f"{name.rsplit('-', 1)[0]}-stop")))


class _Stopped:
    """The cluster's event, asked for every other second only."""

    def __init__(self, event: Any) -> None:
        self._event, self._next, self._is_set = event, 0.0, False

    def is_set(self) -> bool:
        if time.monotonic() >= self._next and not self._is_set:
            try:
                self._is_set = bool(self._event.is_set())
            except Exception:  # the scheduler is gone, so nobody waits for an answer
                self._is_set = True
            self._next = time.monotonic() + 2.0
        return self._is_set


# -- on this machine ----------------------------------------------------------------------------------------------------


@contextmanager
def _connected(address: str) -> Iterator[Any]:
    """A client of the cluster. What experiments say of a cluster that cannot be used is raised as PageError."""
    from ..experiments.cluster import connected
    from ..experiments.one_run import ExperimentError

    for name in ("distributed", "distributed.client"):  # what goes wrong is said in the reports
        logging.getLogger(name).setLevel(logging.CRITICAL)
    client = None
    try:
        client, _ = connected(address, CONNECTING)
        with client.as_current():  # where events and variables look for it
            yield client
    except ExperimentError as error:
        raise PageError(str(error)) from None
    finally:
        with suppress(Exception):  # there is none, or its scheduler is gone
            client.close(timeout=CONNECTING)  # type: ignore[union-attr]


def _check_workers(client: Any, lesson: str) -> None:
    """Raise PageError unless there are workers, all with this lesson."""
    from ..experiments.cluster import answers

    found_there = answers(client, lambda: import_module(HERE).own_lesson(), CONNECTING)
    own, wrong = own_lesson()[0], []
    for worker, found in sorted(found_there.items()):
        if isinstance(found, Exception) and "No module named 'turtle_lesson" not in str(found):
            wrong.append(f"{worker} answers: {found}")
        elif isinstance(found, Exception):
            wrong.append(f"{worker} has none" if "'turtle_lesson'" in str(found) else f"{worker} has an older one")
        elif found != (own, lesson):
            other = f"version {found[0]}" if found[0] != own else "other files of the same version"
            wrong.append(f"{worker} has {other}")
    if wrong:
        more = f", and {len(wrong) - 3} more are wrong" if len(wrong) > 3 else ""
        needed = f"each worker needs the lesson that is installed here, version {own}"
        raise PageError(f"{needed}, but {'; '.join(wrong[:3])}{more}")


class _Run:
    """Copies on their way through a cluster: as many at once as its workers have threads."""

    def __init__(self, client: Any, copies: Sequence[Copy], options: tuple[float, float, str]) -> None:
        from distributed import Variable

        self._client, self._copies, self._options = client, copies, options
        self._name = f"turtle-lesson-{secrets.token_hex(8)}"
        self._waiting = list(enumerate(copies))[::-1]
        self._sent: dict[Any, int] = {}
        self._times = [0] * len(copies)
        self._starts = [Variable(f"{self._name}-{number}") for number in range(len(copies))]
        self._seen_worker = time.monotonic()
        self._threads = 0

    def all(self) -> Generator[tuple[int, Seen]]:
        """Run them; gives each that is done. Ended before that, it stops those that still run."""
        from distributed import Event

        try:
            while self._waiting or self._sent:
                try:
                    if self._has_workers():
                        yield from self._send()
                        yield from self._done()
                    else:
                        yield from self._rest(LOST)
                except OSError:
                    yield from self._rest(GONE)
        finally:
            with suppress(Exception):  # a scheduler that is gone
                if self._sent:
                    Event(f"{self._name}-stop").set()
                    self._client.cancel(list(self._sent))
                for starts in self._starts:
                    starts.delete()

    def _send(self) -> Iterator[tuple[int, Seen]]:
        """Fill the workers; gives copies that cannot be read."""
        while self._waiting and len(self._sent) < max(self._threads, 1):
            number, copy = self._waiting[-1]
            try:
                content = copy.content()
            except PageError as error:
                self._waiting.pop()
                yield number, Seen(str(error))
                continue
            if not self._times[number]:
                self._starts[number].set(0)
            self._times[number] += 1
            name = f"{self._name}-{number}"
            given = (content, name, *self._options)
            future = self._client.submit(
                lambda *given: import_module(HERE).run_copy(*given),
                *given,
                key=f"{name}-{self._times[number]}",
                pure=False,
            )
            self._sent[future] = number
            self._waiting.pop()

    def _done(self) -> Iterator[tuple[int, Seen]]:
        """Wait a moment for some to be done; gives them."""
        from distributed import CancelledError, wait
        from distributed import TimeoutError as NoneDone

        if self._sent:
            with suppress(NoneDone, CancelledError):
                wait(list(self._sent), timeout=2.0, return_when="FIRST_COMPLETED")
        for future in [each for each in self._sent if each.status != "pending"]:
            number = self._sent.pop(future)
            try:
                seen = self._outcome(future, number)
            except NoneDone:  # the worker died with its answer, and another one runs the copy
                self._sent[future] = number
                continue
            if seen is not None:
                yield number, seen

    def _outcome(self, future: Any, number: int) -> Seen | None:
        """What was seen of a copy; None if it has to be sent again."""
        from distributed import KilledWorker

        if future.status in {"cancelled", "lost"}:
            return Seen(GONE)
        if future.status == "finished":
            found: Seen = future.result(timeout=CONNECTING)
            return found
        error = future.exception(timeout=CONNECTING) if future.status == "error" else None
        if isinstance(error, KilledWorker):
            if self._starts[number].get(timeout=CONNECTING) >= STARTS or self._times[number] >= SENT:
                return Seen(DIED)
            self._waiting.append((number, self._copies[number]))
            return None
        return Seen(f"it could not be run on the cluster: {error}")

    def _rest(self, problem: str) -> Iterator[tuple[int, Seen]]:
        """Gives all that are left, with this problem."""
        left = [*self._sent.values(), *(number for number, _ in self._waiting)]
        self._waiting.clear()
        self._sent.clear()
        yield from ((number, Seen(problem)) for number in left)

    def _has_workers(self) -> bool:
        """Whether the cluster has workers, or had some a moment ago. Raises OSError if the scheduler is gone."""
        if self._client.status != "running":
            raise ConnectionError
        self._threads = sum(self._client.nthreads().values())
        if self._threads:
            self._seen_worker = time.monotonic()
        return time.monotonic() - self._seen_worker < ALONE
