"""Comparisons: numbers by size; texts, and true or false, by being the same."""

from __future__ import annotations

import operator
from collections.abc import Callable
from itertools import pairwise
from typing import TYPE_CHECKING, Any, Final

from simkit.conditions.kinds import NUMBER, TRUTH, is_vector_like
from simkit.conditions.parts import Part, is_scalar
from simkit.conditions.syntax import Comparison

if TYPE_CHECKING:
    from simkit.conditions.binding import Binder

_SIGNS: Final[dict[str, Callable[[Any, Any], bool]]] = {
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
    "==": operator.eq,
    "!=": operator.ne,
}


def comparison(binder: Binder, node: Comparison, operands: tuple[Part, ...]) -> Part:
    """What says whether a comparison holds.

    Raises:
        InputError: SK-COND-004 two of the operands cannot be compared.
    """
    for sign, (left, right) in zip(node.signs, pairwise(operands), strict=True):
        _check(binder, sign, left, right)
    signs, gets = [_SIGNS[sign] for sign in node.signs], [part.get for part in operands]
    if len(signs) == 1:
        holds, a, b = signs[0], gets[0], gets[1]
        return Part(node, TRUTH, lambda: holds(a(), b()), operands)

    def value() -> bool:
        left = gets[0]()
        for holds, get in zip(signs, gets[1:], strict=True):
            right = get()
            if not holds(left, right):
                return False
            left = right
        return True

    return Part(node, TRUTH, value, operands)


def _check(binder: Binder, sign: str, left: Part, right: Part) -> None:
    is_equality = sign in ("==", "!=")
    for part in (left, right):
        if is_vector_like(part.kind):
            message = f"{part.node.span.text(binder.source)} is {part.kind}, which cannot be compared"
            hint = "norm(…), min(…) or one of its parts (.x, [0]) can; distance(a, b) says how far two are apart"
            raise binder.fault("SK-COND-004", message, part.node.span, hint)
        if not is_scalar(part.kind):
            raise binder.not_a_number(part)
    if left.kind is not right.kind:
        message = f"{left.kind} is compared with {right.kind}"
        raise binder.fault("SK-COND-004", message, right.node.span)
    if not is_equality and left.kind is not NUMBER:
        message = f"{sign} compares numbers, and {left.node.span.text(binder.source)} is {left.kind}"
        raise binder.fault("SK-COND-004", message, left.node.span, "write == or !=")
