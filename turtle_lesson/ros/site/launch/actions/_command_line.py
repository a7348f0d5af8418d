"""A command written as one text, taken apart into words as a shell would."""

from __future__ import annotations

import shlex
from collections.abc import Iterable

from ..substitution import Substitution
from ..substitutions.text_substitution import TextSubstitution


def words_in(pieces: Iterable[Substitution]) -> list[list[Substitution]]:
    """The words of a text; a substitution belongs to the text that it touches, and is never taken apart."""
    words: list[list[Substitution]] = []
    word: list[Substitution] = []
    for piece in pieces:
        if not isinstance(piece, TextSubstitution):
            word.append(piece)
            continue
        text = piece.text
        if text[:1].isspace() and word:
            words.append(word)
            word = []
        for number, token in enumerate(shlex.split(text)):
            if number > 0:
                words.append(word)
                word = []
            word.append(TextSubstitution(text=token))
        if text[-1:].isspace() and word:
            words.append(word)
            word = []
    return [*words, word] if word else words
