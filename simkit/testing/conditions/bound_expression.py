"""Nodes of an expression bound to a world: how each is evaluated, converted to a vector or pose, and explained."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from operator import attrgetter, itemgetter
from typing import TYPE_CHECKING, Any, Final, Protocol

import numpy as np

from simkit.errors import InputError
from simkit.msgs import Message
from simkit.pose import Pose, Vector, rpy_from_quat
from simkit.testing.conditions import syntax_tree as syntax
from simkit.testing.conditions import value_types as kinds
from simkit.testing.conditions.syntax_tree import REMOVED_CODE, UndecidedValue
from simkit.testing.conditions.value_types import NUMBER, POSE, SCAN, TEXT, TRUTH, ValueType, is_vector_like

if TYPE_CHECKING:
    from simkit.runtime import Joint
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

    node: syntax.Node
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
    if isinstance(node, syntax.Not):
        _collect_findings(source, part.below[0], not wanted, told)
    elif isinstance(node, syntax.Junction):
        # of what has to hold all together only what does not is of interest; else all of it
        is_all = (node.word == "and") == wanted
        for operand in part.below:
            if not is_all or _current_value(operand) is not wanted:
                _collect_findings(source, operand, wanted, told)
    elif isinstance(node, syntax.Comparison):
        for operand in part.below:
            if not _is_literal(operand.node):
                _finding_text(source, operand, told)
    else:
        _finding_text(source, part, told)


def _finding_text(source: str, part: BoundNode, told: dict[str, None]) -> None:
    text = part.node.span.text(source)
    try:
        told[f"{text} was {value_text(part.get())}{part.tell() if part.tell is not None else ''}"] = None
    except syntax.UndecidedValue as reason:
        told[f"{text} is not known: {reason}"] = None


def _current_value(part: BoundNode) -> Any:
    try:
        return part.get()
    except syntax.UndecidedValue:
        return None


def _is_literal(node: syntax.Node) -> bool:
    """Whether it stands there as it is."""
    if isinstance(node, syntax.Sign):
        return _is_literal(node.operand)
    if isinstance(node, syntax.Arithmetic):
        return _is_literal(node.left) and _is_literal(node.right)
    return isinstance(node, (syntax.Number, syntax.Text)) or (
        isinstance(node, syntax.Name) and node.name not in ("time", "tick")
    )


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

    def part(self, node: syntax.Node) -> BoundNode:
        """Bind a node."""

    def number(self, node: syntax.Node) -> BoundNode:
        """Bind a node that has to be a number."""

    def truth(self, node: syntax.Node) -> BoundNode:
        """Bind a node that has to be true or false."""

    def fault(self, code: str, message: str, span: syntax.Span, hint: str = "") -> Exception:
        """Return an error that points at a part of the expression."""

    def not_a_number(self, part: BoundNode) -> Exception:
        """Return the error of a node that should be a number."""


BindFunction = Callable[[ExpressionBinder, syntax.Call], BoundNode]
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


def quoted_argument(binder: ExpressionBinder, call: syntax.Call, place: int, what: str) -> syntax.Text:
    """An argument that is a name in quotes.

    Raises:
        InputError: SK-COND-004 it is something else.
    """
    node = call.arguments[place]
    if isinstance(node, syntax.Text):
        return node
    source = node.span.text(binder.source)
    hint = f"names stand in quotes: {call.name}('{source}')" if isinstance(node, syntax.Name) else ""
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


AttributeGetter = tuple[kinds.ValueType, ValueGetter]
_ReadField = tuple[kinds.ValueType, Callable[[Any], Any]]

_AXES = ("x", "y", "z")
_ANGLES = ("roll", "pitch", "yaw")
_JOINT_ATTRIBUTES = ("position", "velocity", "effort", "lower", "upper")


def _numbered(names: Sequence[str], numbers: Callable[[Any], Any]) -> dict[str, _ReadField]:
    """Numbers of a value by their names.

    Args:
        names: in the order of the numbers.
        numbers: gives them of the value.
    """
    return {name: (kinds.NUMBER, _number_at(at, numbers)) for at, name in enumerate(names)}


def _number_at(at: int, numbers: Callable[[Any], Any]) -> Callable[[Any], float]:
    return lambda value: float(numbers(value)[at])


_AXIS_FIELDS = _numbered(_AXES, lambda vector: vector)
_VALUE_FIELDS: Final[dict[kinds.ValueType, dict[str, _ReadField]]] = {
    kinds.POSE: {
        "position": (kinds.VECTOR, attrgetter("position")),
        "orientation": (kinds.ORIENTATION, attrgetter("quaternion")),
        **_numbered(_AXES, attrgetter("position")),
        **_numbered(_ANGLES, lambda pose: rpy_from_quat(pose.quaternion)),
    },
    kinds.ORIENTATION: {**_numbered("wxyz", lambda quaternion: quaternion), **_numbered(_ANGLES, rpy_from_quat)},
    kinds.TWIST: {"linear": (kinds.VECTOR, itemgetter(0)), "angular": (kinds.VECTOR, itemgetter(1))},
}


def listed_attributes(kind: kinds.ValueType) -> list[str]:
    """What parts a value of a kind has."""
    if kind.message:
        angles = _ANGLES if kinds.is_orientation_like(kind) or kinds.is_pose_like(kind) else ()
        return [*kinds.fields_of(kind.message), *(_AXES if kinds.is_pose_like(kind) else ()), *angles]
    return [*_JOINT_ATTRIBUTES] if kind is kinds.JOINT else [*_fields_of_value(kind)]


def _fields_of_value(kind: kinds.ValueType) -> dict[str, _ReadField]:
    return _AXIS_FIELDS if kind.has_axes else _VALUE_FIELDS.get(kind, {})


def attribute_of(part: BoundNode, name: str) -> AttributeGetter | None:
    """A part of a value, and its kind; None where it has no such part."""
    kind, get = part.kind, part.get
    if kind is kinds.JOINT:
        return _joint_attribute(get(), name)
    if kind.message:
        fields = kinds.fields_of(kind.message)
        if name in fields:
            return _message_attribute(get, *fields[name])
        if kinds.is_pose_like(kind):
            kind, get = kinds.POSE, as_pose(part)
        elif kinds.is_orientation_like(kind):
            kind, get = kinds.ORIENTATION, lambda: _quaternion(part.get())
    found = _fields_of_value(kind).get(name)
    if found is None:
        return None
    of, read = found
    return of, lambda: read(get())


def _joint_attribute(joint: Joint, name: str) -> AttributeGetter | None:
    """Of the handle of a joint: a number for each degree of freedom, which is one number for most."""
    if name not in _JOINT_ATTRIBUTES:
        return None
    read = attrgetter(name)

    def value() -> Any:
        try:
            return read(joint)
        except InputError as error:
            if error.code != REMOVED_CODE:
                raise
            raise UndecidedValue(f"{joint.scoped} was removed") from None

    if joint.dof == 1:
        return kinds.NUMBER, lambda: float(value())
    return kinds.ValueType(kinds.NUMBERS.name, item=kinds.NUMBER), value


def _message_attribute(get: ValueGetter, attribute: str, kind: kinds.ValueType) -> AttributeGetter:
    read = attrgetter(attribute)
    if kind is kinds.NUMBER:
        return kind, lambda: float(read(get()))
    if kind is kinds.TRUTH:
        return kind, lambda: bool(read(get()))
    return kind, lambda: read(get())


def _quaternion(message: Message) -> tuple[float, float, float, float]:
    return message.w, message.x, message.y, message.z
