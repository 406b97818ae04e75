"""Orientations side by side, as turns about an axis."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from simkit.testing.golden.compare.difference import Difference
from simkit.testing.golden.compare.number_columns import HALF_STEP, field_finding
from simkit.testing.golden.compare.tolerances import FieldFinding, FieldTerms, FlatValues
from simkit.testing.golden.compare.units import time_text
from simkit.testing.run_record.record import Array, Column

Floats = npt.NDArray[np.float64]


def quaternion_paths(columns: Sequence[str]) -> list[str]:
    """Paths under which there are x, y, z and w."""
    known = set(columns)
    bases = [path[:-2] for path in columns if path.endswith(".w")]
    return [base for base in bases if all(f"{base}.{axis}" in known for axis in "xyz")]


def compare_orientation(terms: FieldTerms, golden: list[Column], run: list[Column]) -> FieldFinding | None:
    """Compares x, y, z, w as turns; None where they are none (not of length 1, or of other numbers)."""
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
    angle = 2.0 * np.arctan2(np.linalg.norm(vector, axis=-1), np.abs(scalar))
    moved = (np.abs(a - b) > HALF_STEP * step).any(axis=-1)
    if terms.is_exact:
        limit = np.where(moved, -1.0, np.inf)
    else:
        limit = np.full(angle.shape, (terms.tolerance.absolute or 0.0) + 2.0 * step)
    axis = np.argmax(np.abs(vector), axis=-1)
    along = np.take_along_axis(vector * np.where(scalar < 0.0, -1.0, 1.0)[:, None], axis[:, None], axis=-1)[:, 0]
    said = replace(mine[0], values=np.zeros(angle.shape))  # what there is to say is said of the angle
    found = field_finding(terms, np.where(along < 0.0, -angle, angle), limit, said, said, 2.0 * step)
    if found.difference is None:
        return found
    return FieldFinding(_with_axis(terms, found.difference, mine[0], vector, axis, 2.0 * step), found.excess, found.off)


def _with_axis(
    terms: FieldTerms, difference: Difference, values: FlatValues, vector: Floats, axis: Array, rounding: float
) -> Difference:
    """The same, with the axis that it turns about."""
    start = int(values.widths[: difference.index].sum())
    here = slice(start, start + max(1, int(values.widths[difference.index])))
    most = start + int(np.argmax(np.linalg.norm(vector[here], axis=-1)))
    length = float(np.linalg.norm(vector[most]))
    words = difference.words
    if difference.size <= rounding:
        words = f"{terms.name}: the same turn with the other sign from {time_text(difference.time)}"
    elif abs(float(vector[most][axis[most]])) > 0.98 * length:
        words = words.replace("° ", f"° about {'xyz'[int(axis[most])]} ", 1)
    columns = tuple(f"{terms.field}.{part}" for part in "xyzw")
    return replace(difference, words=words, columns=columns)


def _rotation_between(a: Floats, b: Floats) -> tuple[Floats, Floats]:
    """The turn from a to b, in a's frame: vector and scalar part; quaternions are x, y, z, w."""
    av, aw, bv, bw = a[:, :3], a[:, 3], b[:, :3], b[:, 3]
    vector = aw[:, None] * bv - bw[:, None] * av - np.cross(av, bv)
    return vector, aw * bw + (av * bv).sum(axis=-1)
