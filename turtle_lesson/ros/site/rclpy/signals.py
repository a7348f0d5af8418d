"""Which signals rclpy handles: SIGINT, that is Ctrl-C, and SIGTERM.

With its handlers in place, which `rclpy.init()` sees to, both shut all contexts of the process down. After SIGINT the
program hears of a KeyboardInterrupt as well; SIGTERM alone ends no program (rclpy's signals.py and signal_handler.cpp).
"""

from __future__ import annotations

import signal
from enum import Enum

from turtle_lesson.ros.runtime.world import current_process
from turtle_lesson.ros.sim.process import Process

from ._state import RclpyState


class SignalHandlerOptions(Enum):
    """Choice of `rclpy.init(signal_handler_options=…)`."""

    NO = 0
    SIGINT = 1
    SIGTERM = 2
    ALL = 3


class _Handlers:
    """rclpy's handlers in one process. A handler that the program sets after them takes their place."""

    def __init__(self, process: Process, options: SignalHandlerOptions) -> None:
        self.options = options
        self._process = process
        self._before = dict(process.signal_handlers)

    def __call__(self, number: int) -> bool:
        """A signal comes; True if that is the end of it."""
        wanted = self.options.value & {signal.SIGINT: 1, signal.SIGTERM: 2}.get(signal.Signals(number), 0)
        if not wanted or self._process.signal_handlers.get(number) is not self._before.get(number):
            return False
        for context in list(self._process.state(RclpyState).contexts):
            context.shut_down_by_signal()
        return number == signal.SIGTERM


def install_signal_handlers(options: SignalHandlerOptions = SignalHandlerOptions.ALL) -> None:
    """Have rclpy handle signals of this process."""
    if not isinstance(options, SignalHandlerOptions):
        raise TypeError(f"a SignalHandlerOptions is expected, got {options!r}: try SignalHandlerOptions.ALL")
    process = current_process()
    process.signal_hook = _Handlers(process, options)


def get_current_signal_handlers_options() -> SignalHandlerOptions:
    """Which signals rclpy handles now."""
    hook = current_process().signal_hook
    return hook.options if isinstance(hook, _Handlers) else SignalHandlerOptions.NO


def uninstall_signal_handlers() -> None:
    """Leave the signals to Python."""
    current_process().signal_hook = None
