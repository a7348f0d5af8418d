"""`LaunchConfigurationNotEquals` under its real module's name."""

from .launch_configuration_equals import LaunchConfigurationNotEquals

__all__ = ["LaunchConfigurationNotEquals"]
