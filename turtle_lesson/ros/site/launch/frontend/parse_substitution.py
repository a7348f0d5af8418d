"""Text with `$(name argument …)` in it becomes a list of substitutions (facts: launch's grammar.lark).

A backslash takes the meaning from the character behind it. Arguments are parted by one space; one with spaces in
it stands in quotes, and may itself have substitutions in it.
"""

from __future__ import annotations

import re
from typing import Any

from ..substitution import Substitution
from .expose import instantiate_substitution

IDENTIFIER = re.compile(r"[A-Za-z][A-Za-z0-9_-]*")


class SubstitutionSyntaxError(ValueError):
    """A text's `$(…)` are not well formed. `hint` says what to try."""

    def __init__(self, message: str, hint: str = "") -> None:
        super().__init__(message)
        self.hint = hint


def replace_escaped_characters(data: str) -> str:
    """The text without the backslashes that take a character's meaning away."""
    return re.sub(r"\\(.)", r"\1", data)


def parse_substitution(string_value: str) -> list[Substitution]:
    """The pieces of a text: what is plain, and what stands for something.

    Raises:
        SubstitutionSyntaxError: if a `$(` is not closed, or is otherwise wrong.
    """
    from ..substitutions.text_substitution import TextSubstitution

    if not isinstance(string_value, str):
        raise TypeError(f"expected text, got {string_value!r} of type {type(string_value).__name__}")
    try:
        return _Reader(string_value).template("") or [TextSubstitution(text=string_value)]
    except RecursionError:
        raise SubstitutionSyntaxError("the substitutions are nested too deeply") from None


def parse_if_substitutions(value: Any) -> Any:
    """A value with its texts parsed; text without substitutions stays text, and other values as they are.

    Raises:
        ValueError: if the items of a list are of several types.
    """
    kinds: set[type] = set()
    if not isinstance(value, list):
        return _parsed(value, kinds)
    items = [_parsed(item, kinds) for item in value]
    if len(kinds) > 1:
        raise ValueError("The result is a non-uniform list")
    return items


def _parsed(value: Any, kinds: set[type]) -> Any:
    from ..substitutions.text_substitution import TextSubstitution

    if not isinstance(value, str):
        kinds.add(type(value))
        return value
    pieces = parse_substitution(value)
    if len(pieces) == 1 and isinstance(pieces[0], TextSubstitution):
        kinds.add(str)
        return pieces[0].text
    return pieces


class _Reader:
    """Reads one text from left to right."""

    def __init__(self, text: str) -> None:
        self._text = text
        self._at = 0

    def template(self, quote: str) -> list[Substitution]:
        """Everything up to the closing quote; without one, up to the end."""
        found: list[Substitution] = []
        while self._here and self._here != quote:
            found += [self._substitution(quote)] if self._begins_one else self._plain(quote)
        if quote and not self._here:
            raise self._wrong(f"Close the quotation mark {quote} that begins an argument.")
        return found

    def _plain(self, stop: str, *, argument: bool = False) -> list[Substitution]:
        """Text up to a substitution or a character of `stop`; in an argument spaces and brackets end it, too."""
        from ..substitutions.text_substitution import TextSubstitution

        stops = f"{stop} ()" if argument else stop
        found = ""
        while self._here and self._here not in stops and not self._begins_one:
            if self._here == "$":
                raise self._wrong(r"A dollar sign that begins no $(…) is written \$.")
            if self._here == "\\":
                self._at += 1
            found += self._here
            self._at += 1
        return [TextSubstitution(text=found)] if found else []

    def _substitution(self, quote: str) -> Substitution:
        begin = self._at
        self._at += 2
        name = IDENTIFIER.match(self._text, self._at)
        if name is None:
            raise self._wrong("After $( comes the name of a substitution, as in $(var rate).")
        self._at = name.end()
        arguments = []
        while self._here == " ":
            self._at += 1
            arguments.append(self._argument(quote))
        if self._here != ")":
            raise self._wrong(f"Is the bracket of {self._text[begin : begin + 20]!r} closed?")
        self._at += 1
        return instantiate_substitution(name[0], arguments)

    def _argument(self, quote: str) -> list[Substitution]:
        from ..substitutions.text_substitution import TextSubstitution

        if not quote and self._here in {"'", '"'}:
            mark = self._here
            self._at += 1
            inner = self.template(mark)
            self._at += 1
            return inner or [TextSubstitution(text="")]
        found: list[Substitution] = []
        begin = self._at
        while self._here and self._here not in f"{quote or chr(39) + chr(34)} ()":
            found += [self._substitution(quote)] if self._begins_one else self._plain(quote or "'\"", argument=True)
        if self._at == begin:
            raise self._wrong("Separate arguments by one space; put an argument with spaces in quotes.")
        return found or [TextSubstitution(text="")]

    @property
    def _here(self) -> str:
        """The next character, or nothing at the end."""
        return self._text[self._at : self._at + 1]

    @property
    def _begins_one(self) -> bool:
        return self._text.startswith("$(", self._at)

    def _wrong(self, hint: str) -> SubstitutionSyntaxError:
        what = (
            f"No terminal matches {self._here!r} in the current parser context"
            if self._here
            else ("Unexpected end-of-input")
        )
        return SubstitutionSyntaxError(f"{what}, at line 1 col {self._at + 1} of {self._text!r}", hint)
