"""Parser of expressions: a tokenizer and a Pratt parser with binding powers.

Expressions are never parsed or run as Python code.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final, Literal

from simkit.number_text import counted
from simkit.testing.conditions import syntax_tree as syntax

TokenKind = Literal["number", "name", "text", "sign", "end"]

MAX_LENGTH: Final = 2000
"""Maximum length of an expression in characters."""

_TOKEN = re.compile(
    r"(?P<space>\s+)"
    r"|(?P<number>(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)"
    r"|(?P<name>[^\W\d]\w*)"
    r"|(?P<text>'[^'\n]*'|\"[^\"\n]*\")"
    r"|(?P<sign>\*\*|<=|>=|==|!=|[-+*/%<>(),.\[\]])"
)
_OPERATORS_FILE: Final = Path(__file__).with_name("suggested_operators.toml")
_SUGGESTED_OPERATORS: Final[dict[str, str]] = tomllib.loads(_OPERATORS_FILE.read_text(encoding="utf-8"))
_UNITS = {"s", "ms", "m", "mm", "cm", "km", "deg", "rad", "Hz", "hz", "kg", "N", "min", "h"}


@dataclass(frozen=True, slots=True)
class Token:
    """Token with its position."""

    kind: TokenKind
    text: str
    span: syntax.Span


def tokenize(source: str) -> list[Token]:
    """Split a text into tokens and append an end token.

    Raises:
        InputError: SK-COND-001 the text has an invalid character; SK-COND-008 the text is too long.
    """
    if len(source) > MAX_LENGTH:
        message = f"the expression has {counted(len(source), 'character')}; the limit is {MAX_LENGTH}"
        span = syntax.Span(MAX_LENGTH, MAX_LENGTH + 1)
        raise syntax.expression_error("SK-COND-008", message, source, span, "split it into several checks")
    tokens: list[Token] = []
    at = 0
    while at < len(source):
        match = _TOKEN.match(source, at)
        if match is None or match.lastgroup is None:
            raise _invalid_character(source, at)
        if match.lastgroup != "space":
            token = Token(match.lastgroup, match.group(), syntax.Span(at, match.end()))  # type: ignore[arg-type]
            _check_separation(source, tokens[-1] if tokens else None, token)
            tokens.append(token)
        at = match.end()
    tokens.append(Token("end", "", syntax.Span(len(source), len(source) + 1)))
    return tokens


def _check_separation(source: str, before: Token | None, token: Token) -> None:
    """Raise an error if a name follows a number without a space, as in `3m` or `2nd`."""
    if before is None or before.kind != "number" or token.kind != "name" or before.span.end != token.span.start:
        return
    span = before.span.to(token.span)
    what, hint = "is neither a number nor a name", ""
    if token.text in _UNITS:
        what, hint = "has a unit", f"numbers are in SI units (m, s, rad) and have no unit: write {before.text}"
        if token.text == "deg":
            hint = f"angles are in rad: write rad({before.text}) to convert degrees"
    raise _syntax_error(f"{span.text(source)!r} {what}", source, span, hint)


def _syntax_error(message: str, source: str, span: syntax.Span, hint: str = "") -> Exception:
    return syntax.expression_error("SK-COND-001", message, source, span, hint)


def _invalid_character(source: str, at: int) -> Exception:
    sign = source[at]
    if sign in "'\"":
        return _syntax_error("missing closing quote", source, syntax.Span(at, len(source)), f"close it with {sign}")
    pair = source[at : at + 2]
    if pair in _SUGGESTED_OPERATORS:
        span = syntax.Span(at, at + 2)
        return _syntax_error(f"invalid operator {pair}", source, span, _SUGGESTED_OPERATORS[pair])
    what = f"invalid character {sign!r}" if sign.isprintable() else f"invalid character U+{ord(sign):04X}"
    return _syntax_error(what, source, syntax.Span(at, at + 1), _SUGGESTED_OPERATORS.get(sign, ""))


MAX_DEPTH: Final = 100
"""Maximum number of nested levels of an expression."""

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
_VALUE_KINDS = ("name", "number", "text")


def parse(source: str) -> syntax.Expression:
    """Parse an expression; names are resolved later, when the expression is bound to a world.

    Raises:
        InputError: SK-COND-001 a syntax error; SK-COND-008 the expression is too long or has too many
            nested levels. The message shows the position of the error.
    """
    return syntax.Expression(source, _Parser(source).whole())


class _Parser:
    """Parser of one expression; a quoted text keeps its quotes in its token, so that it is never read as a name."""

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

    def whole(self) -> syntax.Node:
        if len(self._tokens) == 1:
            raise _syntax_error("the expression is empty", self._source, self._next.span)
        root = self._expression(0)
        if self._next.kind != "end":
            raise self._unexpected(self._next)
        return root

    # ------------------------------------------------------------------ by binding power

    def _expression(self, least: int) -> syntax.Node:
        """Parse operators that bind more tightly than `least`."""
        self._open += 1
        if self._open > MAX_DEPTH:
            raise self._too_deep(self._next.span)
        left = self._prefix()
        while (binding := _BINDING.get(self._next.text, 0)) > least:
            left = self._infix(left, self._next, binding)
        self._open -= 1
        return left

    def _prefix(self) -> syntax.Node:
        token = self._take()
        if token.kind == "number":
            return syntax.Number(token.span, 1, float(token.text))
        if token.kind == "text":
            return syntax.Text(token.span, 1, token.text[1:-1])
        if token.text == "not":
            operand = self._expression(_NOT)
            return syntax.Not(token.span.to(operand.span), self._level(operand), operand)
        if token.text in ("-", "+"):
            operand = self._expression(_SIGN)
            return syntax.Sign(token.span.to(operand.span), self._level(operand), token.text, operand)
        if token.text == "(":
            return self._bracketed(token)
        if token.kind == "name" and token.text not in ("and", "or") and token.text not in _PYTHON_KEYWORDS:
            return syntax.Name(token.span, 1, token.text)
        raise self._unexpected(token)

    def _bracketed(self, opened: Token) -> syntax.Node:
        """Parse the content of brackets: one expression, or a list of numbers separated by commas."""
        items = [self._expression(0)]
        while self._next.text == ",":
            self._take()
            items.append(self._expression(0))
        span = opened.span.to(self._expect(")", opened).span)
        if len(items) == 1:
            return replace(items[0], span=span)
        return syntax.Numbers(span, self._level(*items), tuple(items))

    def _infix(self, left: syntax.Node, token: Token, binding: int) -> syntax.Node:
        if token.text in ("and", "or"):
            _, operands = self._chain(left, (token.text,), binding)
            return syntax.Junction(left.span.to(operands[-1].span), self._level(*operands), token.text, operands)
        if token.text in _COMPARISONS:
            signs, operands = self._chain(left, _COMPARISONS, binding)
            return syntax.Comparison(left.span.to(operands[-1].span), self._level(*operands), signs, operands)
        self._take()
        if token.text == ".":
            return self._attribute(left)
        if token.text == "[":
            index = self._expression(0)
            end = self._expect("]", token)
            return syntax.Index(left.span.to(end.span), self._level(left, index), left, index)
        if token.text == "(":
            return self._call(left, token)
        # a ** b ** c means a ** (b ** c), and an exponent may have a sign
        right = self._expression(_SIGN - 1 if token.text == "**" else binding)
        span = left.span.to(right.span)
        return syntax.Arithmetic(span, self._level(left, right), token.text, token.span, left, right)

    def _chain(
        self, left: syntax.Node, words: Sequence[str], binding: int
    ) -> tuple[tuple[str, ...], tuple[syntax.Node, ...]]:
        """Parse the rest of a chain such as `a and b and c`; the first operand is already parsed."""
        operators, operands = [], [left]
        while self._next.text in words:
            operators.append(self._take().text)
            operands.append(self._expression(binding))
        return tuple(operators), tuple(operands)

    def _attribute(self, left: syntax.Node) -> syntax.Node:
        name = self._take()
        if name.kind != "name":
            raise _syntax_error("missing attribute name after the dot", self._source, name.span)
        return syntax.Attribute(left.span.to(name.span), self._level(left), left, name.text, name.span)

    def _call(self, left: syntax.Node, bracket: Token) -> syntax.Node:
        if not isinstance(left, syntax.Name):
            hint = "attributes are written without brackets: pose('tb3').x"
            raise _syntax_error("only functions can be called", self._source, left.span, hint)
        arguments: list[syntax.Node] = []
        while self._next.text != ")":
            arguments.append(self._expression(0))
            if self._next.text != ",":
                break
            self._take()
        end = self._expect(")", bracket)
        return syntax.Call(left.span.to(end.span), self._level(*arguments), left.name, left.span, tuple(arguments))

    # ------------------------------------------------------------------ errors

    def _expect(self, sign: str, opened: Token) -> Token:
        token = self._next
        if token.text == sign:
            return self._take()
        if token.kind == "end":
            raise _syntax_error(f"missing {sign}: this {opened.text} is not closed", self._source, opened.span)
        raise self._unexpected(token, sign)

    def _unexpected(self, token: Token, expected: str = "") -> Exception:
        before = self._tokens[self._tokens.index(token) - 1] if token is not self._tokens[0] else None
        hint = ""
        if token.kind == "end":
            message = f"missing value after {before.text!r}" if before else "the expression is empty"
        elif token.text in _PYTHON_KEYWORDS:
            message, hint = f"{token.text!r} is not part of this language", "for the syntax, see docs/conditions.md"
        elif token.kind in _VALUE_KINDS and before and before.kind in _VALUE_KINDS:
            message = f"missing operator between {before.text} and {token.text}"
            hint = "join conditions with and, or; values with + - * / %"
            if before.kind == "name" and before.text not in ("and", "or", "not"):
                hint = f"write the arguments of a function in brackets: {before.text}({token.text})"
        else:
            message = f"unexpected {token.text!r}"
        if expected and token.kind != "end":
            message += f"; missing {expected} before it"
        return _syntax_error(message, self._source, token.span, hint)

    def _too_deep(self, span: syntax.Span) -> Exception:
        message = f"the expression has more than {MAX_DEPTH} nested levels"
        return syntax.expression_error("SK-COND-008", message, self._source, span, "split it into several checks")

    def _level(self, *below: syntax.Node) -> int:
        depth = 1 + max((node.depth for node in below), default=0)
        if depth > MAX_DEPTH:
            raise self._too_deep(below[0].span)
        return depth
