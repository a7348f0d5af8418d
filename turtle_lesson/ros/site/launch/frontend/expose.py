"""Which tag stands for which action, and which `$(name …)` for which substitution."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, TypeVar

if TYPE_CHECKING:
    from ..action import Action
    from ..substitution import Substitution
    from .entity import Entity
    from .parser import Parser

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
    "lifecycle_transition": "It is not available here: give lifecycle_node the attribute autostart.",
    "string-join": "$(string-join …) is not available here: write the pieces one after the other.",
}
"""What a real launch has and this one does not, with what to do instead."""


def instantiate_action(entity: Entity, parser: Parser) -> Action:
    """The action that an entity stands for.

    Raises:
        RuntimeError: if no action has this name; and whatever its `parse` raises, with the place.
    """
    try:
        method = _known(action_parse_methods, entity.type_name, "Unrecognized entity of the type: ")
        action_type, kwargs = method(entity, parser)
        entity.assert_entity_completely_parsed()
        action: Action = action_type(**kwargs)
    except Exception as error:
        if getattr(error, "place", None) is None:
            error.place = entity.place  # type: ignore[attr-defined]
        raise
    action._written_at = entity.place
    return action


def instantiate_substitution(type_name: str, args: Sequence[Any] | None = None) -> Substitution:
    """The substitution that `$(type_name args…)` stands for; each argument is a list of substitutions.

    Raises:
        RuntimeError: if no substitution has this name; and whatever its `parse` raises.
    """
    method = _known(substitution_parse_methods, type_name, "Unknown substitution: ")
    substitution_type, kwargs = method([] if args is None else list(args))
    substitution: Substitution = substitution_type(**kwargs)
    return substitution


def _known(methods: dict[str, Callable[..., Any]], name: str, complaint: str) -> Callable[..., Any]:
    if name in methods:
        return methods[name]
    from turtle_lesson.ros.workspace.errors import did_you_mean

    error = RuntimeError(f"{complaint}{name}")
    close = did_you_mean(str(name)[:100], sorted(methods)) or f"There are: {', '.join(sorted(methods))}."
    error.hint = _NOT_HERE.get(name) or close  # type: ignore[attr-defined]
    raise error


def expose_action(name: str) -> Callable[[Exposed], Exposed]:
    """Let a tag of this name stand for an action: decorates its class, which has a class method `parse`."""
    return _exposing(name, action_parse_methods, "action")


def expose_substitution(name: str) -> Callable[[Exposed], Exposed]:
    """Let `$(name …)` stand for a substitution: decorates its class, which has a class method `parse`."""
    return _exposing(name, substitution_parse_methods, "substitution")


def _exposing(name: str, methods: dict[str, Callable[..., Any]], kind: str) -> Callable[[Exposed], Exposed]:
    def expose(exposed: Exposed) -> Exposed:
        methods[name] = _parse_method(exposed, name, kind)
        return exposed

    return expose


def _parse_method(exposed: Any, name: str, kind: str) -> Callable[..., Any]:
    if inspect.isclass(exposed):
        method = getattr(exposed, "parse", None)
        if method is None or not inspect.ismethod(method):
            raise RuntimeError("Did not find a class method called 'parse' in the class being decorated.")
        return method
    if inspect.isfunction(exposed):
        return exposed
    raise RuntimeError(f"Exposed {kind} parser for {name} is not a callable or a class containing a parse method")
