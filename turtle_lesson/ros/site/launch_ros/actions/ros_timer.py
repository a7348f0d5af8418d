"""`RosTimer`: do something after some time of ROS's clock."""

from __future__ import annotations

from launch.actions import TimerAction
from launch.frontend import expose_action


@expose_action("ros_timer")
class RosTimer(TimerAction):
    """As `TimerAction`: here both go by robot time, also where a node publishes `/clock`."""


ROSTimer = RosTimer
