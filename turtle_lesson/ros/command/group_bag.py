"""`ros2 bag record`, `info`, `play` and `reindex`.

There is no recording of the real ones in golden/: arguments, texts and formats are those of ros2bag, rosbag2_transport
and rosbag2_py of Humble and Jazzy, as far as this simulation has them. What goes to stderr there goes to stderr here, and
the exit code after a Ctrl-C is 0, as there: both verbs handle it themselves. There are no keyboard controls.
"""

from __future__ import annotations

import sys
from argparse import REMAINDER, SUPPRESS, ArgumentParser, Namespace
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from turtle_lesson import files
from turtle_lesson.ros.bags import BagError

from .bag_arguments import info_arguments, play_arguments, reader_arguments, record_arguments
from .common import Command, current_process, end_of_stretch, now, remark, stretch_of


def _record(args: Namespace) -> int:
    if problem := _contradiction(args):
        return _error(problem)
    from turtle_lesson.ros.bags.recorder import Selection, checked_names, record
    from turtle_lesson.ros.bags.writer import BagWriter, is_there

    folder = Path(args.output or _name_by_time()).expanduser().absolute()
    say = _logger("rosbag2_recorder")
    seconds = stretch_of(args)
    try:
        names = checked_names(_topics_of(args))
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


def _topics_of(args: Namespace) -> list[str]:
    return [*args.topics, *args.more_topics]


def _contradiction(args: Namespace) -> str:
    """Why these arguments cannot go together, or nothing."""
    topics = _topics_of(args)
    if (args.all and (topics or args.regex)) or (topics and args.regex):
        return "Must specify only one option out of topics, --regex or --all"
    if not (args.all or topics or args.regex):
        return "Invalid choice: Must specify topic(s), --regex or --all"
    if topics and args.exclude:
        return "--exclude argument cannot be used when specifying a list of topics explicitly"
    return ""


def _name_by_time() -> str:
    simulation: Any = current_process().simulation
    from turtle_lesson.ros.core import EPOCH, NANOSECONDS

    moment = datetime.fromtimestamp((EPOCH + simulation.now) // NANOSECONDS, UTC)
    return f"rosbag2_{moment:%Y_%m_%d-%H_%M_%S}"


def _info(args: Namespace) -> int:
    from turtle_lesson.ros.bags.bag import info_text, open_bag

    try:
        bag = open_bag(Path(args.bag_path).expanduser())
    except BagError as error:
        return _error(str(error))
    print("\n".join(topic.name for topic in bag.topics) if args.topic_name else info_text(bag))
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


def _reindex(args: Namespace) -> int:
    from turtle_lesson.ros.bags.bag import METADATA, reindex

    folder = Path(args.bag_path).expanduser()
    if not folder.is_dir():
        return _error("Must specify a bag directory")
    say = _logger("rosbag2_cpp")
    say("INFO", f"Beginning reindexing bag in directory: {args.bag_path}")
    try:
        files.check(folder / METADATA)
        bag = reindex(folder)
    except (BagError, OSError) as error:
        return _error(_reason(error))
    say("INFO", "Reindexing complete.")
    return _error(bag.damage) if bag.damage else 0


def _everything(parser: ArgumentParser) -> None:
    """Take all words as they are, also those that look like options."""
    parser.prefix_chars = ""
    parser.add_argument("words", nargs=REMAINDER, help=SUPPRESS)


def _not_here(verb: str, reason: str) -> Command:
    """A verb of the real tool that is not here."""

    def work(args: Namespace) -> int:
        print(f"ros2 bag {verb}: not available in this simulation: {reason}. A real ROS 2 has it.", file=sys.stderr)
        return 2

    return Command(f"Not available in this simulation: {reason}", _everything, work)


def _logger(name: str) -> Any:
    """What prints a line as the real tool's logger does."""
    from rclpy.logging import get_logger

    logger = get_logger(name)

    def say(severity: str, text: str) -> None:
        if severity == "INFO":
            logger.info(text)
        elif severity == "WARN":  # on a line of its own: a logger's line has one severity forever
            logger.warning(text)
        else:
            logger.error(text)

    return say


def _reason(error: BagError | OSError) -> str:
    if isinstance(error, OSError) and error.strerror:
        return f"{error.filename}: {error.strerror}"
    return str(error)


def _error(text: str) -> int:
    print(f"[ERROR] [ros2bag]: {text}", file=sys.stderr)
    return 1


VERBS: dict[str, Any] = {
    "burst": _not_here("burst", "'ros2 bag play -r' plays as fast as you like"),
    "convert": _not_here("convert", "record again with '-s', while the bag is played"),
    "info": Command("Describe what a bag contains", info_arguments, _info),
    "list": _not_here("list", "there are no plugins; bags are stored as mcap or sqlite3"),
    "play": Command("Publish recorded messages again", play_arguments, _play),
    "record": Command("Record published messages in a bag", record_arguments, _record),
    "reindex": Command("Rebuild a bag's lost metadata.yaml", reader_arguments, _reindex),
}
