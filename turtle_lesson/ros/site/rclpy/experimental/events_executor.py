"""An executor that runs callbacks in the order in which work for them came."""

from __future__ import annotations

from ..executors import Executor

__all__ = ["EventsExecutor"]


class EventsExecutor(Executor):
    """Like a SingleThreadedExecutor, but timers do not go before messages, nor one node before the other.

    Every executor here is driven by events; this one also keeps to their order. Of several messages that wait for one
    subscription, one is taken at a time, and the others then queue at the end.
    """

    _in_order_of_arrival = True
