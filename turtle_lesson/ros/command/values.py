"""What is typed as YAML, read safely, and put into the fields of a message."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from .common import CommandError

if TYPE_CHECKING:
    from rclpy.node import Node

MAX_LENGTH = 100_000
"""How many characters of YAML are read at most."""


class NoYaml(CommandError):
    """A text is no YAML that can be read."""


class Unparsable(NoYaml):
    """The brackets, commas or colons of a text make no YAML; `ros2 param set` takes such a text as it is."""


def read_yaml(text: str, what: str = "The passed value") -> Any:
    """The value of a YAML text. Raises NoYaml, in one line, for anything that is none or could be a trap."""
    import yaml

    from ..bounded_yaml import safe_load

    if len(text) > MAX_LENGTH:
        raise NoYaml(f"{what} is too long: at most {MAX_LENGTH} characters of YAML are read")
    try:
        return safe_load(text)
    except yaml.MarkedYAMLError as error:
        kind = Unparsable if isinstance(error, yaml.parser.ParserError) else NoYaml
        raise kind(f"{what} is not valid YAML: {_in_one_line(error)}") from None
    except (yaml.YAMLError, ValueError, OverflowError) as error:
        raise NoYaml(f"{what} is not valid YAML: {' '.join(str(error).split())}") from None


def _in_one_line(error: Any) -> str:
    parts = [part for part in (error.context, error.problem) if part]
    mark = error.problem_mark
    place = f" (line {mark.line + 1}, column {mark.column + 1})" if mark else ""
    return ", ".join(" ".join(part.split()) for part in parts) + place


def populate(message: Any, values: Any) -> list[Callable[[Any], None]]:
    """Set the fields of a message (or request) to values as YAML gives them, or raise CommandError with a sentence.

    Returns:
        Functions that want the time of sending: they set what was typed as `header: auto` or `stamp: now`.
    """
    from rosidl_runtime_py.set_message import set_message_fields

    try:
        return set_message_fields(message, values, expand_header_auto=True, expand_time_now=True)
    except (TypeError, AttributeError, ValueError, AssertionError, OverflowError, RecursionError) as error:
        notes = getattr(error, "__notes__", []) if isinstance(error, (AttributeError, TypeError)) else []
        raise CommandError(f"Failed to populate field: {error}", "\n".join(notes)) from None


def stamp(setters: list[Callable[[Any], None]], node: Node) -> None:
    """Have the stamps that `populate` left open be the time of now."""
    if setters:
        now = node.get_clock().now().to_msg()
        for set_stamp in setters:
            set_stamp(now)
