"""Units of message fields, and texts for numbers with units."""

from __future__ import annotations

import math
import re
from functools import cache
from typing import Final

from simkit.msgs.field_units import TABLES, first_match, plain_path, unit_of

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
    number = float(value)
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
    found = f"{size:.{max(0, places)}f}"
    return found.rstrip("0").rstrip(".") if "." in found else found
