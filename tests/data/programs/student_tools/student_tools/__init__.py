from .angles import normalize
from .pid import PID

__all__ = ['PID', 'normalize']
