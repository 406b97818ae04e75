"""Columns of numbers side by side: the first message in which they differ, and by how much."""

from __future__ import annotations

import math
from typing import Final

import numpy as np
import numpy.typing as npt

from simkit.golden.number_words import value_difference, width_difference
from simkit.golden.record import Array, Column
from simkit.golden.terms import Flat, Found, Terms
from simkit.golden.units import is_colour, period_of
from simkit.scenario import Tolerance

Floats = npt.NDArray[np.float64]

HALF: Final = 0.5 * (1.0 + 1e-9)
"""Of a step: how far rounding moves a value."""


def compare_column(terms: Terms, golden: Column, run: Column) -> Found:
    """Compares a field of numbers."""
    mine, other = Flat.of(golden, terms.count), Flat.of(run, terms.count)
    uneven = np.flatnonzero(mine.widths != other.widths)
    count = terms.count
    if uneven.size:
        count = int(uneven[0])
        mine, other = mine.first(count), other.first(count)
    shift = _shift(terms, mine.values, other.values)
    limit = _limit(terms, golden, run, mine.values)
    found = found_in(terms, shift, limit, mine, other, HALF * (golden.step + run.step))
    if found.difference is None and uneven.size:
        return Found(width_difference(terms, count, golden, run), math.inf, math.inf)
    return found


def found_in(terms: Terms, shift: Floats, limit: Floats, golden: Flat, run: Flat, rounding: float) -> Found:
    """What there is to say of values that are off.

    Args:
        terms: of the comparison.
        shift: run less golden, a number for each value.
        limit: how far each may be off.
        golden, run: the values themselves.
        rounding: how far off rounding alone may make a value.
    """
    off = np.abs(shift)
    bad = ~(off <= limit)
    share = 0.0 if terms.is_exact else float(terms.tolerance.share or 0.0)
    bad_counts = np.bincount(golden.messages[bad], minlength=len(golden.widths))
    failing = bad_counts > share * golden.widths
    finite = off[np.isfinite(off)]
    largest = max(0.0, float(finite.max(initial=0.0)) - rounding)
    if not failing.any():
        with np.errstate(divide="ignore", invalid="ignore"):
            ratio = np.nan_to_num(off / limit, nan=0.0, posinf=0.0)
        return Found(None, float(ratio[~bad].max(initial=0.0)), largest)
    excess = _excess(off[bad], _wanted(terms.tolerance, golden.values[bad]))
    return Found(value_difference(terms, shift, bad, failing, golden, run, rounding), excess, largest)


# ---------------------------------------------------------------------- values


def _shift(terms: Terms, golden: Array, run: Array) -> Floats:
    """Run less golden; 0 where both are the same infinity or both no number, infinite where only one is finite."""
    if not golden.size:
        return np.zeros(0)
    if is_colour(terms.field) and golden.dtype == run.dtype and golden.dtype.itemsize == 4:
        return _of_colours(golden, run)
    if golden.dtype.kind in "iub" and run.dtype.kind in "iub":
        return (run.astype(np.float64) - golden.astype(np.float64)) if golden.dtype != np.int64 else _whole(golden, run)
    a, b = golden.astype(np.float64), run.astype(np.float64)
    with np.errstate(invalid="ignore"):
        shift = b - a
    same = (a == b) | (np.isnan(a) & np.isnan(b))
    shift[same] = 0.0
    shift[~same & ~np.isfinite(shift)] = np.inf
    period = period_of(terms.stream.type_name, terms.field)
    if period:
        shift -= period * np.round(np.where(np.isfinite(shift), shift, 0.0) / period)
    return shift


def _of_colours(golden: Array, run: Array) -> Floats:
    """The largest difference of a channel, of colours that are four bytes each."""
    a = np.ascontiguousarray(golden).view(np.uint8).reshape(-1, 4).astype(np.float64)
    b = np.ascontiguousarray(run).view(np.uint8).reshape(-1, 4)
    shift = b - a
    at = np.argmax(np.abs(shift), axis=1)
    return np.asarray(np.take_along_axis(shift, at[:, None], axis=1)[:, 0])


def _whole(golden: Array, run: Array) -> Floats:
    """The difference of times [ns], which are too large for a float."""
    return np.asarray((run.astype(np.int64) - golden).astype(np.float64))


def _limit(terms: Terms, golden: Column, run: Column, values: Array) -> Floats:
    """How far each value may be off."""
    rounding = HALF * (golden.step + run.step)
    limit = np.full(values.shape, rounding)
    if terms.is_exact:
        return limit
    tolerance = terms.tolerance
    limit += tolerance.absolute or 0.0
    is_plain_count = values.dtype.kind in "iub" and tolerance.pattern == terms.field and not terms.unit
    if tolerance.relative and not is_plain_count and not is_colour(terms.field):
        with np.errstate(invalid="ignore"):
            limit += np.nan_to_num(tolerance.relative * np.abs(values.astype(np.float64)), nan=0.0, posinf=0.0)
    return limit


def _wanted(tolerance: Tolerance, values: Array) -> Floats:
    """What a tolerance allows values to be off, whether it counts here or not."""
    with np.errstate(invalid="ignore"):
        part = (tolerance.relative or 0.0) * np.nan_to_num(np.abs(values.astype(np.float64)), posinf=0.0)
    return np.asarray((tolerance.absolute or 0.0) + part)


def _excess(off: Floats, limit: Floats) -> float:
    with np.errstate(divide="ignore", invalid="ignore"):
        return float(np.nan_to_num(off / limit, nan=np.inf, posinf=np.inf).max(initial=0.0))
