"""Devices that a program in the simulation reaches in another way, or not at all: keys, a screen, a user who answers."""

from __future__ import annotations

KEYS = (
    "Here a program reads keys from sys.stdin (with termios, tty and select), by pynput.keyboard or by curses; you press "
    "them in lesson.teleop(), or by lesson.press('w')."
)
SCREEN = (
    "A program here has no screen for a window of its own. lesson.dashboard() may show the same; the "
    "program's nodes can do their work without the window."
)
ANSWER = (
    "Nobody is here to answer input(). Give the lines beforehand (lesson.run(5, input=['3']), `ros2 run … < FILE` or "
    "`echo 3 | ros2 run …`), or the values as arguments (sys.argv) or parameters (-p name:=value)."
)

_BY_KIND = {
    "termios.error": KEYS, "_curses.error": KEYS, "tty.error": KEYS, "builtins.EOFError": ANSWER,
    "IPython.core.error.StdinNotImplementedError": ANSWER, "ipykernel.kernelbase.StdinNotImplementedError": ANSWER,
}  # fmt: skip
_SCREEN_WORDS = ("no display", "could not connect to display", "couldn't connect to display", "cannot open display")


def advice(error: BaseException) -> str:
    """A sentence about a device that is not there."""
    kind = f"{type(error).__module__}.{type(error).__qualname__}"
    text = str(error)
    if kind == "builtins.EOFError" and "reading a line" not in text:
        return ""
    if kind in _BY_KIND:
        return _BY_KIND[kind]
    if kind == "io.UnsupportedOperation" and text == "fileno":
        return KEYS
    return SCREEN if any(words in text for words in _SCREEN_WORDS) else ""
