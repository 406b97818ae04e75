"""How strongly the wind pushes at which place: a number, or pieces of space with a sum of polynomials in each."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from simkit.params import Params
from simkit.plugins.options import Options, blocks, number, vector
from simkit.pose import Vector

Four = tuple[float, float, float, float]
_AXES: Final = ("px", "qy", "rz")
_ZERO: Final[Four] = (0.0, 0.0, 0.0, 0.0)
_ONE: Final = ((0.0, 0.0, 0.0, 1.0), _ZERO, _ZERO)
_FARTHEST: Final = 1e6  # [m], where a polynomial is asked whether it is negative
_ALLOWED: Final = "at least 0 everywhere: wind pushes along, not against"


@dataclass(frozen=True, slots=True)
class Interval:
    """Of one coordinate [m]."""

    low: float = -math.inf
    high: float = math.inf
    has_low: bool = False
    has_high: bool = False


@dataclass(frozen=True, slots=True)
class FieldPiece:
    """k · (p(x) + q(y) + r(z)) in a box of space.

    Attributes:
        where: intervals of x, y and z.
        factor: k.
        terms: coefficients of p, q and r, from the cube down.
    """

    where: tuple[Interval, Interval, Interval]
    factor: float
    terms: tuple[Four, Four, Four]

    def at(self, places: Vector) -> Vector:
        a, b, c, d = np.array(self.terms).T
        found: Vector = self.factor * (((a * places + b) * places + c) * places + d).sum(axis=1)
        return found

    def holds(self, places: Vector) -> npt.NDArray[np.bool_]:
        inside = np.ones(len(places), bool)
        for values, interval in zip(places.T, self.where, strict=True):
            inside &= values >= interval.low if interval.has_low else values > interval.low
            inside &= values <= interval.high if interval.has_high else values < interval.high
        return inside

    def one_at(self, place: Sequence[float]) -> float | None:
        """At one place; None where this piece does not hold it."""
        for value, interval in zip(place, self.where, strict=True):
            if not (value >= interval.low if interval.has_low else value > interval.low):
                return None
            if not (value <= interval.high if interval.has_high else value < interval.high):
                return None
        p, q, r = (((a * x + b) * x + c) * x + d for x, (a, b, c, d) in zip(place, self.terms, strict=True))
        return self.factor * (p + q + r)

    @property
    def least(self) -> float:
        """The smallest value in the box, as far as `_FARTHEST` out."""
        extremes = [_extremes(c, span) for c, span in zip(self.terms, self.where, strict=True)]
        return min(self.factor * sum(corner) for corner in itertools.product(*extremes))


@dataclass(frozen=True, slots=True)
class WindField:
    """The scaling factor of the wind's force [1/s]: of the first piece that holds a place, zero outside of all.

    Attributes:
        pieces: where it is not the same everywhere.
        everywhere: where it is.
    """

    pieces: tuple[FieldPiece, ...] = ()
    everywhere: float = 0.0

    def at(self, places: Vector) -> Vector | float:
        """At places [m], shape (n, 3): shape (n,), or one for all."""
        if not self.pieces:
            return self.everywhere
        found, is_open = np.zeros(len(places)), np.ones(len(places), bool)
        for piece in self.pieces:
            inside = is_open & piece.holds(places)
            if inside.any():
                found[inside] = piece.at(places[inside])
                is_open &= ~inside
        return found

    def one_at(self, place: Sequence[float]) -> float:
        """At one place [m], in plain numbers."""
        for piece in self.pieces:
            found = piece.one_at(place)
            if found is not None:
                return found
        return 0.0 if self.pieces else self.everywhere


class FieldPieceOptions(Options):
    """A sum of polynomials: k · (p(x) + q(y) + r(z))."""

    k: float = number(1.0, minimum=-1e9, maximum=1e9)
    px: tuple[float, ...] = vector(_ZERO)
    qy: tuple[float, ...] = vector(_ZERO)
    rz: tuple[float, ...] = vector(_ZERO)


class WindFieldOptions(FieldPieceOptions):
    """The `<force_approximation_scaling_factor>` block."""

    when: tuple[FieldPieceOptions, ...] = blocks(FieldPieceOptions)


def read_field(params: Params, quirks: bool) -> WindField:
    """A plugin's `<force_approximation_scaling_factor>`; what is wrong is reported.

    Args:
        params: the plugin's.
        quirks: a plain number counts squared, as gz has it.
    """
    name = "force_approximation_scaling_factor"
    block = params.child(name)
    if block is None:
        return WindField(everywhere=1.0)
    if not block.children:
        value = params.number(name, 1.0, minimum=0, maximum=1e9)
        return WindField(everywhere=value * value if quirks else value)
    options = WindFieldOptions(block)
    whens: tuple[FieldPieceOptions, ...] = options.when
    field = WindField(tuple(_piece(when) for when in whens) if whens else (_piece(options, is_bounded=False),))
    for piece, one in zip(field.pieces, whens or (options,), strict=True):
        if piece.least < -1e-9:
            text = f"found <{one.params.name}> that comes down to {piece.least:g}, allowed is {_ALLOWED}"
            one.params.error("SK-PARAM-002", text)
    return field


def _piece(options: FieldPieceOptions, is_bounded: bool = True) -> FieldPiece:
    block = options.params
    x, y, z = (_interval(block, axis) if is_bounded else Interval() for axis in "xyz")
    if not block.children:
        value = _number_of(block)
        return FieldPiece((x, y, z), value, _ONE)
    p, q, r = ((a, b, c, d) for a, b, c, d in (options.px, options.qy, options.rz))
    return FieldPiece((x, y, z), options.k, (p, q, r))


def _number_of(block: Params) -> float:
    """The number that an element itself is."""
    try:
        value = float(block.value)
    except ValueError:
        value = math.nan
    if not abs(value) <= 1e9:
        block.error("SK-PARAM-002", f"found <{block.name}>{block.value}</{block.name}>, allowed is a number")
        return 0.0
    return value


def _interval(block: Params, axis: str) -> Interval:
    low, has_low = _bound(block, axis + "ge", axis + "gt", -math.inf)
    high, has_high = _bound(block, axis + "le", axis + "lt", math.inf)
    return Interval(low, high, has_low, has_high)


def _bound(block: Params, closed: str, opened: str, default: float) -> tuple[float, bool]:
    given = [(name, block.attribute(name)) for name in (closed, opened) if block.attribute(name)]
    if len(given) == 2:
        block.error("SK-PARAM-002", f"found {closed} and {opened} on one <{block.name}>, allowed is one of the two")
    for name, text in given[:1]:
        try:
            value = float(text)
        except ValueError:
            value = math.nan
        if math.isfinite(value):
            return value, name == closed
        block.error("SK-PARAM-002", f'found {name}="{text}", allowed is a number [m]')
    return default, False


def _extremes(terms: Four, span: Interval) -> list[float]:
    """Values of a cubic at the ends of an interval and where its slope is zero within."""
    low, high = max(span.low, -_FARTHEST), min(span.high, _FARTHEST)
    slope = np.polyder(np.poly1d(terms)).coeffs
    turns = [float(r.real) for r in np.roots(slope) if abs(r.imag) < 1e-12] if np.any(slope) else []
    points = [low, high, *(t for t in turns if low < t < high)]
    return [float(np.polyval(terms, point)) for point in points]
