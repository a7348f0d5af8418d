"""What an executor waits for: timers, subscriptions, guard conditions, clients and services have this in common.

An entity *signals* its executor when work for it arrives, and is then looked at in the executor's next cycle. Nothing
is ever polled.
"""

from __future__ import annotations

import inspect
from collections import deque
from collections.abc import Callable
from types import FunctionType, GenericAlias
from typing import TYPE_CHECKING, Any

from turtle_lesson.ros.rmw.trace import CHUNK, PLUMBING, Callback, Trace

from ._hints import explain_call
from .callback_groups import CallbackGroup, MutuallyExclusiveCallbackGroup, begin_of

if TYPE_CHECKING:
    from .executors import Executor
    from .node import Node

WAITABLE, TIMER, SUBSCRIPTION, GUARD, CLIENT, SERVICE = range(-1, 5)

NO_TURN = (0, 0, 0)
"""The place in a cycle of what no executor has had yet."""


class Assignment:
    """Which executor runs the callbacks of a node: all its entities share one, so that it changes for all at once.

    Attributes:
        executor: the one that has the node now, if any has.
        missed: entities for which there may be work that came while none had; a dict keeps their order.
    """

    __slots__ = ("executor", "missed")

    def __init__(self) -> None:
        self.executor: Executor | None = None
        self.missed: dict[Entity, None] = {}


class Handle:
    """What stands for the C object of an entity, publisher, node or clock in the real rclpy: held with `with`."""

    def __init__(self, owner: Any) -> None:
        self._entity = owner
        self.pointer = id(owner)
        """A number that nothing else has."""

    def __enter__(self) -> None:
        if isinstance(self._entity, Destroyable):
            self._entity._check_alive()

    def __exit__(self, *error: object) -> None:
        """Let go."""


class Destroyable:
    """What a node has made: an entity or a publisher. A `with` block destroys it at its end."""

    __class_getitem__: Any = classmethod(GenericAlias)  # newer releases: Publisher[String] in a hint
    _node: Node | None = None
    _destroyed = False

    @property
    def handle(self) -> Handle:
        """What stands for the C object of the real one."""
        return Handle(self)

    @property
    def logger_name(self) -> str:
        """The name of the node's logger."""
        assert self._node is not None
        return self._node.get_logger().name

    def _check_alive(self, doing: str = "") -> None:
        """Raise InvalidHandle if it was destroyed, and after rclpy.shutdown() RCLError for `doing` something."""
        if self._destroyed and self._node is not None:
            self._node._ros_refuse(doing)

    def destroy(self) -> None:
        """Never be used again."""
        raise NotImplementedError

    def __enter__(self) -> Any:
        return self

    def __exit__(self, *error: object) -> None:
        self.destroy()


class Entity(Destroyable):
    """Base class of what is run. `_kind` decides the order in a cycle; `_number` is the order of creation."""

    callback: Any
    _next: int
    """When a timer is due (ns); nothing else has it."""
    _kind = GUARD

    def __init_subclass__(cls, **keywords: Any) -> None:
        """Give each kind of entity a copy of the code that runs for each signal.

        Python (3.11 and newer) specializes code for the classes that it meets. Code that all kinds share would meet
        now a timer, now a subscription, and take twice as long.
        """
        super().__init_subclass__(**keywords)
        for function in (Entity._signal, Entity._run):
            setattr(cls, function.__name__, FunctionType(function.__code__.replace(), function.__globals__))

    def __init__(self, callback: Callable[..., Any] | None, callback_group: CallbackGroup) -> None:
        self.callback = callback
        self.callback_group = callback_group
        self._begin = begin_of(callback_group)
        """Asks the group whether the callback may run, and takes it."""
        self._end_run = callback_group.ending_execution
        """Frees the group again."""
        self._exclusive_group = callback_group if type(callback_group) is MutuallyExclusiveCallbackGroup else None
        """The group, if it is of the usual kind: that is taken and freed here, without a call."""
        self._is_async = inspect.iscoroutinefunction(callback)
        self._answers = False  # whether the callback's result is wanted
        self._traced: Callback | None = None
        """Where its runs are noted, if the world keeps a trace of them."""
        self._assigned = Assignment()
        """The node's, as soon as it has one."""
        self._node: Node | None = None
        self._listed_in: Executor | None = None
        self._turn = NO_TURN
        self._number = 0
        self._destroyed = False
        callback_group.add_entity(self)

    @property
    def _executor(self) -> Executor | None:
        """The executor that runs its callback now, if any."""
        return self._assigned.executor

    def _assign(self, assignment: Assignment) -> None:
        """Be run by another executor than before."""
        self._assigned.missed.pop(self, None)
        self._assigned = assignment

    def _signal(self) -> None:
        """Tell the executor that there may be work."""
        executor = self._assigned.executor
        if executor is None:
            self._assigned.missed[self] = None
        elif self._listed_in is not executor:
            self._listed_in = executor
            executor._signalled.append(self)
            strand = executor._waiter
            if strand is not None and strand.parked:
                strand.parked = False
                make_ready = executor._make_ready
                make_ready(strand)

    def _run(self, executor: Executor, chosen: bool) -> None:
        """Take one piece of work and call the callback with it, and then free its group.

        An executor that has chosen it for its cycle has taken the group. One that found only this signal has not: then it is
        seen here whether there is work, and whether the group lets it run.
        """
        group = self._exclusive_group
        if not chosen:
            self._listed_in = None
            if self._assigned.executor is not executor:
                self._assigned.missed[self] = None
                return
            if not self._has_work():
                return
            if not self._begin(self) if group is None else group._active_entity is not None:
                executor._blocked.append(self)
                return
            if group is not None:
                group._active_entity = self
            if self._is_async:
                executor._execute(self)
                return
        simulation, traced = executor._simulation, self._traced
        if traced is not None:
            began, arrivals, running = simulation.now, traced.arrivals, traced.open
            ready = self._next if arrivals is None else arrivals.popleft() if arrivals else began
            begun = (ready, began)
            running.append(begun)
        try:
            arguments = self._take()
            if arguments is not None:
                callback = self.callback
                result = callback(*arguments)
                if self._answers:
                    self._done_with(arguments, result)
        except TypeError as error:
            explain_call(self, arguments, error)
            raise
        finally:
            if traced is not None:  # `traced.end_run(…)`, written out
                if running[-1] is begun:  # as nearly always: few callbacks run beside themselves
                    running.pop()
                else:
                    running.remove(begun)
                newest = traced.newest
                newest.append((ready, began, simulation.now))
                if len(newest) == CHUNK:
                    traced.pack()
            if group is not None:
                group._active_entity = None
            else:
                self._end_run(self)
            if executor._blocked:
                executor._retry_blocked()

    def _has_work(self) -> bool:
        """Whether there is work right now."""
        raise NotImplementedError

    def _take(self) -> tuple[Any, ...] | None:
        """Take one piece of work: the arguments of the callback, or None if there is nothing to call."""
        raise NotImplementedError

    def _done_with(self, arguments: tuple[Any, ...], result: Any) -> None:
        """The callback has returned `result`."""

    def destroy(self) -> None:
        """Never be called again."""
        self._destroyed = True
        self._assign(Assignment())
        if self._node is not None and self in self._node._ros_waiting_entities:
            self._node._ros_waiting_entities.remove(self)
        self.callback_group.entities.discard(self)


# -- how callbacks get into the world's trace --------------------------------------------------------------------------

KINDS = {TIMER: "timer", SUBSCRIPTION: "subscription", SERVICE: "service"}


def trace_entity(entity: Any, node: Node, trace: Trace) -> None:
    """Give a callback of the program's its place in the trace, unless it has one from another executor."""
    kind, callback, entry = KINDS.get(entity._kind), entity.callback, node._ros_entry
    owner = type(getattr(callback, "__self__", None))
    of_rclpy = owner.__module__.startswith("rclpy.")
    if kind is None or callback is None or entry.hidden or (of_rclpy and owner.__name__ in ("Rate", "TimeSource")):
        return
    end = entity._reader if kind == "subscription" else entity._server if kind == "service" else None
    source = "" if end is None else end.topic.name if kind == "subscription" else end.name
    if source in PLUMBING or entity._traced is not None:
        return
    is_plumbing = of_rclpy and kind == "service"  # such as get_parameters
    name = source.rpartition("/")[2] if is_plumbing else name_of(callback)
    period = entity._period if kind == "timer" else 0
    entity._traced = Callback(entry.full_name, name, kind, source, period, entry.process.pid, entity._is_async)
    trace.callbacks.append(entity._traced)
    if end is not None:  # note beside each message or request that waits when it came
        arrivals = deque([trace.simulation.now] * len(end.queue), maxlen=getattr(end.queue, "maxlen", None))
        end.arrivals = entity._traced.arrivals = arrivals
    elif entity._time is not trace.simulation:
        entity._traced.arrivals = deque()  # a timer whose ticks are in another time is ready when it begins


def name_of(function: Callable[..., Any] | None) -> str:
    """What a learner calls a callback."""
    function = getattr(function, "func", function)  # of a functools.partial
    name = getattr(function, "__name__", type(function).__name__)
    return "lambda" if name == "<lambda>" else name
