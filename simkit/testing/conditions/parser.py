"""Parse expressions: a tokenizer and a Pratt parser by binding powers.

No part of Python reads or runs an expression.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from typing import Final, Literal

from simkit.testing.conditions.syntax_tree import (
    Arithmetic,
    Attribute,
    Call,
    Comparison,
    Expression,
    Index,
    Junction,
    Name,
    Node,
    Not,
    Number,
    Numbers,
    Sign,
    Span,
    Text,
    expression_error,
)

TokenKind = Literal["number", "name", "text", "sign", "end"]

MAX_LENGTH: Final = 2000
"""Characters of an expression."""

_TOKEN = re.compile(
    r"(?P<space>\s+)"
    r"|(?P<number>(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)"
    r"|(?P<name>[^\W\d]\w*)"
    r"|(?P<text>'[^'\n]*'|\"[^\"\n]*\")"
    r"|(?P<sign>\*\*|<=|>=|==|!=|[-+*/%<>(),.\[\]])"
)
_SUGGESTED_OPERATORS = {
    "=": "two values are compared by ==",
    "&&": "write: and",
    "||": "write: or",
    "&": "write: and",
    "|": "write: or",
    "!": "write: not",
    "^": "a power is written **",
    "//": "floor(a / b) is the whole part of a quotient",
    ";": "join conditions by: and",
    "{": "there are no lists or tables",
    "\u2264": "write <=",
    "\u2265": "write >=",
    "\u2260": "write !=",
    "\u201c": "texts stand in plain quotes: 'tb3'",
    "\u2018": "texts stand in plain quotes: 'tb3'",
    "\u2019": "texts stand in plain quotes: 'tb3'",
}
_UNITS = {"s", "ms", "m", "mm", "cm", "km", "deg", "rad", "Hz", "hz", "kg", "N", "min", "h"}


@dataclass(frozen=True, slots=True)
class Token:
    """One word with its place."""

    kind: TokenKind
    text: str
    span: Span


def tokenize(source: str) -> list[Token]:
    """The words of a text, with an end behind them.

    Raises:
        InputError: SK-COND-001 it has a sign that means nothing; SK-COND-008 it is too long.
    """
    if len(source) > MAX_LENGTH:
        raise expression_error(
            "SK-COND-008",
            f"an expression of {len(source)} characters; allowed are {MAX_LENGTH}",
            source,
            Span(MAX_LENGTH, MAX_LENGTH + 1),
            "make several checks of it",
        )
    found: list[Token] = []
    at = 0
    while at < len(source):
        match = _TOKEN.match(source, at)
        if match is None or match.lastgroup is None:
            raise _invalid_character(source, at)
        if match.lastgroup != "space":
            token = Token(match.lastgroup, match.group(), Span(at, match.end()))  # type: ignore[arg-type]
            _check_separation(source, found[-1] if found else None, token)
            found.append(token)
        at = match.end()
    found.append(Token("end", "", Span(len(source), len(source) + 1)))
    return found


def _check_separation(source: str, before: Token | None, token: Token) -> None:
    """A number and a name that touch are a unit, or a name that begins with a digit."""
    if before is None or before.kind != "number" or token.kind != "name" or before.span.end != token.span.start:
        return
    span = Span(before.span.start, token.span.end)
    if token.text in _UNITS:
        hint = f"numbers are in SI units (m, s, rad) and stand alone: {before.text}"
        if token.text == "deg":
            hint = f"angles are in rad: rad({before.text}) makes some of degrees"
        raise expression_error("SK-COND-001", f"{span.text(source)!r} has a unit", source, span, hint)
    raise expression_error("SK-COND-001", f"{span.text(source)!r} is neither a number nor a name", source, span)


def _invalid_character(source: str, at: int) -> Exception:
    sign = source[at]
    if sign in "'\"":
        return expression_error(
            "SK-COND-001", "a text that has no end", source, Span(at, len(source)), f"close it with {sign}"
        )
    pair = source[at : at + 2]
    if pair in _SUGGESTED_OPERATORS:
        return expression_error(
            "SK-COND-001", f"{pair} means nothing here", source, Span(at, at + 2), _SUGGESTED_OPERATORS[pair]
        )
    what = f"{sign!r} means nothing here" if sign.isprintable() else f"a sign that cannot be read (U+{ord(sign):04X})"
    return expression_error("SK-COND-001", what, source, Span(at, at + 1), _SUGGESTED_OPERATORS.get(sign, ""))


MAX_DEPTH: Final = 100
"""Levels of an expression within each other."""

_OR, _AND, _NOT, _COMPARE, _SUM, _PRODUCT, _SIGN, _POWER, _POSTFIX = range(1, 10)
_COMPARISONS = ("<", "<=", ">", ">=", "==", "!=")
_BINDING = {
    "or": _OR,
    "and": _AND,
    **dict.fromkeys(_COMPARISONS, _COMPARE),
    **dict.fromkeys("+-", _SUM),
    **dict.fromkeys("*/%", _PRODUCT),
    "**": _POWER,
    **dict.fromkeys(".[(", _POSTFIX),
}
_PYTHON_KEYWORDS = {"if", "else", "for", "in", "is", "lambda", "import"}


def parse(source: str) -> Expression:
    """Reads an expression; what it names is looked up when it is bound to a world.

    Raises:
        InputError: SK-COND-001 it cannot be read; SK-COND-008 it is too long or too deep. The message shows the place.
    """
    return Expression(source, _Parser(source).whole())


class _Parser:
    def __init__(self, source: str) -> None:
        self._source = source
        self._tokens = tokenize(source)
        self._at = 0
        self._open = 0

    @property
    def _next(self) -> Token:
        return self._tokens[self._at]

    def _take(self) -> Token:
        token = self._tokens[self._at]
        self._at += 1
        return token

    def whole(self) -> Node:
        if len(self._tokens) == 1:
            raise expression_error("SK-COND-001", "an expression is empty", self._source, self._next.span)
        root = self._expression(0)
        after = self._next
        if after.kind != "end":
            raise self._unexpected(after)
        return root

    # ------------------------------------------------------------------ by binding power

    def _expression(self, least: int) -> Node:
        """What binds more tightly than `least`."""
        self._open += 1
        if self._open > MAX_DEPTH:
            raise self._too_deep(self._next.span)
        left = self._prefix()
        while True:
            token = self._next
            binding = _BINDING.get(token.text, 0) if token.kind in ("sign", "name") else 0
            if binding <= least:
                break
            left = self._infix(left, token, binding)
        self._open -= 1
        return left

    def _prefix(self) -> Node:
        token = self._take()
        if token.kind == "number":
            return Number(token.span, 1, float(token.text))
        if token.kind == "text":
            return Text(token.span, 1, token.text[1:-1])
        if token.text == "not":
            operand = self._expression(_NOT)
            return Not(self._from(token.span, operand), self._level(operand), operand)
        if token.text in ("-", "+"):
            operand = self._expression(_SIGN)
            return Sign(self._from(token.span, operand), self._level(operand), token.text, operand)
        if token.text == "(":
            return self._bracketed(token)
        if token.kind == "name" and token.text not in ("and", "or") and token.text not in _PYTHON_KEYWORDS:
            return Name(token.span, 1, token.text)
        raise self._unexpected(token)

    def _bracketed(self, opened: Token) -> Node:
        """What stands in brackets: one part of an expression, or the numbers of a list with commas between."""
        items = [self._expression(0)]
        while self._next.kind == "sign" and self._next.text == ",":
            self._take()
            items.append(self._expression(0))
        span = Span(opened.span.start, self._expect(")", opened).span.end)
        return replace(items[0], span=span) if len(items) == 1 else Numbers(span, self._level(*items), tuple(items))

    def _infix(self, left: Node, token: Token, binding: int) -> Node:
        if token.text in ("and", "or"):
            return self._junction(left, token.text, binding)
        if token.text in _COMPARISONS:
            return self._comparison(left)
        self._take()
        if token.text == ".":
            return self._attribute(left)
        if token.text == "[":
            index = self._expression(0)
            end = self._expect("]", token)
            return Index(Span(left.span.start, end.span.end), self._level(left, index), left, index)
        if token.text == "(":
            return self._call(left, token)
        # a power binds to the right, and its exponent may have a sign
        right = self._expression(_SIGN - 1 if token.text == "**" else binding)
        span = Span(left.span.start, right.span.end)
        return Arithmetic(span, self._level(left, right), token.text, token.span, left, right)

    def _junction(self, left: Node, word: str, binding: int) -> Node:
        operands = [left]
        while self._next.text == word and self._next.kind == "name":
            self._take()
            operands.append(self._expression(binding))
        span = Span(left.span.start, operands[-1].span.end)
        return Junction(span, self._level(*operands), word, tuple(operands))

    def _comparison(self, left: Node) -> Node:
        signs, operands = [], [left]
        while self._next.kind == "sign" and self._next.text in _COMPARISONS:
            signs.append(self._take().text)
            operands.append(self._expression(_COMPARE))
        span = Span(left.span.start, operands[-1].span.end)
        return Comparison(span, self._level(*operands), tuple(signs), tuple(operands))

    def _attribute(self, left: Node) -> Node:
        name = self._take()
        if name.kind != "name":
            raise expression_error(
                "SK-COND-001", "the name of a part is missing after the dot", self._source, name.span
            )
        return Attribute(Span(left.span.start, name.span.end), self._level(left), left, name.text, name.span)

    def _call(self, left: Node, bracket: Token) -> Node:
        if not isinstance(left, Name):
            message = "only functions are called, by their name"
            raise expression_error(
                "SK-COND-001", message, self._source, left.span, "parts of values are read: pose('tb3').x"
            )
        arguments: list[Node] = []
        while self._next.text != ")" or self._next.kind != "sign":
            arguments.append(self._expression(0))
            if self._next.kind == "sign" and self._next.text == ",":
                self._take()
            elif self._next.kind != "sign" or self._next.text != ")":
                break
        end = self._expect(")", bracket)
        span = Span(left.span.start, end.span.end)
        return Call(span, self._level(*arguments), left.name, left.span, tuple(arguments))

    # ------------------------------------------------------------------ what is wrong

    def _expect(self, sign: str, opened: Token) -> Token:
        token = self._next
        if token.kind == "sign" and token.text == sign:
            return self._take()
        if token.kind == "end":
            message = f"{sign} is missing: this {opened.text} is never closed"
            raise expression_error("SK-COND-001", message, self._source, opened.span)
        raise self._unexpected(token, sign)

    def _unexpected(self, token: Token, wanted: str = "") -> Exception:
        before = self._tokens[self._tokens.index(token) - 1] if token is not self._tokens[0] else None
        hint = ""
        if token.kind == "end":
            message = f"it ends after {before.text!r}, where a value is missing" if before else "it is empty"
        elif token.text in _PYTHON_KEYWORDS:
            message, hint = f"{token.text!r} is no word of this language", "this is no Python: see docs/conditions.md"
        elif token.kind in ("name", "number", "text") and before and before.kind in ("name", "number", "text"):
            message = f"{token.text} stands right after {before.text}"
            hint = "join conditions by: and, or; values by + - * / %"
            if before.kind == "name" and before.text not in ("and", "or", "not"):
                hint = f"a function's arguments stand in brackets: {before.text}({token.text})"
        else:
            message = f"{token.text!r} is not expected here"
        if wanted and token.kind != "end":
            message += f"; {wanted} is missing before it"
        return expression_error("SK-COND-001", message, self._source, token.span, hint)

    def _too_deep(self, span: Span) -> Exception:
        message = f"an expression of more than {MAX_DEPTH} levels within each other"
        return expression_error("SK-COND-008", message, self._source, span, "make several checks of it")

    def _level(self, *below: Node) -> int:
        depth = 1 + max((node.depth for node in below), default=0)
        if depth > MAX_DEPTH:
            raise self._too_deep(below[0].span)
        return depth

    @staticmethod
    def _from(span: Span, node: Node) -> Span:
        return Span(span.start, node.span.end)
