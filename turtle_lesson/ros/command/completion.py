"""What Tab offers in a command: verbs, options, and what its arguments may be."""

from __future__ import annotations

import argparse
import re
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

from IPython.core.completer import CompletionContext, SimpleCompletion, SimpleMatcherResult, context_matcher

from ..world import current_world
from .cells import COMMANDS, inner_places
from .completion_words import BY_NAME, job_numbers, paths, source_packages
from .groups import GROUPS, Verb
from .parser import Parser, Stop, verb_parser
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
    if program in {"jobs", "pwd"}:
        return []
    if program == "kill":
        return ["-INT", "-TERM", "-KILL", *job_numbers(world)]
    if program != "ros2":
        return paths(begun, folders_only=program in {"cd", "mkdir"})
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
        return ["build", "graph", "list"]
    return ["--packages-select", "--symlink-install", "--event-handlers", *source_packages()]


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
    find = BY_NAME.get(action.dest)
    return [] if find is None else find(world, given, begun)


# -- IPython -------------------------------------------------------------------------------------------------------------


def install(shell: Any) -> None:
    """Have Tab in an IPython shell offer these words, and in a command nothing else."""
    matchers = shell.Completer.custom_matchers
    matchers[:] = [each for each in matchers if each is not command_matcher]
    matchers.append(command_matcher)


@context_matcher()
def command_matcher(context: CompletionContext) -> SimpleMatcherResult:
    """What IPython asks of the line at the cursor; a line that is no command is left to Python."""
    above = context.full_text.split("\n")[: context.cursor_line]
    text = "\n".join([*above, context.text_until_cursor.rpartition("\n")[2]])
    line = re.sub(r"\\\n\s*", " ", text).rpartition("\n")[2]
    command = next((line[at:] for at in (0, *inner_places(line)) if _reads_like_a_command(line[at:])), None)
    if command is None:
        return {"completions": []}
    command = command.strip(" \t%").removeprefix("terminal ") + " " * command[-1:].isspace()
    begun = "" if command[-1:].isspace() else command.split()[-1]
    found = [SimpleCompletion(text=word, type="command") for word in complete(current_world(), command)]
    return {"completions": found, "suppress": True, "matched_fragment": begun}


def _reads_like_a_command(line: str) -> bool:
    """Whether a line begins with a command's name and a blank, with no `=` or the like after it."""
    found = re.match(r"\s*%?(?:terminal\s+)?(\w+)\s+(?![-+*/%&|^@]?=)", line)
    return found is not None and found[1] in COMMANDS
