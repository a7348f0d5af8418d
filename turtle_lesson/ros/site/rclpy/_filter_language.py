"""The language of content filters: from text to a tree.

It is the subset of SQL of the DDS specification (annex B), as Fast DDS has it (DDSFilterGrammar.hpp): comparisons of fields
with values, parameters (`%0`) or each other, BETWEEN, LIKE and MATCH, and AND, OR, NOT and parentheses. AND and OR are
taken from the left to the right, neither before the other; NOT belongs to the one condition behind it.
"""

from __future__ import annotations

import re
from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import islice
from typing import NamedTuple

KEYWORDS = frozenset({"AND", "OR", "NOT", "BETWEEN", "LIKE", "MATCH", "TRUE", "FALSE"})
TOKEN = re.compile(
    r"""\s*(?:
    (?P<strange> == | => | =< )
  | (?P<number> [+-]? (?: 0[xX][0-9a-fA-F]+ | \d+ (?:\.\d+)? (?:[eE][+-]?\d+)? ) (?![\w.]) )
  | (?P<text> [`'] [^'\r\n]* ' )
  | (?P<parameter> %\d\d? (?!\d) )
  | (?P<operator> <> | != | <= | >= | [=<>] )
  | (?P<bracket> [()] )
  | (?P<word> [A-Za-z_]\w* (?:\[\d{1,9}\])? (?: \. [A-Za-z_]\w* (?:\[\d{1,9}\])? )* )
  | (?P<end> \Z )
  | (?P<other> . )
    )""",
    re.VERBOSE | re.ASCII | re.DOTALL,
)
INSTEAD = {
    "==": "write a single = for equality",
    "=>": "write >=",
    "=<": "write <=",
    "'": "the text has no end",
    '"': "texts stand in single quotes: 'hello'",
    "&": "write AND",
    "|": "write OR",
    "!": "write NOT, or <> for unequal",
    "%": "parameters are %0 to %99",
}
DEEPEST = 50
LONGEST_NUMBER = 40


class FilterError(ValueError):
    """An expression or a parameter that means nothing; the text says what to write instead."""


class Name(NamedTuple):
    """A field of the message: `linear.x`, `ranges[0]`."""

    path: str


class Parameter(NamedTuple):
    """`%0`: the value is given beside the expression."""

    number: int


class Literal(NamedTuple):
    """A value that stands in the expression."""

    value: bool | int | float | str


Operand = Name | Parameter | Literal


@dataclass(frozen=True, slots=True)
class Comparison:
    """`left operator right`; at least one of the two is a Name."""

    left: Operand
    operator: str
    right: Operand


@dataclass(frozen=True, slots=True)
class Between:
    """`name BETWEEN low AND high`, both ends included."""

    name: Operand
    low: Operand
    high: Operand


@dataclass(frozen=True, slots=True)
class Negation:
    """NOT `condition`."""

    condition: Condition


@dataclass(frozen=True, slots=True)
class Chain:
    """`first`, and then AND or OR one condition after the other."""

    first: Condition
    rest: list[tuple[str, Condition]] = field(default_factory=list)


Condition = Comparison | Between | Negation | Chain


class Token(NamedTuple):
    """A piece of an expression; `kind` is the name of a group of TOKEN, or `keyword`."""

    kind: str
    text: str
    start: int


def parse(expression: str) -> Condition:
    """The tree of an expression. Raises FilterError."""
    parser = _Parser(expression)
    tree = parser.chain()
    parser.expect("end", "", "AND, OR or the end")
    return tree


def parse_value(text: str) -> Literal:
    """The value of a parameter: a number, TRUE, FALSE, or a text in single quotes. Raises FilterError."""
    tokens = list(_tokens(text)) if text == text.strip() else []
    if len(tokens) == 2 and (value := _literal(tokens[0])) is not None:
        return value
    hint = f"; write {chr(39) + text + chr(39)!r} for a text" if re.match(r"[A-Za-z_]", text) else ""
    raise FilterError(
        f"the parameter {text!r} is not a value: numbers, TRUE, FALSE and texts in single quotes are values{hint}"
    )


def _tokens(expression: str) -> Iterator[Token]:
    position = 0
    while True:
        match = TOKEN.match(expression, position)
        assert match is not None and match.lastgroup is not None
        kind, text, position = match.lastgroup, match[match.lastgroup], match.end()
        if kind == "word" and text.upper() in KEYWORDS:
            if text not in (text.upper(), text.lower()):
                raise FilterError(f"write {text.upper()} or {text.lower()}, not {text}")
            kind, text = "keyword", text.upper()
        yield Token(kind, text, match.start(kind if kind != "keyword" else "word"))
        if kind == "end":
            return


def _literal(token: Token) -> Literal | None:
    kind, text = token.kind, token.text
    if kind == "keyword" and text in ("TRUE", "FALSE"):
        return Literal(text == "TRUE")
    if kind == "text":
        return Literal(text[1:-1])
    return Literal(_number(text)) if kind == "number" else None


def _number(text: str) -> int | float:
    if "x" in text.lower() or text.lstrip("+-").isdigit():
        value = int(text, 0 if "x" in text.lower() else 10) if len(text) <= LONGEST_NUMBER else 2**64
        if -(2**63) <= value < 2**64:
            return value
        raise FilterError(f"{text[:LONGEST_NUMBER]} has more than 64 bits")
    return float(text)


class _Parser:
    """Reads one expression. `chain`, `condition` and `comparison` each take what they are named after."""

    def __init__(self, expression: str) -> None:
        self._expression = expression
        self._tokens = deque(_tokens(expression))
        self._depth = 0

    def chain(self) -> Condition:
        """Conditions with AND and OR between them."""
        first, rest = self._condition(), []
        while self._tokens[0].kind == "keyword" and self._tokens[0].text in ("AND", "OR"):
            word = self._tokens.popleft().text
            rest.append((word, self._condition()))
        return Chain(first, rest) if rest else first

    def expect(self, kind: str, text: str, wanted: str) -> Token:
        """Take a token that has to stand here."""
        if self._tokens[0].kind != kind or (text and self._tokens[0].text != text):
            raise self._surprise(wanted)
        return self._tokens.popleft()

    def _next_is(self, *keywords: str) -> bool:
        """Take the next tokens if they are these keywords."""
        found = islice(self._tokens, len(keywords))
        if [token.text for token in found if token.kind == "keyword"] != list(keywords):
            return False
        for _ in keywords:
            self._tokens.popleft()
        return True

    def _condition(self) -> Condition:
        negated = False
        while self._next_is("NOT"):
            negated = not negated
        part = self._in_brackets() if self._tokens[0][:2] == ("bracket", "(") else self._comparison()
        return Negation(part) if negated else part

    def _in_brackets(self) -> Condition:
        self._tokens.popleft()
        self._depth += 1
        if self._depth > DEEPEST:
            raise FilterError(f"more than {DEEPEST} nested parentheses are too many")
        part = self.chain()
        self.expect("bracket", ")", "AND, OR or )")
        self._depth -= 1
        return part

    def _comparison(self) -> Condition:
        left = self._operand()
        if isinstance(left, Name):
            negated = self._next_is("NOT", "BETWEEN")
            if negated or self._next_is("BETWEEN"):
                between = self._between(left)
                return Negation(between) if negated else between
        operator = self._operator()
        right = self._operand()
        if not isinstance(left, Name) and not isinstance(right, Name):
            raise FilterError(f"no field of the message is compared in {self._expression!r}: write x > 5")
        return Comparison(left, operator, right)

    def _between(self, name: Name) -> Between:
        low = self._operand()
        self.expect("keyword", "AND", "AND and the upper end")
        return Between(name, low, self._operand())

    def _operator(self) -> str:
        token = self._tokens[0]
        if token.kind == "operator" or (token.kind == "keyword" and token.text in ("LIKE", "MATCH")):
            return self._tokens.popleft().text
        raise self._surprise("a comparison such as = or >")

    def _operand(self) -> Operand:
        token = self._tokens[0]
        value: Operand | None = _literal(token)
        if token.kind == "word":
            value = Name(token.text)
        elif token.kind == "parameter":
            value = Parameter(int(token.text[1:]))
        if value is None:
            raise self._surprise("a field or a value")
        self._tokens.popleft()
        return value

    def _surprise(self, wanted: str) -> FilterError:
        token = self._tokens[0]
        before, rest = self._expression[: token.start].rstrip(), self._expression[token.start :]
        place = f"behind {before[-30:]!r}" if before else "at the beginning"
        found = repr(rest[:30]) if rest else "the end"
        hint = INSTEAD.get(token.text)
        return FilterError(f"expected {wanted} {place}, got {found}" + (f": {hint}" if hint else ""))
