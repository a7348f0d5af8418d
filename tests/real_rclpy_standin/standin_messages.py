"""Message classes as the real generator makes them, as far as the lab looks: fields, defaults, checks, `get_fields_…`."""

from __future__ import annotations

import array
from typing import Any

_made: dict[str, type] = {}
_PLAIN: dict[str, Any] = {"string": "", "boolean": False, "double": 0.0, "float": 0.0}


def message(name: str, /, **fields: Any) -> type:
    """The class of "geometry_msgs/msg/Twist"; a value that is no text is a constant, a lower-case name a field's type."""
    package, folder, short = name.split("/")
    constants = {each: value for each, value in fields.items() if each.isupper()}
    types = {each: value for each, value in fields.items() if each not in constants}
    made = type(
        short,
        (_Message,),
        {**constants, "_types": types, "__module__": f"{package}.{folder}", "__slots__": tuple(types)},
    )
    _made[f"{package}/{short}"] = made
    made.type_name = name  # type: ignore[attr-defined]
    return made


def service(name: str, request: dict[str, str], response: dict[str, str]) -> type:
    """The class of "robot_controller/srv/NavigateTo", with Request and Response."""
    package, folder, short = name.split("/")
    parts = {
        part: message(f"{package}/{folder}/{short}_{part}", **fields)
        for part, fields in (("Request", request), ("Response", response))
    }
    return type(short, (), {**parts, "type_name": name, "__module__": f"{package}.{folder}"})


class _Message:
    __slots__ = ()
    _types: dict[str, str] = {}  # noqa: RUF012

    def __init__(self, **values: Any) -> None:
        assert set(values) <= set(self._types), f"Invalid arguments passed to constructor: {', '.join(values)}"
        for name, kind in self._types.items():
            setattr(self, name, values[name] if name in values else _default(kind))

    def __setattr__(self, name: str, value: Any) -> None:
        kind = self._types.get(name, "")
        if kind in ("float", "double"):
            assert isinstance(value, float), f"The '{name}' field must be of type 'float'"
        elif kind in _made:
            assert isinstance(value, _made[kind]), f"The '{name}' field must be a sub message of type '{kind}'"
        elif kind.lstrip("u").startswith("int"):
            assert isinstance(value, int), f"The '{name}' field must be of type 'int'"
        object.__setattr__(self, name, array.array("f", value) if kind == "sequence<float>" else value)

    def __eq__(self, other: object) -> bool:
        return type(other) is type(self) and all(getattr(self, each) == getattr(other, each) for each in self._types)

    __hash__ = None  # type: ignore[assignment]

    @classmethod
    def get_fields_and_field_types(cls) -> dict[str, str]:
        return dict(cls._types)


def _default(kind: str) -> Any:
    if kind.startswith("sequence<"):
        return []
    return _made[kind]() if "/" in kind else _PLAIN.get(kind, 0)
