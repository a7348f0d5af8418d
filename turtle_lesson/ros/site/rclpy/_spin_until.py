"""A thread runs callbacks until a future is done: most of what a service costs its client is spent here."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ._executor_base import ExternalShutdownException, ShutdownException

if TYPE_CHECKING:
    from turtle_lesson.ros.sim.strand import Strand

    from .executors import SingleThreadedExecutor
    from .task import Future


def spin_until(executor: SingleThreadedExecutor, strand: Strand, future: Future) -> None:
    """Do what a loop over `spin_once_until_future_complete` without a timeout does, written out.

    The common case is that one callback became ready while the strand was waiting; it is run without a batch.
    """
    context, signalled, waiters = executor._context, executor._signalled, executor._waiters
    park, spinning = executor._simulation.park, executor._spinning
    spinning.append(strand)
    try:
        while not (
            future._done or future._cancelled or context.ended or not context.initialized or executor._is_shutdown
        ):
            while not (signalled or executor._batch or executor._resumed or executor._polled):
                if executor._is_shutdown:
                    return
                if context.ended:
                    raise ExternalShutdownException
                waiters.append(strand)
                executor._waiter = strand
                try:
                    park(strand)
                finally:
                    waiters.remove(strand)
                    executor._waiter = waiters[-1] if waiters else None
                if future._done and not executor._batch:
                    return
            if len(signalled) == 1 and not (executor._batch or executor._resumed or executor._polled):
                signalled.pop()._run(executor, False)
            else:
                job = executor._next(strand, None, future._is_done)
                if job is None:
                    return
                executor._execute(job)
            if executor._waiter is not None:
                executor._wake_another_spinner()
    except ShutdownException:
        return
    finally:
        spinning.remove(strand)
        if executor._waiter is not None:
            executor._wake_another_spinner()
