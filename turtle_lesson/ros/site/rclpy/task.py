"""Futures, which will have a result, and tasks, which are futures of a coroutine that an executor runs."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Generator
from typing import TYPE_CHECKING, Any

from turtle_lesson.ros.core import NeverWakes

from ._mistakes import explain_event_loop

if TYPE_CHECKING:
    from .executors import Executor


class Future:
    """Something that will be known later. States: waiting, then done with a result or an exception, or cancelled."""

    def __init__(self, *, executor: Executor | None = None) -> None:
        self._done = False
        self._cancelled = False
        self._result: Any = None
        self._exception: BaseException | None = None
        self._exception_fetched = False
        self._callbacks: list[Callable[[Future], Any]] = []
        self._executor = executor
        self._answered_by: Any = None  # the client whose response this waits for, if any

    def __repr__(self) -> str:
        state = "cancelled" if self._cancelled else "done" if self._done else "waiting"
        return f"<rclpy.task.{type(self).__name__} {state}>"

    def __await__(self) -> Generator[Future, None, Any]:
        while not self._done:
            yield self
        return self.result()

    def cancel(self) -> None:
        """Give up waiting: the future counts as cancelled, its callbacks are called."""
        if not self._done:
            self._cancelled = True
            self._call_callbacks()

    def cancelled(self) -> bool:
        """Whether it was cancelled."""
        return self._cancelled

    def done(self) -> bool:
        """Whether there is a result or an exception."""
        return self._done

    def result(self) -> Any:
        """The result, None while there is none; raises the exception if there is one."""
        if self._exception is not None:
            self._exception_fetched = True
            raise self._exception
        return self._result

    def exception(self) -> BaseException | None:
        """The exception, if there is one."""
        self._exception_fetched = True
        return self._exception

    def set_result(self, result: Any) -> None:
        """Now it is done."""
        self._result = result
        self._done = True
        self._cancelled = False
        self._call_callbacks()

    def set_exception(self, exception: BaseException) -> None:
        """Now it is done, and has failed."""
        self._exception = exception
        self._done = True
        self._cancelled = False
        self._call_callbacks()

    def add_done_callback(self, callback: Callable[[Future], Any]) -> None:
        """Have `callback(future)` called when it is done: by the executor if there is one; at once if it is done."""
        if self._done:
            self._call(callback)
        else:
            self._callbacks.append(callback)

    def _call_callbacks(self) -> None:
        callbacks, self._callbacks = self._callbacks, []
        for callback in callbacks:
            self._call(callback)

    def _call(self, callback: Callable[[Future], Any]) -> None:
        if self._executor is None or getattr(callback, "_at_once", False):
            callback(self)
        else:
            self._executor.create_task(callback, self)

    def _set_executor(self, executor: Executor) -> None:
        self._executor = executor


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
        self._finally: Callable[[], object] | None = None
        self._entity: Any = None
        self._node: Any = None

    def executing(self) -> bool:
        """Whether a step of it runs right now."""
        return self._executing

    def cancel(self) -> None:
        """Stop the coroutine where it waits."""
        if inspect.iscoroutine(self._handler) and not self._executing:
            self._handler.close()
        super().cancel()
        self._end()

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
        if isinstance(awaited, Future):
            problem = self._why_never(awaited)
            if problem:
                awaited = self._handler.throw(NeverWakes(problem))
        if isinstance(awaited, Future):
            awaited._callbacks.append(self._go_on)
        elif awaited is None:
            self._poll()
        else:
            self._handler.throw(
                TypeError(
                    f"a callback can only await rclpy's own futures and coroutines, not {awaited!r}: "
                    "asyncio's need an asyncio loop, which an executor is not"
                )
            )

    def _why_never(self, awaited: Future) -> str:
        """Whether this task keeps busy the very callback group in which the answer would have to be taken."""
        client, entity = awaited._answered_by, self._entity
        if client is None or entity is None or client.callback_group is not entity.callback_group:
            return ""
        if client.callback_group.can_execute(client):
            return ""
        return (
            f"this coroutine waits for an answer of {client.srv_name}, but can never get it: it keeps its callback "
            "group taken while it waits, and the client is in the same group. Give the client a group of its own: "
            "create_client(…, callback_group=MutuallyExclusiveCallbackGroup())"
        )

    def _go_on(self, awaited: Future) -> None:
        if self._executor is not None:
            self._executor._resume_task(self)

    _go_on._at_once = True  # type: ignore[attr-defined]

    def _poll(self) -> None:
        if self._executor is not None:
            self._executor._poll_task(self)

    def _complete(self, value: Any) -> None:
        self._end()
        self.set_result(value)

    def _end(self) -> None:
        if self._finally is not None:
            self._finally()
            self._finally = None
