"""Python classes for interface definitions, as Humble's `rosidl_generator_py` would make them.

The classes are written as source text and executed, which is what makes them fast: each constructor, setter and
copy is straight code for just its fields. The text stays readable in tracebacks and for `inspect.getsource`. Beyond
ROS's classes ours have `_wire_copy()`, which gives what a subscriber on another computer would get.
"""

from __future__ import annotations

import keyword
import linecache
import marshal
import os
import sys
from array import array
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from functools import cache
from hashlib import sha256
from importlib.util import MAGIC_NUMBER
from io import FileIO
from pathlib import Path
from struct import Struct
from types import CodeType, ModuleType
from typing import Any

from .. import hooks
from . import message
from .codegen import FLOAT32, Kind, kind_of, message_source, wrapper_source
from .message import slot_type
from .model import Constant, Definition, Field, FieldType, InvalidDefinition, Plain, carriers
from .names import bounds, module_name

Resolve = Callable[[FieldType], type]
"""Gives the class of a field's messages; raises InvalidDefinition where there is none."""

_BUILT_IN = (bool, bytes, classmethod, dict, float, int, isinstance, len, list, property, range, str, type)
_SHARED = (
    message.message_repr, message.numpy_array, message.numpy_zeros, message.refuse_arguments, message.same_array,
)  # fmt: skip
COMMON: dict[str, Any] = {
    **{f"_{each.__name__}": each for each in (array, *_BUILT_IN, *_SHARED)},
    **{"_new": object.__new__, "_plain_text": message.plain_text, "_unset": message.Unset()},
}
"""The globals of each generated module."""


def make_module(definition: Definition, resolve: Resolve) -> ModuleType:
    """The module of one interface file, e.g. `geometry_msgs.msg._twist` with the class `Twist`.

    Raises InvalidDefinition where ROS could not generate Python code either.
    """
    stem = module_name(definition.name)
    module = ModuleType(
        f"{definition.package}.{definition.folder}.{stem}", f"Classes generated from {definition.full_name}."
    )
    module.__file__ = f"generated/{definition.package}/{definition.folder}/{stem}.py"
    builder = _Builder(module, resolve)
    builder.add(definition)
    lines = builder.source.splitlines(keepends=True)
    linecache.cache[module.__file__] = (len(builder.source), None, lines, module.__file__)
    return module


class _Builder:
    """Adds the classes of one interface file to its module, each executed as soon as its source is written."""

    def __init__(self, module: ModuleType, resolve: Resolve) -> None:
        self._module = module
        self._globals = module.__dict__
        self._globals.update(COMMON)
        self._resolve = resolve
        self.source = ""

    def add(self, definition: Definition) -> None:
        """Add the class of a message, or the classes of a service or action and of all in which ROS carries it."""
        is_action = len(definition.parts) == 3
        for part in definition.parts + (carriers(definition) if is_action else ()):
            self.add(part)
        if not definition.parts:
            self._add_message(definition)
            return
        name = definition.name
        parts = {part.name.rpartition("_")[2]: part.name for part in definition.parts}
        if is_action:
            impl = {
                "SendGoalService": self._globals[f"{name}_SendGoal"],
                "GetResultService": self._globals[f"{name}_GetResult"],
                "FeedbackMessage": self._globals[f"{name}_FeedbackMessage"],
                "CancelGoalService": self._resolve(FieldType("CancelGoal", "action_msgs", folder="srv")),
                "GoalStatusMessage": self._resolve(FieldType("GoalStatusArray", "action_msgs")),
                "__module__": self._module.__name__,
            }
            parts["Impl"] = f"_impl_{name}"
            self._globals[f"_impl_{name}"] = type("Impl", (), impl)
        self._run(definition, wrapper_source(definition, parts))

    def _add_message(self, definition: Definition) -> None:
        name = definition.name
        kinds, weight = [], 1
        members: list[Field | Constant] = [*definition.fields, *definition.constants]
        for member in members:
            try:
                if isinstance(member, Constant):
                    check_value(member.type, member.value)
                    continue
                kinds.append(self._kind(definition, member))
                type_, element = member.type, kinds[-1].element_class
                is_sequence = type_.is_array and not type_.is_fixed  # of any length, at first of none
                weight += 1 if is_sequence else (type_.size or 1) * getattr(element, "_WEIGHT", 1)
                if weight > MAX_WEIGHT:
                    reason = (
                        f"each message {name} would consist of {weight:,} values, which is more than fits into memory"
                    )
                    hint = "A sequence such as float64[] is as long as what is in it"
                    raise InvalidDefinition(reason, "TypeError", hint=hint)
            except InvalidDefinition as error:
                line, text = member.line or None, str(member)
                raise error.locate(
                    interface=definition.full_name, file=definition.file, line=line, line_text=text
                ) from None
        self._globals[f"_kinds_{name}"] = tuple(kinds)
        self._globals[f"_slot_types_{name}"] = tuple(slot_type(field.type) for field in definition.fields)
        written_out = list(_with_inner(kinds))
        for kind in written_out:
            self._globals.update(kind.objects)
        if rounded := sum(kind.member.type == FLOAT32 for kind in written_out):
            packing = Struct(f"{rounded}f")  # rounds them to float32
            self._globals.update({f"_pack_{rounded}": packing.pack, f"_unpack_{rounded}": packing.unpack})
        self._run(definition, message_source(definition, kinds))
        self._globals[name]._WEIGHT = weight

    def _run(self, definition: Definition, source: str) -> None:
        self._globals[f"_definition_{definition.name}"] = definition
        self.source += "\n\n" if self.source else ""
        first_line = self.source.count("\n")
        self.source += source
        try:
            exec(compiled("\n" * first_line + source, str(self._module.__file__)), self._globals)
        except (SyntaxError, ValueError) as error:  # such as of a message None, or a field wire_copy
            refused = InvalidDefinition(f"Python cannot have a class of this name, or with these fields ({error})")
            raise refused.locate(interface=definition.full_name, file=definition.file) from None

    def _kind(self, definition: Definition, field: Field) -> Kind:
        check_buildable(field)
        default, type_ = field.default, field.type
        for value in default if isinstance(default, tuple) else (default,):
            if value is not None:
                check_value(type_.base, value)
        if type_.is_primitive:
            return kind_of(definition, field, None)
        is_own = type_.folder == "action"  # a goal, a result or feedback, in the messages that carry it
        return kind_of(definition, field, self._globals[type_.base] if is_own else self._resolve(type_))


def _with_inner(kinds: Iterable[Kind]) -> Iterator[Kind]:
    """All fields, those of messages that are written out included."""
    for kind in kinds:
        yield kind
        yield from _with_inner(kind.inner)


# -- what can be read in a definition and yet not be built -------------------------------------------------------------
# ROS 2 turns each definition into an IDL file, and that into C, C++ and Python. A build stops where a name is a word
# of one of these languages, or where a default value gets lost on the way (facts: rosidl_adapter/msg,
# rosidl_parser/parser.py, rosidl_generator_py; for special numbers ros2/rosidl issue 351, for words of C++ issue
# 272).

_CPP = """
    alignas alignof and and_eq asm auto bitand bitor bool break case catch char char16_t char32_t class compl const
    const_cast constexpr continue decltype default delete do double dynamic_cast else enum explicit export extern false
    float for friend goto if inline int long mutable namespace new noexcept not not_eq nullptr operator or or_eq private
    protected public register reinterpret_cast restrict return short signed sizeof static static_assert static_cast
    struct switch template this thread_local throw true try typedef typeid typename union unsigned using virtual void
    volatile wchar_t while xor xor_eq
"""
CPP_WORDS = frozenset(_CPP.split())
"""The reserved words of C and of C++17."""

MAX_WEIGHT = 10_000_000
"""How many values and messages one message may consist of: more would fill the memory of a small computer."""


def check_buildable(field: Field) -> None:
    """Raise InvalidDefinition for a field that no build gets through."""
    name, base = field.name, field.type.base
    error, hint = "NameError", "Please use a different name"
    if base in ("time", "duration"):
        reason, error = f"the type '{base}' belongs to ROS 1", "TypeError"
        hint = f"Write 'builtin_interfaces/{base.capitalize()} {name}'"
    elif keyword.iskeyword(name):
        reason = f"Member name '{name}' is a reserved keyword in Python and is not supported at the moment. {hint}"
        hint = ""
    elif name in CPP_WORDS:
        reason = f"Member name '{name}' is a keyword of C++, in which ROS 2 also generates code"
        hint += f", such as '{name}_value'"
    else:
        return
    raise InvalidDefinition(reason, error, hint=hint)


def check_value(base: str, value: Plain) -> None:
    """Raise InvalidDefinition for a default value or constant that no build gets through, or only as another value."""
    is_wrong_number = isinstance(value, float) and not abs(value) <= bounds(base)[1]
    if is_wrong_number or (isinstance(value, str) and "\\" in value):
        reason = f"value '{value}' cannot be written in a form that a build accepts"
        raise InvalidDefinition(reason, "InvalidValue", hint="Set it in the program")


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
    with suppress(OSError), FileIO(path) as kept:  # without a buffer, in a fifth of the time
        content = kept.readall()
        if sha256(content[DIGEST:]).digest() == content[:DIGEST]:  # marshal would not always notice
            code: CodeType = marshal.loads(content[DIGEST:])
            return code
    code = compile(source, file, "exec")
    if not sys.dont_write_bytecode:
        _write(path, marshal.dumps(code))
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
    place = os.environ.get("LOCALAPPDATA") or os.environ.get("XDG_CACHE_HOME") or "~/.cache"  # the first on Windows
    python = f"{sys.implementation.cache_tag}-{MAGIC_NUMBER.hex()}-{sys.flags.optimize}"
    return Path(place).expanduser() / "turtle-lesson" / "messages" / python
