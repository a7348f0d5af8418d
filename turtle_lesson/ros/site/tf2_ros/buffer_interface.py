"""What every buffer offers: transforming stamped data, with the functions that packages have registered for their types.

Facts: geometry2, tf2_ros_py/tf2_ros/buffer_interface.py.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, ClassVar

from geometry_msgs.msg import TransformStamped
from rclpy.duration import Duration
from rclpy.time import Time

AT_ONCE = Duration()
"""A timeout of no time: nothing is waited for."""
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
        if "sensor_msgs" in str(key) and "geometry_msgs" not in str(key):
            error.add_note("The types of sensor_msgs are transformed by tf2_sensor_msgs, which is not available here")
        else:
            error.add_note("For the types of geometry_msgs write: import tf2_geometry_msgs")
        raise error


class BufferInterface:
    """Base class of buffers. Times of 0 ask for the latest; a timeout says how long to wait for the transform."""

    def __init__(self) -> None:
        self.registration = TransformRegistration()

    def transform(self, object_stamped: Any, target_frame: str, timeout: Duration = AT_ONCE) -> Any:
        """Stamped data as seen from the target frame, at the time of its stamp.

        Raises TypeException for a type that is not registered, and TransformException.
        """
        do_transform = self.registration.get(type(object_stamped))
        header = object_stamped.header
        return do_transform(object_stamped, self.lookup_transform(target_frame, header.frame_id, header.stamp, timeout))

    def lookup_transform(
        self, target_frame: str, source_frame: str, time: Time, timeout: Duration = AT_ONCE
    ) -> TransformStamped:
        """Where a frame is, seen from another one; for subclasses to say."""
        raise NotImplementedError
