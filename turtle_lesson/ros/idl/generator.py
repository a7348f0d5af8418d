"""Python classes for interface definitions, as Humble's `rosidl_generator_py` would make them.

The classes are written as source text and executed, which is what makes them fast: each constructor, setter and
copy is straight code for just its fields. The text stays readable in tracebacks and for `inspect.getsource`. Beyond
ROS's classes ours have `_wire_copy()`, which gives what a subscriber on another computer would get.
"""

from __future__ import annotations

import codecs
import linecache
import marshal
import os
import re
import sys
import warnings
from array import array
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import replace
from functools import cache
from hashlib import sha256
from importlib.util import MAGIC_NUMBER
from io import FileIO
from math import inf, isfinite, nan
from pathlib import Path
from struct import Struct
from types import CodeType, ModuleType
from typing import Any

from .. import hooks
from . import message
from .checks import FLOAT_BOUNDS
from .codegen import Kind, kind_of, message_source, weight_of, wrapper_source
from .message import slot_type
from .model import (
    ActionDefinition,
    Constant,
    Definition,
    Field,
    FieldType,
    InvalidDefinition,
    InvalidType,
    InvalidValue,
    MessageDefinition,
    Plain,
    ServiceDefinition,
    Value,
    derived_parts,
)
from .names import STRINGS, check_buildable_field, check_class_name, module_name

Resolve = Callable[[FieldType], type]
"""Gives the class of a field's messages; raises UnknownMessageType where there is none."""

_BUILT_IN = (bool, bytes, classmethod, dict, float, int, isinstance, len, property, range, str, type)
_SHARED = (
    message.message_repr, message.numpy_array, message.numpy_zeros, message.refuse_arguments, message.same_array,
)  # fmt: skip
COMMON: dict[str, Any] = {
    **{f"_{each.__name__}": each for each in (array, *_BUILT_IN, *_SHARED)},
    **{"_inf": inf, "_nan": nan, "_new": object.__new__, "_plain_text": message.plain_text},
}
"""The globals of each generated module."""


def make_module(definition: Definition, resolve: Resolve) -> ModuleType:
    """The module of one interface file, e.g. `geometry_msgs.msg._twist` with the class `Twist`.

    Raises InvalidDefinition where ROS could not generate Python code either.
    """
    builder = _Builder(definition, resolve)
    if isinstance(definition, MessageDefinition):
        builder.add_message(definition)
    elif isinstance(definition, ServiceDefinition):
        builder.add_service(definition)
    else:
        builder.add_action(definition)
    return builder.finish()


class _Builder:
    """Collects the classes of one interface file, each executed as soon as its source is written."""

    def __init__(self, definition: Definition, resolve: Resolve) -> None:
        stem = module_name(definition.name)
        self._module = ModuleType(
            f"{definition.package}.{definition.folder}.{stem}",
            f"Classes generated from {definition.full_name}.",
        )
        self._file = f"generated/{definition.package}/{definition.folder}/{stem}.py"
        self._module.__file__ = self._file
        self._globals = self._module.__dict__
        self._globals.update(COMMON)
        self._source = ""
        self._resolve = resolve

    def add_message(self, definition: MessageDefinition) -> None:
        """Add the class of a message or of a part of a service or action."""
        name = definition.name
        kinds = tuple(self._kind(definition, member) for member in definition.fields)
        try:
            check_class_name(name)
            check_weight(name, weight_of(kinds))
        except InvalidDefinition as error:
            raise error.locate(interface=definition.full_name, file=definition.file) from None
        constants = []
        for constant in definition.constants:
            try:
                constants.append(replace(constant, value=built_value(constant.type, constant.value)))
            except InvalidDefinition as error:
                raise _located(error, definition, constant) from None
        definition = replace(definition, constants=tuple(constants))
        self._globals[f"_kinds_{name}"] = kinds
        self._globals[f"_slot_types_{name}"] = tuple(slot_type(member.type) for member in definition.fields)
        for kind in _with_inner(kinds):
            self._globals.update(kind.objects)
        for kind in kinds:
            if not kind.shares:
                self._globals[f"_unset_{name}_{kind.name}"] = message.Unset(_signature_default(kind))
        if rounded := sum(kind.is_float32 for kind in _with_inner(kinds)):
            packing = Struct(f"{rounded}f")  # rounds them to float32
            self._globals.update({f"_pack_{rounded}": packing.pack, f"_unpack_{rounded}": packing.unpack})
        self._run(definition, message_source(definition, kinds))

    def add_service(self, definition: ServiceDefinition) -> None:
        """Add request, response and the class that holds both."""
        for part in definition.parts():
            self.add_message(part)
        self._add_wrapper(definition, {"Request": definition.request.name, "Response": definition.response.name})

    def add_action(self, definition: ActionDefinition) -> None:
        """Add goal, result, feedback, the class that holds them, and what carries them (`Impl`)."""
        for part in (*definition.parts(), *derived_parts(definition)):
            self.add_message(part)
        name = definition.name
        for service in (f"{name}_SendGoal", f"{name}_GetResult"):
            request, response = (self._globals[f"{service}_{part}"]._DEFINITION for part in ("Request", "Response"))
            carrier = ServiceDefinition(definition.package, service, request, response, "", definition.file, "action")
            self._add_wrapper(carrier, {"Request": request.name, "Response": response.name})
        impl = {
            "SendGoalService": self._globals[f"{name}_SendGoal"],
            "GetResultService": self._globals[f"{name}_GetResult"],
            "FeedbackMessage": self._globals[f"{name}_FeedbackMessage"],
            "CancelGoalService": self._resolve(FieldType("CancelGoal", "action_msgs", folder="srv")),
            "GoalStatusMessage": self._resolve(FieldType("GoalStatusArray", "action_msgs")),
            "__module__": self._module.__name__,
        }
        self._globals[f"_impl_{name}"] = type("Impl", (), impl)
        parts = {part.name.rpartition("_")[2]: part.name for part in definition.parts()}
        self._add_wrapper(definition, {**parts, "Impl": f"_impl_{name}"})

    def finish(self) -> ModuleType:
        """The module with all that was added."""
        lines = self._source.splitlines(keepends=True)
        linecache.cache[self._file] = (len(self._source), None, lines, self._file)
        self._source = ""  # the cache has it
        return self._module

    def _add_wrapper(self, definition: Definition, parts: dict[str, str]) -> None:
        self._run(definition, wrapper_source(definition, parts))

    def _run(self, definition: Definition, source: str) -> None:
        name = definition.name
        kind = "srv" if isinstance(definition, ServiceDefinition) else definition.folder
        self._globals[f"_support_{name}"] = message.TypeSupport(kind, definition.full_name)
        self._globals[f"_definition_{name}"] = definition
        if self._source:
            self._source += "\n\n"
        first_line = self._source.count("\n")
        self._source += source
        exec(compiled("\n" * first_line + source, self._file), self._globals)

    def _kind(self, definition: MessageDefinition, member: Field) -> Kind:
        try:
            check_buildable_field(member)
            built = member if member.default is None else replace(member, default=built_default(member))
            return kind_of(definition, built, self._message_class(definition, member.type))
        except InvalidDefinition as error:
            raise _located(error, definition, member) from None

    def _message_class(self, definition: MessageDefinition, type_: FieldType) -> type | None:
        if type_.is_primitive:
            return None
        if (type_.package, type_.folder) == (definition.package, definition.folder) != (type_.package, "msg"):
            own: type = self._globals[type_.base]
            return own
        return self._resolve(type_)


def _with_inner(kinds: tuple[Kind, ...]) -> Iterator[Kind]:
    """All fields, those of messages that are written out included."""
    for kind in kinds:
        yield kind
        if kind.inlined is not None:
            yield from _with_inner(kind.inlined)


def _signature_default(kind: Kind) -> str:
    return (
        f"{kind.message_class.__name__}()"
        if kind.message_class
        else kind.fresh.replace("_numpy_", "numpy.").replace("_array('", "array('")
    )


def _located(error: InvalidDefinition, definition: MessageDefinition, member: Field | Constant) -> InvalidDefinition:
    return error.locate(
        interface=definition.full_name, file=definition.file, line=member.line or None, line_text=str(member)
    )


# -- what can be read in a definition and yet not be built -------------------------------------------------------------
# ROS 2 turns each definition into an IDL file, and that into C, C++ and Python. A build stops where a name is a word
# of one of these languages, or where a default value gets lost on the way (facts: rosidl_adapter/msg,
# rosidl_parser/parser.py, rosidl_generator_py; for special numbers ros2/rosidl issue 351, for words of C++ issue
# 272).

MAX_WEIGHT = 10_000_000
"""How many values and messages one message may consist of: more would fill the memory of a small computer."""


def check_weight(name: str, weight: int) -> None:
    """Raise InvalidType for a message of which each instance would consist of too many values."""
    if weight > MAX_WEIGHT:
        raise InvalidType(
            f"each message {name} would consist of {weight:,} values, which is more than fits into memory here",
            hint="A sequence such as float64[] is as long as what is in it",
        )


def built_default(field: Field) -> Value | None:
    """A field's default value as the built class has it; InvalidValue where a build would fail on it."""
    base = field.type.base
    if isinstance(field.default, tuple):
        return tuple(built_value(base, each, field.type.string_bound) for each in field.default)
    return None if field.default is None else built_value(base, field.default, field.type.string_bound)


def built_value(base: str, value: Plain, string_bound: int | None = None) -> Plain:
    """One value of a primitive type as the built class has it."""
    if base in FLOAT_BOUNDS and isinstance(value, float):
        return _number(base, value)
    return _text(value, string_bound) if base in STRINGS and isinstance(value, str) else value


def _number(base: str, value: float) -> float:
    if not isfinite(value):
        hint = "Set it in the program: float('nan'), float('inf')"
        raise InvalidValue(f"value '{value}' cannot be written in a form that a build accepts", hint=hint)
    if abs(value) > FLOAT_BOUNDS[base]:
        raise InvalidValue(f"value '{value}' is too large for {base}")
    return value


def _text(text: str, bound: int | None) -> str:
    """A text after its way through IDL, which decodes escapes such as `\\n` and `\\x41`."""
    if text.isascii() and "\\" not in text:
        return text
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of escapes that are none, such as \d: they stay as they are
            idl = text.encode().decode("unicode_escape").replace('"', r"\"").encode("latin-1").decode()
            seen = re.sub(r"\\x.{1,2}", lambda match: codecs.decode(match[0], "unicode_escape"), idl)
    except UnicodeError:
        raise _lost(text) from None
    if len(re.search(r"\\*$", idl)[0]) % 2:  # type: ignore[index]
        raise _lost(text)
    seen = re.sub(r'\\(["\\])', r"\1", seen)
    if bound is not None and len(seen) > bound:
        raise InvalidValue(f"value '{text}' is longer than {bound} characters once its escapes are read")
    return seen


def _lost(text: str) -> InvalidValue:
    hint = r"Write three more backslashes before each one that is to stay; write é itself, not \u00e9"
    return InvalidValue(f"value '{text}' has a backslash that no build accepts", hint=hint)


# -- the user's cache folder -------------------------------------------------------------------------------------------
# To compile the code of generated classes takes most of the time of a start, so it is kept. Each Python has a folder of
# its own. A file is named by a hash of the source text, so that a changed definition and a newer lesson have another
# one, and begins with a hash of its content: a damaged file counts as none. Where the folder cannot be written nothing
# is kept. `TURTLE_LESSON_CACHE=off` switches the cache off, as grading does.

VARIABLE = "TURTLE_LESSON_CACHE"
"""The environment variable that switches the cache off: `off`."""

DIGEST = sha256().digest_size


def compiled(source: str, file: str) -> CodeType:
    """The code of a module's text, as `compile` makes it; `file` is its name in tracebacks."""
    if (folder := cache_folder()) is None:
        return compile(source, file, "exec")
    path = os.path.join(folder, sha256(f"{file}\n{source}".encode()).hexdigest())
    code = _read(path)
    if code is None:
        code = compile(source, file, "exec")
        if not sys.dont_write_bytecode:
            _write(path, marshal.dumps(code))
    return code


def _read(path: str) -> CodeType | None:
    try:
        with FileIO(path) as file:  # without a buffer, in a fifth of the time
            content = file.readall()
    except OSError:
        return None
    if sha256(content[DIGEST:]).digest() != content[:DIGEST]:  # marshal would not always notice
        return None
    code: CodeType = marshal.loads(content[DIGEST:])
    return code


def _write(path: str, content: bytes) -> None:
    """Write a file in one step, so that no other process ever sees a part of it."""
    beside = Path(f"{path}.{os.getpid()}")
    with suppress(OSError):
        try:
            beside.write_bytes(sha256(content).digest() + content)
            beside.replace(path)
        finally:
            beside.unlink(missing_ok=True)


@cache
def cache_folder() -> str | None:
    """The folder to use, made if need be; None where nobody else must be able to put code into it, and somebody could."""
    if os.environ.get(VARIABLE) == "off":
        return None
    folder = _user_folder()
    with suppress(OSError, RuntimeError):
        if not folder.is_absolute() or folder.resolve().is_relative_to(hooks.learners_folder().resolve()):
            return None  # it may have come with the learner's files
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        found = folder.stat()
        if sys.platform == "win32" or (found.st_uid == os.getuid() and not found.st_mode & 0o022):
            return str(folder)
    return None


def _user_folder() -> Path:
    """Where this user's programs keep what they can make again."""
    if sys.platform == "win32":
        place = os.environ.get("LOCALAPPDATA", r"~\AppData\Local")
    elif sys.platform == "darwin":
        place = "~/Library/Caches"
    else:
        place = os.environ.get("XDG_CACHE_HOME") or "~/.cache"
    python = f"{sys.implementation.cache_tag}-{MAGIC_NUMBER.hex()}-{sys.flags.optimize}"
    return Path(place).expanduser() / "turtle-lesson" / "messages" / python
