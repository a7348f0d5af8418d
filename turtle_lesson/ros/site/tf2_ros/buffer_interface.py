"""The functions that transform stamped data, which packages register for their types.

Facts: geometry2, tf2_ros_py/tf2_ros/buffer_interface.py.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, ClassVar

from geometry_msgs.msg import TransformStamped

Transforming = Callable[[Any, TransformStamped], Any]


class TypeException(Exception):
    """No function is registered that transforms data of this type."""


class TransformRegistration:
    """The functions that transform data, by the type of the data; all registrations are one."""

    _functions: ClassVar[dict[Any, Transforming]] = {}

    def add(self, key: Any, callback: Transforming) -> None:
        """Have data of this type be transformed by a function of the data and a TransformStamped."""
        self._functions[key] = callback

    def get(self, key: Any) -> Transforming:
        """The function for a type. Raises TypeException."""
        if key in self._functions:
            return self._functions[key]
        error = TypeException(f"Type {key} is not loaded or supported")
        error.add_note("For geometry_msgs write: import tf2_geometry_msgs; messages of sensor_msgs are not transformed")
        raise error
