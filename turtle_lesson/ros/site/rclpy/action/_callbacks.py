"""How the callbacks of an action are called, and what is said when one cannot be called like that."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import Any

ARGUMENTS = {
    "goal_callback": "goal_request",
    "handle_accepted_callback": "goal_handle",
    "cancel_callback": "goal_handle",
    "execute_callback": "goal_handle",
    "feedback_callback": "feedback_msg",
}


async def call_back(role: str, callback: Callable[[Any], Any], argument: Any) -> Any:
    """Call a callback that plays a role in an action, and await what it returns if it is an `async def`."""
    try:
        result = callback(argument)
    except TypeError as error:
        _explain(role, error)
        raise
    return await result if inspect.iscoroutinefunction(callback) else result


def _explain(role: str, error: TypeError) -> None:
    """Add to an error that the call itself raised, not the callback, how the callback is called."""
    trace = error.__traceback__
    if trace is not None and trace.tb_next is None:
        name = ARGUMENTS[role]
        error.add_note(f"The {role} of an action is called with one argument: def {role}(self, {name}).")
