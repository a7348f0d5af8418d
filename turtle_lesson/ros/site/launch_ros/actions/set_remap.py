"""`SetRemap` under its real module's name."""

from .set_parameter import SetRemap

__all__ = ["SetRemap"]
