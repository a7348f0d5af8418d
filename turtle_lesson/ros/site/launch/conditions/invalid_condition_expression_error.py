"""`InvalidConditionExpressionError`: a condition's text is neither true nor false."""

from __future__ import annotations

from ..substitution import Substitution


class InvalidConditionExpressionError(ValueError):
    """A condition's text is neither true nor false."""

    def __init__(
        self, expression: str, unexpanded_expression: list[Substitution], valid_expressions: list[str]
    ) -> None:
        source = " + ".join(part.describe() for part in unexpanded_expression)
        super().__init__(
            f"invalid condition expression, expected one of [{', '.join(valid_expressions)}] "
            f"but got '{expression}', expanded from '{source}'"
        )
