"""Futures, which will have a result, and tasks, which are futures of a coroutine that an executor runs."""

from __future__ import annotations

import asyncio
import inspect
import sys
import warnings
import weakref
from collections.abc import Callable, Generator
from functools import partial
from itertools import count
from types import GenericAlias
from typing import TYPE_CHECKING, Any, TypeVar

from turtle_lesson.ros.sim.errors import NeverWakes
from turtle_lesson.ros.sim.strand import running_strand
from turtle_lesson.ros.stdlib.deadlock import looked_in_vain

from ._deadlock import why_never_awaited
from ._hints import explain_event_loop

if TYPE_CHECKING:
    from .executors import Executor

Function = TypeVar("Function", bound=Callable[..., Any])

NUMBERS = count()
"""Of tasks, in the order in which they are made."""

FOR_ALL = object()
"""Stands for a future that is cancelled for good, not only for one of asyncio's coroutines."""


def at_once(callback: Function) -> Function:
    """Decorator for a done callback of rclpy's own: it is called right when the future is done, by no executor."""
    callback._at_once = True  # type: ignore[attr-defined]
    return callback


class Future:
    """Something that will be known later. States: waiting, then done with a result or an exception, or cancelled."""

    _answered_by: Any = None
    """The client whose response this waits for, if any."""
    _request_number = 0
    _never_retrieved: weakref.finalize | None = None
    __class_getitem__: Any = classmethod(GenericAlias)  # newer releases: Future[Trigger.Response] in a hint

    def __init__(self, *, executor: Executor | None = None) -> None:
        self._done = False
        self._cancelled = False
        self._result: Any = None
        self._exception: BaseException | None = None
        self._callbacks: list[Callable[[Future], Any]] = []
        self._executor = executor

    def __repr__(self) -> str:
        state = "cancelled" if self._cancelled else "done" if self._done else "waiting"
        return f"<rclpy.task.{type(self).__name__} {state}>"

    def __await__(self) -> Generator[Future, None, Any]:
        if running_strand() is None and asyncio._get_running_loop() is not None:
            raise RuntimeError(
                "a future of rclpy's cannot be awaited in a cell: no robot time would pass meanwhile. Write "
                "rclpy.spin_until_future_complete(node, future), then future.result()."
            )
        while not self._done:
            self._asyncio_future_blocking = True  # for asyncio's tasks, should this be awaited in one of them
            yield self
        return self.result()

    def get_loop(self) -> Any:
        """The asyncio loop whose coroutine awaits this: asyncio asks for it."""
        return asyncio.get_running_loop()

    def cancel(self, msg: Any = FOR_ALL) -> bool | None:
        """Give up waiting: the future counts as cancelled, its callbacks are called.

        Only asyncio gives a `msg`: then its coroutines give up waiting, and nothing becomes of the future.
        """
        if msg is not FOR_ALL:
            for callback in [each for each in self._callbacks if isinstance(each, _OfAsyncio)]:
                self._callbacks.remove(callback)
                callback(self)
            return False
        if not self._done:
            self._cancelled = True
            self._call_callbacks()
        return None

    def cancelled(self) -> bool:
        """Whether it was cancelled."""
        return self._cancelled

    def done(self) -> bool:
        """Whether there is a result or an exception."""
        return self._done or looked_in_vain()

    def _is_done(self) -> bool:
        """The same, for executors, which do not poll: they wait when there is nothing to do."""
        return self._done

    def result(self) -> Any:
        """The result, None while there is none; raises the exception if there is one."""
        if self._exception is not None:
            raise self._exception_fetched()
        return self._result

    def exception(self) -> BaseException | None:
        """The exception, if there is one."""
        return None if self._exception is None else self._exception_fetched()

    def _exception_fetched(self) -> BaseException:
        """The exception, for a caller that deals with it."""
        if self._never_retrieved is not None:
            self._never_retrieved.detach()
        assert self._exception is not None
        return self._exception

    def set_result(self, result: Any) -> None:
        """Now it is done."""
        self._result = result
        self._done = True
        self._cancelled = False
        self._call_callbacks()

    def set_exception(self, exception: BaseException) -> None:
        """Now it is done, and has failed. An exception that is never asked for is reported at the end."""
        self._exception = exception
        text = f"The following exception was never retrieved: {exception}"
        self._never_retrieved = weakref.finalize(self, print, text, file=sys.stderr)
        self._never_retrieved.atexit = False
        self._done = True
        self._cancelled = False
        self._call_callbacks()

    def add_done_callback(self, callback: Callable[[Future], Any], *, context: Any = None) -> None:
        """Have `callback(future)` called when it is done: by the executor if there is one; at once if it is done.

        Only asyncio gives a `context`: then its loop calls the callback.
        """
        if context is not None:
            callback = _OfAsyncio(asyncio.get_running_loop().call_soon_threadsafe, callback, context=context)
        if self._done:
            self._call(callback)
        else:
            self._callbacks.append(callback)

    def remove_done_callback(self, callback: Callable[[Future], Any]) -> bool:
        """No longer call a callback; whether it was to be called (newer releases)."""
        if callback not in self._callbacks:
            return False
        self._callbacks.remove(callback)
        return True

    def _call_callbacks(self) -> None:
        callbacks, self._callbacks = self._callbacks, []
        if self._answered_by is not None:
            self._answered_by._waiting.pop(self._request_number, None)
        for callback in callbacks:
            if self._executor is None:
                try:
                    callback(self)
                except Exception as error:  # the code that sets the result is not to blame for what is done with it
                    warnings.warn(f"Unhandled exception in done callback: {error!r} in {callback!r}", stacklevel=3)
            elif getattr(callback, "_at_once", False):
                callback(self)
            else:
                self._executor.create_task(callback, self)

    def _call(self, callback: Callable[[Future], Any]) -> None:
        if self._executor is None or getattr(callback, "_at_once", False):
            callback(self)
        else:
            self._executor.create_task(callback, self)


class _OfAsyncio(partial[object]):
    """A done callback of asyncio's: it has the loop that was running call asyncio's function."""

    _at_once = True


class Task(Future):
    """A function or coroutine to be run by an executor, step by step; calling the task does one step."""

    def __init__(
        self,
        handler: Callable[..., Any] | Any,
        args: tuple[Any, ...] | list[Any] | None = None,
        kwargs: dict[str, Any] | None = None,
        executor: Executor | None = None,
    ) -> None:
        super().__init__(executor=executor)
        self._args = tuple(args or ())
        self._kwargs = dict(kwargs or {})
        if inspect.iscoroutinefunction(handler):
            handler = handler(*self._args, **self._kwargs)
        self._handler: Any = handler
        self._executing = False
        self._number = next(NUMBERS)
        self._finally: Callable[[], object] | None = None
        self._entity: Any = None
        self._node: Any = None
        self._refused: Future | None = None

    def executing(self) -> bool:
        """Whether a step of it runs right now."""
        return self._executing

    def __call__(self) -> None:
        """Do one step: until the coroutine waits for something, or ends. Errors are kept for `result()`."""
        if self._done or self._executing or self._cancelled:
            return
        self._executing = True
        try:
            if inspect.iscoroutine(self._handler):
                self._step()
            else:
                self._complete(self._handler(*self._args, **self._kwargs))
        except StopIteration as end:
            self._complete(end.value)
        except Exception as error:
            explain_event_loop(error)
            self._end()
            self.set_exception(error)
        finally:
            self._executing = False

    def _step(self) -> None:
        awaited = self._handler.send(None)
        while (problem := self._why_not_awaited(awaited)) is not None:
            awaited = self._handler.throw(problem)  # it may catch that, and await something else
        if awaited is not None:
            awaited._callbacks.append(self._go_on)
        elif self._executor is not None:
            self._executor._resume_later(self)

    def _why_not_awaited(self, awaited: Any) -> Exception | None:
        """What is wrong with what the coroutine waits for, if anything is."""
        if awaited is None:
            return None
        if not isinstance(awaited, Future):
            return TypeError(
                f"a callback can only await rclpy's own futures and coroutines, not {awaited!r}: "
                "asyncio's futures need an asyncio loop, and an executor is not one"
            )
        if awaited._answered_by is None or awaited is self._refused:
            return None
        problem = why_never_awaited(awaited, self, running_strand())
        if not problem:
            return None
        self._refused = awaited  # said once: a coroutine that tries it again and again only waits
        return NeverWakes(problem)

    @at_once
    def _go_on(self, awaited: Future) -> None:
        if self._executor is not None:
            self._executor._resume_task(self)

    def _complete(self, value: Any) -> None:
        self._end()
        self.set_result(value)

    def _end(self) -> None:
        if self._finally is not None:
            self._finally()
            self._finally = None
