"""Comparison of number columns and orientations: the first message that differs, the size and the change over time."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import numpy as np
import numpy.typing as npt

from simkit.elementary_functions import arctan2
from simkit.linear_algebra import norm
from simkit.number_text import counted
from simkit.run_spec import Tolerance
from simkit.testing.golden.compare.difference import Difference
from simkit.testing.golden.compare.tolerances import (
    FieldFinding,
    FieldTerms,
    FlatValues,
    is_colour,
    item_name,
    period_of,
    quantity_text,
    time_text,
    value_text,
)
from simkit.testing.run_record.record import Array, Column

Floats = npt.NDArray[np.float64]
Flags = npt.NDArray[np.bool_]

_NAMES = ("child_frame_id", "name", "names", "joint_names", "link_name", "id")


def _largest_deviation(shift: Floats, counted: Flags, messages: npt.NDArray[np.intp]) -> tuple[float, int]:
    """Return the largest finite difference and the index of its message; NaN and -1 if there is none."""
    off = np.where(counted & np.isfinite(shift), np.abs(shift), -1.0)
    at = int(np.argmax(off))
    return (float(shift[at]), int(messages[at])) if off[at] >= 0.0 else (math.nan, -1)


def _setting_text(terms: FieldTerms, golden: FlatValues, run: FlatValues, first: int, failing: Flags) -> str:
    """Describe the change of a constant setting: `3.5 m became 4 m`; empty if the field is not constant."""
    width = int(golden.widths[0])
    if is_colour(terms.field) or first or not failing.all() or (golden.widths != width).any():
        return ""
    a, b = golden.values.reshape(-1, width), run.values.reshape(-1, width)
    if not (a == a[0]).all() or not (b == b[0]).all() or (len(a) == 1 and terms.tolerance.absolute):
        return ""
    changed = np.flatnonzero(a[0] != b[0])
    if not 0 < len(changed) <= 3:
        return ""
    words = [f"{value_text(a[0, i], terms.unit)} became {value_text(b[0, i], terms.unit)}" for i in changed.tolist()]
    if width == 1:
        return words[0]
    names = _value_names(terms, width, 0) or [f"value {i}" for i in range(width)]
    return ", ".join(f"{names[i]} {text}" for i, text in zip(changed.tolist(), words, strict=True))


def _which_values(terms: FieldTerms, numbers: npt.NDArray[np.intp], width: int, index: int) -> str:
    """Describe which values of a message differ: `14 of 360 rays (45 to 58) `."""
    names = _value_names(terms, width, index)
    if width == 1 and not names:
        return ""
    if names and len(numbers) <= 3:
        return ", ".join(names[int(i)] for i in numbers) + " "
    things = item_name(terms.stream.type_name, terms.field)
    if len(numbers) == width:
        return f"all {width} {things} " if width > 1 else ""
    first, last = int(numbers[0]), int(numbers[-1])
    place = ""
    if len(numbers) == 1:
        place = f"(number {first}) "
    elif last - first + 1 == len(numbers):
        place = f"({first} to {last}) "
    return f"{len(numbers)} of {width} {things} {place}"


def _value_names(terms: FieldTerms, width: int, index: int) -> list[str]:
    """Return the names of a message's values from a field with names in the same message; empty if there is none."""
    if width > 64:
        return []
    parts = terms.field.split(".")
    for depth in range(len(parts) - 1, -1, -1):
        prefix = ".".join([*parts[:depth], ""]) if depth else ""
        for name in _NAMES:
            texts = terms.stream.words.get(prefix + name)
            if texts is not None and index < len(texts):
                names = texts[index].split(", ")
                if len(names) == width and all(names) and (width > 1 or depth):
                    return names
    return []


def _deviation_text(terms: FieldTerms, shift: Floats, golden: Array, run: Array, error: float) -> str:
    is_finite = np.isfinite(shift)
    parts = [_signed(shift[is_finite], terms.unit, error)] if is_finite.any() else []
    parts += _finiteness_text(golden[~is_finite], run[~is_finite], only=not is_finite.any(), single=shift.size == 1)
    return ", ".join(parts)


def _signed(shift: Floats, unit: str, error: float) -> str:
    """Return `+12 mm` if more than 80 % of the differences have the same sign, else `up to ±12 mm`."""
    positive = float((shift > 0).mean())
    if 0.2 < positive < 0.8:
        return f"up to ±{quantity_text(float(np.abs(shift).max()), unit, signed=False, error=error)}"
    return quantity_text(_typical(shift), unit, error=error)


def _typical(shift: Floats) -> float:
    finite = shift[np.isfinite(shift)]
    return float(np.median(finite)) if finite.size else math.nan


def _finiteness_text(golden: Array, run: Array, *, only: bool, single: bool) -> list[str]:
    """Describe values that became infinite, finite or NaN."""
    a, b = golden.astype(np.float64), run.astype(np.float64)
    kinds = (
        ("became NaN", np.isnan(b)),
        ("no longer NaN", np.isnan(a) & ~np.isnan(b)),
        ("became infinite", np.isinf(b) & ~np.isnan(a)),
        ("became finite", np.isinf(a) & np.isfinite(b)),
    )
    texts = []
    for words, which in kinds:
        number = int(which.sum())
        if number:
            texts.append(words if (only and number == len(a)) or single else f"{number} {words}")
    return texts


def _duration_text(
    terms: FieldTerms, first: int, failing: Flags, typical: float, largest: float, at: int, error: float
) -> str:
    """Describe the first time, the number of messages and the largest difference."""
    rest = len(failing) - first
    number = int(failing[first:].sum())
    if number == 1 and rest > 1:
        return f" at {time_text(terms.time(first))}, in that message only"
    words = f" {'at' if rest == 1 else 'from'} {time_text(terms.time(first))}"
    if number < rest:
        words += f", in {number} of {counted(rest, 'message')}"
    if at > first and abs(largest) > 1.5 * abs(typical):
        words += f", up to {quantity_text(largest, terms.unit, error=error)} at {time_text(terms.time(at))}"
    return words


HALF_STEP: Final = 0.5 * (1.0 + 1e-9)
"""Largest error from rounding, as a multiple of the rounding step."""


def compare_column(terms: FieldTerms, golden: Column, run: Column) -> FieldFinding:
    """Compare a field of numbers."""
    mine, other = FlatValues.of(golden, terms.count), FlatValues.of(run, terms.count)
    uneven = np.flatnonzero(mine.widths != other.widths)
    first = int(uneven[0]) if uneven.size else terms.count
    if uneven.size:
        mine, other = mine.first(first), other.first(first)
    shift = _deviation(terms, mine.values, other.values)
    limit = _limit(terms, golden, run, mine.values)
    finding = field_finding(terms, shift, limit, mine, other, HALF_STEP * (golden.step + run.step))
    if finding.difference is not None or not uneven.size:
        return finding
    # describe the first message with more or fewer values
    a, b, time = int(golden.of(first).size), int(run.of(first).size), terms.time(first)
    things = item_name(terms.stream.type_name, terms.field)
    words, size = f"{terms.name}: {a} {things} became {b} at {time_text(time)}", float(abs(b - a))
    topic, field = terms.stream.topic, terms.field
    difference = Difference(topic, field, "count", time, size, things, words, "none", first)
    return FieldFinding(difference, math.inf, math.inf)


def field_finding(
    terms: FieldTerms, shift: Floats, limit: Floats, golden: FlatValues, run: FlatValues, rounding: float
) -> FieldFinding:
    """Evaluate differences against their limits.

    Args:
        terms: Settings of the comparison.
        shift: Run minus golden, for each value.
        limit: Largest allowed difference of each value.
        golden: Values of the golden run.
        run: Values of the new run.
        rounding: Largest difference that rounding alone can cause.
    """
    off = np.abs(shift)
    bad = ~(off <= limit)
    share = 0.0 if terms.is_exact else float(terms.tolerance.share or 0.0)
    failing = np.bincount(golden.messages[bad], minlength=len(golden.widths)) > share * golden.widths
    largest_off = max(0.0, float(off[np.isfinite(off)].max(initial=0.0)) - rounding)
    with np.errstate(divide="ignore", invalid="ignore"):
        if not failing.any():
            ratio = np.nan_to_num(off / limit, nan=0.0, posinf=0.0)
            return FieldFinding(None, float(ratio[~bad].max(initial=0.0)), largest_off)
        ratio = off[bad] / _tolerances(terms.tolerance, golden.values[bad])
        excess = float(np.nan_to_num(ratio, nan=np.inf, posinf=np.inf).max(initial=0.0))
    first = int(np.argmax(failing))
    counted = bad & failing[golden.messages]
    largest, at = _largest_deviation(shift, counted, golden.messages)
    text = _setting_text(terms, golden, run, first, failing)
    if not text:
        here = counted & (golden.messages == first)
        numbers = np.flatnonzero(here) - int(golden.widths[:first].sum())
        text = _which_values(terms, numbers, int(golden.widths[first]), first)
        text += _deviation_text(terms, shift[here], golden.values[here], run.values[here], rounding)
        text += _duration_text(terms, first, failing, _typical(shift[here]), largest, at, rounding)
    topic, words = terms.stream.topic, f"{terms.name}: {text}"
    difference = Difference(
        topic, terms.field, "value", terms.time(first), abs(largest), terms.unit, words, terms.allowed, first
    )
    return FieldFinding(difference, excess, largest_off)


# ---------------------------------------------------------------------- values


def _deviation(terms: FieldTerms, golden: Array, run: Array) -> Floats:
    """Subtract golden from run; 0 for equal infinities or two NaN, infinite if only one value is finite."""
    if not golden.size:
        return np.zeros(0)
    if is_colour(terms.field) and golden.dtype == run.dtype and golden.dtype.itemsize == 4:
        return _colour_deviation(golden, run)
    if golden.dtype.kind in "iub" and run.dtype.kind in "iub":
        if golden.dtype == np.int64:  # times [ns] exceed the integer precision of a float
            return np.asarray((run.astype(np.int64) - golden).astype(np.float64))
        return run.astype(np.float64) - golden.astype(np.float64)
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


def _colour_deviation(golden: Array, run: Array) -> Floats:
    """Return the largest channel difference of four-byte colours."""
    a = np.ascontiguousarray(golden).view(np.uint8).reshape(-1, 4).astype(np.float64)
    b = np.ascontiguousarray(run).view(np.uint8).reshape(-1, 4)
    shift = b - a
    at = np.argmax(np.abs(shift), axis=1)
    return np.asarray(np.take_along_axis(shift, at[:, None], axis=1)[:, 0])


def _limit(terms: FieldTerms, golden: Column, run: Column, values: Array) -> Floats:
    """Return the largest allowed difference of each value."""
    rounding = HALF_STEP * (golden.step + run.step)
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


def _tolerances(tolerance: Tolerance, values: Array) -> Floats:
    """Return the tolerance of each value without rounding; a comparison of bits uses it as a scale."""
    with np.errstate(invalid="ignore"):
        part = (tolerance.relative or 0.0) * np.nan_to_num(np.abs(values.astype(np.float64)), posinf=0.0)
    return np.asarray((tolerance.absolute or 0.0) + part)


def quaternion_paths(columns: Sequence[str]) -> list[str]:
    """Return the paths of quaternions: paths for which columns x, y, z and w exist."""
    known = set(columns)
    bases = [path[:-2] for path in columns if path.endswith(".w")]
    return [base for base in bases if all(f"{base}.{axis}" in known for axis in "xyz")]


def compare_orientation(terms: FieldTerms, golden: list[Column], run: list[Column]) -> FieldFinding | None:
    """Compare quaternions x, y, z, w as rotations; None if they are not unit quaternions or if their numbers differ."""
    mine, other = [FlatValues.of(c, terms.count) for c in golden], [FlatValues.of(c, terms.count) for c in run]
    widths = mine[0].widths
    if any(len(f.widths) != len(widths) or (f.widths != widths).any() for f in (*mine, *other)):
        return None
    a = np.stack([f.values.astype(np.float64) for f in mine], axis=-1)
    b = np.stack([f.values.astype(np.float64) for f in other], axis=-1)
    for turns in (a, b):
        if not (np.abs(np.linalg.norm(turns, axis=-1) - 1.0) < 1e-2).all():
            return None
    step = max(c.step for c in (*golden, *run))
    vector, scalar = _rotation_between(a, b)
    angle = 2.0 * arctan2(np.linalg.norm(vector, axis=-1), np.abs(scalar))
    moved = (np.abs(a - b) > HALF_STEP * step).any(axis=-1)
    if terms.is_exact:
        limit = np.where(moved, -1.0, np.inf)
    else:
        limit = np.full(angle.shape, (terms.tolerance.absolute or 0.0) + 2.0 * step)
    axis = np.argmax(np.abs(vector), axis=-1)
    along = np.take_along_axis(vector * np.where(scalar < 0.0, -1.0, 1.0)[:, None], axis[:, None], axis=-1)[:, 0]
    angles = replace(mine[0], values=np.zeros(angle.shape))  # only the shape and the messages are used
    finding = field_finding(terms, np.where(along < 0.0, -angle, angle), limit, angles, angles, 2.0 * step)
    if finding.difference is None:
        return finding
    return FieldFinding(
        _with_axis(terms, finding.difference, mine[0], vector, axis, 2.0 * step), finding.excess, finding.off
    )


def _with_axis(
    terms: FieldTerms, difference: Difference, values: FlatValues, vector: Floats, axis: Array, rounding: float
) -> Difference:
    """Add the rotation axis to the description of a difference."""
    start = int(values.widths[: difference.index].sum())
    here = slice(start, start + max(1, int(values.widths[difference.index])))
    most = start + int(np.argmax(np.linalg.norm(vector[here], axis=-1)))
    length = norm(vector[most])
    words = difference.words
    if difference.size <= rounding:
        words = f"{terms.name}: the same rotation with opposite quaternion sign from {time_text(difference.time)}"
    elif abs(float(vector[most][axis[most]])) > 0.98 * length:
        words = words.replace("° ", f"° about {'xyz'[int(axis[most])]} ", 1)
    columns = tuple(f"{terms.field}.{part}" for part in "xyzw")
    return replace(difference, words=words, columns=columns)


def _rotation_between(a: Floats, b: Floats) -> tuple[Floats, Floats]:
    """Return the rotation from a to b in the frame of a, as vector part and scalar part; quaternions are x, y, z, w."""
    av, aw, bv, bw = a[:, :3], a[:, 3], b[:, :3], b[:, 3]
    vector = aw[:, None] * bv - bw[:, None] * av - np.cross(av, bv)
    return vector, aw * bw + (av * bv).sum(axis=-1)
