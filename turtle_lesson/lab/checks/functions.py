"""Functions that the learner wrote, in a cell or in a file of the package: found by name, called, compared with examples."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable, Sequence
from typing import Any

from ..words import did_you_mean
from .probe import Probe
from .registry import Expectation
from .results import Advice, CannotLook, Seen

Example = tuple[Sequence[Any], Any]
"""The arguments of a call, and what it should return."""


def learner_function(probe: Probe, name: str, file: str = "") -> Callable[..., Any]:
    """The learner's function of this name: from the notebook's cells, or from a file of the package where one is named.

    Call it by `probe.call(function, …)`, so that it is stopped if it computes without end. Raises CannotLook where there is no
    such function, and what the file raises where it cannot be read as Python.

    Args:
        probe: the look at the system that needs it; within one probe a file is read once.
        name: the function's name, such as "turn_to".
        file: a file in the package's folder of nodes, such as "navigator_node.py".
    """
    names = probe.once(("functions", file), lambda: _names_in(probe, file)) if file else _names_in_cells()
    place = f"{file} of your package" if file else "this notebook"
    found = names.get(name)
    if found is None:
        functions = [each for each, value in names.items() if callable(value)]
        raise CannotLook(f"there is no function {name} in {place}. {did_you_mean(name, functions)}".strip(" ."))
    if not callable(found):
        raise CannotLook(f"{name} in {place} is {found!r}, not a function")
    return found


def returns(
    name: str,
    examples: Iterable[Example],
    expected: str,
    advice: str | Advice = "",
    *,
    file: str = "",
    within: float = 0.0,
) -> Expectation:
    """The learner's function returns what these examples say; numbers may be off by `within`.

    The first example that it does not meet is shown, with the value that came. What it raises is shown by its line.
    """

    def look(probe: Probe) -> Seen:
        function = learner_function(probe, name, file)
        said = ""
        for arguments, wanted in examples:
            came = probe.call(function, *arguments)
            said = f"{name}({', '.join(map(_shown, arguments))}) is {_shown(came)}"
            if not agrees(came, wanted, within):
                return Seen(False, f"{said}, not {_shown(wanted)}", advice)
        return Seen(True, said)

    return Expectation(expected, look)


def agrees(came: Any, wanted: Any, within: float) -> bool:
    """Whether a value is the wanted one, of its type; a number may be of either type of numbers, and off by `within`."""
    if isinstance(wanted, bool) or not isinstance(wanted, int | float):
        return bool(type(came) is type(wanted) and came == wanted)
    return isinstance(came, int | float) and not isinstance(came, bool) and abs(came - wanted) <= within


def _shown(value: Any) -> str:
    """A value as it is typed; of a float, four decimals at most. A message only by what makes the call readable."""
    if isinstance(value, float):
        return f"{round(value, 4)!r}"
    fields = getattr(value, "get_fields_and_field_types", None)
    if fields is None:
        return repr(value)
    return f"({', '.join(f'{name}={_shown(getattr(value, name))}' for name in fields())})"


def _names_in_cells() -> dict[str, Any]:
    """All names that the notebook's cells have made."""
    return vars(sys.modules["__main__"])


def _names_in(probe: Probe, file: str) -> dict[str, Any]:
    """All names that a file of the package makes when it is read; its `main` is not started."""
    from ...learner.workspace import workspace

    mine = workspace()
    path = mine.package / mine.package.name / file
    if not path.is_file():
        raise CannotLook(f"there is no file {path.relative_to(mine.folder.parent).as_posix()}")
    names = {"__name__": path.stem, "__file__": str(path)}
    probe.call(exec, compile(path.read_text(encoding="utf-8"), str(path), "exec"), names)
    return names
