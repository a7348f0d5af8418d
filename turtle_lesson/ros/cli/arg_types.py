"""Numbers as arguments: times, frequencies and counts, within what makes sense in a simulated world."""

from __future__ import annotations

from argparse import ArgumentTypeError

LONGEST = 86_400.0
"""How long, in s of robot time, a command can be told to go on: a day."""

FASTEST = 10_000.0
"""How often a second a command can be told to do something."""

MOST = 2**31 - 1
"""The greatest whole number that a command takes."""


def positive_float(text: str) -> float:
    """An argument that is a number above 0."""
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 0 < value < float("inf"):
        raise ArgumentTypeError(f"'{text}' is not a number above 0")
    return value


def frequency(text: str) -> float:
    """An argument that says how often a second; more often than `FASTEST` no robot could.

    Anything but a number above 0 is refused in the words that argparse has for ros2topic's `positive_float`.
    """
    try:
        value = positive_float(text)
    except ArgumentTypeError as error:
        raise ArgumentTypeError(f"invalid positive_float value: '{text}'\n{error}") from None
    if value > FASTEST:
        raise ArgumentTypeError(f"'{text}' times a second is too often; at most {FASTEST:g}")
    if value < 1 / LONGEST:
        raise ArgumentTypeError(f"'{text}' times a second is too rare; at least once a day")
    return value


def seconds(text: str) -> float:
    """An argument that is a number of seconds, 0 or more, up to a day."""
    try:
        value = float(text)
    except ValueError:
        value = -1.0
    if not 0 <= value < float("inf"):
        raise ArgumentTypeError(f"'{text}' is not a number of seconds")
    if value > LONGEST:
        raise ArgumentTypeError(f"'{text}' is too long; at most {LONGEST:.0f} s, a day")
    return value


def stretch(text: str) -> float:
    """An argument that is a stretch of time: more than 0 s, up to a day."""
    positive_float(text)
    return seconds(text)


def positive_int(text: str) -> int:
    """An argument that is a whole number above 0."""
    if not text.isdigit() or not text.strip("0"):
        raise ArgumentTypeError("value must be a positive integer")
    return unsigned_int(text)


def unsigned_int(text: str) -> int:
    """An argument that is a whole number, 0 or above."""
    if not (text.isascii() and text.isdigit() and len(text) < 19):
        raise ArgumentTypeError("value must be non-negative integer")
    if int(text) > MOST:
        raise ArgumentTypeError(f"value must be at most {MOST}")
    return int(text)
