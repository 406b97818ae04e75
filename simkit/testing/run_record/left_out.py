"""Names of the sensors, plugins and controllers without which a world runs, to compare two runs."""

from __future__ import annotations

import logging
import re
from collections import Counter
from collections.abc import Iterable, Mapping
from typing import Final

from simkit.diagnostics import Diagnostic
from simkit.plugins.discovery.left_out import CODE, DRIVE_CODE

CODES: Final = frozenset(
    (
        CODE,
        DRIVE_CODE,
        *("SK-PLUGIN-001", "SK-PLUGIN-002", "SK-PLUGIN-007", "SK-PLUGIN-010", "SK-CONTROL-013"),
        *("SK-SENSOR-001", "SK-SENSOR-024", "SK-SENSOR-052", "SK-SENSOR-053"),
    )
)
"""Codes of all warnings after which a world runs without a sensor, plugin or controller."""
_PART: Final = re.compile(r"(?:unknown )?((?:plugin|sensor|controller) '[^']*'(?: \([^)]*\))?(?: of '[^']*')?)")


def count_left_out(diagnostics: Iterable[Diagnostic]) -> dict[str, int]:
    """Return the names of the sensors, plugins and controllers without which a world runs, with their numbers.

    The names do not depend on places in files. Several equal names belong to several equal models, for example.
    """
    found = (item for item in diagnostics if item.code in CODES and item.severity == "warning")
    names = (match[1] if (match := _PART.match(item.message)) else item.message for item in found)
    return dict(sorted(Counter(names).items()))


def newly_left_out(before: Mapping[str, int], now: Mapping[str, int]) -> list[str]:
    """Return the names of what is left out now and was not left out before."""
    return [name for name, count in now.items() if count > before.get(name, 0)]


def log_left_out(names: Iterable[str]) -> None:
    """Log what a world runs without, for users who see no diagnostics."""
    for name in names:
        logging.getLogger("simkit").warning("the world runs without %s; `simkit check` gives the reason", name)
