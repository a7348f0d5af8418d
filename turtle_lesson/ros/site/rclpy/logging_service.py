"""The two services through which others read and set a process's log levels (`Node(…, enable_logger_service=True)`)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from .logging import get_logger_level, set_logger_level
from .qos import qos_profile_services_default

if TYPE_CHECKING:
    from .node import Node


class LoggingService:
    """Made by a node that is told to. rclpy of Jazzy and newer has it."""

    def __init__(self, node: Node) -> None:
        from rcl_interfaces import srv

        profile, name = qos_profile_services_default, node.get_name()
        node.create_service(srv.GetLoggerLevels, f"{name}/get_logger_levels", self._get, qos_profile=profile)
        node.create_service(srv.SetLoggerLevels, f"{name}/set_logger_levels", self._set, qos_profile=profile)

    def _get(self, request: Any, response: Any) -> Any:
        from rcl_interfaces.msg import LoggerLevel

        response.levels = [LoggerLevel(name=name, level=int(get_logger_level(name))) for name in request.names]
        return response

    def _set(self, request: Any, response: Any) -> Any:
        from rcl_interfaces.msg import SetLoggerLevelsResult

        for wish in request.levels:
            result = SetLoggerLevelsResult(successful=True)
            try:
                set_logger_level(wish.name, wish.level, detailed_error=True)
            except ValueError:
                result.successful, result.reason = False, "Failed reason: Invalid logger level."
            response.results.append(result)
        return response
