"""Nodes of an expression bound to a world: evaluation, conversion to vectors and poses, and texts for reports."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from operator import attrgetter, itemgetter
from typing import TYPE_CHECKING, Any, Final, Protocol

import numpy as np

from simkit.errors import InputError
from simkit.msgs import Message
from simkit.number_text import counted
from simkit.pose import Pose, Vector, rpy_of_quaternions
from simkit.testing.conditions import syntax_tree as syntax
from simkit.testing.conditions import value_types as kinds
from simkit.testing.conditions.syntax_tree import REMOVED_CODE, UndecidedValue
from simkit.testing.conditions.value_types import NUMBER, POSE, SCAN, TEXT, TRUTH, ValueType, is_vector_like

if TYPE_CHECKING:
    from simkit.runtime import Joint
    from simkit.testing.conditions.topic_listeners import LatestMessage
    from simkit.testing.conditions.world_view import WorldView


_MAX_SHOWN = 6  # number of list items in a report; a longer list is described by its length


ValueGetter = Callable[[], Any]
"""Function that returns the present value of a node: a number, a text, a vector, a pose or a message."""


@dataclass(frozen=True, slots=True)
class BoundNode:
    """Node of an expression bound to a world.

    Attributes:
        node: Node of the syntax tree.
        kind: Type of the value.
        get: Function that returns the present value; raises UndecidedValue if it is unknown.
        below: Operands of the node.
        feed: Source of the message, if the value depends only on the newest message of one topic; None otherwise.
        tell: Function that returns details about the value, which reports append; None without details.
    """

    node: syntax.Node
    kind: ValueType
    get: ValueGetter
    below: tuple[BoundNode, ...] = ()
    feed: LatestMessage | None = None
    tell: Callable[[], str] | None = None


def value_text(value: Any) -> str:
    """Format a value for a report."""
    if value is True or value is False:
        return "true" if value else "false"
    if isinstance(value, (int, float)):
        return f"{value:.6g}"
    if isinstance(value, str):
        return repr(value)
    if hasattr(value, "rpy"):
        return f"({_join_texts(value.position)}; {_join_texts(value.rpy)})"
    if hasattr(value, "__len__"):
        return f"({_join_texts(value)})" if len(value) <= _MAX_SHOWN else counted(len(value), "value")
    return f"a {getattr(value, '__msgtype__', type(value).__name__)}"


def _join_texts(values: Iterable[object]) -> str:
    return ", ".join(value_text(v.item() if hasattr(v, "item") else v) for v in values)


def findings(source: str, part: BoundNode, *, expected: bool = True) -> list[str]:
    """Return the values that make a condition true or false: `min(scan('/scan')) was 0.098`.

    Args:
        source: Text of the expression.
        part: Node that is true or false.
        expected: Value that the condition should have.
    """
    texts: dict[str, None] = {}
    _collect_findings(source, part, expected, texts)
    if not texts:  # constant condition, such as `1 > 2`
        _finding_text(source, part, texts)
    return list(texts)


def _collect_findings(source: str, part: BoundNode, expected: bool, texts: dict[str, None]) -> None:
    node = part.node
    if isinstance(node, syntax.Not):
        _collect_findings(source, part.below[0], not expected, texts)
    elif isinstance(node, syntax.Junction):
        # if all operands are needed, only operands without the expected value explain the result
        is_all = (node.word == "and") == expected
        for operand in part.below:
            if not is_all or _current_value(operand) is not expected:
                _collect_findings(source, operand, expected, texts)
    elif isinstance(node, syntax.Comparison):
        for operand in part.below:
            if not _is_literal(operand.node):
                _finding_text(source, operand, texts)
    else:
        _finding_text(source, part, texts)


def _finding_text(source: str, part: BoundNode, texts: dict[str, None]) -> None:
    text = part.node.span.text(source)
    try:
        texts[f"{text} was {value_text(part.get())}{part.tell() if part.tell is not None else ''}"] = None
    except syntax.UndecidedValue as reason:
        texts[f"{text} is unknown: {reason}"] = None


def _current_value(part: BoundNode) -> Any:
    try:
        return part.get()
    except syntax.UndecidedValue:
        return None


def _is_literal(node: syntax.Node) -> bool:
    """Check whether the value of a node is constant."""
    if isinstance(node, syntax.Sign):
        return _is_literal(node.operand)
    if isinstance(node, syntax.Arithmetic):
        return _is_literal(node.left) and _is_literal(node.right)
    return isinstance(node, (syntax.Number, syntax.Text)) or (
        isinstance(node, syntax.Name) and node.name not in ("time", "tick")
    )


def is_scalar(kind: ValueType) -> bool:
    """Check whether values of a type can be compared for equality."""
    return kind in (NUMBER, TRUTH, TEXT)


class NotInRows(Exception):
    """A part of an expression has no value as arrays."""


class ExpressionBinder(Protocol):
    """Interface of the binder for functions of the expression language.

    Attributes:
        source: Text of the expression.
        view: World that the expression is bound to.
        in_rows: True for many worlds at once, whose values are arrays; the first axis is the world.
    """

    source: str
    view: WorldView
    in_rows: bool

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
"""Maximum number of arguments of a function that takes any number of them."""


@dataclass(frozen=True)
class Function:
    """Function of the expression language.

    Attributes:
        usage: Call syntax, for messages.
        least, most: Limits of the number of arguments.
        make: Function that binds a call.
        has_rows: True if the function has values as arrays, for many worlds at once.
    """

    usage: str
    least: int
    most: int
    make: BindFunction
    has_rows: bool = False


def quoted_argument(binder: ExpressionBinder, call: syntax.Call, index: int, what: str) -> syntax.Text:
    """Return an argument that must be a quoted name.

    Raises:
        InputError: SK-COND-004 the argument is not a quoted name.
    """
    node = call.arguments[index]
    if isinstance(node, syntax.Text):
        return node
    source = node.span.text(binder.source)
    hint = f"names need quotes: {call.name}('{source}')" if isinstance(node, syntax.Name) else ""
    message = f"{call.name} needs {what} in quotes, found {source}"
    raise binder.fault("SK-COND-004", message, node.span, hint)


def as_vector(part: BoundNode) -> ValueGetter:
    """Return a function that gets a node's value as a float array, shape (n,); a number is returned unchanged."""
    get = part.get
    if part.kind is NUMBER:
        return get
    if part.kind.message:
        return lambda: vector_from_message(get())
    return lambda: np.asarray(get(), dtype=np.float64)


def vector_from_message(message: Message) -> Vector:
    """Return a vector or point message as an array, shape (3,)."""
    return np.array((message.x, message.y, message.z), dtype=np.float64)


def as_pose(part: BoundNode) -> Callable[[], Pose]:
    """Return a function that gets a node's pose; a pose message is converted."""
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
    """Return a function that gets the numbers in a list, a vector or a scan; None if the node has no numbers.

    Rays of a scan without a hit (+inf, NaN) are left out. Rays with -inf (object below the minimum range) remain.
    """
    get = part.get
    if part.kind.message == SCAN:

        def met() -> Vector:
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
    """Return attributes that each select one number of a value, such as x, y and z.

    Args:
        names: Attribute names in the order of the numbers.
        numbers: Function that returns the numbers of a value.
    """
    return {name: (kinds.NUMBER, _number_at(at, numbers)) for at, name in enumerate(names)}


def _number_at(at: int, numbers: Callable[[Any], Any]) -> Callable[[Any], Any]:
    return lambda value: number_of(numbers(value), at)


def number_of(values: Vector, at: int) -> float | Vector:
    """Return one number of a vector, or one number of the vector of each world, shape (worlds,)."""
    return values[:, at] if getattr(values, "ndim", 1) == 2 else float(values[at])


def vector_of(values: Sequence[float | Vector]) -> Vector:
    """Return numbers as a vector, or as the vector of each world, shape (worlds, n), if one of them is an array."""
    if any(isinstance(value, np.ndarray) for value in values):
        return np.stack(np.broadcast_arrays(*values), axis=-1)
    return np.array(values)


_AXIS_FIELDS = _numbered(_AXES, lambda vector: vector)
_VALUE_FIELDS: Final[dict[kinds.ValueType, dict[str, _ReadField]]] = {
    kinds.POSE: {
        "position": (kinds.VECTOR, attrgetter("position")),
        "orientation": (kinds.ORIENTATION, attrgetter("quaternion")),
        **_numbered(_AXES, attrgetter("position")),
        **_numbered(_ANGLES, lambda pose: rpy_of_quaternions(pose.quaternion)),
    },
    kinds.ORIENTATION: {**_numbered("wxyz", lambda quaternion: quaternion), **_numbered(_ANGLES, rpy_of_quaternions)},
    kinds.TWIST: {"linear": (kinds.VECTOR, itemgetter(0)), "angular": (kinds.VECTOR, itemgetter(1))},
}


def listed_attributes(kind: kinds.ValueType) -> list[str]:
    """Return the names of the attributes of a type."""
    if kind.message:
        angles = _ANGLES if kinds.is_orientation_like(kind) or kinds.is_pose_like(kind) else ()
        return [*kinds.fields_of(kind.message), *(_AXES if kinds.is_pose_like(kind) else ()), *angles]
    return [*_JOINT_ATTRIBUTES] if kind is kinds.JOINT else [*_fields_of_value(kind)]


def _fields_of_value(kind: kinds.ValueType) -> dict[str, _ReadField]:
    return _AXIS_FIELDS if kind.has_axes else _VALUE_FIELDS.get(kind, {})


def attribute_of(part: BoundNode, name: str) -> AttributeGetter | None:
    """Return the type of an attribute and the function that gets its value; None if the attribute does not exist."""
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
    reader = _fields_of_value(kind).get(name)
    if reader is None:
        return None
    of, read = reader
    return of, lambda: read(get())


def _joint_attribute(joint: Joint, name: str) -> AttributeGetter | None:
    """Return an attribute of a joint: a number, or a list with one number for each degree of freedom."""
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
        return kinds.NUMBER, lambda: number if isinstance(number := value(), np.ndarray) else float(number)
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
