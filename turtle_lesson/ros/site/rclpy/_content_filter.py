"""Content filters: from an expression and a message class to a function that says which messages come in.

All is settled when the filter is set. A value of a sequence that is not there lets no message in, whatever is asked of it.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ._filter_language import (
    Between,
    Chain,
    Comparison,
    Condition,
    FilterError,
    Literal,
    Name,
    Negation,
    Operand,
    parse,
    parse_value,
)
from ._filter_values import OPERATORS, Predicate, Value, compared, constant_of, field_of, matched, words_of
from .exceptions import RCLError
from .subscription_content_filter_options import ContentFilterOptions

MOST_PARAMETERS = 100


def content_filter(message_class: Any, expression: str, parameters: list[str]) -> Predicate:
    """The function that says of a message whether it comes in. Raises FilterError."""
    passes = _Compiler(message_class, parameters).condition(parse(expression))

    def comes_in(message: Any) -> bool:
        try:
            return passes(message)
        except (IndexError, FilterError):  # a sequence is shorter; a field's text is no pattern
            return False

    return comes_in


def prepared(message_class: Any, options: Any, refusal: str) -> tuple[ContentFilterOptions | None, Predicate | None]:
    """A filter as it is kept and as it is used; twice None where the expression is empty.

    Raises AttributeError and TypeError for options that are none, and RCLError, its text begun with `refusal`.
    """
    for name in ContentFilterOptions._fields:
        if not hasattr(options, name):
            raise AttributeError(
                f"{type(options).__name__!r} object has no attribute {name!r}: a filter is made with "
                "ContentFilterOptions(filter_expression='x > %0', expression_parameters=['5'])"
            )
    expression, parameters = options.filter_expression, options.expression_parameters
    _check_types(expression, parameters)
    if not expression:
        return None, None
    if len(parameters) > MOST_PARAMETERS:
        raise RCLError(f"{refusal}: {len(parameters)} parameters were given, and {MOST_PARAMETERS} can be")
    try:
        chooses = content_filter(message_class, expression, parameters)
    except FilterError as error:
        raise RCLError(f"{refusal}: {error}") from None
    return ContentFilterOptions(expression, list(parameters)), chooses


def _check_types(expression: Any, parameters: Any) -> None:
    if not isinstance(expression, str):
        raise TypeError(f"filter_expression must be a str such as 'x > %0', got {expression!r}")
    if isinstance(parameters, str) or not isinstance(parameters, Sequence):
        raise TypeError(f"expression_parameters must be a list of str such as ['5'], got {parameters!r}")
    for each in parameters:
        if not isinstance(each, str):
            raise TypeError(f"expression_parameters are texts, got {each!r}: write {str(each)!r}")


class _Compiler:
    """Makes predicates of the parts of an expression's tree."""

    def __init__(self, message_class: Any, parameters: list[str]) -> None:
        self._message_class = message_class
        self._parameters = parameters

    def condition(self, tree: Condition) -> Predicate:
        """The predicate of a part of the tree."""
        if isinstance(tree, Chain):
            return self._chain(tree)
        if isinstance(tree, Negation):
            part = self.condition(tree.condition)
            return lambda message: not part(message)
        if isinstance(tree, Between):
            return self._between(tree)
        return self._comparison(tree)

    def _chain(self, tree: Chain) -> Predicate:
        first = self.condition(tree.first)
        rest = [(word == "AND", self.condition(part)) for word, part in tree.rest]

        def chain(message: Any) -> bool:
            so_far = first(message)
            for is_and, part in rest:
                if so_far is is_and:  # or else this part makes no difference
                    so_far = part(message)
            return so_far

        return chain

    def _between(self, tree: Between) -> Predicate:
        value, low, high = (self._value(each) for each in (tree.name, tree.low, tree.high))
        above, below = compared(low, "<=", value), compared(value, "<=", high)
        return lambda message: above(message) and below(message)

    def _comparison(self, tree: Comparison) -> Predicate:
        left, right = self._value(tree.left), self._value(tree.right)
        if tree.operator in OPERATORS:
            return compared(left, tree.operator, right)
        for side, value in ((tree.left, left), (tree.right, right)):
            if value.kind != "text":
                raise FilterError(f"{tree.operator} compares texts; {side[0]!r} is {words_of(value.kind)}")
        return matched(left, tree.operator, right)

    def _value(self, operand: Operand) -> Value:
        if isinstance(operand, Name):
            return field_of(self._message_class, operand.path)
        if isinstance(operand, Literal):
            return constant_of(operand.value)
        return constant_of(self._parameter(operand.number).value, f"%{operand.number}, which is ")

    def _parameter(self, number: int) -> Literal:
        if number >= len(self._parameters):
            raise FilterError(
                f"the expression uses %{number}, and expression_parameters holds {len(self._parameters)}: "
                "%0 is the first of them"
            )
        return parse_value(self._parameters[number])
