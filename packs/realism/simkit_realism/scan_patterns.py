"""Scan patterns of lidars that do not repeat their rays: from a table of angles, or from a formula."""

from __future__ import annotations

import abc
import io
import math
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

from simkit.errors import InputError
from simkit.extend import Vector, counted
from simkit.input_file import read_input

MOST_ROWS: Final = 4_000_000
_LIMIT: Final = 256 << 20  # [bytes] of a table
_TURN: Final = 2.0 * math.pi
_COLUMN: Final = re.compile(r"\s*(time|azimuth|zenith|elevation)\s*[/(\[ _]*\s*(s|deg|rad)?\W*\s*", re.IGNORECASE)
_HELP: Final = "the first line names the columns, such as Time/s,Azimuth/deg,Zenith/deg"


class ScanPattern(abc.ABC):
    """Directions of the rays of each scan.

    Attributes:
        samples: rays of a scan.
    """

    samples: int

    @abc.abstractmethod
    def angles(self, index: int, period: float) -> tuple[Vector, Vector]:
        """Return the azimuths and elevations of the rays of a scan [rad], shape (samples,) each.

        Args:
            index: number of the scan; the first is 1.
            period: time of a scan [s].
        """


@dataclass(frozen=True, slots=True)
class TablePattern(ScanPattern):
    """Pattern from a table, whose rows follow each other from scan to scan; after the last row, the first follows.

    Attributes:
        azimuths: angles about z [rad], shape (rows,).
        elevations: angles above the x-y plane [rad], shape (rows,).
        samples: rays of a scan.
        stride: rows from a ray to the next one.
    """

    azimuths: Vector
    elevations: Vector
    samples: int
    stride: int = 1

    def angles(self, index: int, period: float) -> tuple[Vector, Vector]:
        count = len(self.azimuths)
        first = (index - 1) * self.samples * self.stride % count  # Python's integers do not overflow
        rows = (first + np.arange(self.samples) * (self.stride % count)) % count
        return self.azimuths[rows], self.elevations[rows]


@dataclass(frozen=True, slots=True)
class RosettePattern(ScanPattern):
    """Pattern of two rotating prisms, each of which deflects the beam by a constant angle.

    The deflections add as vectors of small angles. Rates that are no multiples of each other do not repeat. Liu, Yuan
    and Zhang, Low-cost Retina-like Robotic Lidars Based on Incommensurable Scanning (2020), describe such lidars.

    Attributes:
        samples: rays of a scan.
        rates: rotations of the prisms [Hz]; negative for clockwise.
        deflections: deflection of each prism [rad].
    """

    samples: int
    rates: tuple[float, float]
    deflections: tuple[float, float]

    def angles(self, index: int, period: float) -> tuple[Vector, Vector]:
        first, second = (_phases(rate, self.samples, index, period) for rate in self.rates)
        a, b = self.deflections
        return a * np.cos(first) + b * np.cos(second), a * np.sin(first) + b * np.sin(second)


@dataclass(frozen=True, slots=True)
class SpiralPattern(ScanPattern):
    """Pattern of a rotating head whose elevation moves up and down at another rate, at constant speed.

    Attributes:
        samples: rays of a scan.
        azimuth_rate: rotations of the head [Hz]; negative for clockwise.
        elevation_rate: movements up and down [Hz].
        low, high: lowest and highest elevation [rad].
    """

    samples: int
    azimuth_rate: float
    elevation_rate: float
    low: float
    high: float

    def angles(self, index: int, period: float) -> tuple[Vector, Vector]:
        turned = _phases(self.azimuth_rate, self.samples, index, period)
        share = _phases(self.elevation_rate, self.samples, index, period) / _TURN
        rise = 1.0 - np.abs(2.0 * share - 1.0)
        return np.where(turned > math.pi, turned - _TURN, turned), self.low + (self.high - self.low) * rise


def _phases(rate: float, samples: int, index: int, period: float) -> Vector:
    """Return the phase [rad], from 0 to 2π, of a rotation at each ray of a scan, shape (samples,)."""
    rotations = rate * period * (index - 1 + np.arange(samples) / samples)
    phases: Vector = (rotations - np.floor(rotations)) * _TURN
    return phases


def read_table(path: Path) -> tuple[Vector, Vector]:
    """Read the azimuths and elevations [rad] of a CSV file; the zenith angle is 90° minus the elevation.

    Columns are named `azimuth` and `zenith` or `elevation`, with their unit, `deg` or `rad`. Other columns, such as the
    time, are ignored: the rays follow each other at equal times.

    Raises:
        InputError: SK-SENSOR-281 the file cannot be read or is no such table.
    """
    try:
        text = read_input(path, _LIMIT, inside=path.parent).decode("utf-8-sig", "replace")
    except OSError as error:
        raise InputError("SK-SENSOR-281", f"cannot read the scan pattern {path.name}: {error.strerror}") from None
    head, _, body = text.partition("\n")
    columns: dict[str, tuple[int, float]] = {}
    for number, title in enumerate(head.split(",")):
        match = _COLUMN.fullmatch(title)
        if match is not None:
            columns[match[1].lower()] = number, math.pi / 180.0 if (match[2] or "deg").lower() == "deg" else 1.0
    height = "elevation" if "elevation" in columns else "zenith"
    missing = {"azimuth", height} - columns.keys()
    if missing:
        found = f"found the columns {head.strip()[:80]!r}; expected azimuth and zenith or elevation"
        raise InputError("SK-SENSOR-281", f"scan pattern {path.name}: {found}", help=_HELP)
    if not body.strip():
        raise InputError("SK-SENSOR-281", f"scan pattern {path.name}: found no row below the names of the columns")
    wanted = columns["azimuth"], columns[height]
    try:
        rows = np.loadtxt(io.StringIO(body), delimiter=",", usecols=[column for column, _ in wanted], ndmin=2)
    except ValueError as error:
        reason = str(error).partition(";")[0]
        raise InputError("SK-SENSOR-281", f"scan pattern {path.name}: {reason}", help=_HELP) from None
    if not 0 < len(rows) <= MOST_ROWS or not np.isfinite(rows).all():
        found = (
            f"found {counted(len(rows), 'row')}"
            if np.isfinite(rows).all()
            else "found numbers that are NaN or infinite"
        )
        expected = f"expected 1 to {MOST_ROWS} rows of finite numbers"
        raise InputError("SK-SENSOR-281", f"scan pattern {path.name}: {found}; {expected}", help=_HELP)
    azimuths, heights = (rows[:, i] * scale for i, (_, scale) in enumerate(wanted))
    return azimuths, heights if height == "elevation" else math.pi / 2 - heights
