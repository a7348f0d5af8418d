"""`ThisLaunchFileDir` under its real module's name."""

from .this_launch_file import ThisLaunchFileDir

__all__ = ["ThisLaunchFileDir"]
