"""Binder of expressions: each node gets the type of its value and a function that returns the value."""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Mapping, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from simkit.diagnostics import did_you_mean
from simkit.number_text import counted
from simkit.runtime.array_rules import CannotBatchError
from simkit.testing.conditions import syntax_tree as syntax
from simkit.testing.conditions.bound_expression import (
    BoundNode,
    Function,
    NotInRows,
    ValueGetter,
    as_vector,
    attribute_of,
    is_scalar,
    listed_attributes,
    vector_of,
)
from simkit.testing.conditions.history_functions import HISTORY_FUNCTIONS
from simkit.testing.conditions.math_functions import (
    LIST_FUNCTIONS,
    NUMBER_FUNCTIONS,
    NUMBER_OPERATORS,
    ROW_OPERATORS,
    VECTOR_OPERATORS,
)
from simkit.testing.conditions.parser import parse
from simkit.testing.conditions.value_types import JOINT, NUMBER, NUMBERS, TEXT, TRUTH, VECTOR, ValueType, is_vector_like
from simkit.testing.conditions.world_functions import WORLD_FUNCTIONS

if TYPE_CHECKING:
    import numpy.typing as npt

    from simkit.testing.conditions.world_view import WorldView


FUNCTIONS: Final[dict[str, Function]] = {
    **WORLD_FUNCTIONS,
    **LIST_FUNCTIONS,
    **NUMBER_FUNCTIONS,
    **HISTORY_FUNCTIONS,
}


_COMPARISON_OPERATORS: Final[dict[str, Callable[[Any, Any], bool]]] = {
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
    "==": operator.eq,
    "!=": operator.ne,
}


_CONSTANTS: Final[dict[str, tuple[ValueType, float | bool]]] = {
    **{name: (NUMBER, value) for name, value in (("pi", math.pi), ("inf", math.inf), ("nan", math.nan))},
    **{name: (TRUTH, name.lower() == "true") for name in ("true", "false", "True", "False")},
}
_TIME_NAMES: Final = ("time", "tick")


def bind(expression: syntax.Expression, view: WorldView) -> BoundNode:
    """Bind an expression to a world.

    Raises:
        InputError: A name is unknown, or the type of a value does not fit.
        AbsentTopic: The view waits for a topic of the expression.
    """
    return Binder(expression.source, view).part(expression.root)


def bind_value(source: str, view: WorldView, kinds: Sequence[ValueType], what: str) -> BoundNode:
    """Bind the text of an expression that must have one of several types.

    Args:
        source: Text of the expression.
        view: World.
        kinds: Allowed types.
        what: Name of the value for the error, such as "the metric".

    Raises:
        InputError: The expression has a syntax error, an unknown name, or another type.
    """
    part = bind(parse(source), view)
    if part.kind not in kinds:
        message = f"{what} is {part.kind}, but must be {', or '.join(map(str, kinds))}"
        raise syntax.expression_error("SK-COND-004", message, source, part.node.span, number_hint(part.kind))
    return part


def bind_rows(expression: syntax.Expression, view: WorldView) -> BoundNode:
    """Bind an expression to many worlds at once; its values are arrays whose first axis is the world.

    Args:
        expression: Expression that is already bound to one of these worlds, so that its types are right.
        view: View of the worlds, whose entities, joints, contacts and clock have arrays.

    Raises:
        CannotBatchError: A part of the expression has no value as arrays.
    """
    return RowsBinder(expression.source, view).part(expression.root)


class Binder:
    """Binder of one expression.

    Args:
        source: Text of the expression.
        view: World.
    """

    in_rows = False
    number_operators: Mapping[str, Callable[[Any, Any], Any]] = NUMBER_OPERATORS

    def __init__(self, source: str, view: WorldView) -> None:
        self.source, self.view = source, view
        self._kinds: dict[type[syntax.Node], Callable[[Any], BoundNode]] = {
            syntax.Number: lambda node: BoundNode(node, NUMBER, lambda: node.value),
            syntax.Text: lambda node: BoundNode(node, TEXT, lambda: node.value),
            syntax.Numbers: self._numbers,
            syntax.Name: self._name,
            syntax.Sign: self._sign,
            syntax.Not: self._not,
            syntax.Arithmetic: self._arithmetic,
            syntax.Comparison: self._comparison,
            syntax.Junction: self._junction,
            syntax.Attribute: self._attribute,
            syntax.Index: self._index,
            syntax.Call: self._call,
        }

    def part(self, node: syntax.Node) -> BoundNode:
        """Bind a node."""
        return self._kinds[type(node)](node)

    def fault(self, code: str, message: str, span: syntax.Span, hint: str = "") -> Exception:
        """Return an error that points at a part of the expression."""
        return syntax.expression_error(code, message, self.source, span, hint)

    # ------------------------------------------------------------------ names

    def _name(self, node: syntax.Name) -> BoundNode:
        if node.name in _CONSTANTS:
            kind, value = _CONSTANTS[node.name]
            return BoundNode(node, kind, lambda: value)
        clock = self.view.clock
        if node.name == "time":
            return BoundNode(node, NUMBER, lambda: clock.time)
        if node.name == "tick":
            return BoundNode(node, NUMBER, lambda: float(clock.tick))
        if node.name in FUNCTIONS:
            message = f"{node.name} is a function"
            raise self.fault("SK-COND-002", message, node.span, f"write {FUNCTIONS[node.name].usage}")
        near = did_you_mean(node.name, [*_CONSTANTS, *_TIME_NAMES, *FUNCTIONS])
        if not near:
            near = f"names of models and topics need quotes: '{node.name}'"
        raise self.fault("SK-COND-002", f"unknown name {node.name!r}", node.span, near)

    def _call(self, node: syntax.Call) -> BoundNode:
        function = FUNCTIONS.get(node.name)
        if function is None:
            near = did_you_mean(node.name, FUNCTIONS)
            if node.name in (*_TIME_NAMES, *_CONSTANTS):
                near = f"write {node.name} alone"
            raise self.fault(
                "SK-COND-002",
                f"unknown function {node.name!r}",
                node.name_span,
                near or f"available: {', '.join(FUNCTIONS)}",
            )
        count = len(node.arguments)
        if not function.least <= count <= function.most:
            message = f"{node.name} does not take {counted(count, 'argument')}"
            raise self.fault("SK-COND-003", message, node.span, f"write {function.usage}")
        return function.make(self, node)

    # ------------------------------------------------------------------ truth

    def truth(self, node: syntax.Node) -> BoundNode:
        """Bind a node that must be true or false.

        Raises:
            InputError: SK-COND-004 the node has another type.
        """
        part = self.part(node)
        if part.kind is not TRUTH:
            message = f"{node.span.text(self.source)} is {part.kind}, but must be true or false"
            raise self.fault("SK-COND-004", message, node.span, "compare it with < <= > >= == !=")
        return part

    def _not(self, node: syntax.Not) -> BoundNode:
        operand = self.truth(node.operand)
        get = operand.get
        return BoundNode(node, TRUTH, lambda: not get(), (operand,))

    def _junction(self, node: syntax.Junction) -> BoundNode:
        operands = tuple(self.truth(operand) for operand in node.operands)
        gets = tuple(operand.get for operand in operands)
        decisive: bool = node.word == "or"

        def value() -> bool:
            unknown: syntax.UndecidedValue | None = None
            for get in gets:
                try:
                    holds: bool = get()
                    if holds is decisive:
                        return holds
                except syntax.UndecidedValue as reason:  # a later operand may decide the result alone
                    unknown = unknown or reason
            if unknown is not None:
                raise unknown
            return not decisive

        return BoundNode(node, TRUTH, value, operands)

    def _comparison(self, node: syntax.Comparison) -> BoundNode:
        """Bind a comparison."""
        operands = tuple(self.part(operand) for operand in node.operands)
        for sign, (left, right) in zip(node.signs, pairwise(operands), strict=True):
            self._check_comparable(sign, left, right)
        signs, gets = [_COMPARISON_OPERATORS[sign] for sign in node.signs], [part.get for part in operands]
        if len(signs) == 1:
            holds, a, b = signs[0], gets[0], gets[1]
            return BoundNode(node, TRUTH, lambda: holds(a(), b()), operands)

        def value() -> bool:
            left = gets[0]()
            for holds, get in zip(signs, gets[1:], strict=True):
                right = get()
                if not holds(left, right):
                    return False
                left = right
            return True

        return BoundNode(node, TRUTH, value, operands)

    def _check_comparable(self, sign: str, left: BoundNode, right: BoundNode) -> None:
        for part in (left, right):
            if is_vector_like(part.kind):
                hint = "compare norm(…), min(…) or a part (.x, [0]); distance(a, b) gives the distance of two points"
                raise self._of_wrong_kind(part, "which cannot be compared", hint)
            if not is_scalar(part.kind):
                raise self.not_a_number(part)
        if left.kind is not right.kind:
            message = f"cannot compare {left.kind} with {right.kind}"
            raise self.fault("SK-COND-004", message, right.node.span)
        if sign not in ("==", "!=") and left.kind is not NUMBER:
            message = f"{sign} compares numbers, but {left.node.span.text(self.source)} is {left.kind}"
            raise self.fault("SK-COND-004", message, left.node.span, "write == or !=")

    # ------------------------------------------------------------------ numbers

    def number(self, node: syntax.Node) -> BoundNode:
        """Bind a node that must be a number.

        Raises:
            InputError: SK-COND-004 the node has another type.
        """
        part = self.part(node)
        if part.kind is not NUMBER:
            raise self.not_a_number(part)
        return part

    def not_a_number(self, part: BoundNode) -> Exception:
        """Return an error for a part that is not a number, with a hint for converting it."""
        return self._of_wrong_kind(part, "but must be a number", number_hint(part.kind))

    def _of_wrong_kind(self, part: BoundNode, why: str, hint: str) -> Exception:
        message = f"{part.node.span.text(self.source)} is {part.kind}, {why}"
        return self.fault("SK-COND-004", message, part.node.span, hint)

    def _numbers(self, node: syntax.Numbers) -> BoundNode:
        items = tuple(self.number(item) for item in node.items)
        gets = tuple(item.get for item in items)
        kind = VECTOR if len(items) == 3 else ValueType(NUMBERS.name, item=NUMBER, length=len(items))
        return BoundNode(node, kind, lambda: vector_of([get() for get in gets]), items)

    def _sign(self, node: syntax.Sign) -> BoundNode:
        operand = self.part(node.operand)
        get = operand.get
        if is_vector_like(operand.kind):
            vector = as_vector(operand)
            return BoundNode(node, operand.kind, (lambda: -vector()) if node.sign == "-" else vector, (operand,))
        if operand.kind is not NUMBER:
            raise self.not_a_number(operand)
        return BoundNode(node, NUMBER, (lambda: -get()) if node.sign == "-" else get, (operand,), operand.feed)

    def _arithmetic(self, node: syntax.Arithmetic) -> BoundNode:
        left, right = self.part(node.left), self.part(node.right)
        if left.kind is NUMBER and right.kind is NUMBER:
            act, a, b = self.number_operators[node.sign], left.get, right.get
            return BoundNode(node, NUMBER, lambda: act(a(), b()), (left, right))
        for part in (left, right):
            if part.kind is not NUMBER and not is_vector_like(part.kind):
                raise self.not_a_number(part)
        return self._vectors(node, left, right)

    def _vectors(self, node: syntax.Arithmetic, left: BoundNode, right: BoundNode) -> BoundNode:
        both = is_vector_like(left.kind) and is_vector_like(right.kind)
        allowed = ("+", "-") if both else ("*", "/") if left.kind is not NUMBER else ("*",)
        if node.sign not in allowed:
            message = f"cannot compute {left.kind} {node.sign} {right.kind}"
            raise self.fault("SK-COND-004", message, node.span, "norm(v) is the length of a vector, v.x a component")
        lengths = {part.kind.length for part in (left, right) if is_vector_like(part.kind)} - {None}
        if len(lengths) > 1:
            message = f"cannot combine vectors of {' and '.join(map(str, sorted(lengths, key=str)))} numbers"
            raise self.fault("SK-COND-004", message, node.span)
        act, a, b = VECTOR_OPERATORS[node.sign], self.operand(left), self.operand(right)
        source = node.span.text(self.source)

        def value() -> object:
            x, y = a(), b()
            if both and x.shape[-1] != y.shape[-1]:
                raise syntax.UndecidedValue(
                    f"{source} combines lists of {x.shape[-1]} and {counted(y.shape[-1], 'number')}"
                )
            return act(x, y)

        kind = next(part.kind for part in (left, right) if is_vector_like(part.kind))
        return BoundNode(node, kind if kind.is_numbers else NUMBERS, value, (left, right))

    def operand(self, part: BoundNode) -> ValueGetter:
        """Return the function that gets an operand of an operator of vectors: a vector or a factor."""
        return as_vector(part)

    # ------------------------------------------------------------------ parts of values

    def _attribute(self, node: syntax.Attribute) -> BoundNode:
        if isinstance(node.of, syntax.Name) and node.of.name not in (*_CONSTANTS, *_TIME_NAMES, *FUNCTIONS):
            name = f"{node.of.name}.{node.name}"
            hint = f"write pose('{node.of.name}').{node.name} for a pose; names need quotes"
            raise self.fault("SK-COND-002", f"unknown name {name!r}", node.span, hint)
        of = self.part(node.of)
        attribute = attribute_of(of, node.name)
        if attribute is None:
            allowed = listed_attributes(of.kind)
            message = f"{of.node.span.text(self.source)} is {of.kind}, which has no {node.name!r}"
            hint = did_you_mean(node.name, allowed) or _parts_hint(of.kind) or "it has no attributes"
            raise self.fault("SK-COND-007", message, node.name_span, hint)
        kind, get = attribute
        return BoundNode(node, kind, get, (of,), of.feed)

    def _index(self, node: syntax.Index) -> BoundNode:
        of, index = self.part(node.of), self.number(node.index)
        item, length = of.kind.item, of.kind.length
        if item is None:
            message = f"{of.node.span.text(self.source)} is {of.kind}, which has no numbered items"
            raise self.fault("SK-COND-007", message, node.index.span, _parts_hint(of.kind))
        get, at = of.get, index.get
        is_negated = isinstance(node.index, syntax.Sign) and isinstance(node.index.operand, syntax.Number)
        fixed = at() if isinstance(node.index, syntax.Number) or is_negated else None
        if fixed is not None and not float(fixed).is_integer():
            raise self.fault("SK-COND-004", "an index must be an integer", node.index.span)
        if fixed is not None and length is not None and not -length <= fixed < length:
            raise self.fault("SK-COND-007", f"index out of range: there are {counted(length, 'item')}", node.index.span)
        source = node.span.text(self.source)
        is_number = item is NUMBER

        def value() -> object:
            items, place = get(), at()
            if not (-len(items) <= place < len(items)) or place != int(place):
                raise syntax.UndecidedValue(f"{source} is out of range: there are {counted(len(items), 'item')}")
            item_value = items[int(place)]
            return float(item_value) if is_number else bool(item_value) if item is TRUTH else item_value

        return BoundNode(node, item, value, (of, index), of.feed if fixed is not None else None)


class RowsBinder(Binder):
    """Binder of one expression to many worlds at once."""

    in_rows = True
    number_operators = ROW_OPERATORS

    def part(self, node: syntax.Node) -> BoundNode:
        has_rows = not isinstance(node, syntax.Index) and not (isinstance(node, syntax.Name) and node.name == "tick")
        if isinstance(node, syntax.Call):
            has_rows = FUNCTIONS[node.name].has_rows
        try:
            if has_rows:
                return super().part(node)
        except NotInRows:
            pass
        text = node.span.text(self.source)
        raise CannotBatchError(f"{text} in the expression {self.source!r}; simkit.gym.Batched has one for arrays")

    def _attribute(self, node: syntax.Attribute) -> BoundNode:
        part = super()._attribute(node)
        (owner,) = part.below
        if owner.kind is JOINT and not hasattr(owner.get(), node.name):
            raise NotInRows
        return part

    def _not(self, node: syntax.Not) -> BoundNode:
        operand = self.truth(node.operand)
        return BoundNode(node, TRUTH, lambda: np.logical_not(operand.get()), (operand,))

    def _junction(self, node: syntax.Junction) -> BoundNode:
        operands = tuple(self.truth(operand) for operand in node.operands)
        join = np.logical_or if node.word == "or" else np.logical_and
        return BoundNode(
            node, TRUTH, lambda: join.reduce(np.broadcast_arrays(*(part.get() for part in operands))), operands
        )

    def _comparison(self, node: syntax.Comparison) -> BoundNode:
        operands = tuple(self.part(operand) for operand in node.operands)
        signs = [_COMPARISON_OPERATORS[sign] for sign in node.signs]

        def value() -> object:
            holds: bool | npt.NDArray[np.bool_] = True
            for sign, (left, right) in zip(signs, pairwise([part.get() for part in operands]), strict=True):
                holds = np.logical_and(holds, sign(left, right))
            return holds

        return BoundNode(node, TRUTH, value, operands)

    def operand(self, part: BoundNode) -> ValueGetter:
        get = as_vector(part)
        # a factor of each world multiplies all numbers of the world's vector
        return (lambda: np.asarray(get())[..., None]) if part.kind is NUMBER else get


def _parts_hint(kind: ValueType) -> str:
    allowed = listed_attributes(kind)
    return f"it has {', '.join(allowed)}" if allowed else ""


def number_hint(kind: ValueType) -> str:
    """Return a hint for converting a value to a number."""
    if is_vector_like(kind):
        return "min(…), max(…), mean(…), norm(…) or [0] convert it to a number"
    attributes = listed_attributes(kind)
    return f"it has .{', .'.join(attributes)}" if attributes else ""
