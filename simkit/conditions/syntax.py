"""Expressions as trees."""

from __future__ import annotations

from dataclasses import dataclass

from simkit.conditions.faults import Span


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
