"""`ForEach` and `ForLoop`: the same actions several times over."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from copy import deepcopy
from typing import Any

from .. import logging
from ..action import Action
from ..frontend import Entity, Parser, expose_action
from ..launch_context import LaunchContext
from ..launch_description_entity import LaunchDescriptionEntity
from ..some_types import SomeSubstitutionsType
from ..substitution import Substitution
from ..substitutions import ForEachVar
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions
from .opaque_function import OpaqueFunction

MOST_ROUNDS = 10_000
"""So many rounds may a loop have; a number that is larger is a mistake, and would never end."""

Entities = list[LaunchDescriptionEntity]


@expose_action("for_each")
class ForEach(Action):
    """Calls a function with each set of values, such as `{name: a, id: 1};{name: b, id: 2}`."""

    SEPARATOR = ";"

    def __init__(
        self, input_values: SomeSubstitutionsType, *, function: Callable[..., Entities | None], **kwargs: Any
    ) -> None:
        super().__init__(**kwargs)
        self._input_values = normalize_to_list_of_substitutions(input_values)
        self._function = function

    @property
    def input_values(self) -> list[Substitution]:
        """The sets of values, as YAML parted by semicolons."""
        return self._input_values

    @property
    def function(self) -> Callable[..., Entities | None]:
        """What is called with each."""
        return self._function

    def describe(self) -> str:
        """Its name with what it was given."""
        return f"{type(self).__name__}(input_values='{self._input_values}', function={self._function})"

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type, dict[str, Any]]:
        """Its arguments from `values` and the actions in it."""
        _, kwargs = super().parse(entity, parser)
        kwargs["input_values"] = parser.parse_substitution(entity.get_attr("values"))
        children = [parser.parse_action(child) for child in entity.children]

        def for_each(**values: Any) -> Entities:
            return one_round(children, values)

        return cls, {**kwargs, "function": for_each}

    def execute(self, context: LaunchContext) -> Entities | None:
        """Call the function with each set, and give all that it gave."""
        from turtle_lesson.ros.bounded_yaml import safe_load

        text = perform_substitutions(context, self._input_values)
        sets = [safe_load(part.strip()) for part in text.strip().split(self.SEPARATOR) if part]
        if not sets:
            logging.get_logger("launch.actions.for_loop").warning("no input values: will not iterate")
        found: Entities = []
        for values in sets:
            if values is None:
                continue
            if not isinstance(values, Mapping):
                raise TypeError(f"ForEach expected sets such as '{{name: a}};{{name: b}}', got {values!r} in {text!r}")
            found += self._function(**values) or []
        return found


@expose_action("for")
class ForLoop(Action):
    """Calls a function with 0, 1, 2, … below a length."""

    def __init__(
        self,
        length: SomeSubstitutionsType,
        *,
        function: Callable[..., Entities | None],
        name: str | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self._length = normalize_to_list_of_substitutions(length)
        self._function = function
        self._name = name

    @property
    def length(self) -> list[Substitution]:
        """How many times, as text that is a number."""
        return self._length

    @property
    def function(self) -> Callable[..., Entities | None]:
        """What is called with each number, as `i`."""
        return self._function

    @property
    def name(self) -> str | None:
        """What `$(index …)` calls the number."""
        return self._name

    def describe(self) -> str:
        """Its name with what it was given."""
        return f"{type(self).__name__}(length='{self._length}', name='{self._name}', function={self._function})"

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type, dict[str, Any]]:
        """Its arguments from `len`, `name` and the actions in it."""
        _, kwargs = super().parse(entity, parser)
        name = entity.get_attr("name")
        kwargs["length"] = parser.parse_substitution(entity.get_attr("len"))
        children = [parser.parse_action(child) for child in entity.children]

        def for_i(i: int) -> Entities:
            return one_round(children, {name: i})

        return cls, {**kwargs, "name": name, "function": for_i}

    def execute(self, context: LaunchContext) -> Entities | None:
        """Call the function with each number, and give all that it gave.

        Raises:
            ValueError: if the length is no number.
        """
        length = int(perform_substitutions(context, self._length))
        if length > MOST_ROUNDS:
            raise ValueError(f"ForLoop has at most {MOST_ROUNDS} rounds here, got {length}")
        return [entity for i in range(length) for entity in self._function(i=i) or []]


def one_round(children: Sequence[LaunchDescriptionEntity], values: Mapping[str, Any]) -> Entities:
    """The actions of one round, which see the round's values and no other's."""
    named = {ForEachVar.get_local_arg_name(name): str(value) for name, value in values.items()}
    return [
        OpaqueFunction(function=lambda context: context._push_locals()),
        OpaqueFunction(function=lambda context: context.extend_locals(named)),
        *deepcopy(children),
        OpaqueFunction(function=lambda context: context._pop_locals()),
    ]
