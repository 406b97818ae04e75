"""Syntax tree of an expression: nodes, their position in the text, and errors that point at it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from simkit.errors import InputError

REMOVED_CODE: Final = "SK-NAME-002"
"""Diagnostic code of an error from the handle of a removed entity."""

_MAX_COLUMNS = 100  # maximum number of characters before and after the error in a message


@dataclass(frozen=True, slots=True)
class Span:
    """Part of an expression's text from `start` up to, but not including, `end`."""

    start: int
    end: int

    def text(self, source: str) -> str:
        """Return the text of this part."""
        return source[self.start : self.end]

    def to(self, last: Span) -> Span:
        """Return the span from the start of this span to the end of a later one."""
        return Span(self.start, last.end)


class UndecidedValue(Exception):
    """Value that is unknown at this step: no message was received, an index is out of range, or a model was removed."""


def expression_error(code: str, message: str, source: str, span: Span, hint: str = "") -> InputError:
    """Return an error that shows the expression, carets under the error, and a hint."""
    return InputError(code, f"{message}\n    {underlined_expression(source, span)}", help=hint)


def underlined_expression(source: str, span: Span) -> str:
    """Return the expression with carets under a span; shorten a long expression around the span."""
    plain = "".join(c if c.isprintable() else " " for c in source)
    first = 0
    if len(plain) > _MAX_COLUMNS:
        first = max(0, min(span.start - _MAX_COLUMNS // 2, len(plain) - _MAX_COLUMNS))
    before, after = ("... " if first else ""), (" ..." if first + _MAX_COLUMNS < len(plain) else "")
    shown = plain[first : first + _MAX_COLUMNS]
    carets = max(1, min(span.end, first + len(shown)) - span.start)
    return f"{before}{shown}{after}\n    {' ' * (len(before) + span.start - first)}{'^' * carets}"


@dataclass(frozen=True, slots=True)
class Node:
    """Node of the syntax tree with its span and the number of levels of its subtree."""

    span: Span
    depth: int


@dataclass(frozen=True, slots=True)
class Number(Node):
    """Literal number."""

    value: float


@dataclass(frozen=True, slots=True)
class Text(Node):
    """Literal text in quotes."""

    value: str


@dataclass(frozen=True, slots=True)
class Numbers(Node):
    """List of numbers `(a, b, c)`, such as a point or a vector."""

    items: tuple[Node, ...]


@dataclass(frozen=True, slots=True)
class Name(Node):
    """Name of a value: `time`, `tick`, `pi`, `true`."""

    name: str


@dataclass(frozen=True, slots=True)
class Sign(Node):
    """Signed operand: `-a` or `+a`."""

    sign: str
    operand: Node


@dataclass(frozen=True, slots=True)
class Not(Node):
    """Negated operand: `not a`."""

    operand: Node


@dataclass(frozen=True, slots=True)
class Arithmetic(Node):
    """Arithmetic operation: two operands and one of + - * / % **."""

    sign: str
    sign_span: Span
    left: Node
    right: Node


@dataclass(frozen=True, slots=True)
class Comparison(Node):
    """Chain of comparisons such as `0 < a < 1`, which is true if every comparison in the chain is true."""

    signs: tuple[str, ...]
    operands: tuple[Node, ...]


@dataclass(frozen=True, slots=True)
class Junction(Node):
    """Logical operation: two or more operands joined by `and`, or by `or`."""

    word: str
    operands: tuple[Node, ...]


@dataclass(frozen=True, slots=True)
class Attribute(Node):
    """Attribute of a value: `of.name`."""

    of: Node
    name: str
    name_span: Span


@dataclass(frozen=True, slots=True)
class Index(Node):
    """Item of a list: `of[index]`."""

    of: Node
    index: Node


@dataclass(frozen=True, slots=True)
class Call(Node):
    """Function call: `name(arguments)`."""

    name: str
    name_span: Span
    arguments: tuple[Node, ...]


@dataclass(frozen=True, slots=True)
class Expression:
    """Parsed expression."""

    source: str
    root: Node

    def __str__(self) -> str:
        return self.source
