"""`SetLaunchConfiguration` under its real module's name."""

from .launch_configurations import SetLaunchConfiguration

__all__ = ["SetLaunchConfiguration"]
