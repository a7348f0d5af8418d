"""What Tab offers in a command: verbs, options, and what its arguments may be."""

from __future__ import annotations

import argparse
import re
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import yaml
from IPython.core.completer import CompletionContext, SimpleCompletion, SimpleMatcherResult, context_matcher
from rclpy._state import RclpyState

from ..idl.names import is_hidden
from ..idl.registry import registry
from ..runtime.world import World, current_world
from .cells import COMMANDS
from .group_pkg import package_names
from .run_command import GROUPS
from .script import UnfinishedError, Word, tokens
from .typed_values import interface_names
from .verb import Verb, absolute


def complete(world: World, line: str) -> list[str]:
    """The words that the last, unfinished word of a line may become, sorted; `line` ends at the cursor."""
    try:
        found = tokens(line)
    except UnfinishedError:
        return []
    start = max((place + 1 for place, token in enumerate(found) if isinstance(token, str)), default=0)
    words = [token.text for token in found[start:] if isinstance(token, Word)]
    begun = words.pop() if words and not line[-1:].isspace() else ""
    if not words or words[0] not in COMMANDS:
        return []
    return sorted({each for each in _candidates(world, words, begun) if each.startswith(begun) and each != begun})


def _candidates(world: World, words: list[str], begun: str) -> Iterable[str]:
    program, *rest = words
    if program == "colcon":
        packages = {path.parent.name for path in Path("src").glob("**/package.xml")}
        options = ["--packages-select", "--symlink-install", "--event-handlers", *packages]
        return options if rest else ["build", "list"]
    if program != "ros2":
        return paths(begun, folders_only=program in {"cd", "mkdir"})
    if not rest:
        return [*GROUPS, "--help"]
    group = GROUPS.get(rest[0])
    if group is None:
        return []
    name = "" if "" in group.members else next((word for word in rest[1:] if not word.startswith("-")), None)
    if name is None:
        return [*group.members, "--help", group.flag[0]]
    verb = group.members.get(name)
    return _arguments(world, verb, rest[rest.index(name or rest[0]) + 1 :], begun) if isinstance(verb, Verb) else []


def _arguments(world: World, verb: Verb, words: list[str], begun: str) -> Iterable[str]:
    parser = verb.parser
    given: list[str] = []  # the words that are neither options nor their values
    option: argparse.Action | None = None  # the option that the next word is the value of
    for word in words:
        if word.startswith("-"):
            option = next((each for each in parser.actions if word in each.option_strings and each.nargs != 0), None)
        else:
            given += [word] if option is None else []
            option = None
    places = [action for action in parser.actions if not action.option_strings]
    is_full = len(given) >= len(places) and (not places or places[-1].nargs not in ("*", "+", argparse.REMAINDER))
    if begun.startswith("-") or (option is None and is_full):
        return parser.option_names()
    if option is not None:
        return _values(world, option, words, begun)
    return _values(world, places[min(len(given), len(places) - 1)], given, begun)


def _values(world: World, action: argparse.Action, given: Sequence[str], begun: str) -> Iterable[str]:
    """What an argument may be, behind the words that are `given`."""
    first = given[0] if given else ""
    match action.dest:
        case _ if action.choices is not None:
            return map(str, action.choices)
        case "action_name":
            return [name.removesuffix(FEEDBACK) for name in world.graph.topics() if name.endswith(FEEDBACK)]
        case "service_name":
            return [name for name in world.graph.services() if not is_hidden(name)]
        case "topic" | "topic_name" | "topics":
            return [name for name in world.graph.topics() if not is_hidden(name)]
        case "node" | "node_name":
            return [node.full_name for node in world.graph.nodes if not node.hidden]
        case "action_type" | "message_type" | "service_type" | "topic_type" | "type" as dest:
            folder = {"action_type": "/action/", "service_type": "/srv/", "type": "/"}.get(dest, "/msg/")
            return _own_type(world, first) or [name for name in interface_names() if folder in name]
        case "values" if len(given) > 1:
            return _default_values(given[1])
        case "parameter_name" | "parameter_names":
            return _parameters(world, first)
        case "transition":
            return ("configure", "activate", "deactivate", "cleanup", "shutdown")
        case "dependencies" | "package_name":
            return package_names()
        case "executable_name" if first in world.packages:
            return world.packages.get(first).executables
        case "launch_file_name" if first in world.packages:
            return [path.name for path in world.packages.get(first).shared_files("*launch.*")]
        case "bag_path" | "output" | "parameter_file":
            return paths(begun)
        case "destination_directory" | "output_dir":
            return paths(begun, folders_only=True)
    return ()


def install(shell: Any) -> None:
    """Have Tab in an IPython shell offer these words, and in a command nothing else."""
    matchers = shell.Completer.custom_matchers
    matchers[:] = [each for each in matchers if each is not command_matcher]
    matchers.append(command_matcher)


_COMMAND = re.compile(rf"\s*%?(?:terminal\s+)?(?:{'|'.join(COMMANDS)})\s+(?![-+*/%&|^@]?=)")
"""The beginning of a line with a command's name and a blank, with no `=` or the like after it."""


@context_matcher()
def command_matcher(context: CompletionContext) -> SimpleMatcherResult:
    """What IPython asks of the line at the cursor; a line that is no command is left to Python."""
    above = context.full_text.split("\n")[: context.cursor_line]
    text = "\n".join([*above, context.text_until_cursor.rpartition("\n")[2]])
    line = re.sub(r"\\\n\s*", " ", text).rpartition("\n")[2]
    if not _COMMAND.match(line):
        return {"completions": []}
    command = line.strip(" \t%").removeprefix("terminal ") + " " * line[-1:].isspace()
    begun = "" if command[-1:].isspace() else command.split()[-1]
    found = [SimpleCompletion(text=word, type="command") for word in complete(current_world(), command)]
    return {"completions": found, "suppress": True, "matched_fragment": begun}


def paths(begun: str, *, folders_only: bool = False) -> list[str]:
    """The files and folders that a path may become; hidden ones if its last part begins with a dot."""
    head, slash, last = begun.rpartition("/")
    place = Path(head + slash).expanduser() if slash else Path()
    try:
        found = [path for path in place.iterdir() if path.name.startswith(".") == last.startswith(".")]
    except (OSError, ValueError, RuntimeError):
        return []
    return [f"{head}{slash}{path.name}{'/' * path.is_dir()}" for path in found if path.is_dir() or not folders_only]


# -- names ---------------------------------------------------------------------------------------------------------------

FEEDBACK = "/_action/feedback"
"""What an action's topic of feedback is called behind the action's own name."""


def _own_type(world: World, name: str) -> list[str]:
    """The type of a topic, action or service that is there."""
    topics = world.graph.topics()
    topic = topics.get(name) or topics.get(f"{name}{FEEDBACK}")
    types = topic.types if topic else world.graph.services().get(name, [])
    return [each.removesuffix("_FeedbackMessage") for each in types]


def _parameters(world: World, name: str) -> list[str]:
    """The parameters of a node. Tab must not let time pass, so the node's services are not asked, as commands do."""
    nodes = [node for entry in world.graph.nodes for node in entry.process.state(RclpyState).nodes]
    found = [node for node in nodes if node.get_fully_qualified_name() == absolute(name)]
    return [each for node in found[:1] for each in node.list_parameters([], 0).names]


def _default_values(type_name: str) -> list[str]:
    """A message, request or goal with its default values, to be changed."""
    from rosidl_runtime_py.convert import message_to_yaml

    try:
        made = registry.get(type_name)
        values = yaml.safe_load(message_to_yaml(getattr(made, "Request", getattr(made, "Goal", made))()))
    except Exception:  # a name that is not finished, or a definition that is refused
        return []
    text = yaml.safe_dump(values, default_flow_style=True, sort_keys=False, width=1_000_000)
    return [f'"{text.strip()}"']
