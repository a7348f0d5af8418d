"""`foreach(…)` in a CMakeLists.txt: over which values it goes, and what stands in it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from .cmake_syntax import Call

MOST_ROUNDS = 10_000
_LEAVES = {"break", "continue", "return"}
_NOT_READ = {"RANGE", "ZIP_LISTS"}


def body_of(calls: Sequence[Call], start: int, kind: str = "foreach") -> list[Call]:
    """The calls from `start` up to the endforeach() that belongs to the foreach() before it, or another kind's end."""
    depth = 1
    for place in range(start, len(calls)):
        depth += {kind: 1, f"end{kind}": -1}.get(calls[place].name, 0)
        if not depth:
            return list(calls[start:place])
    return list(calls[start:])


def can_be_unrolled(call: Call, body: Sequence[Call]) -> bool:
    """Whether such a loop is understood here: it goes over a list, and always to its end."""
    words = {argument.text for argument in call.args}
    return bool(call.args) and not words & _NOT_READ and not any(each.name in _LEAVES for each in body)


def loop_values(words: Sequence[str], variables: Mapping[str, str]) -> Iterator[str]:
    """The values of `foreach(name value …)`, or of `foreach(name IN LISTS variable … ITEMS value …)`."""
    if not words or words[0] != "IN":
        yield from words
        return
    kind = ""
    for word in words[1:]:
        if word in ("LISTS", "ITEMS"):
            kind = word
        elif kind == "LISTS":
            yield from filter(None, variables.get(word, "").split(";"))
        else:
            yield word
