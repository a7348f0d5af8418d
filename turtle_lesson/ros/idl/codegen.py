"""The source text of generated classes, and its pieces: how each kind of field is checked, made fresh and copied.

A piece is an expression with `{value}` where the value belongs. Names that begin with an underscore are
globals of the generated module; no field can have such a name. The definition itself is `_TYPE_SUPPORT`, where ROS keeps
pointers to its C code.
"""

from __future__ import annotations

from array import array
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any

from . import checks, message
from .checks import zero
from .message import slot_type
from .model import Definition, Field, FieldType, Plain
from .names import bounds


@dataclass(frozen=True, slots=True)
class Kind:
    """What the generator needs to know of one field.

    Attributes:
        member: type, name and default, as the definition has them.
        check: global name of the function that checks a value and gives what to store.
        fresh: expression of the default value.
        test: expression that is true where a value can be stored as it is; empty where each needs the check.
        copy: expression of a value's copy, as it is after transport.
        construct: expression of what the constructor stores for a value it was given.
        same: expression that compares `{value}` with `{other}`.
        element_class: class of the value or of its elements, where these are messages.
        inner: the fields of a message that is written out field by field, which is fast.
        objects: globals that these expressions use.
    """

    member: Field
    check: str
    fresh: str
    test: str = ""
    copy: str = "{value}"
    construct: str = ""
    same: str = "{value} == {other}"
    element_class: type | None = None
    inner: tuple[Kind, ...] = ()
    objects: dict[str, Any] = field(default_factory=dict)

    @property
    def name(self) -> str:
        """The field's name."""
        return self.member.name

    @property
    def shares_default(self) -> bool:
        """Whether the default may be shared by all messages (a number, a text)."""
        return self.member.type.is_primitive and not self.member.type.is_array

    @property
    def lines(self) -> int:
        """How many fields stand where this one is written out."""
        return 1 + sum(kind.lines for kind in self.inner)


FLOAT32 = FieldType("float32")
"""The type of the values that transport rounds."""

MOST_LINES = 64
"""A message with more fields than these, its messages' fields included, is not written out in those that contain it."""


def kind_of(definition: Definition, member: Field, message_class: type | None) -> Kind:
    """The kind of one field; `message_class` is the class of its elements, where these are messages."""
    type_ = member.type
    key = f"{definition.package}_{definition.folder}_{definition.name}_{member.name}"
    if not type_.is_array:
        return _message_kind(member, key, message_class) if message_class else _plain_kind(member, key)
    if type_.base in checks.TYPE_CODES and message_class is None:
        return _numpy_kind(member, key) if type_.is_fixed else _sequence_kind(member, key)
    return _list_kind(member, key, message_class)


def literal(base: str, value: Plain | bytes) -> str:
    """Source text of a default value or constant."""
    if base == "byte" and isinstance(value, int):
        return repr(bytes([value]))
    return repr(value)


def _plain_kind(member: Field, key: str) -> Kind:
    type_, check = member.type, f"_check_{key}"
    base, kind = type_.base, type(zero(type_.base))
    value = zero(base) if member.default is None else member.default
    assert not isinstance(value, tuple)
    test = f"_type({{value}}) is _{kind.__name__}"
    if kind is bytes:
        test += " and _len({value}) == 1"
    elif type_.string_bound is not None:
        test += f" and _len({{value}}) <= {type_.string_bound}"
    elif kind is int or base == "float32":
        low, high = bounds(base)
        test += f" and {low} <= {{value}} <= {high}"
    return Kind(
        member,
        check,
        fresh=literal(base, value),
        test=test,
        copy={str: "_plain_text({value})", int: "+{value}"}.get(kind, "{value}"),  # + makes 1 of True
        objects={check: checks.assigned(checks.scalar_check(member.name, type_))},
    )


def _message_kind(member: Field, key: str, message_class: type) -> Kind:
    check, fresh, variable = f"_check_{key}", f"_fresh_{key}", class_variable(message_class)
    inner: tuple[Kind, ...] = message_class._KINDS  # type: ignore[attr-defined]
    return Kind(
        member,
        check,
        fresh=f"{fresh}()",
        test=f"_type({{value}}) is {variable}",
        copy="{value}._wire_copy()",
        element_class=message_class,
        inner=inner if sum(kind.lines for kind in inner) < MOST_LINES else (),
        objects={
            check: checks.assigned(checks.message_check(member.name, message_class)),
            fresh: message_class._FRESH,  # type: ignore[attr-defined]
            variable: message_class,
        },
    )


def _sequence_kind(member: Field, key: str) -> Kind:
    type_, check = member.type, f"_check_{key}"
    code = checks.TYPE_CODES[type_.base]
    limits = f" and _len({{value}}) <= {type_.size}" if type_.size is not None else ""
    start = f", {list(member.default)!r}" if isinstance(member.default, tuple) else ""
    made = f"_array('{code}', {{value}})"
    return Kind(
        member,
        check,
        fresh=f"_array('{code}'{start})",
        test=f"_type({{value}}) is _array and {{value}}.typecode == '{code}'{limits}",
        copy="{value}[:]",
        construct=f"{check}({made})" if type_.size is not None else made,
        objects={check: checks.assigned(checks.sequence_check(member.name, type_), partial(array, code))},
    )


def _numpy_kind(member: Field, key: str) -> Kind:
    type_, check = member.type, f"_check_{key}"
    name = checks.numpy_name(type_.base)
    given = isinstance(member.default, tuple) and repr(list(member.default))
    return Kind(
        member,
        check,
        fresh=f"_numpy_array({given}, '{name}')" if given else f"_numpy_zeros({type_.size}, '{name}')",
        copy="{value}.flatten()",
        construct=f"{check}(_numpy_array({{value}}, '{name}'))",
        same="_same_array({value}, {other})",
        objects={
            check: checks.assigned(checks.numpy_check(member.name, type_), partial(message.numpy_array, dtype=name))
        },
    )


def _list_kind(member: Field, key: str, message_class: type | None) -> Kind:
    type_, check, elements = member.type, f"_check_{key}", f"_elements_{key}"
    element_class = message_class or type(zero(type_.base))
    check_function = checks.list_check(member.name, type_, element_class)
    # What was put into the list since the check is refused when it is copied.
    objects: dict[str, Any] = {check: checks.assigned(check_function), elements: check_function}
    copy = f"_list({elements}({{value}}))"
    if message_class:
        objects[class_variable(message_class)] = message_class
        copy = f"[each._wire_copy() for each in {elements}({{value}})]"
    elif element_class is str:
        copy = f"[_plain_text(each) for each in {elements}({{value}})]"
    if isinstance(member.default, tuple):
        fresh = "[" + ", ".join(literal(type_.base, each) for each in member.default) + "]"
    elif not type_.is_fixed:
        fresh = "[]"
    elif message_class:
        fresh = f"[{class_variable(message_class)}() for _ in _range({type_.size})]"
    else:
        fresh = f"[{literal(type_.base, zero(type_.base))}] * {type_.size}"
    return Kind(member, check, fresh=fresh, copy=copy, element_class=message_class, objects=objects)


def class_variable(message_class: type) -> str:
    """Global name of a message class in generated modules."""
    return "_class_" + message_class._TYPE_NAME.replace("/", "_")  # type: ignore[attr-defined]


# -- the text of whole classes ----------------------------------------------------------------------------------------


def message_source(definition: Definition, kinds: Sequence[Kind]) -> str:
    """Metaclass, class and fresh-message function of one message."""
    name = definition.name
    me = "_self" if any(kind.name == "self" for kind in kinds) else "self"
    types = {kind.name: str(slot_type(kind.member.type)) for kind in kinds}
    constants = {each.name: literal(each.type, each.value) for each in definition.constants}
    defaults = {f"{kind.name.upper()}__DEFAULT": kind.fresh for kind in kinds if kind.member.default is not None}
    of_class = {**constants, **defaults}
    same = [kind.same.format(value=f"self._{kind.name}", other=f"other._{kind.name}") for kind in kinds]
    arguments, construct = "*, " if kinds else "", []
    for kind in kinds:
        default = kind.fresh if kind.shares_default else "_unset"
        value = kind.construct.format(value=kind.name) or _stored(kind, kind.name)
        arguments += f"{kind.name}={default}, "
        given = value if kind.shares_default else f"{kind.fresh} if {kind.name} is {default} else {value}"
        construct.append(f"{me}._{kind.name} = {given}")
    packed: list[tuple[str, str]] = []
    copy = _filled("new", kinds, "self", packed)
    if packed:
        targets = "".join(f"{target}, " for target, _ in packed)
        sources = ", ".join(source for _, source in packed)
        copy.append(f"{targets}= _unpack_{len(packed)}(_pack_{len(packed)}({sources}))")
    return f'''\
class Metaclass_{name}(type):
    """Metaclass of message '{name}'."""

    _TYPE_SUPPORT = _definition_{name}
{"".join(_class_property(each, value) for each, value in of_class.items())}

class {name}(metaclass=Metaclass_{name}):
    {_docstring(name, types, constants)}

{_indented(4, [f"{each} = {value}" for each, value in of_class.items()])}\
    __slots__ = {["_" + each for each in types]}
    _fields_and_field_types = {types}
    SLOT_TYPES = _slot_types_{name}
    _TYPE_SUPPORT = _definition_{name}
    _TYPE_NAME = '{definition.full_name}'
    _DEFINITION = _definition_{name}
    _KINDS = _kinds_{name}
    __repr__ = _message_repr

    @_classmethod
    def get_fields_and_field_types(cls):
        """Names of the fields, and their types as text."""
        return _dict(cls._fields_and_field_types)

    def __init__({me}, {arguments}**_unknown):
        if _unknown:
            _refuse_arguments({name}, _unknown)
{_indented(8, construct)}
    def __eq__(self, other):
        return {" and ".join(["_isinstance(other, self.__class__)", *same])}

    def _wire_copy(self):
        """Copy that shares nothing, with numbers as transport leaves them."""
        new = _new({name})
{_indented(8, copy)}\
        return new
{"".join(map(_property, kinds))}

def _fresh_{name}():
    """A message of default values, made without the constructor."""
    new = _new({name})
{_indented(4, _filled("new", kinds, "", []))}\
    return new

{name}._FRESH = _fresh_{name}
'''


def wrapper_source(definition: Definition, parts: dict[str, str]) -> str:
    """Class of a service or an action: it holds the classes of its parts and cannot be instantiated."""
    name = definition.name
    what = "Service" if len(definition.parts) == 2 else "Action"
    return f'''\
class Metaclass_{name}(type):
    """Metaclass of {what.lower()} '{name}'."""

    _TYPE_SUPPORT = _definition_{name}


class {name}(metaclass=Metaclass_{name}):
    """{what} class '{name}'."""

{_indented(4, [f"{attribute} = {value}" for attribute, value in parts.items()])}\
    _TYPE_SUPPORT = _definition_{name}
    _TYPE_NAME = '{definition.full_name}'
    _DEFINITION = _definition_{name}

    def __init__(self):
        raise NotImplementedError('{what} classes can not be instantiated')
'''


def _class_property(name: str, value: str) -> str:
    return f'''
    @_property
    def {name}(cls):
        """Message constant, or the default value of a message's field."""
        return {value}
'''


def _property(kind: Kind) -> str:
    return f'''
    @_property
    def {kind.name}(self):
        """Message field '{kind.name}'."""
        return self._{kind.name}

    @{kind.name}.setter
    def {kind.name}(self, value):
        self._{kind.name} = {_stored(kind, "value")}
'''


def _indented(by: int, lines: list[str]) -> str:
    return "".join(f"{' ' * by}{line}\n" for line in lines)


def _docstring(name: str, types: dict[str, str], constants: dict[str, str]) -> str:
    text = ""
    if types:
        text += "\n    Fields:\n" + _indented(8, [f"{each}: {type_}" for each, type_ in types.items()])
    if constants:
        text += "\n    Constants:\n" + _indented(8, [f"{each} = {value}" for each, value in constants.items()])
    text = text.replace('"""', "'''")
    return f'r"""Message class \'{name}\'.\n{text}    """' if text else f'"""Message class \'{name}\'."""'


def _stored(kind: Kind, value: str) -> str:
    checked = f"{kind.check}({value})"
    return f"({value} if {kind.test.format(value=value)} else {checked})" if kind.test else checked


def _filled(new: str, kinds: Sequence[Kind], old: str, packed: list[tuple[str, str]]) -> list[str]:
    """Fill a new message, and those of its messages that are written out, with the values of an old one, or without one afresh.

    An old message's float32 fields are left for one packing at the end.
    """
    lines: list[str] = []
    for kind in kinds:
        target, source = f"{new}._{kind.name}", f"{old}._{kind.name}"
        if kind.element_class is not None and kind.inner:
            inner, inner_old = f"{new}__{kind.name}", f"{old}__{kind.name}" if old else ""
            lines += [f"{inner_old} = {source}"] if old else []
            lines.append(f"{target} = {inner} = _new({class_variable(kind.element_class)})")
            lines += _filled(inner, kind.inner, inner_old, packed)
        elif not old:
            lines.append(f"{target} = {kind.fresh}")
        elif kind.member.type == FLOAT32:
            packed.append((target, source))
        else:
            lines.append(f"{target} = {kind.copy.format(value=source)}")
    return lines
