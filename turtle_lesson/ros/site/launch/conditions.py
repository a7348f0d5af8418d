"""Conditions: whether an action is carried out."""

from __future__ import annotations

from collections.abc import Iterable

from ._context import LaunchContext
from ._entities import Condition, SomeSubstitutionsType, Substitution, described
from .utilities import normalize_to_list_of_substitutions, perform_substitutions

__all__ = [
    "IfCondition",
    "InvalidConditionExpressionError",
    "LaunchConfigurationEquals",
    "LaunchConfigurationNotEquals",
    "UnlessCondition",
    "evaluate_condition_expression",
]


class InvalidConditionExpressionError(ValueError):
    """A condition's text is neither true nor false."""

    def __init__(
        self, expression: str, unexpanded_expression: list[Substitution], valid_expressions: list[str]
    ) -> None:
        super().__init__(
            f"invalid condition expression, expected one of [{', '.join(valid_expressions)}] "
            f"but got '{expression}', expanded from '{described(unexpanded_expression)}'"
        )


VALID_TRUE_EXPRESSIONS = ["true", "1"]
VALID_FALSE_EXPRESSIONS = ["false", "0"]


def evaluate_condition_expression(context: LaunchContext, expression: Iterable[Substitution]) -> bool:
    """True for `true` and `1`, False for `false` and `0`, however they are capitalised.

    Raises InvalidConditionExpressionError for any other text.
    """
    pieces = list(expression)
    text = perform_substitutions(context, pieces).strip().lower()
    valid = VALID_TRUE_EXPRESSIONS + VALID_FALSE_EXPRESSIONS
    if text not in valid:
        raise InvalidConditionExpressionError(text, pieces, valid)
    return text in VALID_TRUE_EXPRESSIONS


class IfCondition(Condition):
    """Holds for `true` and `1`."""

    def __init__(self, predicate_expression: SomeSubstitutionsType) -> None:
        super().__init__(predicate=self._holds)
        self.__expression = normalize_to_list_of_substitutions(predicate_expression)

    def _holds(self, context: LaunchContext) -> bool:
        return evaluate_condition_expression(context, self.__expression)


class UnlessCondition(IfCondition):
    """Holds for `false` and `0`."""

    def _holds(self, context: LaunchContext) -> bool:
        return not super()._holds(context)


class LaunchConfigurationEquals(Condition):
    """Holds if the launch configuration has this value; for None, if it is not set at all."""

    def __init__(self, launch_configuration_name: str, expected_value: SomeSubstitutionsType | None) -> None:
        super().__init__(predicate=self._holds)
        self.__name = launch_configuration_name
        self.__expected = None if expected_value is None else normalize_to_list_of_substitutions(expected_value)

    def _holds(self, context: LaunchContext) -> bool:
        context._configurations_read.add(self.__name)
        value = context.launch_configurations.get(self.__name)
        if self.__expected is None or value is None:
            return self.__expected is None and value is None
        return bool(value == perform_substitutions(context, self.__expected))


class LaunchConfigurationNotEquals(LaunchConfigurationEquals):
    """Holds if the launch configuration has another value; for None, if it is set."""

    def _holds(self, context: LaunchContext) -> bool:
        return not super()._holds(context)
