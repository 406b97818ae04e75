"""Tolerances of a comparison: differences that count as none."""

from __future__ import annotations

import fnmatch
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

from simkit.errors import InputError
from simkit_identification.comparison.row import Row

INVALID: Final = "SK-COMPARE-003"
DEFAULT_TOLERANCE: Final = "0.1%"
"""Tolerance of all rows that no other tolerance names."""


@dataclass(frozen=True)
class Tolerance:
    """Tolerance of the rows that match a pattern.

    Attributes:
        pattern: pattern of the option.
        topic: shell pattern of the topic.
        quantity: shell pattern of the quantity.
        size: size, in the unit of the row, or relative to its value.
        is_relative: True for a size relative to the larger value.
    """

    pattern: str
    topic: str
    quantity: str
    size: float
    is_relative: bool

    def matches(self, topic: str, quantity: str) -> bool:
        """Check whether the tolerance is for a row."""
        return fnmatch.fnmatchcase(topic, self.topic) and fnmatch.fnmatchcase(quantity, self.quantity)

    def of(self, scale: float) -> float:
        """Return the tolerance in the unit of a row.

        Args:
            scale: size of the values of the row.
        """
        return self.size * scale if self.is_relative else self.size


def parse_tolerances(given: Mapping[str, float | str]) -> list[Tolerance]:
    """Return the tolerances of an option; later ones win, and the default is last.

    Args:
        given: sizes by pattern. A pattern is a QUANTITY, a /TOPIC, or /TOPIC:QUANTITY. A size is a number in the unit
            of the row, or a text with a percentage.

    Raises:
        InputError: SK-COMPARE-003 with all invalid tolerances.
    """
    found: list[Tolerance] = []
    problems: list[str] = []
    for pattern, size in given.items():
        try:
            found.append(_tolerance(pattern, str(size)))
        except ValueError:
            text = f"tolerance {pattern}={size}: expected a size of 0 or more, such as 0.01 or 5%"
            problems.append(text)
    if problems:
        raise InputError(INVALID, f"\n{INVALID} ".join(problems))
    return [*reversed(found), _tolerance("*", DEFAULT_TOLERANCE)]


def _tolerance(pattern: str, text: str) -> Tolerance:
    is_relative = text.rstrip().endswith("%")
    size = float(text.rstrip().rstrip("%")) * (0.01 if is_relative else 1.0)
    if not math.isfinite(size) or size < 0.0:
        raise ValueError(text)
    topic, colon, quantity = pattern.partition(":")
    if not colon:
        topic, quantity = (pattern, "*") if pattern.startswith("/") else ("*", pattern)
    # square brackets are parts of names, such as position[wheel], not classes of characters
    return Tolerance(pattern, topic or "*", quantity.replace("[", "[[]") or "*", size, is_relative)


def unused_tolerances(tolerances: Sequence[Tolerance], rows: Sequence[Row]) -> list[Tolerance]:
    """Return the tolerances that match no row."""
    return [t for t in tolerances if not any(t.matches(row.topic, row.quantity) for row in rows)]


def tolerance_of(tolerances: list[Tolerance], topic: str, quantity: str, scale: float) -> float:
    """Return the tolerance of a row, in its unit."""
    chosen = next(t for t in tolerances if t.matches(topic, quantity))
    return chosen.of(scale)
