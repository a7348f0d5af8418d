"""What Tab offers in a command: verbs, options, and the names of nodes, topics, services, types and packages."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import yaml
from IPython.core.completer import CompletionContext, SimpleCompletion, SimpleMatcherResult, context_matcher

from ..graph.graph import is_hidden
from ..interfaces.registry import registry
from ..world import current_world
from .cells import COMMANDS
from .groups import GROUPS, Verb
from .parser import Parser, Stop, verb_parser
from .text import message_to_yaml
from .words import Operator, UnfinishedError, Word, tokens

if TYPE_CHECKING:
    from ..world import World


def complete(world: World, line: str) -> list[str]:
    """The words that the last, unfinished word of a line may become, sorted; `line` ends at the cursor."""
    try:
        found = list(tokens(line))
    except UnfinishedError:
        return []
    starts = [place + 1 for place, token in enumerate(found) if isinstance(token, Operator)]
    words = [token.text for token in found[starts[-1] if starts else 0 :] if isinstance(token, Word)]
    begun = words.pop() if words and not line[-1:].isspace() else ""
    if not words or words[0] not in COMMANDS:
        return []
    return sorted({each for each in _candidates(world, words, begun) if each.startswith(begun) and each != begun})


def _candidates(world: World, words: list[str], begun: str) -> Iterable[str]:
    program, *rest = words
    if program == "colcon":
        return _colcon(rest)
    if program != "ros2":
        return _paths(begun)
    if not rest:
        return [*GROUPS, "--help"]
    group = GROUPS.get(rest[0])
    if group is None:
        return []
    if group.alone is not None:
        return _arguments(world, group.alone, rest[1:], begun)
    before = [word for word in rest[1:] if not word.startswith("-")]
    if not before:
        return [*group.verbs, "--help", *([group.flag[0]] if group.flag else [])]
    verb = group.verbs.get(before[0])
    return [] if verb is None else _arguments(world, verb, rest[rest.index(before[0]) + 1 :], begun)


def _colcon(words: Sequence[str]) -> list[str]:
    if not words:
        return ["build"]
    return ["--packages-select", "--symlink-install", "--event-handlers", *_source_packages()]


def _source_packages() -> list[str]:
    return sorted({path.parent.name for path in Path("src").glob("*/package.xml")})


def _paths(begun: str) -> list[str]:
    """The files and folders that a path may become."""
    head, slash, _ = begun.rpartition("/")
    place = Path(head + slash) if slash else Path()
    if not place.is_dir():
        return []
    inside = [path for path in place.iterdir() if not path.name.startswith(".")]
    return [f"{head}{slash}{path.name}{'/' if path.is_dir() else ''}" for path in inside]


# -- the arguments of a verb ---------------------------------------------------------------------------------------------


def _arguments(world: World, verb: Verb, words: list[str], begun: str) -> Iterable[str]:
    try:
        parser = verb_parser(verb, "ros2")
    except Stop:
        return []
    if begun.startswith("-"):
        return parser.option_names()
    option = _waiting_option(parser, words)
    if option is not None:
        return _values(world, option, words, begun)
    given = _positional(parser, words)
    places = [action for action in parser.actions if not action.option_strings]
    if not places:
        return parser.option_names()
    place = places[min(len(given), len(places) - 1)]
    if len(given) >= len(places) and place.nargs not in ("*", "+", argparse.REMAINDER):
        return parser.option_names()
    return _values(world, place, given, begun)


def _waiting_option(parser: Parser, words: Sequence[str]) -> argparse.Action | None:
    """The option that the next word is the value of."""
    if not words or not words[-1].startswith("-"):
        return None
    return next((a for a in parser.actions if words[-1] in a.option_strings and a.nargs != 0), None)


def _positional(parser: Parser, words: Sequence[str]) -> list[str]:
    """The words that are neither options nor their values."""
    given: list[str] = []
    for place, word in enumerate(words):
        if not word.startswith("-") and _waiting_option(parser, words[:place]) is None:
            given.append(word)
    return given


def _values(world: World, action: argparse.Action, given: Sequence[str], begun: str) -> Iterable[str]:
    if action.choices is not None:
        return [str(choice) for choice in action.choices]
    find = _BY_NAME.get(action.dest)
    return [] if find is None else find(world, given, begun)


Finder = Callable[["World", Sequence[str], str], Iterable[str]]


def _nodes(world: World, given: Sequence[str], begun: str) -> list[str]:
    return [node.full_name for node in world.graph.nodes if not node.hidden]


def _topics(world: World, given: Sequence[str], begun: str) -> list[str]:
    return [name for name in world.graph.topics() if not is_hidden(name)]


def _services(world: World, given: Sequence[str], begun: str) -> list[str]:
    return [name for name in world.graph.services() if not is_hidden(name)]


def _types(*folders: str) -> Finder:
    def find(world: World, given: Sequence[str], begun: str) -> list[str]:
        own = _own_type(world, given[0]) if given else []
        every = (f"{package}/{name}" for package in registry.packages() for name in registry.interface_names(package))
        return own or [name for name in every if name.split("/")[1] in folders]

    return find


def _own_type(world: World, name: str) -> list[str]:
    """The type of a topic or service that is there."""
    topic = world.graph.topics().get(name)
    if topic is not None:
        return topic.types
    return world.graph.services().get(name, [])


def _packages(world: World, given: Sequence[str], begun: str) -> list[str]:
    from .group_pkg import package_names

    return package_names()


def _executables(world: World, given: Sequence[str], begun: str) -> list[str]:
    return sorted(world.packages.get(given[0]).executables) if given and given[0] in world.packages else []


def _launch_files(world: World, given: Sequence[str], begun: str) -> list[str]:
    if not given or given[0] not in world.packages:
        return _paths(begun)
    return [path.name for path in world.packages.get(given[0]).shared_files("*launch.*")]


def _values_of(world: World, given: Sequence[str], begun: str) -> list[str]:
    """The type that was named, with its default values, to be changed."""
    name = given[1] if len(given) > 1 else ""
    try:
        made = registry.get(name)
        values = yaml.safe_load(message_to_yaml(getattr(made, "Request", made)()))
    except Exception:  # a name that is not finished, or a definition that is refused
        return []
    text = yaml.safe_dump(values, default_flow_style=True, sort_keys=False, width=1_000_000)
    return [f'"{text.strip()}"']


_MESSAGES, _SERVICES, _ALL = _types("msg"), _types("srv"), _types("msg", "srv", "action")

_BY_NAME: dict[str, Finder] = {
    "executable_name": _executables,
    "launch_file_name": _launch_files,
    "message_type": _MESSAGES,
    "node": _nodes,
    "node_name": _nodes,
    "package_name": _packages,
    "service_name": _services,
    "service_type": _SERVICES,
    "topic": _topics,
    "topic_name": _topics,
    "topic_type": _MESSAGES,
    "type": _ALL,
    "values": _values_of,
}


# -- IPython -------------------------------------------------------------------------------------------------------------


def install(shell: Any) -> None:
    """Have Tab in an IPython shell offer these words, and in a command nothing else."""
    matchers = shell.Completer.custom_matchers
    matchers[:] = [each for each in matchers if each is not command_matcher]
    matchers.append(command_matcher)


@context_matcher()
def command_matcher(context: CompletionContext) -> SimpleMatcherResult:
    """What IPython asks of the line at the cursor; a line that is no command is left to Python."""
    line = context.text_until_cursor.rpartition("\n")[2].lstrip().removeprefix("%terminal ").removeprefix("%")
    if not _reads_like_a_command(line):
        return {"completions": []}
    begun = "" if line[-1:].isspace() else line.split()[-1]
    found = [SimpleCompletion(text=word, type="command") for word in complete(current_world(), line)]
    return {"completions": found, "suppress": True, "matched_fragment": begun}


def _reads_like_a_command(line: str) -> bool:
    """Whether a line begins with a command's name and a blank, with no `=` or the like after it."""
    return any(line.startswith(f"{word} ") and not line[len(word) :].lstrip().startswith("=") for word in COMMANDS)
