"""The arguments of `ros2 bag`.

Spellings of Humble and of later releases are understood (`record /a /b` and `record --topics /a /b`). What only tunes the
real tool is accepted; what would change the result and is not here is refused, with the reason.
"""

from __future__ import annotations

import math
from argparse import SUPPRESS, Action, ArgumentError, ArgumentParser, ArgumentTypeError
from pathlib import Path

from .common import add_duration, frequency

LONGEST = 1e9
"""Seconds of robot time that an argument may say: thirty years; also the fastest and the slowest rate of playing."""


def existing_path(text: str) -> str:
    """An argument that names a file or folder which is there."""
    if not _exists(Path(text)):
        raise ArgumentTypeError(f"Bag path '{text}' does not exist!{_bags_here(text)}")
    return text


def _exists(path: Path) -> bool:
    try:
        return path.expanduser().exists()
    except (OSError, ValueError, RuntimeError):
        return False  # no path at all: far too long, or with a zero byte in it


def _bags_here(text: str) -> str:
    """What perhaps was meant: the bags beside the one that is not there."""
    from turtle_lesson.ros.interfaces.names import did_you_mean

    try:
        folder = Path(text).expanduser().parent
        bags = [path.parent.name for path in folder.glob("*/metadata.yaml")]
    except (OSError, ValueError):
        return ""
    hint = did_you_mean(Path(text).expanduser().name, bags)
    return f" {hint}" if hint else ""


def positive_rate(text: str) -> float:
    """An argument that is a number above 0."""
    value = _number(text)
    if not value > 0:
        raise ArgumentTypeError(f"{text} is not in the valid range (> 0.0)")
    if value < 1 / LONGEST:
        raise ArgumentTypeError(f"{text} is too slow to wait for")
    return value


def not_negative(text: str) -> float:
    """An argument that is a number, 0 or above."""
    value = _number(text)
    if not value >= 0:
        raise ArgumentTypeError(f"{text} is not in the valid range (>= 0.0)")
    return value


def _number(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise ArgumentTypeError(f"{text} is not the valid type (float)")
    if abs(value) > LONGEST:
        raise ArgumentTypeError(f"{text} is too much: at most {LONGEST:.0e}")
    return value


class _Refused(Action):
    """An option of the real tool that is not here; `const` says why."""

    def __call__(self, parser: ArgumentParser, *_: object) -> None:
        raise ArgumentError(self, f"not available in this simulation: {self.const}. A real ROS 2 has it.")


def _refuse(parser: ArgumentParser, reason: str, *options: str) -> None:
    for names in options:
        parser.add_argument(*names.split(), action=_Refused, nargs="?", const=reason, help=SUPPRESS)


def _accept(parser: ArgumentParser, *options: str) -> None:
    """Options with a number that tunes the real tool, and changes nothing in what it does."""
    for option in options:
        parser.add_argument(option, type=int, metavar="N", help=SUPPRESS)


def reader_arguments(parser: ArgumentParser) -> None:
    """Arguments of every verb that reads a bag."""
    parser.add_argument("bag_path", type=existing_path, help="The bag: its folder, or one of its files")
    parser.add_argument(
        "-s", "--storage", choices=["mcap", "sqlite3"], help="Accepted; the storage is recognised from the bag's files"
    )


def record_arguments(parser: ArgumentParser) -> None:
    """Arguments of `ros2 bag record`."""
    add = parser.add_argument
    add("topics", nargs="*", default=[], help="The topics to record")
    add(
        "--topics",
        dest="more_topics",
        nargs="+",
        default=[],
        metavar="topic",
        help="The same, as newer releases spell it",
    )
    add("-a", "--all", "--all-topics", action="store_true", help="Record all topics but the hidden ones")
    add("-e", "--regex", default="", help="Record the topics that match this pattern")
    add("-x", "--exclude", "--exclude-regex", default="", help="Leave out the topics that match this pattern")
    add("--include-hidden-topics", action="store_true", help="Also record topics with a hidden name")
    add("--include-unpublished-topics", action="store_true", help="Also note topics without publishers")
    add("-o", "--output", help="Folder to create (default: named after the date and time)")
    add("-s", "--storage", default="mcap", choices=["mcap", "sqlite3"], help="Storage format of the bag")
    add_duration(parser)
    _accept(parser, "--max-cache-size", "--polling-interval", "--compression-queue-size", "--compression-threads")
    add("--disable-keyboard-controls", action="store_true", help=SUPPRESS)
    add("--use-sim-time", action="store_true", help=SUPPRESS)
    _refuse(parser, "a bag is one file here", "-b --max-bag-size", "-d --max-bag-duration", "--max-splits")
    _refuse(parser, "a bag is not compressed here", "--compression-mode", "--compression-format")
    _refuse(parser, "a bag is always written in the same way", "--storage-preset-profile", "--storage-config-file")
    _refuse(
        parser, "the recorder requests the quality of service that the publishers offer", "--qos-profile-overrides-path"
    )
    _refuse(parser, "a topic is recorded whenever it appears", "--no-discovery", "--ignore-leaf-topics")
    _refuse(parser, "there is no key to press to continue", "--start-paused", "--snapshot-mode")
    _refuse(
        parser, "a bag holds what is published on topics", "--services", "--all-services", "--actions", "--all-actions"
    )


def play_arguments(parser: ArgumentParser) -> None:
    """Arguments of `ros2 bag play`."""
    add = parser.add_argument
    reader_arguments(parser)
    add("-r", "--rate", type=positive_rate, default=1.0, help="How many times as fast as recorded")
    add("--topics", nargs="+", default=[], help="Play only these topics")
    add("-m", "--remap", nargs="+", default=[], help="Other names for topics: /old:=/new ...")
    add("-l", "--loop", action="store_true", help="Start over at the end")
    add("-d", "--delay", type=not_negative, default=0.0, help="Seconds to wait before the first message (each time)")
    add("--start-offset", type=not_negative, default=0.0, help="Start this many seconds into the bag")
    add("--playback-duration", type=_number, default=-1.0, help="Play only this many seconds of the bag")
    add(
        "--clock",
        type=frequency,
        nargs="?",
        const=40.0,
        default=0.0,
        help="Publish the bag's time on /clock this many times a second (default: never; without a number: 40)",
    )
    add("--disable-keyboard-controls", action="store_true", help="Accepted; there are none here")
    add_duration(parser)
    _accept(parser, "--read-ahead-queue-size")
    _refuse(parser, "there is no key to press to continue", "-p --start-paused")
    _refuse(parser, "the player offers what was recorded", "--qos-profile-overrides-path")
    _refuse(parser, "a bag is always read in the same way", "--storage-config-file")
    _refuse(parser, "say how far to play with --playback-duration", "--playback-until-sec", "--playback-until-nsec")


def info_arguments(parser: ArgumentParser) -> None:
    """Arguments of `ros2 bag info`."""
    reader_arguments(parser)
    parser.add_argument("-t", "--topic-name", action="store_true", help="Print only the names of the topics")
    _refuse(parser, "there are no further details of a bag", "-v --verbose", "--sort")
