"""Actions: goals that take their time, with feedback on the way, a result at the end, and the possibility to cancel."""

# ruff: noqa: F401

from .client import ActionClient
from .graph import (
    get_action_client_names_and_types_by_node,
    get_action_names_and_types,
    get_action_server_names_and_types_by_node,
)
from .server import ActionServer, CancelResponse, GoalResponse
