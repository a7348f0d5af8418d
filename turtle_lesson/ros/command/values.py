"""What is typed as YAML, read safely, and put into the fields of a message.

The rules and sentences are those of rosidl_runtime_py (set_message.py), as recorded from a real one.
"""

from __future__ import annotations

import array
import warnings
from collections.abc import Mapping
from functools import cache
from typing import Any

from turtle_lesson.ros.interfaces.names import did_you_mean

from .common import CommandError

MAX_LENGTH = 100_000
"""How many characters of YAML are read at most."""

MAX_ALIASES = 16
"""How many aliases (`*name`) YAML may have: a text of a few lines with more of them can stand for billions of values."""


class NoYaml(CommandError):
    """A text is no YAML that can be read."""


class Unparsable(NoYaml):
    """The brackets, commas or colons of a text make no YAML; `ros2 param set` takes such a text as it is."""


def read_yaml(text: str, what: str = "The passed value") -> Any:
    """The value of a YAML text. Raises NoYaml, in one line, for anything that is none or could be a trap."""
    import yaml

    if len(text) > MAX_LENGTH:
        raise NoYaml(f"{what} is too long: at most {MAX_LENGTH} characters of YAML are read")
    try:
        return yaml.load(text, _loader())
    except yaml.MarkedYAMLError as error:
        kind = Unparsable if isinstance(error, yaml.parser.ParserError) else NoYaml
        raise kind(f"{what} is no YAML: {_in_one_line(error)}") from None
    except (yaml.YAMLError, ValueError, OverflowError) as error:
        raise NoYaml(f"{what} is no YAML: {' '.join(str(error).split())}") from None
    except RecursionError:
        raise NoYaml(f"{what} is no YAML that can be read: its brackets are nested too deeply") from None


def _in_one_line(error: Any) -> str:
    parts = [part for part in (error.context, error.problem) if part]
    mark = error.problem_mark
    place = f" (line {mark.line + 1}, column {mark.column + 1})" if mark else ""
    return ", ".join(" ".join(part.split()) for part in parts) + place


@cache
def _loader() -> Any:
    import yaml

    class Loader(yaml.SafeLoader):
        """Refuses many aliases, with which a short text can stand for a gigantic value."""

        aliases = 0

        def compose_node(self, parent: Any, index: Any) -> Any:
            if self.check_event(yaml.AliasEvent):
                self.aliases += 1
                if self.aliases > MAX_ALIASES:
                    raise yaml.YAMLError(f"it has more than {MAX_ALIASES} aliases (*{self.peek_event().anchor})")
            return super().compose_node(parent, index)

    return Loader


def fill(message: Any, values: Any) -> None:
    """Set fields of a message (or request) to values as YAML gives them, converted as the real tool does.

    Raises TypeError, AttributeError, ValueError or AssertionError with the real one's sentence; an unknown field's
    error has a hint as a note.
    """
    if not isinstance(values, Mapping):
        raise TypeError(f"Value '{_short(values)}' is expected to be a dictionary but is a {type(values).__name__}")
    kinds = {kind.name: kind for kind in getattr(message, "_KINDS", ())}
    for name, value in values.items():
        if not isinstance(name, str):
            raise TypeError(f"attribute name must be string, not '{type(name).__name__}'")
        if name not in kinds:
            raise _no_such_field(message, name, kinds)
        setattr(message, name, _converted(getattr(message, name), value, kinds[name].element_class))


def _no_such_field(message: Any, name: str, known: Mapping[str, Any]) -> AttributeError:
    error = AttributeError(f"'{type(message).__name__}' object has no attribute '{_short(name)}'")
    hint = did_you_mean(name, known)
    if ":" in name and name.partition(":")[0] in known:
        hint = f"YAML wants a space after the colon: {name.replace(':', ': ', 1)}"
    error.add_note(hint or f"The fields are: {', '.join(known) or 'none'}.")
    return error


def _converted(field: Any, value: Any, element_class: Any) -> Any:
    """What a field that holds `field` now is set to, when YAML says `value`."""
    kind = type(field)
    if kind is array.array:
        return array.array(field.typecode, value)
    if kind.__module__ == "numpy":
        return _numpy(value, field.dtype)
    if element_class is not None and kind is not list:
        fill(field := element_class(), value)
        return field
    if type(value) is kind:
        converted = value
    elif kind is bytes and isinstance(value, int):
        converted = bytes(min(value, 2))  # as many zeros, of which the field takes one
    else:
        converted = _by_type(kind, value)
    if kind is list and element_class is not None:
        return [_element(element_class, each) for each in converted]
    return converted


def _by_type(kind: type, value: Any) -> Any:
    """`kind(value)`; where that is impossible, the real tool takes the field for a message and says so."""
    try:
        return kind(value)
    except TypeError:
        fill(kind(), value)
        raise


def _element(element_class: Any, value: Any) -> Any:
    message = element_class()
    fill(message, value)
    return message


def _numpy(value: Any, dtype: Any) -> Any:
    import numpy

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return numpy.array(value, dtype=dtype)


def _short(value: Any) -> str:
    text = str(value)
    return text if len(text) <= 200 else f"{text[:200]}..."


def populate(message: Any, values: Any) -> None:
    """`fill`, with the sentence that the commands say when it fails."""
    try:
        fill(message, values)
    except (TypeError, AttributeError, ValueError, AssertionError, OverflowError) as error:
        notes = getattr(error, "__notes__", []) if isinstance(error, AttributeError) else []
        raise CommandError(f"Failed to populate field: {error}", "\n".join(notes)) from None
