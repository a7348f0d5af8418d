"""`LocalSubstitution`: a value among `context.locals`, such as `event.pid`."""

from __future__ import annotations

from ..launch_context import LaunchContext
from ..substitution import Substitution
from .substitution_failure import SubstitutionFailure


class LocalSubstitution(Substitution):
    """Stands for an attribute of `context.locals`, written with dots."""

    def __init__(self, expression: str, description: str | None = None) -> None:
        self.__expression = expression
        self.__description = description

    @property
    def expression(self) -> str:
        """The attribute, as in `event.action.name`."""
        return self.__expression

    def describe(self) -> str:
        """As in `LocalVar('event.pid')`."""
        return f"LocalVar('{self.__description or self.expression}')"

    def perform(self, context: LaunchContext) -> str:
        """The value as text.

        Raises:
            SubstitutionFailure: if there is no such value.
        """
        value: object = context.locals
        for name in self.expression.split("."):
            try:
                value = getattr(value, name)
            except AttributeError as error:
                raise SubstitutionFailure(f"'{self.expression}': {error}") from error
        return str(value)
