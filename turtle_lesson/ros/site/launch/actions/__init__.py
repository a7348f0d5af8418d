"""Actions: what a launch description can do."""

# ruff: noqa: F403  (each module says in its __all__ what it exports)

from . import _configuration, _events, _groups, _processes
from ._configuration import *
from ._events import *
from ._groups import *
from ._processes import *

__all__ = [*_configuration.__all__, *_events.__all__, *_groups.__all__, *_processes.__all__]
