"""`LogInfo` under its real module's name."""

from .log import LogInfo

__all__ = ["LogInfo"]
