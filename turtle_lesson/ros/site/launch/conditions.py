"""Conditions: whether an action is carried out."""

from __future__ import annotations

from collections.abc import Iterable

from ._context import LaunchContext
from ._entities import Condition, SomeSubstitutionsType, Substitution, described, text_of
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


def evaluate_condition_expression(context: LaunchContext, expression: Iterable[Substitution]) -> bool:
    """True for `true` and `1`, False for `false` and `0`, however they are capitalised.

    Raises InvalidConditionExpressionError for any other text.
    """
    pieces = list(expression)
    text = perform_substitutions(context, pieces).strip().lower()
    if text not in ("true", "1", "false", "0"):
        raise InvalidConditionExpressionError(
            "invalid condition expression, expected one of [true, 1, false, 0] "
            f"but got '{text}', expanded from '{described(pieces)}'"
        )
    return text in ("true", "1")


class IfCondition(Condition):
    """Holds for `true` and `1`. `evaluate` raises InvalidConditionExpressionError if the text is neither true nor false."""

    def __init__(self, predicate_expression: SomeSubstitutionsType) -> None:
        expression = normalize_to_list_of_substitutions(predicate_expression)
        super().__init__(predicate=lambda context: evaluate_condition_expression(context, expression))


class UnlessCondition(IfCondition):
    """Holds for `false` and `0`."""

    def evaluate(self, context: LaunchContext) -> bool:
        """Whether it holds now."""
        return not super().evaluate(context)


class LaunchConfigurationEquals(Condition):
    """Holds if the launch configuration has this value; for None, if it is not set at all."""

    def __init__(self, launch_configuration_name: str, expected_value: SomeSubstitutionsType | None) -> None:
        def holds(context: LaunchContext) -> bool:
            context._configurations_read.add(launch_configuration_name)
            expected = None if expected_value is None else text_of(context, expected_value)
            return bool(context.launch_configurations.get(launch_configuration_name) == expected)

        super().__init__(predicate=holds)


class LaunchConfigurationNotEquals(LaunchConfigurationEquals):
    """Holds if the launch configuration has another value; for None, if it is set."""

    def evaluate(self, context: LaunchContext) -> bool:
        """Whether it holds now."""
        return not super().evaluate(context)
