"""Names that programs take from a module of rclpy that has them only from another one."""

from __future__ import annotations

import typing

import pytest
import rclpy


def test_what_programs_write() -> None:
    from action_msgs.msg import GoalStatus as TrueStatus
    from rclpy.action.client import GoalStatus
    from rclpy.action.server import GoalStatus as OfServers
    from rclpy.node import Optional, ParameterDescriptor, Rate, ReentrantCallbackGroup, SetParametersResult
    from rclpy.parameter import ParameterType

    assert GoalStatus is OfServers is TrueStatus
    assert ParameterDescriptor(type=ParameterType.PARAMETER_BOOL).type == 1
    assert SetParametersResult(successful=True).successful
    assert issubclass(ReentrantCallbackGroup, rclpy.callback_groups.CallbackGroup)
    assert Rate is rclpy.timer.Rate
    assert Optional is typing.Optional


def test_a_name_that_nobody_has() -> None:
    with pytest.raises(ImportError, match=r"cannot import name 'Telepathy' from 'rclpy\.node'"):
        exec("from rclpy.node import Telepathy")
    with pytest.raises(AttributeError, match=r"module 'rclpy.action.client' has no attribute 'goal_status'"):
        rclpy.action.client.goal_status  # noqa: B018


def test_types_with_types_in_brackets() -> None:
    from example_interfaces.action import Fibonacci
    from rclpy.action import ActionClient, ActionServer
    from rclpy.action.client import ClientGoalHandle
    from rclpy.action.server import ServerGoalHandle
    from rclpy.client import Client
    from rclpy.lifecycle import LifecyclePublisher
    from rclpy.parameter import Parameter
    from rclpy.publisher import Publisher
    from rclpy.service import Service
    from rclpy.subscription import Subscription
    from rclpy.task import Future, Task
    from std_msgs.msg import String
    from std_srvs.srv import Trigger

    for kind in (Publisher, Subscription, LifecyclePublisher):
        assert kind[String].__args__ == (String,)
    for kind in (Client, Service):
        assert kind[Trigger.Request, Trigger.Response].__origin__ is kind
    for kind in (ActionClient, ActionServer, ClientGoalHandle, ServerGoalHandle):
        assert len(kind[Fibonacci.Goal, Fibonacci.Result, Fibonacci.Feedback].__args__) == 3
    assert [Future[int]().done(), Task[None].__origin__, Parameter[float]("a", value=0.5).value] == [False, Task, 0.5]
