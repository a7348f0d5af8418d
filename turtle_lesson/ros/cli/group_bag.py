"""`ros2 bag record`, `info` and `play`.

There is no recording of the real ones: arguments, texts and formats are those of ros2bag, rosbag2_transport and rosbag2_py
of Humble and Jazzy, as far as this simulation has them. What goes to stderr there goes to stderr here, and the exit code
after a Ctrl-C is 0, as there: both verbs handle it themselves. There are no keyboard controls.
"""

from __future__ import annotations

import os
from argparse import ArgumentTypeError, Namespace
from collections.abc import Callable
from datetime import UTC, datetime
from pathlib import Path

from rclpy.logging import get_logger

from ..bags import BagError
from ..bags.bag import info_text, open_bag
from ..bags.player import Playback, parse_remaps, play
from ..bags.recorder import Selection, checked_names, record
from ..bags.writer import STORAGES, BagWriter
from ..runtime import files
from ..runtime.world import current_process
from ..sim.simulation import EPOCH, NANOSECONDS
from .arguments import arg, bounded, duration, flag
from .verb import CommandError, end_of_stretch, now, remark, stretch_of, verb

# -- arguments ---------------------------------------------------------------------------------------------------------
# Spellings of Humble and of later releases are understood (`record /a /b` and `record --topics /a /b`). Of the real
# tool's options those are here that change what is recorded or played; --storage is for bags that others read.

LONGEST = 1e9
"""Seconds of robot time that an argument may say: thirty years; also the fastest and the slowest rate of playing."""

_at_least_0 = bounded("float", 0.0, LONGEST)
_rate = bounded("positive_float", 1 / LONGEST, LONGEST)


def existing_path(text: str) -> str:
    """An argument that names a file or folder which is there."""
    if os.path.exists(os.path.expanduser(text)):
        return text
    raise ArgumentTypeError(f"Bag path '{text}' does not exist!")


READER = (
    arg("bag_path", "The bag: its folder, or one of its files", type=existing_path),
    arg("-s --storage", "Accepted; the storage is recognised from the bag's files", choices=STORAGES),
)
"""Arguments of every verb that reads a bag."""


@verb(
    "bag record",
    arg("topics", "The topics to record", nargs="*", default=[]),
    arg("--topics", "The same, as newer releases spell it", dest="more_topics", nargs="+", default=[], metavar="topic"),
    flag("-a --all --all-topics", "Record all topics but the hidden ones"),
    arg("-e --regex", "Record the topics that match this pattern", default=""),
    arg("-x --exclude --exclude-regex", "Leave out the topics that match this pattern", default=""),
    flag("--include-hidden-topics", "Also record topics with a hidden name"),
    arg("-o --output", "Folder to create (default: named after the date and time)"),
    arg("-s --storage", "Storage format of the bag", default="mcap", choices=STORAGES),
    duration(),
)
def _record(args: Namespace) -> None:
    """Record published messages in a bag."""
    topics = [*args.topics, *args.more_topics]
    if bool(args.all) + bool(topics) + bool(args.regex) > 1:
        raise _error("Must specify only one option out of topics, --regex or --all")
    if not (args.all or topics or args.regex):
        raise _error("Invalid choice: Must specify topic(s), --regex or --all")
    if topics and args.exclude:
        raise _error("--exclude argument cannot be used when specifying a list of topics explicitly")
    moment = datetime.fromtimestamp((EPOCH + current_process().simulation.now) // NANOSECONDS, UTC)
    name = args.output or f"rosbag2_{moment:%Y_%m_%d-%H_%M_%S}"
    folder = Path(name).expanduser().absolute()
    say = _logger("rosbag2_recorder")
    seconds = stretch_of(args)
    try:
        names = checked_names(topics)
        selection = Selection(names, args.regex, args.exclude, args.include_hidden_topics)
        bag = BagWriter(folder if os.path.lexists(folder) else files.check(folder), args.storage)
    except (OSError, ValueError) as error:
        reason = f"{error.filename}: {error.strerror}" if isinstance(error, OSError) else str(error)
        raise _error(reason.replace(str(folder), name)) from None
    say("INFO", "Listening for topics...")
    began = now()
    record(bag, selection, say, seconds)
    say("INFO", "Recording stopped")
    if seconds is not None and now() >= began + seconds and args.seconds is None:
        remark(str(end_of_stretch(seconds)))


@verb("bag info", *READER, flag("-t --topic-name", "Print only the names of the topics"))
def _info(args: Namespace) -> None:
    """Describe what a bag contains."""
    try:
        bag = open_bag(Path(args.bag_path).expanduser())
    except BagError as error:
        raise _error(str(error)) from None
    print("\n".join(topic.name for topic in bag.topics) if args.topic_name else info_text(bag))
    if bag.damage:
        raise _error(bag.damage)


@verb(
    "bag play",
    *READER,
    arg("-r --rate", "How many times as fast as recorded", type=_rate, default=1.0),
    arg("--topics", "Play only these topics", nargs="+", default=[]),
    arg("-m --remap", "Other names for topics: /old:=/new ...", nargs="+", default=[]),
    flag("-l --loop", "Start over at the end"),
    arg("--start-offset", "Start this many seconds into the bag", type=_at_least_0, default=0.0),
    duration(),
)
def _play(args: Namespace) -> int:
    """Publish recorded messages again."""
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
        )
        if bag.damage:
            say("ERROR", bag.damage)
        say("INFO", f"Set rate to {args.rate:g}")
        ended = play(bag, how, say, seconds)
    except BagError as error:
        raise _error(str(error)) from None
    if not ended and seconds is not None and args.seconds is None:
        remark(str(end_of_stretch(seconds)))
    return 1 if bag.damage else 0


def _logger(name: str) -> Callable[[str, str], None]:
    """What prints a line as the real tool's logger does."""
    logger = get_logger(name)

    def say(severity: str, text: str) -> None:
        if severity == "INFO":  # each on a line of its own: a logger's line has one severity forever
            logger.info(text)
        elif severity == "WARN":
            logger.warning(text)
        else:
            logger.error(text)

    return say


def _error(text: str) -> CommandError:
    return CommandError(f"[ERROR] [ros2bag]: {text}")
