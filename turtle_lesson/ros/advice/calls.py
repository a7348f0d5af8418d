"""Functions that are called with something else than they take."""

from __future__ import annotations

import inspect
import re
import sys
from collections.abc import Callable
from typing import Any

from ..core.tracebacks import is_ours, traceback_entries
from .attributes import meant

_WRONG_CALL = re.compile(r"([\w.]+)\(\) (missing|takes|got an unexpected keyword argument '(\w+)'|got multiple values)")


def advice(error: BaseException) -> str:
    """A sentence about a call with wrong arguments."""
    if not isinstance(error, TypeError):
        return ""
    text = str(error)
    if "'__init__' requires a 'super' object" in text:
        return "Call super with brackets: super().__init__('the_name_of_the_node')"
    match = _WRONG_CALL.match(text)
    if match is None or not _is_called_by_a_learner(error):
        return ""
    name, keyword = match[1], match[3]
    if "takes 0 positional arguments but 1 was given" in text and "." in name:
        return f"A method's first parameter is self: def {name.rpartition('.')[2]}(self)"
    function = _function(name)
    return "" if function is None else _how(name, function, keyword)


def _is_called_by_a_learner(error: BaseException) -> bool:
    """Whether the call stands in a learner's code; there may be a wrapper of ours around the function."""
    frames = traceback_entries(error.__traceback__)[-2:]
    return any(not is_ours(frame.tb_frame.f_code.co_filename) for frame in frames)


def _how(name: str, function: Callable[..., Any], keyword: str | None) -> str:
    owner, _, method = name.rpartition(".")
    if name == "Node.__init__":
        return "A node needs a name: super().__init__('the_name_of_the_node')"
    if hasattr(getattr(function, "__self__", None), "get_fields_and_field_types"):
        kind: Any = function.__self__  # type: ignore[attr-defined]
        fields = list(kind.get_fields_and_field_types())
        return f"Give the fields by name: {kind.__name__}({', '.join(f'{each}=…' for each in fields[:3])})"
    if owner == "RcutilsLogger":
        return "A log message is one text: put values into it with an f-string, as in f'x is {x}'."
    signature = _signature(function)
    close = meant(keyword, inspect.signature(function).parameters) if keyword else ""
    return f"{close} It is called as {owner if method == '__init__' else method}({signature})".lstrip()


def _signature(function: Callable[..., Any]) -> str:
    """The parameters, those without a default and the first of the others."""
    found = [
        each
        for each in inspect.signature(function).parameters.values()
        if each.name != "self" and each.kind is not each.VAR_KEYWORD
    ]
    parts = [each.name if each.default is each.empty else f"{each.name}={_default(each)}" for each in found]
    shown = [*parts[:4], "…"] if len(parts) > 5 else parts
    return ", ".join(shown)


def _default(parameter: inspect.Parameter) -> str:
    simple = parameter.default is None or isinstance(parameter.default, (bool, int, float, str))
    return repr(parameter.default) if simple else "…"


def _function(name: str) -> Callable[..., Any] | None:
    """The function or method of rclpy, or of a message, of this name."""
    parts = name.split(".")
    for module in [each for key, each in list(sys.modules.items()) if key.partition(".")[0] in _OURS]:
        found: Any = vars(module).get(parts[0])
        for part in parts[1:]:
            found = None if found is None else getattr(found, part, None)
        if inspect.isfunction(found):
            return found
    return _constructor_of_a_message(parts) if parts[-1] == "__init__" else None


def _constructor_of_a_message(parts: list[str]) -> Callable[..., Any] | None:
    for key, module in list(sys.modules.items()):
        kind = vars(module).get(parts[0]) if ".msg." in key or ".srv." in key or ".action." in key else None
        if hasattr(kind, "get_fields_and_field_types"):
            return _Bound(kind)
    return None


class _Bound:
    """Stands for the constructor of a message class, which is its `__self__`."""

    def __init__(self, kind: Any) -> None:
        self.__self__ = kind

    def __call__(self) -> None:
        """Never called."""


_OURS = frozenset({"rclpy", "tf2_ros", "message_filters", "ament_index_python", "rosidl_runtime_py"})
