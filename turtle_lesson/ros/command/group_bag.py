"""`ros2 bag record`, `info` and `play`.

There is no recording of the real ones in golden/: arguments, texts and formats are those of ros2bag, rosbag2_transport
and rosbag2_py of Humble and Jazzy, as far as this classroom has them. What goes to stderr there goes to stderr here, and
the exit code after a Ctrl-C is 0, as there: both verbs handle it themselves. Keyboard controls and `--clock` are left out.
"""

from __future__ import annotations

import math
import sys
from argparse import ArgumentParser, ArgumentTypeError, Namespace
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from turtle_lesson.ros.bags.errors import BagError

from .common import Command, add_duration, current_process, end_of_stretch, now, stretch_of

# -- arguments ---------------------------------------------------------------------------------------------------------


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
    return value


def _add_reader(parser: ArgumentParser) -> None:
    parser.add_argument("bag_path", type=existing_path, help="The bag: its folder, or one of its files")
    parser.add_argument(
        "-s", "--storage", choices=["mcap", "sqlite3"], help="Accepted; how a bag is stored is seen from its files"
    )


def _record_arguments(parser: ArgumentParser) -> None:
    parser.add_argument("topics", nargs="*", default=None, help="The topics to record")
    parser.add_argument("-a", "--all", action="store_true", help="Record all topics but the hidden ones")
    parser.add_argument("-e", "--regex", default="", help="Record the topics that this pattern is found in")
    parser.add_argument("-x", "--exclude", default="", help="Leave out the topics that this pattern is found in")
    parser.add_argument("--include-hidden-topics", action="store_true", help="Record topics with a hidden name, too")
    parser.add_argument("--include-unpublished-topics", action="store_true", help="Note topics without publishers, too")
    parser.add_argument("-o", "--output", help="The folder to make (default: named after day and time)")
    parser.add_argument("-s", "--storage", default="mcap", choices=["mcap", "sqlite3"], help="How to store it")
    add_duration(parser)


def _play_arguments(parser: ArgumentParser) -> None:
    _add_reader(parser)
    parser.add_argument("-r", "--rate", type=positive_rate, default=1.0, help="How many times as fast as recorded")
    parser.add_argument("--topics", nargs="+", default=[], help="Play these topics only")
    parser.add_argument("-m", "--remap", nargs="+", default=[], help="Other names for topics: /old:=/new ...")
    parser.add_argument("-l", "--loop", action="store_true", help="Begin again at the end")
    parser.add_argument(
        "-d", "--delay", type=not_negative, default=0.0, help="Seconds to wait before the first message"
    )
    parser.add_argument("--start-offset", type=not_negative, default=0.0, help="Begin so many seconds into the bag")
    parser.add_argument("--playback-duration", type=_number, default=-1.0, help="Play so many seconds of the bag only")
    parser.add_argument("--disable-keyboard-controls", action="store_true", help="Accepted; there are none here")
    add_duration(parser)


# -- what the verbs do -------------------------------------------------------------------------------------------------


def _record(args: Namespace) -> int:
    if problem := _contradiction(args):
        return _error(problem)
    from turtle_lesson.ros.bags.recorder import Selection, checked_names, record
    from turtle_lesson.ros.bags.writer import BagWriter

    folder = Path(args.output or _name_by_time()).expanduser()
    say = _logger("rosbag2_recorder")
    seconds = stretch_of(args)
    try:
        names = checked_names(args.topics or ())
        selection = Selection(
            names, args.regex, args.exclude, args.include_hidden_topics, args.include_unpublished_topics
        )
        bag = BagWriter(folder.absolute(), args.storage)
    except BagError as error:
        return _error(str(error).replace(str(folder.absolute()), args.output or folder.name))
    if args.storage == "sqlite3":
        _logger("rosbag2_storage")(
            "INFO", f"Opened database '{args.output or folder.name}/{bag.file.name}' for READ_WRITE."
        )
    say("INFO", "Listening for topics...")
    began = now()
    recorder = record(bag, selection, say, seconds)
    for sentence in recorder.silent():
        say("WARN", sentence)
    say("INFO", "Recording stopped")
    if seconds is not None and now() >= began + seconds and args.seconds is None:
        print(end_of_stretch(seconds), file=sys.stderr)
    return 0


def _contradiction(args: Namespace) -> str:
    """Why these arguments cannot go together, or nothing."""
    if (args.all and (args.topics or args.regex)) or (args.topics and args.regex):
        return "Must specify only one option out of topics, --regex or --all"
    if not (args.all or args.topics or args.regex):
        return "Invalid choice: Must specify topic(s), --regex or --all"
    if args.topics and args.exclude:
        return "--exclude argument cannot be used when specifying a list of topics explicitly"
    return ""


def _name_by_time() -> str:
    simulation: Any = current_process().simulation
    from turtle_lesson.ros.core import EPOCH, NANOSECONDS

    moment = datetime.fromtimestamp((EPOCH + simulation.now) // NANOSECONDS, UTC)
    return f"rosbag2_{moment:%Y_%m_%d-%H_%M_%S}"


def _info(args: Namespace) -> int:
    from turtle_lesson.ros.bags.bag import open_bag
    from turtle_lesson.ros.bags.text import info_text

    try:
        bag = open_bag(Path(args.bag_path).expanduser())
    except BagError as error:
        return _error(str(error))
    print(info_text(bag))
    return _error(bag.damage) if bag.damage else 0


def _play(args: Namespace) -> int:
    from turtle_lesson.ros.bags.bag import open_bag
    from turtle_lesson.ros.bags.player import Playback, parse_remaps, play

    say = _logger("rosbag2_player")
    seconds = stretch_of(args) if args.loop else args.seconds
    try:
        bag = open_bag(Path(args.bag_path).expanduser())
        how = Playback(
            rate=args.rate,
            start_offset=args.start_offset,
            topics=tuple(name if name.startswith("/") else f"/{name}" for name in args.topics),
            remaps=parse_remaps(args.remap),
            loop=args.loop,
            delay=args.delay,
            duration=args.playback_duration if args.playback_duration >= 0 else None,
        )
        if bag.damage:
            say("ERROR", bag.damage)
        if bag.storage == "sqlite3":
            text = f"Opened database '{args.bag_path}/{bag.files[0].name}' for READ_ONLY."
            _logger("rosbag2_storage")("INFO", text)
        say("INFO", f"Set rate to {args.rate:g}")
        ended = play(bag, how, say, seconds)
    except BagError as error:
        return _error(str(error))
    if not ended and seconds is not None and args.seconds is None:
        print(end_of_stretch(seconds), file=sys.stderr)
    return 1 if bag.damage else 0


def _logger(name: str) -> Any:
    """What prints a line as the real tool's logger does."""
    from rclpy.logging import get_logger

    logger = get_logger(name)

    def say(severity: str, text: str) -> None:
        if severity == "INFO":
            logger.info(text)
        elif severity == "WARN":  # on a line of its own: a logger's line has one severity for ever
            logger.warning(text)
        else:
            logger.error(text)

    return say


def _error(text: str) -> int:
    print(f"[ERROR] [ros2bag]: {text}", file=sys.stderr)
    return 1


VERBS: dict[str, Any] = {
    "info": Command("Say what is in a bag", _add_reader, _info),
    "play": Command("Publish again what was recorded", _play_arguments, _play),
    "record": Command("Write what is published into a bag", _record_arguments, _record),
}
