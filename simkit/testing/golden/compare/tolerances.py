"""Tolerances for readings on another machine, the settings for comparing one field, and its unit."""

from __future__ import annotations

import math
import re
import tomllib
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Final

import numpy as np
import numpy.typing as npt

from simkit.msgs.field_units import TABLES, first_match, plain_path, unit_of
from simkit.run_spec import RunSpec, Tolerance
from simkit.testing.golden.compare.difference import Difference
from simkit.testing.run_record.record import Array, Column, Stream

_SMALL: Final = {"m": ("mm", 1e3), "m/s": ("mm/s", 1e3), "s": ("ms", 1e3), "T": ("µT", 1e6), "V": ("mV", 1e3)}
_SMALLER: Final = {"m": ("µm", 1e6), "T": ("nT", 1e9), "s": ("µs", 1e6)}


def period_of(type_name: str, field: str) -> float:
    """Return a full turn in the unit of an angle (360 or 2π); 0 for other fields.

    The position of a joint counts full rotations and therefore has no period.
    """
    unit = unit_of(type_name, field)
    if not re.search(r"(^|\.)(track|heading|yaw|theta)$", plain_path(field)):
        return 0.0
    return {"rad": math.tau, "°": 360.0}.get(unit, 0.0)


def is_colour(field: str) -> bool:
    """Check whether the numbers of a field are colours with one byte per channel."""
    return plain_path(field) in ("points.rgb", "points.rgba")


def joint_unit(unit: str, position: str) -> str:
    """Select the unit of a joint quantity by the type of the joint.

    Args:
        unit: Result of `unit_of`, such as `rad/s or m/s`.
        position: Unit of the joint's position: "rad", "m", or empty if unknown.
    """
    turns, _, slides = unit.partition(" or ")
    return {"rad": turns, "m": slides or unit}.get(position, unit)


@cache
def item_name(type_name: str, field: str) -> str:
    """Return the name of an array's values: rays, points, pixels, joints, contacts, or values."""
    return first_match(TABLES["item_names"], type_name, field, "values")


def quantity_text(value: float, unit: str, signed: bool = True, error: float = 0.0) -> str:
    """Format a number with its unit and three digits: `+12 mm`, `−1.5°`, `0.2 m/s²`.

    Lengths under a metre are in mm, angles in degrees, magnetic fields in µT.

    Args:
        value: Number in `unit`.
        unit: SI unit from `unit_of`.
        signed: Write a plus sign.
        error: Uncertainty of the number in `unit`; digits smaller than the uncertainty are omitted.
    """
    sign = "−" if value < 0 else "+" if signed else ""
    size = abs(value)
    if math.isnan(size):
        return "nan"
    if math.isinf(size):
        return f"{sign}inf"
    if unit == "rad":
        return f"{sign}{_digits(math.degrees(size), math.degrees(error))}°"
    if unit == "ns":
        return quantity_text(value * 1e-9, "s", signed, error * 1e-9)
    if 0.0 < size < 1.0 and unit in _SMALL:
        shown, factor = _SMALL[unit]
        if size * factor < 0.1 and unit in _SMALLER:
            shown, factor = _SMALLER[unit]
        return f"{sign}{_digits(size * factor, error * factor)} {shown}"
    gap = "" if unit in ("", "°") else " "
    return f"{sign}{_digits(size, error)}{gap}{unit}"


def value_text(value: float, unit: str, digits: int = 6) -> str:
    """Format a value with its unit and at most the given number of digits."""
    number = float(value) + 0.0  # without the sign of -0.0
    if unit == "ns":
        return f"{number * 1e-9:.9g} s"
    text = f"{number:.{digits}g}"
    text = "−" + text[1:] if text.startswith("-") else text
    return f"{text} {unit}" if unit and unit != "°" else f"{text}{unit}"


def time_text(time: float) -> str:
    """Format a time: `t = 3.20 s`; use more decimals if the time is not a multiple of 10 ms."""
    hundredths = round(time * 100.0, 6)
    return f"t = {time:.2f} s" if hundredths == round(hundredths) else f"t = {time:.6f}".rstrip("0") + " s"


def _digits(size: float, error: float) -> str:
    """Format a number with three digits, or fewer for an uncertain number; write short results without an exponent."""
    if size == 0.0:
        return "0"
    if size >= 99_999.5 or size < 1e-3:
        return f"{size:.2e}".replace("e-0", "e-").replace("e+0", "e+").replace("e+", "e")
    first = -math.floor(math.log10(size))
    places = first + 2
    if error > 0.0:
        places = max(first, min(places, math.floor(-math.log10(error))))
    digits = f"{size:.{max(0, places)}f}"
    return digits.rstrip("0").rstrip(".") if "." in digits else digits


_STEPS_PER_TOLERANCE = 8  # stored numbers are rounded to an eighth of the tolerance

_TABLES: Final = tomllib.loads(Path(__file__).with_name("default_tolerances.toml").read_text(encoding="utf-8"))
IMAGE: Final = 2.0
"""Default tolerance for the mean difference of pixel values, 0 to 255."""
SSIM: Final = 0.98
"""Default lower limit of the structural similarity."""


@cache
def default_tolerance(type_name: str, field: str) -> Tolerance:
    """Return the default tolerance of a field; none of its numbers is None.

    Args:
        type_name: ROS type of the message.
        field: Path of the field within the message.
    """
    path, by_unit = plain_path(field), _TABLES["by_unit"]
    absolute, relative = by_unit.get(unit_of(type_name, field), by_unit[""])
    share = 0.0
    for of_type, of_field, *numbers in _TABLES["by_field"]:
        if re.fullmatch(of_type, type_name) and re.fullmatch(of_field, path):
            absolute, relative, share = numbers
            break
    return Tolerance(field, absolute=absolute, relative=relative, share=share, image=IMAGE, ssim=SSIM, statistics=False)


def tolerance_of(scenario: RunSpec, topic: str, type_name: str, field: str) -> Tolerance:
    """Return the tolerance of a field in a scenario.

    Each number comes from the first matching tolerance of the scenario that sets the number, else from the default.
    A scenario that sets only an absolute tolerance has no relative tolerance, and vice versa.
    """
    default = default_tolerance(type_name, field)
    tolerances = scenario.tolerance(topic, field)
    if not tolerances:
        return default
    first = tolerances[0]
    for name in ("share", "image", "ssim", "statistics"):
        value = next((getattr(t, name) for t in tolerances if getattr(t, name) is not None), getattr(default, name))
        first = replace(first, **{name: value})
    sizes = next((t for t in tolerances if t.absolute is not None or t.relative is not None), None)
    if sizes is None:
        return replace(first, absolute=default.absolute, relative=default.relative)
    return replace(first, absolute=sizes.absolute or 0.0, relative=sizes.relative or 0.0)


def storage_step(type_name: str, field: str, scenario: RunSpec | None = None, topic: str = "") -> float:
    """Return the step to which golden runs round the values of a field, a power of two; 0 for exact values.

    Args:
        type_name: ROS type of the message.
        field: Path of the field within the message.
        scenario: Scenario with tolerances; None for the defaults.
        topic: Topic of the message, to select the scenario's tolerances.
    """
    tolerance = tolerance_of(scenario, topic, type_name, field) if scenario else default_tolerance(type_name, field)
    if tolerance.exact or not tolerance.absolute or is_colour(field):
        return 0.0
    return math.ldexp(1.0, math.floor(math.log2(tolerance.absolute / _STEPS_PER_TOLERANCE)))


def allowed_text(tolerance: Tolerance, unit: str) -> str:
    """Return a tolerance in words."""
    parts = []
    if tolerance.absolute:
        parts.append(quantity_text(tolerance.absolute, unit, signed=False))
    if tolerance.relative:
        parts.append(f"{100.0 * tolerance.relative:g} % of the value")
    words = " + ".join(parts) or "nothing"
    return words + (f", {100.0 * tolerance.share:g} % of a message may differ more" if tolerance.share else "")


@dataclass(frozen=True)
class FieldTerms:
    """Settings for comparing one field of a topic.

    Attributes:
        stream: Stream of the new run.
        field: Path of the field.
        tolerance: Tolerance in which no number is None.
        is_exact: True if bits must be equal.
        count: Number of messages to compare, from the first one on.
        unit: SI unit of the field.
    """

    stream: Stream
    field: str
    tolerance: Tolerance
    is_exact: bool
    count: int
    unit: str

    @property
    def name(self) -> str:
        """Topic and field, for messages."""
        return f"{self.stream.topic}.{self.field}" if self.field else self.stream.topic

    @property
    def allowed(self) -> str:
        """Tolerance in words."""
        return "the same bits" if self.is_exact else allowed_text(self.tolerance, self.unit)

    def time(self, index: int) -> float:
        """Return the time of a message [s]."""
        return float(self.stream.times_ns[index]) * 1e-9


@dataclass(frozen=True)
class FieldFinding:
    """Result of comparing a field.

    Attributes:
        difference: Difference; None if all values are within the tolerance.
        excess: Ratio of the largest difference to its tolerance: at most 1 if the field passed, infinite for a
            tolerance of 0.
        off: Largest difference after subtracting the possible rounding error, in the field's unit.
    """

    difference: Difference | None
    excess: float = 0.0
    off: float = 0.0


@dataclass(frozen=True)
class FlatValues:
    """Values of a column in one array, with the message of each value."""

    values: Array
    messages: npt.NDArray[np.intp]
    widths: npt.NDArray[np.int64]

    @staticmethod
    def of(column: Column, count: int) -> FlatValues:
        """Return the values of a column's first messages."""
        if column.lengths is None:
            table = column.values[:count].reshape(count, -1) if count else np.zeros((0, 1))
            widths = np.full(count, table.shape[1], np.int64)
            return FlatValues(table.reshape(-1), np.repeat(np.arange(count), widths), widths)
        widths = np.asarray(column.lengths[:count], np.int64)
        return FlatValues(column.values[: int(widths.sum())], np.repeat(np.arange(count), widths), widths)

    def first(self, count: int) -> FlatValues:
        """Return the values of the first messages."""
        end = int(self.widths[:count].sum())
        return FlatValues(self.values[:end], self.messages[:end], self.widths[:count])
