"""What is said of a world once, however many sensors stand in it."""

from __future__ import annotations

from itertools import chain
from typing import TYPE_CHECKING

from simkit.diagnostics import Where

if TYPE_CHECKING:
    from simkit.diagnostics import Severity
    from simkit.sensors.base import Sensor


def report_once(sensor: Sensor, severity: Severity, code: str, message: str, where: Where, hint: str = "") -> None:
    """Adds a diagnostic unless the same was said of that place already."""
    known = chain(sensor.diagnostics, sensor.sim.reports)
    if not any(d.code == code and (d.file, d.line) == (where.file, where.line) for d in known):
        sensor.diagnostics.add(severity, code, message, where, hint)
