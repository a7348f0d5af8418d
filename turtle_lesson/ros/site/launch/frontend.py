"""Launch files that are not Python: from XML or YAML text to actions (facts: launch.frontend of ROS 2 Humble)."""

from __future__ import annotations

import inspect
import re
from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, TextIO, TypeVar, get_args, get_origin

from turtle_lesson.ros.idl.names import did_you_mean

from ._entities import LaunchDescription, Place, Substitution, TextSubstitution, explained

if TYPE_CHECKING:
    from ._entities import Action

__all__ = [
    "Entity",
    "InvalidFrontendLaunchFileError",
    "Parser",
    "expose_action",
    "expose_substitution",
    "parse_if_substitutions",
    "parse_substitution",
]


class InvalidLaunchFileError(Exception):
    """A launch file could not be loaded; the text lists what each loader said."""

    def __init__(self, extension: str = "", *, likely_errors: Sequence[BaseException] | None = None) -> None:
        self.likely_errors = list(likely_errors or [])
        self.extension = extension
        # what the real one prints, without the simulation's hint after it
        said = [KeyError.__str__(each) if isinstance(each, KeyError) else str(each) for each in self.likely_errors]
        text = "The launch file may have a syntax error, or its format is unknown"
        if extension and len(said) == 1:
            text = f"Caught exception when trying to load file of format [{extension}]: {said[0]}"
        elif extension and said:
            lines = [f" - {type(each).__name__}: {words}" for each, words in zip(self.likely_errors, said, strict=True)]
            what = f"Caught multiple exceptions when trying to load file of format [{extension}]:"
            text = "\n".join([what, *lines])
        super().__init__(text)


class InvalidFrontendLaunchFileError(InvalidLaunchFileError):
    """A launch file that is neither XML nor YAML."""


MEANT = {
    "package": "pkg",
    "executable": "exec",
    "type": "exec",
    "ns": "namespace",
    "default_value": "default",
    "value": "default",
    "msg": "message",
    "text": "message",
    "arguments": "args",
    "path": "file",
}
"""What attributes are called in Python launch files or in ROS 1, and what they are called here."""


class Entity:
    """Base of `launch_xml.Entity` and `launch_yaml.Entity`, which say how their text is read.

    What is asked for (`get_attr`, `children`) is remembered, so that what nobody asks for can be refused. `place` is the file
    and line where it is written, if that is known.
    """

    def __init__(
        self, element: Any, type_name: str, *, parent: Entity | None = None, file: str = "", line: int | None = None
    ) -> None:
        self.type_name = type_name
        self.parent = parent
        self._element = element
        self._file: str = file or (parent._file if parent is not None else "")
        self.place: Place | None = (self._file, line) if self._file and line is not None else None
        # What was asked for, and what of it was there: names by what the format calls them, such as `attribute(s)`.
        self._asked: defaultdict[str, set[str]] = defaultdict(set)
        self._read: defaultdict[str, set[str]] = defaultdict(set)

    @property
    def children(self) -> list[Entity]:
        """The entities in it."""
        raise NotImplementedError

    def _given(self) -> dict[str, Mapping[str, Any]]:
        """Everything in it by name, for each kind of names that its format has."""
        raise NotImplementedError

    def _nested(self, name: str, given: Any) -> list[Entity]:
        """The entities of a name."""
        raise NotImplementedError

    def _value(self, name: str, given: Mapping[str, Any], data_type: Any, can_be_str: bool) -> Any:
        """The value of a name. Raises TypeError if it is of another type."""
        raise NotImplementedError

    def assert_entity_completely_parsed(self) -> None:
        """Check that everything in it was asked for. Raises ValueError naming what nobody knows."""
        for kind, given in self._given().items():
            if left := set(given) - self._read[kind]:
                raise self._unexpected(kind, left, self._asked[kind])

    def get_attr(self, name: str, *, data_type: Any = str, optional: bool = False, can_be_str: bool = True) -> Any:
        """An attribute's value, or the nested entities of that name if `data_type` is `List[Entity]`.

        The type is bool, int, float, str, a list of one of these, or None for YAML's rules; with `can_be_str`, text,
        which may have substitutions in it, is as good. Raises AttributeError if it is absent and not optional, and
        TypeError for another type.
        """
        is_nested = check_is_list_entity(data_type)
        kind, given = list(self._given().items())[0 if is_nested else -1]
        self._asked[kind].add(name)
        if name not in given:
            if optional:
                return None
            raise self._absent(name, data_type, given)
        self._read[kind].add(name)
        return self._nested(name, given[name]) if is_nested else self._value(name, given, data_type, can_be_str)

    def _absent(self, name: str, data_type: Any, given: Iterable[Any]) -> AttributeError:
        """The error about an attribute that must be given; what was perhaps given instead is pointed out."""
        error = AttributeError(f"Attribute '{name}' of type '{data_type}' not found in Entity '{self.type_name}'")
        other = next((word for word in given if MEANT.get(word) == name), None)
        hint = f"It is called {name} here, not {other}." if other else f"Give {self.type_name} the attribute {name}."
        return explained(error, hint)

    def _unexpected(self, what: str, names: set[str], known: set[str]) -> ValueError:
        """The error about names that nobody has asked for, with what was perhaps meant."""
        found = sorted(names, key=str)
        error = ValueError(f"Unexpected {what} found in `{self.type_name}`: {{{', '.join(map(repr, found))}}}")
        hints = [f"Did you mean '{MEANT[name]}'?" for name in found if MEANT.get(name) in known]
        hints += [did_you_mean(str(name)[:100], sorted(known)) for name in found]
        takes = f"`{self.type_name}` can have: {', '.join(sorted(known))}." if known else ""
        return explained(error, next(filter(None, hints), takes))


def check_is_list_entity(data_type: Any) -> bool:
    """Whether it is `List[Entity]`, or a list of a subclass."""
    return get_origin(data_type) is list and all(
        isinstance(kind, type) and issubclass(kind, Entity) for kind in get_args(data_type)
    )


Exposed = TypeVar("Exposed")

action_parse_methods: dict[str, Callable[..., Any]] = {}
substitution_parse_methods: dict[str, Callable[..., Any]] = {}

_LOOP = "Loops are not available in XML and YAML files here: write the file in Python, with a loop."
_LOGS = "There are no log files here."
_NOT_HERE = {
    **dict.fromkeys(("for", "for_each", "for-var", "index"), _LOOP),
    **dict.fromkeys(("log_dir", "launch_log_dir", "set_ros_log_dir"), _LOGS),
    "all": "$(all …) is not available here: use $(and …).",
    "any": "$(any …) is not available here: use $(or …).",
    "param": "$(param …) is not available here: use $(var …) of an argument.",
    "lifecycle_transition": "It is not available here: give lifecycle_node the attribute autostart.",
    "string-join": "$(string-join …) is not available here: write the pieces one after the other.",
}
"""What a real launch has and this one does not, with what to do instead."""


def instantiate_action(entity: Entity, parser: Parser) -> Action:
    """The action that an entity stands for.

    Raises RuntimeError if no action has this name; and whatever its `parse` raises, with the place.
    """
    try:
        method = _known(action_parse_methods, entity.type_name, "Unrecognized entity of the type: ")
        action_type, kwargs = method(entity, parser)
        entity.assert_entity_completely_parsed()
        action: Action = action_type(**kwargs)
    except Exception as error:
        explained(error, place=entity.place)
        raise
    action._written_at = entity.place
    return action


def instantiate_substitution(type_name: str, args: Sequence[Any] | None = None) -> Substitution:
    """The substitution that `$(type_name args…)` stands for; each argument is a list of substitutions.

    Raises RuntimeError if no substitution has this name; and whatever its `parse` raises.
    """
    method = _known(substitution_parse_methods, type_name, "Unknown substitution: ")
    substitution_type, kwargs = method([] if args is None else list(args))
    substitution: Substitution = substitution_type(**kwargs)
    return substitution


def _known(methods: dict[str, Callable[..., Any]], name: str, complaint: str) -> Callable[..., Any]:
    if name in methods:
        return methods[name]
    close = did_you_mean(str(name)[:100], sorted(methods)) or f"There are: {', '.join(sorted(methods))}."
    raise explained(RuntimeError(f"{complaint}{name}"), _NOT_HERE.get(name) or close)


def expose_action(name: str) -> Callable[[Exposed], Exposed]:
    """Let a tag of this name stand for an action: decorates its class, which has a class method `parse`."""
    return _exposing(name, action_parse_methods)


def expose_substitution(name: str) -> Callable[[Exposed], Exposed]:
    """Let `$(name …)` stand for a substitution: decorates its class, which has a class method `parse`."""
    return _exposing(name, substitution_parse_methods)


def _exposing(name: str, methods: dict[str, Callable[..., Any]]) -> Callable[[Exposed], Exposed]:
    def expose(exposed: Exposed) -> Exposed:
        method: Any = getattr(exposed, "parse", None) if inspect.isclass(exposed) else exposed
        if inspect.isclass(exposed) and not inspect.ismethod(method):
            raise RuntimeError("Did not find a class method called 'parse' in the class being decorated.")
        methods[name] = method
        return exposed

    return expose


IDENTIFIER = re.compile(r"[A-Za-z][A-Za-z0-9_-]*")


class SubstitutionSyntaxError(ValueError):
    """A text's `$(…)` are not well formed."""


def replace_escaped_characters(data: str) -> str:
    """The text without the backslashes that take a character's meaning away."""
    return re.sub(r"\\(.)", r"\1", data)


def parse_substitution(string_value: str) -> list[Substitution]:
    """The pieces of a text: what is plain, and what stands for something.

    Raises SubstitutionSyntaxError if a `$(` is not closed, or is otherwise wrong.
    """
    if not isinstance(string_value, str):
        raise TypeError(f"expected text, got {string_value!r} of type {type(string_value).__name__}")
    try:
        return _Reader(string_value).template("") or [TextSubstitution(text=string_value)]
    except RecursionError:
        raise SubstitutionSyntaxError("the substitutions are nested too deeply") from None


def parse_if_substitutions(value: Any) -> Any:
    """A value with its texts parsed; text without substitutions stays text, and other values as they are.

    Raises ValueError if the items of a list are of several types.
    """
    kinds: set[type] = set()
    if not isinstance(value, list):
        return _parsed(value, kinds)
    items = [_parsed(item, kinds) for item in value]
    if len(kinds) > 1:
        raise ValueError("The result is a non-uniform list")
    return items


def _parsed(value: Any, kinds: set[type]) -> Any:
    if not isinstance(value, str):
        kinds.add(type(value))
        return value
    pieces = parse_substitution(value)
    if len(pieces) == 1 and isinstance(pieces[0], TextSubstitution):
        kinds.add(str)
        return pieces[0].text
    return pieces


class _Reader:
    """Reads one text from left to right."""

    def __init__(self, text: str) -> None:
        self._text = text
        self._at = 0

    def template(self, quote: str) -> list[Substitution]:
        """Everything up to the closing quote; without one, up to the end."""
        found: list[Substitution] = []
        while self._here and self._here != quote:
            found += [self._substitution(quote)] if self._begins_one else self._plain(quote)
        if quote and not self._here:
            raise self._wrong(f"Close the quotation mark {quote} that begins an argument.")
        return found

    def _plain(self, stop: str, *, argument: bool = False) -> list[Substitution]:
        """Text up to a substitution or a character of `stop`; in an argument spaces and brackets end it, too."""
        stops = f"{stop} ()" if argument else stop
        found = ""
        while self._here and self._here not in stops and not self._begins_one:
            if self._here == "$":
                raise self._wrong(r"A dollar sign that begins no $(…) is written \$.")
            if self._here == "\\":
                self._at += 1
            found += self._here
            self._at += 1
        return [TextSubstitution(text=found)] if found else []

    def _substitution(self, quote: str) -> Substitution:
        begin = self._at
        self._at += 2
        name = IDENTIFIER.match(self._text, self._at)
        if name is None:
            raise self._wrong("After $( comes the name of a substitution, as in $(var rate).")
        self._at = name.end()
        arguments = []
        while self._here == " ":
            self._at += 1
            arguments.append(self._argument(quote))
        if self._here != ")":
            raise self._wrong(f"Is the bracket of {self._text[begin : begin + 20]!r} closed?")
        self._at += 1
        return instantiate_substitution(name[0], arguments)

    def _argument(self, quote: str) -> list[Substitution]:
        if not quote and self._here in {"'", '"'}:
            mark = self._here
            self._at += 1
            inner = self.template(mark)
            self._at += 1
            return inner or [TextSubstitution(text="")]
        found: list[Substitution] = []
        begin = self._at
        while self._here and self._here not in f"{quote or chr(39) + chr(34)} ()":
            found += [self._substitution(quote)] if self._begins_one else self._plain(quote or "'\"", argument=True)
        if self._at == begin:
            raise self._wrong("Separate arguments by one space; put an argument with spaces in quotes.")
        return found or [TextSubstitution(text="")]

    @property
    def _here(self) -> str:
        """The next character, or nothing at the end."""
        return self._text[self._at : self._at + 1]

    @property
    def _begins_one(self) -> bool:
        return self._text.startswith("$(", self._at)

    def _wrong(self, hint: str) -> SubstitutionSyntaxError:
        what = (
            f"No terminal matches {self._here!r} in the current parser context"
            if self._here
            else ("Unexpected end-of-input")
        )
        return explained(SubstitutionSyntaxError(f"{what}, at line 1 col {self._at + 1} of {self._text!r}"), hint)


MOST_ACTIONS = 10_000
"""So many actions may stand in a file; YAML's anchors could make any number of them out of a few lines."""


class Parser:
    """Base of `launch_xml.Parser` and `launch_yaml.Parser`, which say how their text is read."""

    def __init__(self) -> None:
        self._actions = 0
        self.load_launch_extensions()

    @classmethod
    def load(cls, file: str | TextIO) -> tuple[Entity, Parser]:
        """The root entity of a file; in this base by the reader that its ending asks for, or else by any that can read it.

        Raises InvalidFrontendLaunchFileError if none can.
        """
        if isinstance(file, str | Path):
            name, text = str(file), Path(file).read_text(encoding="utf-8-sig")
        else:
            name, text = str(getattr(file, "name", "")), file.read()
        if cls is not Parser:
            return cls.load_text(text, name)
        import launch_xml
        import launch_yaml

        extension = Path(name).suffix.lstrip(".")
        readers: list[type[Parser]] = [launch_xml.Parser, launch_yaml.Parser]
        if extension in ("yaml", "yml"):
            readers.reverse()
        errors = []
        for reader in readers:
            try:
                return reader.load_text(text, name)
            except Exception as error:
                errors.append(error)
        known = extension if extension in ("xml", "yaml", "yml") else ""
        raise InvalidFrontendLaunchFileError(known, likely_errors=errors) from errors[0]

    @classmethod
    def load_text(cls, text: str, name: str) -> tuple[Entity, Parser]:
        """The root entity of a text; `name` is the file's, for messages."""
        raise NotImplementedError(f"{cls.__name__} does not say how to read a launch file")

    @classmethod
    def load_launch_extensions(cls) -> None:
        """Make all actions and substitutions known."""
        import launch_ros  # noqa: F401

    def parse_action(self, entity: Entity) -> Action:
        """The action that an entity stands for."""
        self._actions += 1
        if self._actions > MOST_ACTIONS:
            raise RuntimeError(f"a launch file of more than {MOST_ACTIONS} actions; does it repeat itself?")
        return instantiate_action(entity, self)

    parse_substitution = staticmethod(parse_substitution)
    parse_if_substitutions = staticmethod(parse_if_substitutions)
    escape_characters = staticmethod(replace_escaped_characters)

    def parse_description(self, entity: Entity) -> LaunchDescription:
        """The description that a root entity stands for.

        Raises RuntimeError if the root is not `launch`; and whatever is wrong below it.
        """
        if entity.type_name != "launch":
            raise explained(RuntimeError("Expected 'launch' as root tag"), place=entity.place)
        try:
            deprecated = entity.get_attr("deprecated", optional=True)
            actions = [self.parse_action(child) for child in entity.children]
            entity.assert_entity_completely_parsed()
        except Exception as error:
            explained(error, place=entity.place)
            raise
        return LaunchDescription(actions, deprecated_reason=deprecated)
