"""The source text of generated classes."""

from __future__ import annotations

from .field_codegen import Kind, class_variable, literal
from .message import slot_type
from .model import Constant, Definition, MessageDefinition, ServiceDefinition

Lines = list[str]


def message_source(definition: MessageDefinition, kinds: tuple[Kind, ...]) -> str:
    """Metaclass, class and fresh-message function of one message."""
    name = definition.name
    defaults = [
        (f"{member.name.upper()}__DEFAULT", kind.fresh)
        for member, kind in zip(definition.fields, kinds, strict=True)
        if member.default is not None
    ]
    same = [kind.same.format(value=f"self._{kind.name}", other=f"other._{kind.name}") for kind in kinds]
    lines = [
        *_metaclass(definition, defaults),
        *_class_head(definition, defaults),
        *_indent(_constructor(name, kinds)),
        "",
        "    def __eq__(self, other):",
        "        return " + " and ".join(["_isinstance(other, self.__class__)", *same]),
        *_indent(_wire_copy(name, kinds)),
    ]
    for kind in kinds:
        lines += _indent(_property(kind))
    lines += [
        "",
        "",
        f"def _fresh_{name}():",
        '    """A message of default values, made without the constructor."""',
        f"    new = _new({name})",
        *_indent(_fresh_fields("new", kinds)),
        "    return new",
        "",
        f"{name}._FRESH = _fresh_{name}",
    ]
    return "\n".join(lines) + "\n"


def wrapper_source(definition: Definition, parts: dict[str, str]) -> str:
    """Class of a service or an action: it holds the classes of its parts and cannot be instantiated."""
    name = definition.name
    what = "Service" if isinstance(definition, ServiceDefinition) else "Action"
    return "\n".join(
        [
            f"class Metaclass_{name}(type):",
            f'    """Metaclass of {what.lower()} \'{name}\'."""',
            "",
            f"    _TYPE_SUPPORT = _support_{name}",
            "",
            "",
            f"class {name}(metaclass=Metaclass_{name}):",
            f'    """{what} class \'{name}\'."""',
            "",
            *(f"    {attribute} = {value}" for attribute, value in parts.items()),
            *_indent(_identity(definition)),
            "",
            "    def __init__(self):",
            f"        raise NotImplementedError('{what} classes can not be instantiated')",
            "",
        ]
    )


def _indent(lines: Lines) -> Lines:
    return [f"    {line}" if line else line for line in lines]


def _identity(definition: Definition) -> Lines:
    return [
        f"_TYPE_SUPPORT = _support_{definition.name}",
        f"_TYPE_NAME = '{definition.full_name}'",
        f"_DEFINITION = _definition_{definition.name}",
    ]


def _metaclass(definition: MessageDefinition, defaults: list[tuple[str, str]]) -> Lines:
    lines = [
        f"class Metaclass_{definition.name}(type):",
        f'    """Metaclass of message \'{definition.name}\'."""',
        "",
        f"    _TYPE_SUPPORT = _support_{definition.name}",
    ]
    members = [(each.name, f"Message constant '{each.name}'.", _constant(each)) for each in definition.constants]
    members += [(name, "Return default value of a message field.", fresh) for name, fresh in defaults]
    for name, text, value in members:
        lines += _indent(["", "@_property", f"def {name}(cls):", f'    """{text}"""', f"    return {value}"])
    return [*lines, "", ""]


def _constant(constant: Constant) -> str:
    return literal(constant.type, constant.value)


def _class_head(definition: MessageDefinition, defaults: list[tuple[str, str]]) -> Lines:
    name = definition.name
    types = {member.name: str(slot_type(member.type)) for member in definition.fields}
    body = [
        *_docstring(definition, types),
        "",
        *(f"{constant.name} = {_constant(constant)}" for constant in definition.constants),
        *(f"{default} = {fresh}" for default, fresh in defaults),
        f"__slots__ = {['_' + member for member in types]!r}",
        f"_fields_and_field_types = {types!r}",
        f"SLOT_TYPES = _slot_types_{name}",
        *_identity(definition),
        f"_KINDS = _kinds_{name}",
        "__repr__ = _message_repr",
        "",
        "@_classmethod",
        "def get_fields_and_field_types(cls):",
        '    """Names of the fields, and their types as text."""',
        "    return _dict(cls._fields_and_field_types)",
    ]
    return [f"class {name}(metaclass=Metaclass_{name}):", *_indent(body)]


def _docstring(definition: MessageDefinition, types: dict[str, str]) -> Lines:
    head = f"Message class '{definition.name}'."
    if not types and not definition.constants:
        return [f'"""{head}"""']
    members = [f"    {name}: {type_}" for name, type_ in types.items()]
    constants = [f"    {constant.name} = {_constant(constant)}" for constant in definition.constants]
    text = ["", "Fields:", *members] if members else []
    text += ["", "Constants:", *constants] if constants else []
    return [f'r"""{head}', *(line.replace('"""', "'''") for line in text), '"""']


def _constructor(name: str, kinds: tuple[Kind, ...]) -> Lines:
    me = "_self" if any(kind.name == "self" for kind in kinds) else "self"
    arguments, body = "", []
    for kind in kinds:
        default = kind.fresh if kind.shares else f"_unset_{name}_{kind.name}"
        value = kind.construct.format(value=kind.name) or _stored(kind, kind.name)
        arguments += f"{kind.name}={default}, "
        given = value if kind.shares else f"{kind.fresh} if {kind.name} is {default} else {value}"
        body.append(f"    {me}._{kind.name} = {given}")
    head = f"def __init__({me}, {'*, ' if kinds else ''}{arguments}**_unknown):"
    return ["", head, "    if _unknown:", f"        _refuse_arguments({name}, _unknown)", *body]


def _stored(kind: Kind, value: str) -> str:
    checked = f"{kind.check}({value})"
    return f"({value} if {kind.test.format(value=value)} else {checked})" if kind.test else checked


def _property(kind: Kind) -> Lines:
    lines = ["", "@_property", f"def {kind.name}(self):", f'    """Message field \'{kind.name}\'."""']
    lines += [f"    return self._{kind.name}", "", f"@{kind.name}.setter", f"def {kind.name}(self, value):"]
    return [*lines, f"    self._{kind.name} = {_stored(kind, 'value')}"]


def _wire_copy(name: str, kinds: tuple[Kind, ...]) -> Lines:
    lines = [
        "",
        "def _wire_copy(self):",
        '    """Copy that shares nothing, with numbers as transport leaves them."""',
    ]
    lines.append(f"    new = _new({name})")
    packed: list[tuple[str, str]] = []
    lines += _indent(_copy_fields("new", "self", kinds, packed))
    if packed:
        targets = "".join(f"{target}, " for target, _ in packed)
        sources = ", ".join(source for _, source in packed)
        lines.append(f"    {targets}= _unpack_{len(packed)}(_pack_{len(packed)}({sources}))")
    return [*lines, "    return new"]


def _copy_fields(new: str, old: str, kinds: tuple[Kind, ...], packed: list[tuple[str, str]]) -> Lines:
    """Copy field by field; sub messages in place, float32 fields left for one packing at the end."""
    lines: Lines = []
    for kind in kinds:
        target, source = f"{new}._{kind.name}", f"{old}._{kind.name}"
        if kind.is_float32:
            packed.append((target, source))
        elif kind.message_class is None or kind.inlined is None:
            lines.append(f"{target} = {kind.copy.format(value=source)}")
        else:
            inner_new, inner_old = f"{new}__{kind.name}", f"{old}__{kind.name}"
            lines.append(f"{inner_old} = {source}")
            lines.append(f"{target} = {inner_new} = _new({class_variable(kind.message_class)})")
            lines += _copy_fields(inner_new, inner_old, kind.inlined, packed)
    return lines


def _fresh_fields(new: str, kinds: tuple[Kind, ...]) -> Lines:
    lines: Lines = []
    for kind in kinds:
        target = f"{new}._{kind.name}"
        if kind.message_class is None or kind.inlined is None:
            lines.append(f"{target} = {kind.fresh}")
        else:
            inner_new = f"{new}__{kind.name}"
            lines.append(f"{target} = {inner_new} = _new({class_variable(kind.message_class)})")
            lines += _fresh_fields(inner_new, kind.inlined)
    return lines
