"""What Tab offers in a command: verbs, options, and what its arguments may be."""

from __future__ import annotations

import argparse
import re
from collections.abc import Callable, Iterable, Sequence
from contextlib import redirect_stdout
from io import StringIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

import yaml
from IPython.core.completer import CompletionContext, SimpleCompletion, SimpleMatcherResult, context_matcher

from .. import launching
from ..idl.names import is_hidden
from ..idl.registry import registry
from ..runtime.world import current_world
from .cells import COMMANDS, inner_places
from .group_pkg import package_names
from .jobs import jobs
from .run_command import GROUPS
from .script import Operator, UnfinishedError, Word, tokens
from .typed_values import interface_names
from .verb import Verb, absolute

if TYPE_CHECKING:
    from ..runtime.world import World


def complete(world: World, line: str) -> list[str]:
    """The words that the last, unfinished word of a line may become, sorted; `line` ends at the cursor."""
    try:
        found = tokens(line)
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
        packages = {path.parent.name for path in Path("src").glob("**/package.xml")}
        options = ["--packages-select", "--symlink-install", "--event-handlers", *packages]
        return options if rest else ["build", "list"]
    if program in {"jobs", "pwd"}:
        return []
    if program == "kill":
        return ["-INT", "-TERM", "-KILL", *(f"%{job.number}" for job in jobs(world).running)]
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
    if action.choices is not None:
        return [str(choice) for choice in action.choices]
    find = BY_NAME.get(action.dest)
    return [] if find is None else find(world, given, begun)


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
    command = next((line[at:] for at in (0, *inner_places(line)) if _COMMAND.match(line[at:])), None)
    if command is None:
        return {"completions": []}
    command = command.strip(" \t%").removeprefix("terminal ") + " " * command[-1:].isspace()
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

Finder = Callable[["World", Sequence[str], str], Iterable[str]]

FEEDBACK = "/_action/feedback"
"""What an action's topic of feedback is called behind the action's own name."""


def _types(*folders: str) -> Finder:
    def find(world: World, given: Sequence[str], begun: str) -> list[str]:
        own = _own_type(world, given[0]) if given else []
        return own or [name for name in interface_names() if name.split("/")[1] in folders]

    return find


def _own_type(world: World, name: str) -> list[str]:
    """The type of a topic, action or service that is there."""
    topic = world.graph.topics().get(name)
    if topic is not None:
        return topic.types
    feedback = world.graph.topics().get(f"{name}{FEEDBACK}")
    if feedback is not None:
        return [each.removesuffix("_FeedbackMessage") for each in feedback.types]
    return world.graph.services().get(name, [])


def _executables(world: World, given: Sequence[str], begun: str) -> list[str]:
    return sorted(world.packages.get(given[0]).executables) if given and given[0] in world.packages else []


def _launch_files(world: World, given: Sequence[str], begun: str) -> list[str]:
    if not given or given[0] not in world.packages:
        return _launch_arguments(world, given, begun)
    return [path.name for path in world.packages.get(given[0]).shared_files("*launch.*")]


def _launch_arguments(world: World, given: Sequence[str], begun: str) -> list[str]:
    """The arguments that a launch file takes and was not given yet: `rate:=`, or with their values if there are few."""
    try:
        is_path = Path(given[0]).is_file()
        path = Path(given[0]) if is_path else launching.find_launch_file(world, *given[:2])
        with redirect_stdout(StringIO()):
            taken = launching.launch_arguments(world, path)
    except Exception:  # a file that is not there, or not finished
        return []
    left = [each for each in taken if not any(word.startswith(f"{each.name}:=") for word in given)]
    return [f"{each.name}:={choice}" for each in left for choice in each.choices or ("",)]


def _parameters(world: World, given: Sequence[str], begun: str) -> list[str]:
    node = _node_of(world, given[0]) if given else None
    return [] if node is None else list(node.list_parameters([], 0).names)


def _value_now(world: World, given: Sequence[str], begun: str) -> list[str]:
    """The value that a parameter has, to be changed."""
    node = _node_of(world, given[0]) if len(given) > 1 else None
    if node is None or not node.has_parameter(given[1]):
        return []
    text = yaml.safe_dump(node.get_parameter(given[1]).value, default_flow_style=True, width=1_000_000)
    text = text.removesuffix("...\n").strip()
    return [f'"{text}"' if " " in text else text]


def _transitions(world: World, given: Sequence[str], begun: str) -> list[str]:
    """The transitions that a managed node can make now."""
    machine = getattr(_node_of(world, given[0]) if given else None, "_state_machine", None)
    return [] if machine is None else [each.label for each in machine.available_transitions]


def _node_of(world: World, name: str) -> Any:
    """The running node of a name. Tab must not let time pass, so it does not ask the node's services, as commands do."""
    from rclpy._state import RclpyState

    for entry in world.graph.nodes:
        context = entry.process.state(RclpyState).context
        for node in context._nodes if context is not None else ():
            if node.get_fully_qualified_name() == absolute(name):
                return node
    return None


def _values_of(world: World, given: Sequence[str], begun: str) -> list[str]:
    """The type that was named, with its default values, to be changed."""
    from rosidl_runtime_py.convert import message_to_yaml

    name = given[1] if len(given) > 1 else ""
    try:
        made = registry.get(name)
        values = yaml.safe_load(message_to_yaml(getattr(made, "Request", getattr(made, "Goal", made))()))
    except Exception:  # a name that is not finished, or a definition that is refused
        return []
    text = yaml.safe_dump(values, default_flow_style=True, sort_keys=False, width=1_000_000)
    return [f'"{text.strip()}"']


_FINDERS: dict[str, Finder] = {
    "action_name": lambda world, given, begun: [
        name.removesuffix(FEEDBACK) for name in world.graph.topics() if name.endswith(FEEDBACK)
    ],
    "action_type": _types("action"),
    "bag_path output parameter_file": lambda world, given, begun: paths(begun),
    "dependencies package_name": lambda world, given, begun: package_names(),
    "destination_directory output_dir": lambda world, given, begun: paths(begun, folders_only=True),
    "executable_name": _executables,
    "launch_arguments": _launch_arguments,
    "launch_file_name": _launch_files,
    "message_type topic_type": _types("msg"),
    "node node_name": lambda world, given, begun: [node.full_name for node in world.graph.nodes if not node.hidden],
    "parameter_name parameter_names": _parameters,
    "service_name": lambda world, given, begun: [name for name in world.graph.services() if not is_hidden(name)],
    "service_type": _types("srv"),
    "topic topic_name topics": lambda world, given, begun: [
        name for name in world.graph.topics() if not is_hidden(name)
    ],
    "transition": _transitions,
    "type": _types("msg", "srv", "action"),
    "value": _value_now,
    "values": _values_of,
}
"""What finds the values of an argument, by the names that such arguments have."""

BY_NAME = {name: find for names, find in _FINDERS.items() for name in names.split()}
