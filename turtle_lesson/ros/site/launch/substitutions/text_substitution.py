"""`TextSubstitution`: fixed text."""

from __future__ import annotations

from ..launch_context import LaunchContext
from ..substitution import Substitution


class TextSubstitution(Substitution):
    """Text that is known beforehand."""

    def __init__(self, *, text: str) -> None:
        if not isinstance(text, str):
            what = f"TextSubstitution expected Text object got '{type(text)}' instead."
            error = TypeError(what)
            error.add_note(f"Write it as text: TextSubstitution(text='{text}')")
            raise error
        self.__text = text

    @property
    def text(self) -> str:
        """The text."""
        return self.__text

    def describe(self) -> str:
        """The text in quotation marks."""
        return f"'{self.text}'"

    def perform(self, context: LaunchContext) -> str:
        """The text."""
        return self.text
