"""What Ctrl-C and SIGTERM do to rclpy: contexts are shut down, and the program hears of it in its own way."""

from __future__ import annotations

import signal
import time
from collections.abc import Callable
from typing import Any

import pytest
import rclpy
from rclpy.context import Context
from rclpy.exceptions import RCLError
from rclpy.executors import ExternalShutdownException
from rclpy.signals import SignalHandlerOptions, get_current_signal_handlers_options
from std_msgs.msg import String

from turtle_lesson.ros.runtime.world import World
from turtle_lesson.ros.sim.process import Process

Capture = pytest.CaptureFixture[str]
SIGNALS = {"SIGINT": signal.SIGINT, "SIGTERM": signal.SIGTERM}


def told(world: World, program: Callable[[list[Any]], object], name: str = "SIGINT") -> tuple[list[Any], Process]:
    """What a program notes that gets a signal after a second, and its process."""
    found: list[Any] = []
    process = world.spawn(lambda: program(found), name="program")
    world.sim.run_until(1_000_000_000)
    process.send_signal(SIGNALS[name])
    world.sim.run_until(10_000_000_000)
    return found, process


def test_ctrl_c_shuts_the_context_down_before_the_program_hears_of_it(world: World) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init(args=[])
        node = rclpy.create_node("n")
        publisher, timer = node.create_publisher(String, "t", 1), node.create_timer(0.1, lambda: None)
        node.context.on_shutdown(lambda: found.append("never called after a signal, as on a robot"))
        try:
            rclpy.spin(node)
        except KeyboardInterrupt:
            found.append(rclpy.ok())
            with pytest.raises(RCLError) as caught:
                publisher.publish(String(data="stop!"))
            found.append(str(caught.value))
        finally:
            timer.cancel()
            node.get_logger().info("bye")
            node.destroy_node()
            rclpy.try_shutdown()

    found, process = told(world, program)
    assert found == [False, "Failed to publish: publisher's context is invalid"]
    assert process.exit_code == 0
    assert world.graph.nodes == []


def test_a_shutdown_after_ctrl_c_is_one_too_many_as_on_a_robot(world: World, capsys: Capture) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init(args=[])
        node = rclpy.create_node("n")
        try:
            rclpy.spin(node)
        except KeyboardInterrupt:
            pass
        finally:
            node.destroy_node()
            rclpy.shutdown()

    _, process = told(world, program)
    assert process.exit_code == 1
    error = capsys.readouterr().err
    assert "RCLError: failed to shutdown: rcl_shutdown already called on the given context\n" in error
    assert error.endswith("rclpy.try_shutdown() does it only if it is still necessary.\n")


def test_after_that_one_may_begin_anew(world: World) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init(args=[])
        try:
            time.sleep(100)
        except KeyboardInterrupt:
            rclpy.try_shutdown()
        rclpy.init(args=[])
        found.append(rclpy.ok())

    assert told(world, program)[0] == [True]


def test_sigterm_ends_the_spinning_and_no_program(world: World) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init(args=[])
        try:
            rclpy.spin(rclpy.create_node("n"))
        except ExternalShutdownException:
            found.append(time.monotonic())

    found, process = told(world, program, "SIGTERM")
    assert found == [pytest.approx(1.0, abs=1e-5)]
    assert process.exit_code == 0


@pytest.mark.parametrize(
    ("options", "signal_name", "is_up"),
    [
        (SignalHandlerOptions.NO, "SIGINT", True),
        (SignalHandlerOptions.SIGTERM, "SIGINT", True),
        (SignalHandlerOptions.SIGINT, "SIGINT", False),
        (SignalHandlerOptions.ALL, "SIGINT", False),
    ],
)
def test_who_handles_signals_is_a_choice(
    world: World, options: SignalHandlerOptions, signal_name: str, is_up: bool
) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init(args=[], signal_handler_options=options)
        found.append(get_current_signal_handlers_options() is options)
        try:
            time.sleep(100)
        except KeyboardInterrupt:
            found.append(rclpy.ok())
            rclpy.try_shutdown()
        found.append(get_current_signal_handlers_options().name)

    assert told(world, program, signal_name)[0] == [True, is_up, "NO"]


def test_without_rclpys_handlers_sigterm_ends_the_program(world: World) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init(args=[], signal_handler_options=SignalHandlerOptions.NO)
        rclpy.spin(rclpy.create_node("n"))

    _, process = told(world, program, "SIGTERM")
    assert process.exit_code is not None and process.exit_code < 0


def test_a_context_of_ones_own_installs_no_handlers_but_is_shut_down_by_those_of_the_default_one(world: World) -> None:
    def program(found: list[Any]) -> None:
        own = Context()
        rclpy.init(args=[], context=own)
        found.append(get_current_signal_handlers_options().name)
        rclpy.init(args=[])
        try:
            time.sleep(100)
        except KeyboardInterrupt:
            found.append(own.ok())

    assert told(world, program)[0] == ["NO", False]


def test_a_handler_that_the_program_sets_later_takes_the_place_of_rclpys(world: World) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init(args=[])
        signal.signal(signal.SIGINT, lambda number, frame: found.append(number))
        rclpy.spin_once(rclpy.create_node("n"), timeout_sec=3.0)
        found.append(rclpy.ok())

    assert told(world, program)[0] == [signal.SIGINT, True]


def test_the_handlers_can_be_taken_away_and_put_back(world: World) -> None:
    assert get_current_signal_handlers_options() is SignalHandlerOptions.NO
    rclpy.init(args=[])
    assert get_current_signal_handlers_options() is SignalHandlerOptions.ALL
    rclpy.uninstall_signal_handlers()
    assert get_current_signal_handlers_options() is SignalHandlerOptions.NO
    rclpy.install_signal_handlers(SignalHandlerOptions.SIGINT)
    assert get_current_signal_handlers_options() is SignalHandlerOptions.SIGINT
    with pytest.raises(TypeError, match="a SignalHandlerOptions is expected, got 'ALL'"):
        rclpy.install_signal_handlers("ALL")
    rclpy.shutdown(uninstall_handlers=False)
    assert get_current_signal_handlers_options() is SignalHandlerOptions.SIGINT
