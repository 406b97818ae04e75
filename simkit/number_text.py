"""Numbers and truth values in the text of a file or a message."""

from __future__ import annotations

import math
import re

_TRUTHS = {"true": True, "1": True, "false": False, "0": False}
# possessive quantifiers: the time is proportional to the length, also for a million digits
_WITH_UNIT = re.compile(r"([-+]?(?:\d++(?:\.\d*+)?|\.\d++)(?:[eE][-+]?\d++)?)[A-Za-z°%]{1,8}")


def is_number(text: str) -> bool:
    """Check whether a text is a number; NaN and infinite numbers count."""
    try:
        float(text)
    except ValueError:
        return False
    return True


def number_or_nan(text: str) -> float:
    """Return the number that a text contains; NaN if the text is not a number."""
    return float(text) if is_number(text) else math.nan


def counted(count: int, noun: str, plural: str = "") -> str:
    """Return a number with its noun, such as `1 note` or `2 notes`; without a plural, an s is added to the noun."""
    return f"{count} {noun if count == 1 else plural or noun + 's'}"


def range_text(minimum: float | None, maximum: float | None) -> str:
    """Return the end of a message that names the allowed range of a number."""
    if minimum is not None:
        return f" of at least {minimum:g}" if maximum is None else f" from {minimum:g} to {maximum:g}"
    return f" of at most {maximum:g}" if maximum is not None else ""


def parse_number(text: str, minimum: float | None, maximum: float | None, finite: bool) -> float:
    """Return a number in a range.

    Raises:
        ValueError: the text is not a number, is NaN, is out of range, or is infinite where `finite` is set.
    """
    value = float(text)
    if "_" in text or not text.isascii() or value != value or (finite and math.isinf(value)):
        raise ValueError(text)
    if (minimum is not None and value < minimum) or (maximum is not None and value > maximum):
        raise ValueError(text)
    return value


def parse_boolean(text: str) -> bool:
    """Return a truth value.

    Raises:
        ValueError: the text is not true, false, 1 or 0.
    """
    truth = _TRUTHS.get(text.strip().lower())
    if truth is None:
        raise ValueError(text)
    return truth


def without_units(text: str) -> str:
    """Return the numbers of a text without letters after them, such as `1.5m` or `0.3s`.

    sdformat reads the number and ignores the letters. A word without a number at its beginning stays as it is.
    """
    words = [(_WITH_UNIT.fullmatch(word), word) for word in text.split()]
    return " ".join(match[1] if match else word for match, word in words)
