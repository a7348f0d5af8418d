"""The kinds of clock that ROS knows."""

from enum import IntEnum


class ClockType(IntEnum):
    """System time can be set, ROS time can be simulated, steady time only goes forward."""

    UNINITIALIZED = 0
    ROS_TIME = 1
    SYSTEM_TIME = 2
    STEADY_TIME = 3
