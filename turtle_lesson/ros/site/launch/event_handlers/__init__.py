"""Event handlers: what to do when something happens."""

from .._missing import explain_missing
from ..event_handler import EventHandler
from .on_action_event_base import OnActionEventBase
from .on_execution_complete import OnExecutionComplete
from .on_process_exit import OnProcessExit
from .on_process_io import OnProcessIO
from .on_process_start import OnProcessStart
from .on_shutdown import OnShutdown

__all__ = [
    "EventHandler",
    "OnActionEventBase",
    "OnExecutionComplete",
    "OnProcessExit",
    "OnProcessIO",
    "OnProcessStart",
    "OnShutdown",
]

__getattr__ = explain_missing(
    __name__, {"OnIncludeLaunchDescription": "launch itself carries an included description out"}
)
