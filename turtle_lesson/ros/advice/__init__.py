"""What to try about an error of a learner's program, said below the error's own words.

Nothing of this runs before an error is shown. Each adviser looks at an error and says a sentence, or nothing; the first
that has something to say is heard. An error that brings advice of its own (a note) is left as it is.
"""

from __future__ import annotations

import contextlib
from collections.abc import Callable

from ..core import tracebacks
from . import attributes, calls, devices, imports, values

Adviser = Callable[[BaseException], str]

ADVISERS: tuple[Adviser, ...] = (imports.advice, attributes.advice, calls.advice, values.advice, devices.advice)


def advise(error: BaseException) -> None:
    """Add a note to an error that has none, if there is something to say. What goes wrong in it is not worth a word."""
    if getattr(error, "__notes__", None) and not isinstance(error, AssertionError):  # those only tell what came
        return
    with contextlib.suppress(Exception):
        sentence = next(filter(None, (adviser(error) for adviser in ADVISERS)), "")
        if sentence and sentence not in getattr(error, "__notes__", ()):
            error.add_note(sentence)


def install() -> None:
    """Have each error that is shown be looked at; a second call changes nothing."""
    tracebacks.before_showing = advise
