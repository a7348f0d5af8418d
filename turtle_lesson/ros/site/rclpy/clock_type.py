"""The kinds of clock that ROS knows."""

from enum import IntEnum


class CEnum(IntEnum):
    """An enumeration that rclpy takes from C (_rclpy_pybind11.cpp): a number that prints as its name."""

    def __str__(self) -> str:
        return f"{type(self).__name__}.{self.name}"

    def __format__(self, spec: str) -> str:
        return format(str(self), spec)


class ClockType(CEnum):
    """System time can be set, ROS time can be simulated, steady time only goes forward."""

    UNINITIALIZED = 0
    ROS_TIME = 1
    SYSTEM_TIME = 2
    STEADY_TIME = 3
