"""`ros2 bag record`, `info` and `play`.

There is no recording of the real ones in golden/: arguments, texts and formats are those of ros2bag, rosbag2_transport
and rosbag2_py of Humble and Jazzy, as far as this simulation has them. What goes to stderr there goes to stderr here, and
the exit code after a Ctrl-C is 0, as there: both verbs handle it themselves. There are no keyboard controls.
"""

from __future__ import annotations

import sys
from argparse import REMAINDER, SUPPRESS, Action, ArgumentError, ArgumentParser, ArgumentTypeError, Namespace
from contextlib import suppress
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from ..bags import BagError
from ..idl.names import did_you_mean
from ..runtime import files
from ..runtime.world import current_process
from .arguments import Argument, arg, duration, flag, frequency, number
from .verb import end_of_stretch, now, remark, stretch_of, verb

# -- arguments ---------------------------------------------------------------------------------------------------------
# Spellings of Humble and of later releases are understood (`record /a /b` and `record --topics /a /b`). What only
# tunes the real tool is accepted; what would change the result and is not here is refused, with the reason.

LONGEST = 1e9
"""Seconds of robot time that an argument may say: thirty years; also the fastest and the slowest rate of playing."""


def existing_path(text: str) -> str:
    """An argument that names a file or folder which is there."""
    with suppress(OSError, ValueError, RuntimeError):  # no path at all: far too long, or with a zero byte in it
        if Path(text).expanduser().exists():
            return text
    hint = ""
    with suppress(OSError, ValueError):
        path = Path(text).expanduser()
        hint = did_you_mean(path.name, [bag.parent.name for bag in path.parent.glob("*/metadata.yaml")])
    raise ArgumentTypeError(f"Bag path '{text}' does not exist! {hint}".rstrip())


def finite(text: str) -> float:
    """An argument that is a number."""
    value = number(text)
    if value != value:
        raise ArgumentTypeError(f"{text} is not the valid type (float)")
    if abs(value) > LONGEST:
        raise ArgumentTypeError(f"{text} is too much: at most {LONGEST:.0e}")
    return value


def positive_rate(text: str) -> float:
    """An argument that is a number above 0."""
    if not finite(text) > 0:
        raise ArgumentTypeError(f"{text} is not in the valid range (> 0.0)")
    if finite(text) < 1 / LONGEST:
        raise ArgumentTypeError(f"{text} is too slow to wait for")
    return finite(text)


def not_negative(text: str) -> float:
    """An argument that is a number, 0 or above."""
    if not finite(text) >= 0:
        raise ArgumentTypeError(f"{text} is not in the valid range (>= 0.0)")
    return finite(text)


class _Refused(Action):
    """An option of the real tool that is not here; `const` says why."""

    def __call__(self, parser: ArgumentParser, *_: object) -> None:
        raise ArgumentError(self, f"not available in this simulation: {self.const}. A real ROS 2 has it.")


def _refuse(reason: str, *options: str) -> tuple[Argument, ...]:
    return tuple(arg(names, SUPPRESS, action=_Refused, nargs="?", const=reason) for names in options)


def _accept(*options: str) -> tuple[Argument, ...]:
    """Options with a number that tunes the real tool, and changes nothing in what it does."""
    return tuple(arg(option, SUPPRESS, type=int, metavar="N") for option in options)


STORAGES = ["mcap", "sqlite3"]
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
    flag("--include-unpublished-topics", "Also note topics without publishers"),
    arg("-o --output", "Folder to create (default: named after the date and time)"),
    arg("-s --storage", "Storage format of the bag", default="mcap", choices=STORAGES),
    duration(),
    *_accept("--max-cache-size", "--polling-interval", "--compression-queue-size", "--compression-threads"),
    flag("--disable-keyboard-controls", SUPPRESS),
    flag("--use-sim-time", SUPPRESS),
    *_refuse("a bag is one file here", "-b --max-bag-size", "-d --max-bag-duration", "--max-splits"),
    *_refuse("a bag is not compressed here", "--compression-mode", "--compression-format"),
    *_refuse("a bag is always written in the same way", "--storage-preset-profile", "--storage-config-file"),
    *_refuse("the recorder requests the quality of service that the publishers offer", "--qos-profile-overrides-path"),
    *_refuse("a topic is recorded whenever it appears", "--no-discovery", "--ignore-leaf-topics"),
    *_refuse("there is no key to press to continue", "--start-paused", "--snapshot-mode"),
    *_refuse("a bag holds what is published on topics", "--services", "--all-services", "--actions", "--all-actions"),
)
def _record(args: Namespace) -> int:
    """Record published messages in a bag."""
    if problem := _contradiction(args):
        return _error(problem)
    from ..bags.recorder import Selection, checked_names, record
    from ..bags.writer import BagWriter, is_there

    folder = Path(args.output or _name_by_time()).expanduser().absolute()
    say = _logger("rosbag2_recorder")
    seconds = stretch_of(args)
    try:
        names = checked_names([*args.topics, *args.more_topics])
        selection = Selection(
            names, args.regex, args.exclude, args.include_hidden_topics, args.include_unpublished_topics
        )
        bag = BagWriter(folder if is_there(folder) else files.check(folder), args.storage)
    except (BagError, OSError) as error:
        return _error(_reason(error).replace(str(folder), args.output or folder.name))
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
        remark(str(end_of_stretch(seconds)))
    return 0


def _contradiction(args: Namespace) -> str:
    """Why these arguments cannot go together, or nothing."""
    topics = [*args.topics, *args.more_topics]
    if (args.all and (topics or args.regex)) or (topics and args.regex):
        return "Must specify only one option out of topics, --regex or --all"
    if not (args.all or topics or args.regex):
        return "Invalid choice: Must specify topic(s), --regex or --all"
    if topics and args.exclude:
        return "--exclude argument cannot be used when specifying a list of topics explicitly"
    return ""


def _name_by_time() -> str:
    simulation: Any = current_process().simulation
    from ..sim.simulation import EPOCH, NANOSECONDS

    moment = datetime.fromtimestamp((EPOCH + simulation.now) // NANOSECONDS, UTC)
    return f"rosbag2_{moment:%Y_%m_%d-%H_%M_%S}"


@verb(
    "bag info",
    *READER,
    flag("-t --topic-name", "Print only the names of the topics"),
    *_refuse("there are no further details of a bag", "-v --verbose", "--sort"),
)
def _info(args: Namespace) -> int:
    """Describe what a bag contains."""
    from ..bags.bag import info_text, open_bag

    try:
        bag = open_bag(Path(args.bag_path).expanduser())
    except BagError as error:
        return _error(str(error))
    print("\n".join(topic.name for topic in bag.topics) if args.topic_name else info_text(bag))
    return _error(bag.damage) if bag.damage else 0


@verb(
    "bag play",
    *READER,
    arg("-r --rate", "How many times as fast as recorded", type=positive_rate, default=1.0),
    arg("--topics", "Play only these topics", nargs="+", default=[]),
    arg("-m --remap", "Other names for topics: /old:=/new ...", nargs="+", default=[]),
    flag("-l --loop", "Start over at the end"),
    arg("-d --delay", "Seconds to wait before the first message (each time)", type=not_negative, default=0.0),
    arg("--start-offset", "Start this many seconds into the bag", type=not_negative, default=0.0),
    arg("--playback-duration", "Play only this many seconds of the bag", type=finite, default=-1.0),
    arg(
        "--clock",
        "Publish the bag's time on /clock this many times a second (default: never; without a number: 40)",
        type=frequency,
        nargs="?",
        const=40.0,
        default=0.0,
    ),
    flag("--disable-keyboard-controls", "Accepted; there are none here"),
    duration(),
    *_accept("--read-ahead-queue-size"),
    *_refuse("there is no key to press to continue", "-p --start-paused"),
    *_refuse("the player offers what was recorded", "--qos-profile-overrides-path"),
    *_refuse("a bag is always read in the same way", "--storage-config-file"),
    *_refuse("say how far to play with --playback-duration", "--playback-until-sec", "--playback-until-nsec"),
)
def _play(args: Namespace) -> int:
    """Publish recorded messages again."""
    from ..bags.bag import open_bag
    from ..bags.player import Playback, parse_remaps, play

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
            clock=args.clock,
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
        remark(str(end_of_stretch(seconds)))
    return 1 if bag.damage else 0


def _all_words(parser: ArgumentParser) -> None:
    """Take all words as they are, also those that look like options."""
    parser.prefix_chars = ""
    parser.add_argument("words", nargs=REMAINDER, help=SUPPRESS)


def _not_here(name: str, reason: str) -> None:
    """Add a verb of the real tool that is not here."""

    @verb(f"bag {name}", _all_words, help_text=f"Not available in this simulation: {reason}")
    def work(args: Namespace) -> int:
        print(f"ros2 bag {name}: not available in this simulation: {reason}. A real ROS 2 has it.", file=sys.stderr)
        return 2


_not_here("burst", "'ros2 bag play -r' plays as fast as you like")
_not_here("convert", "record again with '-s', while the bag is played")
_not_here("list", "there are no plugins; bags are stored as mcap or sqlite3")
_not_here("reindex", "a bag without metadata.yaml is read all the same")


def _logger(name: str) -> Any:
    """What prints a line as the real tool's logger does."""
    from rclpy.logging import get_logger

    logger = get_logger(name)
    # each on a line of its own: a logger's line has one severity forever
    methods = {
        "INFO": lambda text: logger.info(text),
        "WARN": lambda text: logger.warning(text),
        "ERROR": lambda text: logger.error(text),
    }
    return lambda severity, text: methods[severity](text)


def _reason(error: BagError | OSError) -> str:
    if isinstance(error, OSError) and error.strerror:
        return f"{error.filename}: {error.strerror}"
    return str(error)


def _error(text: str) -> int:
    print(f"[ERROR] [ros2bag]: {text}", file=sys.stderr)
    return 1
