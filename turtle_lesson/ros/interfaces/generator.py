"""Python classes for interface definitions, as Humble's `rosidl_generator_py` would make them.

The classes are written as source text and executed, which is what makes them fast: each constructor, setter
and copy is straight code for just its fields. The text stays readable in tracebacks and for
`inspect.getsource`. Beyond ROS's classes ours have `_wire_copy()`, which gives what a subscriber on another
computer would get.
"""

from __future__ import annotations

import linecache
from array import array
from collections.abc import Callable, Iterator
from dataclasses import replace
from math import inf, nan
from struct import Struct
from types import ModuleType
from typing import Any

from turtle_lesson.ros.interfaces import buildable, message
from turtle_lesson.ros.interfaces.actions import derived_parts
from turtle_lesson.ros.interfaces.errors import InvalidDefinition
from turtle_lesson.ros.interfaces.kinds import Kind, kind_of, weight_of
from turtle_lesson.ros.interfaces.model import (
    ActionDefinition,
    Constant,
    Definition,
    Field,
    FieldType,
    MessageDefinition,
    ServiceDefinition,
)
from turtle_lesson.ros.interfaces.names import module_name
from turtle_lesson.ros.interfaces.slot_types import slot_type
from turtle_lesson.ros.interfaces.source import message_source, wrapper_source

Resolve = Callable[[FieldType], type]
"""Gives the class of a field's messages; raises UnknownMessageType where there is none."""

COMMON: dict[str, Any] = {
    "_array": array,
    "_bool": bool,
    "_bytes": bytes,
    "_classmethod": classmethod,
    "_dict": dict,
    "_float": float,
    "_inf": inf,
    "_int": int,
    "_isinstance": isinstance,
    "_len": len,
    "_message_repr": message.message_repr,
    "_nan": nan,
    "_new": object.__new__,
    "_plain_text": message.plain_text,
    "_property": property,
    "_range": range,
    "_refuse_arguments": message.refuse_arguments,
    "_same_array": message.same_array,
    "_str": str,
    "_type": type,
}


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
            buildable.check_class_name(name)
            buildable.check_weight(name, weight_of(kinds))
        except InvalidDefinition as error:
            raise error.locate(interface=definition.full_name, file=definition.file) from None
        if definition.constants:
            constants = tuple(_built_constant(definition, constant) for constant in definition.constants)
            definition = replace(definition, constants=constants)
        self._globals[f"_kinds_{name}"] = kinds
        self._globals[f"_slot_types_{name}"] = tuple(slot_type(member.type) for member in definition.fields)
        for kind in _with_inner(kinds):
            self._globals.update(kind.objects)
        for kind in kinds:
            if not kind.shares:
                self._globals[f"_unset_{name}_{kind.name}"] = message.Unset(_signature_default(kind))
        self._add_packing(sum(kind.is_float32 for kind in _with_inner(kinds)))
        self._run(definition, message_source(definition, kinds))

    def add_service(self, definition: ServiceDefinition) -> None:
        """Add request, response and the class that holds both."""
        for part in definition.parts():
            self.add_message(part)
        self._add_service_class(definition)

    def add_action(self, definition: ActionDefinition) -> None:
        """Add goal, result, feedback, the class that holds them, and what carries them (`Impl`)."""
        for part in (*definition.parts(), *derived_parts(definition)):
            self.add_message(part)
        name = definition.name
        for service in (f"{name}_SendGoal", f"{name}_GetResult"):
            self._add_carrier(definition, service)
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

    def _add_service_class(self, definition: ServiceDefinition) -> None:
        self._add_wrapper(definition, {"Request": definition.request.name, "Response": definition.response.name})

    def _add_carrier(self, action: ActionDefinition, name: str) -> None:
        request, response = (self._globals[f"{name}_{part}"]._DEFINITION for part in ("Request", "Response"))
        self._add_service_class(ServiceDefinition(action.package, name, request, response, "", action.file, "action"))

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
        exec(compile("\n" * first_line + source, self._file, "exec"), self._globals)

    def _kind(self, definition: MessageDefinition, member: Field) -> Kind:
        try:
            buildable.check_field(member)
            built = member if member.default is None else replace(member, default=buildable.built_default(member))
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

    def _add_packing(self, count: int) -> None:
        """Provide the packing that rounds `count` numbers to float32, if any."""
        if count:
            packing = Struct(f"{count}f")
            self._globals.update({f"_pack_{count}": packing.pack, f"_unpack_{count}": packing.unpack})


def _with_inner(kinds: tuple[Kind, ...]) -> Iterator[Kind]:
    """All fields, those of messages that are written out included."""
    for kind in kinds:
        yield kind
        if kind.inlined is not None:
            yield from _with_inner(kind.inlined)


def _signature_default(kind: Kind) -> str:
    return f"{kind.message_class.__name__}()" if kind.message_class else kind.fresh.replace("_array('", "array('")


def _built_constant(definition: MessageDefinition, constant: Constant) -> Constant:
    try:
        return replace(constant, value=buildable.built_constant(constant))
    except InvalidDefinition as error:
        raise _located(error, definition, constant) from None


def _located(error: InvalidDefinition, definition: MessageDefinition, member: Field | Constant) -> InvalidDefinition:
    return error.locate(
        interface=definition.full_name, file=definition.file, line=member.line or None, line_text=str(member)
    )
