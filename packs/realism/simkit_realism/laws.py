"""Laws of artefacts: a number that depends on range, angle or another quantity, as a formula or as a table."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from simkit import Params
from simkit.elementary_functions import power
from simkit.extend import LARGEST, Vector


@dataclass(frozen=True, slots=True)
class Law:
    """Function y(x) = max(least, constant + coefficient · x^exponent), or straight lines between the rows of a table.

    Attributes:
        constant: value at x = 0, in the unit of y.
        coefficient: growth, in the unit of y per unit of x to the power of the exponent.
        exponent: exponent of x.
        least: lower limit of y.
        table: x and y of the rows, with ascending x; empty for a formula. Beyond its ends, y is constant.
    """

    constant: float = 0.0
    coefficient: float = 0.0
    exponent: float = 1.0
    least: float = -np.inf
    table: tuple[tuple[float, ...], tuple[float, ...]] = ((), ())

    def __call__(self, x: Vector) -> Vector:
        """Return y for finite x of any shape; infinite x gives the value at 0."""
        x = np.where(np.isfinite(x), x, 0.0)
        if self.table[0]:
            return np.interp(x, *self.table)
        y = self.constant + self.coefficient * _power(x, self.exponent) if self.coefficient else self.constant
        return np.broadcast_to(np.maximum(y, self.least), x.shape)

    @property
    def is_zero(self) -> bool:
        """True if y is 0 everywhere."""
        return not (self.constant or self.coefficient or self.least > 0 or any(self.table[1]))


def _power(x: Vector, exponent: float) -> Vector:
    if exponent == 1.0:
        return x
    if exponent == 2.0:
        return x * x
    return power(x, exponent)


def read_law(owner: Params, name: str, minimum: float = 0.0, maximum: float | None = None) -> Law | None:
    """Read a law from a block; None if the file has no such element.

    Args:
        owner: block that contains the element.
        name: name of the element, with a `<table>`, or with `<constant>`, `<coefficient>`, `<exponent>` and `<least>`;
            a number alone is a constant.
        minimum: lower limit of y in a table and of a constant.
        maximum: upper limit of these; None for none.
    """
    params = owner.child(name)
    if params is None:
        return None
    if params.value and not params.children:
        return Law(owner.number(name, 0.0, minimum=minimum, maximum=maximum))
    if params.has("table"):
        return Law(table=_read_table(params, minimum, maximum))
    return Law(
        params.number("constant", 0.0, minimum=minimum, maximum=maximum),
        params.number("coefficient", 0.0, minimum=-LARGEST, maximum=LARGEST),
        params.number("exponent", 1.0, minimum=-10.0, maximum=10.0),
        params.number("least", minimum, minimum=minimum, maximum=maximum),
    )


def _read_table(params: Params, minimum: float, maximum: float | None) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Read the rows `x y` of a table, separated by white space; report a table that is none."""
    text = params.text("table")
    top = np.inf if maximum is None else maximum
    try:
        numbers = [float(word) for word in text.split()]
    except ValueError:
        numbers = []
    x, y = tuple(numbers[::2]), tuple(numbers[1::2])
    is_ascending = all(a < b for a, b in pairwise(x))
    is_good = len(x) == len(y) > 0 and is_ascending and np.isfinite(numbers).all()
    if is_good and all(minimum <= value <= top for value in y):
        return x, y
    limits = f"of at least {minimum:g}" if maximum is None else f"from {minimum:g} to {maximum:g}"
    message = f"<table> of <{params.name}> is {text!r}; expected pairs x y with ascending x, and y {limits}"
    params.block("table").error("SK-SENSOR-210", message, "write for example <table>0 0  5 0.1  10 0.5</table>")
    return (0.0,), (0.0,)
