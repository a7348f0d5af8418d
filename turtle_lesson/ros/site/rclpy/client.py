"""Clients: the side that asks."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any, NoReturn

from turtle_lesson.ros.idl import checks
from turtle_lesson.ros.rmw.service import ClientEnd, ServerEnd
from turtle_lesson.ros.sim.errors import NeverWakes
from turtle_lesson.ros.sim.simulation import NANOSECONDS
from turtle_lesson.ros.sim.strand import running_strand
from turtle_lesson.ros.stdlib.deadlock import looked_in_vain, wait_in_vain

from ._blocking import drives_the_simulation, wait_until
from ._deadlock import Words, why_never_answered
from ._entity import CLIENT, Entity
from ._hints import shown
from .callback_groups import CallbackGroup
from .qos import QoSProfile
from .task import Future, at_once

if TYPE_CHECKING:
    from turtle_lesson.ros.sim.strand import Strand

    from .context import Context
    from .node import Node

POLL = 250_000_000  # how often, in ns, the real one looks whether a service has appeared (client.py)


class Client(Entity):
    """Made by `Node.create_client`."""

    _kind = CLIENT
    _node: Node
    _words = Words()

    def __init__(
        self, end: ClientEnd, srv_type: Any, srv_name: str, qos_profile: QoSProfile, callback_group: CallbackGroup
    ) -> None:
        super().__init__(self._set_result, callback_group)
        self._end = end
        end.wake = self._signal
        self.srv_type = srv_type
        self._request_type = srv_type.Request
        self.srv_name = srv_name
        self.qos_profile = qos_profile
        self._waiting: dict[int, Future] = {}

    def __repr__(self) -> str:
        return f"<Client of {self.srv_name}>"

    @property
    def service_name(self) -> str:
        """The service's full name."""
        return self._end.name

    @property
    def context(self) -> Context:
        """The context that the client's node lives in."""
        return self._node.context

    def service_is_ready(self) -> bool:
        """Whether somebody offers the service now."""
        self._check_alive("failed to check service availability: rcl node's")
        return bool(self._servers()) or looked_in_vain()

    def _servers(self) -> list[ServerEnd]:
        return self._node._ros_graph.servers(self._end.name, self._end.type_name)

    def wait_for_service(self, timeout_sec: float | None = None) -> bool:
        """Wait until a node offers the service; False if none does within the timeout (s). None waits forever."""
        what = f"wait_for_service for {self._end.name}"
        return wait_until(self.service_is_ready, timeout_sec, POLL, self._node.context, what)

    def call_async(self, request: Any) -> Future:
        """Send a request; the future will have the response. Raises TypeError for anything but a request."""
        if not isinstance(request, self._request_type):
            self._refuse(request)
        future = Future(executor=self._assigned.executor)
        if self._destroyed:
            self._check_alive()
            return future  # after rclpy.shutdown() a request goes nowhere, as on a robot
        future._answered_by = self
        if not checks.when_assigned:
            request = checks.sendable(request)
        future._request_number = number = self._end.ask(request)
        self._waiting[number] = future
        return future

    def _refuse(self, request: Any) -> NoReturn:
        name = f"{self.srv_type.__name__}.Request"
        raise TypeError(f"a request of {self.srv_name} is of type {name}, got {shown(request)}: try {name}(…)")

    @drives_the_simulation
    def call(self, request: Any, timeout_sec: float | None = None) -> Any:
        """Send a request and wait for the response; None after the timeout (s).

        Works where another thread takes the answer, and in a plain notebook cell. Where nobody ever could, it raises
        NeverWakes, which says why, instead of hanging as a real one does.
        """
        strand = running_strand()
        assert strand is not None
        strand.activity = f"the call of {self._end.name}"
        if not isinstance(request, self._request_type):
            self._refuse(request)
        if timeout_sec is None and (problem := why_never_answered(self, strand)):
            raise NeverWakes(f"this call of {self._end.name} can never be answered: {problem}")
        return self._answer_to(self.call_async(request), strand, timeout_sec)

    def _answer_to(self, future: Future, strand: Strand, timeout_sec: float | None = None) -> Any:
        """Wait for the result of a future that `call_async` returned; None after the timeout (s)."""
        try:
            if not strand.process.is_notebook or self._taken_elsewhere(strand):
                self._wait(future, strand, timeout_sec)
            elif self._executor is not None:
                self._executor.spin_until_future_complete(future, timeout_sec)
            else:
                from . import spin_until_future_complete

                spin_until_future_complete(self._node, future, timeout_sec=timeout_sec)
        finally:
            self._waiting.pop(future._request_number, None)
        return future.result()

    def _wait(self, future: Future, strand: Strand, timeout_sec: float | None) -> None:
        simulation = self._end.simulation
        deadline = None if timeout_sec is None else simulation.now + int(timeout_sec * NANOSECONDS)
        future.add_done_callback(at_once(lambda _: simulation.wake(strand)))
        executor = self._executor
        calls = executor._calls if deadline is None and executor is not None and executor._is_worker(strand) else []
        calls.append(future)
        try:
            simulation.wait_for(strand, future.done, deadline, partial(wait_in_vain, strand, strand.activity))
        finally:
            calls.remove(future)

    def _taken_elsewhere(self, strand: Strand) -> bool:
        return self._executor is not None and self._executor._spun_by_another(strand)

    def _has_work(self) -> bool:
        return bool(self._end.queue)

    def _take(self) -> tuple[Any, ...] | None:
        queue = self._end.queue
        number, response = queue.popleft()
        if queue:
            self._signal()
        future = self._waiting.pop(number, None)
        return None if future is None else (future, response)

    def _set_result(self, future: Future, response: Any) -> None:
        if not future._cancelled:
            future._executor = self._assigned.executor
            future.set_result(response)

    def get_pending_request(self, sequence_number: int) -> Future:
        """The future of a request by its number; KeyError if there is none."""
        return self._waiting[sequence_number]

    def remove_pending_request(self, future: Future) -> None:
        """Stop waiting for the response of a future."""
        self._waiting.pop(future._request_number, None)

    def destroy(self) -> None:
        """Leave the service; answers under way are dropped."""
        if not self._destroyed:
            super().destroy()
            self._node._ros_graph.remove_service_end(self._end)
