"""Syntax tree of an expression: nodes, their position in the text, and errors that point at it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from simkit.errors import InputError

REMOVED_CODE: Final = "SK-NAME-002"
"""What handles of things that were removed raise."""

_MAX_COLUMNS = 100  # characters of an expression that are shown around a place


@dataclass(frozen=True, slots=True)
class Span:
    """A part of an expression's text: from `start` up to, not including, `end`."""

    start: int
    end: int

    def text(self, source: str) -> str:
        """What stands there."""
        return source[self.start : self.end]

    def to(self, last: Span) -> Span:
        """Return the part from the start of this one to the end of a later one."""
        return Span(self.start, last.end)


class UndecidedValue(Exception):
    """A value that is not known now: no message has come yet, an index is out of range, a model was removed."""


def expression_error(code: str, message: str, source: str, span: Span, hint: str = "") -> InputError:
    """An error with the expression, a caret under the place, and what helps."""
    text = f"{code} {message}\n    {underlined_expression(source, span)}"
    if hint:
        text += f"\n    help: {hint}"
    return InputError(text, code)


def underlined_expression(source: str, span: Span) -> str:
    """The expression, and below it carets under a place; of a long one the part around it."""
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
    """A part of an expression, at its place, with so many levels below it and itself."""

    span: Span
    depth: int


@dataclass(frozen=True, slots=True)
class Number(Node):
    value: float


@dataclass(frozen=True, slots=True)
class Text(Node):
    value: str


@dataclass(frozen=True, slots=True)
class Numbers(Node):
    """`(a, b, c)`: a point, a vector, or another list of numbers."""

    items: tuple[Node, ...]


@dataclass(frozen=True, slots=True)
class Name(Node):
    """A word that stands for a value: `time`, `tick`, `pi`, `true`."""

    name: str


@dataclass(frozen=True, slots=True)
class Sign(Node):
    """`-a` or `+a`."""

    sign: str
    operand: Node


@dataclass(frozen=True, slots=True)
class Not(Node):
    operand: Node


@dataclass(frozen=True, slots=True)
class Arithmetic(Node):
    """Two operands and one of + - * / % **."""

    sign: str
    sign_span: Span
    left: Node
    right: Node


@dataclass(frozen=True, slots=True)
class Comparison(Node):
    """One operand more than signs: `0 < a < 1` holds where both do."""

    signs: tuple[str, ...]
    operands: tuple[Node, ...]


@dataclass(frozen=True, slots=True)
class Junction(Node):
    """Two or more operands joined by `and`, or by `or`."""

    word: str
    operands: tuple[Node, ...]


@dataclass(frozen=True, slots=True)
class Attribute(Node):
    """`of.name`."""

    of: Node
    name: str
    name_span: Span


@dataclass(frozen=True, slots=True)
class Index(Node):
    """`of[index]`."""

    of: Node
    index: Node


@dataclass(frozen=True, slots=True)
class Call(Node):
    """`name(arguments)`."""

    name: str
    name_span: Span
    arguments: tuple[Node, ...]


@dataclass(frozen=True, slots=True)
class Expression:
    """A text that was read."""

    source: str
    root: Node

    def __str__(self) -> str:
        return self.source
