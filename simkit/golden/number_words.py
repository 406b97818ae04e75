"""Numbers that are other, in words: which, by how much, from when on, and how it goes on."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from simkit.golden.difference import Difference
from simkit.golden.record import Array, Column
from simkit.golden.terms import Flat, Terms
from simkit.golden.units import is_colour, moment, quantity, things_of, value_in_words

Floats = npt.NDArray[np.float64]
Flags = npt.NDArray[np.bool_]

_NAMES = ("child_frame_id", "name", "names", "joint_names", "link_name", "id")


def value_difference(
    terms: Terms, shift: Floats, bad: Flags, failing: Flags, golden: Flat, run: Flat, error: float
) -> Difference:
    """What there is to say of values that are too far off.

    Args:
        terms: of the comparison.
        shift: run less golden, a number for each value.
        bad: which values are too far off.
        failing: which messages have too many of those.
        golden, run: the values.
        error: what rounding may make a difference seem larger or smaller.
    """
    first = int(np.argmax(failing))
    counted = bad & failing[golden.messages]
    here = counted & (golden.messages == first)
    start = int(golden.widths[:first].sum())
    numbers = np.flatnonzero(here) - start
    largest, at = _largest(shift, counted, golden.messages)
    said = _constant(terms, golden, run, first, failing)
    if not said:
        said = _who(terms, numbers, int(golden.widths[first]), first)
        said += _how_far(terms, shift[here], golden.values[here], run.values[here], error)
        said += _when(terms, first, failing, _typical(shift[here]), largest, at, error)
    size = abs(largest)
    return Difference(
        terms.stream.topic,
        terms.field,
        "value",
        terms.time(first),
        size,
        terms.unit,
        f"{terms.name}: {said}",
        terms.allowed,
        first,
    )


def _largest(shift: Floats, counted: Flags, messages: npt.NDArray[np.intp]) -> tuple[float, int]:
    """The largest finite difference and its message; nan and -1 where there is none."""
    off = np.where(counted & np.isfinite(shift), np.abs(shift), -1.0)
    at = int(np.argmax(off))
    return (float(shift[at]), int(messages[at])) if off[at] >= 0.0 else (math.nan, -1)


def _constant(terms: Terms, golden: Flat, run: Flat, first: int, failing: Flags) -> str:
    """`3.5 m became 4 m`, of a setting that says the same all along."""
    width = int(golden.widths[0])
    if is_colour(terms.field) or first or not failing.all() or (golden.widths != width).any():
        return ""
    a, b = golden.values.reshape(-1, width), run.values.reshape(-1, width)
    if not (a == a[0]).all() or not (b == b[0]).all() or (len(a) == 1 and terms.tolerance.absolute):
        return ""
    changed = np.flatnonzero(a[0] != b[0])
    if not 0 < len(changed) <= 3:
        return ""
    words = [
        f"{value_in_words(a[0, i], terms.unit)} became {value_in_words(b[0, i], terms.unit)}" for i in changed.tolist()
    ]
    if width == 1:
        return words[0]
    names = _names(terms, width, 0) or [f"value {i}" for i in range(width)]
    return ", ".join(f"{names[i]} {said}" for i, said in zip(changed.tolist(), words, strict=True))


def _who(terms: Terms, numbers: npt.NDArray[np.intp], width: int, index: int) -> str:
    """Which values of the message: `14 of 360 rays (45 to 58) `."""
    if width == 1 and not _names(terms, width, index):
        return ""
    names = _names(terms, width, index)
    if names and len(numbers) <= 3:
        return ", ".join(names[int(i)] for i in numbers) + " "
    things = things_of(terms.stream.type_name, terms.field)
    if len(numbers) == width:
        return f"all {width} {things} " if width > 1 else ""
    first, last = int(numbers[0]), int(numbers[-1])
    place = ""
    if len(numbers) == 1:
        place = f"number {first}"
    elif last - first + 1 == len(numbers):
        place = f"{first} to {last}"
    return f"{len(numbers)} of {width} {things} " + (f"({place}) " if place else "")


def _names(terms: Terms, width: int, index: int) -> list[str]:
    """What the values of a message are called, by a field of names beside theirs."""
    if width > 64:
        return []
    parts = terms.field.split(".")
    for depth in range(len(parts) - 1, -1, -1):
        prefix = ".".join([*parts[:depth], ""]) if depth else ""
        for name in _NAMES:
            texts = terms.stream.words.get(prefix + name)
            if texts is not None and index < len(texts):
                found = texts[index].split(", ")
                if len(found) == width and all(found) and (width > 1 or depth):
                    return found
    return []


def _how_far(terms: Terms, shift: Floats, golden: Array, run: Array, error: float) -> str:
    finite = shift[np.isfinite(shift)]
    parts = []
    if finite.size:
        parts.append(_signed(finite, terms.unit, error))
    parts += _flips(golden[~np.isfinite(shift)], run[~np.isfinite(shift)], only=not finite.size, single=shift.size == 1)
    return ", ".join(parts)


def _signed(shift: Floats, unit: str, error: float) -> str:
    """`+12 mm` where nearly all go one way, else `up to ±12 mm`."""
    positive = float((shift > 0).mean())
    if 0.2 < positive < 0.8:
        return f"up to ±{quantity(float(np.abs(shift).max()), unit, signed=False, error=error)}"
    return quantity(_typical(shift), unit, error=error)


def _typical(shift: Floats) -> float:
    finite = shift[np.isfinite(shift)]
    return float(np.median(finite)) if finite.size else math.nan


def _flips(golden: Array, run: Array, *, only: bool, single: bool) -> list[str]:
    """What became infinite, finite or no number."""
    a, b = golden.astype(np.float64), run.astype(np.float64)
    kinds = (
        ("no number any more", np.isnan(b)),
        ("a number now", np.isnan(a) & ~np.isnan(b)),
        ("infinite now", np.isinf(b) & ~np.isnan(a)),
        ("finite now", np.isinf(a) & np.isfinite(b)),
    )
    told = []
    for words, which in kinds:
        number = int(which.sum())
        if number:
            told.append(words if (only and number == len(a)) or single else f"{number} {words}")
    return told


def _when(terms: Terms, first: int, failing: Flags, typical: float, largest: float, at: int, error: float) -> str:
    """From when on, in how many messages, and how large it gets."""
    rest = len(failing) - first
    number = int(failing[first:].sum())
    if number == 1 and rest > 1:
        return f" at {moment(terms.time(first))}, in that message only"
    words = f" {'at' if rest == 1 else 'from'} {moment(terms.time(first))}"
    if number < rest:
        words += f", in {number} of {rest} messages"
    if at > first and abs(largest) > 1.5 * abs(typical):
        words += f", up to {quantity(largest, terms.unit, error=error)} at {moment(terms.time(at))}"
    return words


def width_difference(terms: Terms, index: int, golden: Column, run: Column) -> Difference:
    """A message that has more or fewer values."""
    a, b = int(golden.of(index).size), int(run.of(index).size)
    things = things_of(terms.stream.type_name, terms.field)
    words = f"{terms.name}: {a} {things} became {b} at {moment(terms.time(index))}"
    return Difference(
        terms.stream.topic, terms.field, "count", terms.time(index), float(abs(b - a)), things, words, "none", index
    )
