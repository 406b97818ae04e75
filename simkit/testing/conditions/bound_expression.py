"""Nodes of an expression bound to a world: how each is evaluated, converted to a vector or pose, and explained."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final, Protocol

import numpy as np

from simkit.msgs import Message
from simkit.pose import Pose, Vector
from simkit.testing.conditions.syntax_tree import (
    Arithmetic,
    Call,
    Comparison,
    Junction,
    Name,
    Node,
    Not,
    Number,
    Sign,
    Span,
    Text,
    UndecidedValue,
)
from simkit.testing.conditions.value_types import NUMBER, POSE, SCAN, TEXT, TRUTH, ValueType, is_vector_like

if TYPE_CHECKING:
    from simkit.testing.conditions.world_view import LatestMessage, WorldView


_MAX_SHOWN = 6  # items of a list


ValueGetter = Callable[[], Any]
"""Returns the value of a part of an expression at this tick: a number, a text, a vector, a pose or a message."""


@dataclass(frozen=True, slots=True)
class BoundNode:
    """A part of an expression.

    Attributes:
        node: where it stands.
        kind: of its value.
        get: its value now; raises Undecided where it has none.
        below: the parts that it is made of.
        feed: where it comes from one topic's newest message and nothing else, that one.
        tell: more about its value, in words.
    """

    node: Node
    kind: ValueType
    get: ValueGetter
    below: tuple[BoundNode, ...] = ()
    feed: LatestMessage | None = None
    tell: Callable[[], str] | None = None


def value_text(value: Any) -> str:
    """A value as a report has it."""
    if value is True or value is False:
        return "true" if value else "false"
    if isinstance(value, (int, float)):
        return f"{value:.6g}"
    if isinstance(value, str):
        return repr(value)
    if hasattr(value, "rpy"):
        return f"({_join_texts(value.position)}; {_join_texts(value.rpy)})"
    if hasattr(value, "__len__"):
        return f"({_join_texts(value)})" if len(value) <= _MAX_SHOWN else f"{len(value)} values"
    return f"a {getattr(value, '__msgtype__', type(value).__name__)}"


def _join_texts(values: Any) -> str:
    return ", ".join(value_text(v.item() if hasattr(v, "item") else v) for v in values)


def findings(source: str, part: BoundNode, *, wanted: bool = True) -> list[str]:
    """The values that make a condition hold or not: `min(scan('/scan')) was 0.098`.

    Args:
        source: the expression.
        part: true or false.
        wanted: what it should have been.
    """
    told: dict[str, None] = {}
    _collect_findings(source, part, wanted, told)
    if not told:  # nothing in it changes: `1 > 2`
        _finding_text(source, part, told)
    return list(told)


def _collect_findings(source: str, part: BoundNode, wanted: bool, told: dict[str, None]) -> None:
    node = part.node
    if isinstance(node, Not):
        _collect_findings(source, part.below[0], not wanted, told)
    elif isinstance(node, Junction):
        # of what has to hold all together only what does not is of interest; else all of it
        is_all = (node.word == "and") == wanted
        for operand in part.below:
            if not is_all or _current_value(operand) is not wanted:
                _collect_findings(source, operand, wanted, told)
    elif isinstance(node, Comparison):
        for operand in part.below:
            if not _is_literal(operand.node):
                _finding_text(source, operand, told)
    else:
        _finding_text(source, part, told)


def _finding_text(source: str, part: BoundNode, told: dict[str, None]) -> None:
    text = part.node.span.text(source)
    try:
        told[f"{text} was {value_text(part.get())}{part.tell() if part.tell is not None else ''}"] = None
    except UndecidedValue as reason:
        told[f"{text} is not known: {reason}"] = None


def _current_value(part: BoundNode) -> Any:
    try:
        return part.get()
    except UndecidedValue:
        return None


def _is_literal(node: Node) -> bool:
    """Whether it stands there as it is."""
    if isinstance(node, Sign):
        return _is_literal(node.operand)
    if isinstance(node, Arithmetic):
        return _is_literal(node.left) and _is_literal(node.right)
    return isinstance(node, (Number, Text)) or (isinstance(node, Name) and node.name not in ("time", "tick"))


def is_scalar(kind: ValueType) -> bool:
    """Whether two values of a kind can be equal."""
    return kind in (NUMBER, TRUTH, TEXT)


class ExpressionBinder(Protocol):
    """What a function of the language asks of the binder of the expression that calls it.

    Attributes:
        source: text of the expression.
        view: the world that the expression is bound to.
    """

    source: str
    view: WorldView

    def part(self, node: Node) -> BoundNode:
        """Bind a node."""

    def number(self, node: Node) -> BoundNode:
        """Bind a node that has to be a number."""

    def truth(self, node: Node) -> BoundNode:
        """Bind a node that has to be true or false."""

    def fault(self, code: str, message: str, span: Span, hint: str = "") -> Exception:
        """Return an error that points at a part of the expression."""

    def not_a_number(self, part: BoundNode) -> Exception:
        """Return the error of a node that should be a number."""


BindFunction = Callable[[ExpressionBinder, Call], BoundNode]
UNLIMITED_ARGUMENTS: Final = 100
"""Arguments of a function that takes any number of them."""


@dataclass(frozen=True)
class Function:
    """One function.

    Attributes:
        usage: how it is written.
        least, most: arguments that it takes.
        make: binds a call of it.
    """

    usage: str
    least: int
    most: int
    make: BindFunction


def quoted_argument(binder: ExpressionBinder, call: Call, place: int, what: str) -> Text:
    """An argument that is a name in quotes.

    Raises:
        InputError: SK-COND-004 it is something else.
    """
    node = call.arguments[place]
    if isinstance(node, Text):
        return node
    source = node.span.text(binder.source)
    hint = f"names stand in quotes: {call.name}('{source}')" if isinstance(node, Name) else ""
    message = f"{call.name} wants {what} in quotes, and is given {source}"
    raise binder.fault("SK-COND-004", message, node.span, hint)


def as_vector(part: BoundNode) -> ValueGetter:
    """What gives a part as an array of 64 bit numbers, shape (n,); a number as it is."""
    get = part.get
    if part.kind is NUMBER:
        return get
    if part.kind.message:
        return lambda: vector_from_message(get())
    return lambda: np.asarray(get(), dtype=np.float64)


def vector_from_message(message: Message) -> Vector:
    """A vector or a point, shape (3,)."""
    return np.array((message.x, message.y, message.z), dtype=np.float64)


def as_pose(part: BoundNode) -> Callable[[], Pose]:
    """What gives a pose, or a message that is one, as a pose."""
    get = part.get
    if part.kind is POSE:
        return get

    def value() -> Pose:
        message = get()
        q = message.orientation
        quaternion = (q.w, q.x, q.y, q.z)
        return Pose(vector_from_message(message.position), quaternion if any(quaternion) else (1.0, 0.0, 0.0, 0.0))

    return value


def as_numbers(part: BoundNode) -> ValueGetter | None:
    """What gives the numbers of a list, a vector, or a scan; of a scan those of the rays that met something.

    Rays that met nothing (+inf, nan) are left out; -inf, too near to be measured, is not. None where it has no numbers.
    """
    get = part.get
    if part.kind.message == SCAN:

        def met() -> Any:
            ranges = np.asarray(get().ranges, dtype=np.float64)
            return ranges[ranges < np.inf]

        return met
    return as_vector(part) if is_vector_like(part.kind) else None
