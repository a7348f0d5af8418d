"""`IfCondition`: carried out if a text says true."""

from __future__ import annotations

from ..condition import Condition
from ..launch_context import LaunchContext
from ..some_types import SomeSubstitutionsType
from ..utilities import normalize_to_list_of_substitutions
from .evaluate_condition_expression_impl import evaluate_condition_expression


class IfCondition(Condition):
    """Holds for `true` and `1`."""

    def __init__(self, predicate_expression: SomeSubstitutionsType) -> None:
        super().__init__(predicate=self._holds)
        self.__expression = normalize_to_list_of_substitutions(predicate_expression)

    def _holds(self, context: LaunchContext) -> bool:
        return evaluate_condition_expression(context, self.__expression)
