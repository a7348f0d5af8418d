"""The same runs on a cluster of dask.distributed: each of its workers has worker processes as they are used on one computer.

A run gets a process of its own there, too: a world needs the main thread and a current folder, and Dask's tasks are threads.
If one of Dask's workers dies, Dask has its runs carried out by another one.
"""

from __future__ import annotations

import contextlib
import platform
import socket
from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, Any, TypeVar

from .one_run import DIED, VERSION, Ending, ExperimentError, Run, Setting
from .pools import Workers

if TYPE_CHECKING:
    from distributed import Client

T = TypeVar("T")

PATIENCE = 10.0
"""Seconds of real time within which a scheduler answers."""

FIRST_WORKER = 60.0
"""Seconds of real time within which a cluster has its first worker."""


class ClusterPool:
    """A cluster that carries out runs: `client` is a `dask.distributed.Client`, a cluster, or the address of a scheduler."""

    def __init__(self, setting: Setting, client: Any) -> None:
        self._client, self._is_own = connected(client)
        self._key = setting.key
        self._futures: list[Any] = []
        try:
            _check_workers(self._client)
        except BaseException:
            self.close()
            raise
        # a task, and nothing scattered: Dask makes it once more if the only worker that has it dies
        self._setting = self._client.submit(_itself, setting, pure=False)

    def carry_out(self, runs: Sequence[Run]) -> Iterator[tuple[Run, Ending]]:
        """Carry out runs; they come in the order in which they end."""
        from distributed import KilledWorker, as_completed

        self._futures = self._client.map(_carry_out_there, runs, setting=self._setting, pure=False)
        of = dict(zip((future.key for future in self._futures), runs, strict=True))
        for future in as_completed(self._futures):
            try:
                ending = future.result()
            except KilledWorker:
                ending = Ending(DIED, error="several workers of the cluster died in the middle of this run")
            yield of[future.key], ending

    def close(self) -> None:
        """End what goes on, and the connection if it was made here."""
        with contextlib.suppress(Exception):  # a cluster that is gone has nothing to end
            self._client.cancel(self._futures)
            self._client.run(_end_there, self._key, on_error="ignore")
        self._futures = []
        if self._is_own:
            self._client.close()


def connected(client: Any, patience: float = PATIENCE) -> tuple[Client, bool]:
    """A client, and whether it was made here. Raises ExperimentError if there is no cluster, or none within some time (s)."""
    try:
        from distributed import Client
        from distributed.comm.addressing import get_address_host_port
    except ImportError:
        raise ExperimentError("a cluster needs Dask, which is not here: pip install 'turtle-lesson[cluster]'") from None
    if isinstance(client, Client):
        if client.status != "running" or client.asynchronous:
            what = "asynchronous" if client.asynchronous else client.status
            raise ExperimentError(
                f"this client is {what}: make a new Client(…), which is connected and waits for answers"
            )
        return client, False
    try:
        if isinstance(client, str):  # a Client that cannot connect complains once more when it is collected
            with socket.create_connection(get_address_host_port(client), patience):
                pass
        return Client(client, timeout=patience, set_as_default=False), True
    except (OSError, ValueError, TypeError) as error:
        raise ExperimentError(
            f'no scheduler of Dask answers at {client!r} ({error}). An address looks like "tcp://10.0.0.1:8786"; '
            "`dask scheduler` prints its own"
        ) from None


def answers(client: Client, question: Callable[[], T], patience: float) -> dict[str, T | Exception]:
    """What each worker answers, by its address. Raises ExperimentError if the cluster has none within some time (s)."""
    try:
        client.wait_for_workers(1, timeout=patience)
    except TimeoutError:
        raise ExperimentError(f"the cluster has no workers, and none came within {patience:g} s") from None
    return client.run(question, on_error="return")


def _check_workers(client: Client) -> None:
    """Raise ExperimentError for a cluster without workers, or with workers that lack what runs need."""
    mine = _about()
    for address, about in answers(client, _about, FIRST_WORKER).items():
        if isinstance(about, Exception):
            raise ExperimentError(f"the cluster's workers cannot import turtle_lesson ({about}): install {mine} there")
        if about != mine:
            raise ExperimentError(f"the worker {address} has {about}, and this notebook {mine}: they must be the same")


# -- on a worker of the cluster ------------------------------------------------------------------------------------------

_workers: dict[str, Workers] = {}
"""What is kept here of each experiment."""


def _itself(setting: Setting) -> Setting:
    return setting


def _about() -> str:
    return f"turtle_lesson {VERSION} on Python {'.'.join(platform.python_version_tuple()[:2])}"


def _carry_out_there(run: Run, setting: Setting) -> Ending:
    """Carry out a run in a process of this worker's."""
    return _workers.setdefault(setting.key, Workers(setting)).carry_out(run)


def _end_there(key: str) -> None:
    if workers := _workers.pop(key, None):
        workers.close()
