"""`SetEnvironmentVariable` under its real module's name."""

from .environment import SetEnvironmentVariable

__all__ = ["SetEnvironmentVariable"]
