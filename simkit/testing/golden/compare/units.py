"""Units of messages' fields, and numbers with them in words."""

from __future__ import annotations

import math
import re
import tomllib
from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import Final

_INDEX = re.compile(r"\[[^\]]*\]|\.\d+(?=\.|$)")

_TABLES = tomllib.loads(Path(__file__).with_name("field_units.toml").read_text(encoding="utf-8"))
_SMALL: Final = {"m": ("mm", 1e3), "m/s": ("mm/s", 1e3), "s": ("ms", 1e3), "T": ("µT", 1e6), "V": ("mV", 1e3)}
_SMALLER: Final = {"m": ("µm", 1e6), "T": ("nT", 1e9), "s": ("µs", 1e6)}


def plain_path(field: str) -> str:
    """A path without indices and names in brackets: `transforms[base].transform` as `transforms.transform`."""
    return _INDEX.sub("", field)


@cache
def unit_of(type_name: str, field: str) -> str:
    """The SI unit of a field; "" for a number without one.

    Orientations are compared as angles, so theirs is rad. A joint's position is in rad or m, which the message does not
    say.

    Args:
        type_name: the message's ROS type.
        field: path of the field within it; indices do not count.
    """
    by_field = ([".*", of_field, unit] for of_field, unit in _TABLES["by_field"])
    return _first_that_fits([*_TABLES["by_type"], *by_field], type_name, field, "")


def _first_that_fits(rows: Sequence[Sequence[str]], type_name: str, field: str, otherwise: str) -> str:
    """The last column of the first row whose expressions for type and field fit."""
    path = plain_path(field)
    for of_type, of_field, found in rows:
        if re.fullmatch(of_type, type_name) and re.fullmatch(of_field, path):
            return found
    return otherwise


def period_of(type_name: str, field: str) -> float:
    """After which an angle is the same again, in its unit; 0 for what does not come round.

    A joint's position counts its turns, and does not.
    """
    unit = unit_of(type_name, field)
    if not re.search(r"(^|\.)(track|heading|yaw|theta)$", plain_path(field)):
        return 0.0
    return {"rad": math.tau, "°": 360.0}.get(unit, 0.0)


def is_colour(field: str) -> bool:
    """Whether numbers of a field are colours, a byte for each channel."""
    return plain_path(field) in ("points.rgb", "points.rgba")


def joint_unit(unit: str, position: str) -> str:
    """The unit of a joint's quantity, once it is known whether it turns or slides.

    Args:
        unit: as `unit_of` gives it: `rad/s or m/s`.
        position: unit of the joint's position: "rad", "m", or "" where it is not known.
    """
    turns, _, slides = unit.partition(" or ")
    return {"rad": turns, "m": slides or unit}.get(position, unit)


@cache
def item_name(type_name: str, field: str) -> str:
    """What the values of an array are: rays, points, pixels, joints, contacts, or values."""
    return _first_that_fits(_TABLES["item_names"], type_name, field, "values")


def quantity_text(value: float, unit: str, signed: bool = True, error: float = 0.0) -> str:
    """A number with its unit, three digits of it: `+12 mm`, `−1.5°`, `0.2 m/s²`.

    Lengths under a metre are in mm, angles in degrees, magnetic fields in µT.

    Args:
        value: in `unit`.
        unit: SI, as `unit_of` gives it.
        signed: whether a plus is written.
        error: how far off the number may be, in `unit`; digits below that are left out.
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
    """A value as such, with as many digits as it has, up to some."""
    number = float(value)
    if unit == "ns":
        return f"{number * 1e-9:.9g} s"
    text = f"{number:.{digits}g}"
    text = "−" + text[1:] if text.startswith("-") else text
    return f"{text} {unit}" if unit and unit != "°" else f"{text}{unit}"


def time_text(time: float) -> str:
    """A time in words: `t = 3.20 s`; milliseconds where it is between hundredths."""
    hundredths = round(time * 100.0, 6)
    return f"t = {time:.2f} s" if hundredths == round(hundredths) else f"t = {time:.6f}".rstrip("0") + " s"


def _digits(size: float, error: float) -> str:
    """Three digits or as many as are certain, without an exponent where that stays short."""
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
