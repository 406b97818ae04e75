"""Tide of dave's currents: `tidal_oscillation.cc` and the tables of `ocean_current_world_plugin.cc`."""

from __future__ import annotations

import datetime
import math
from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass

_HOUR, _DAY = 3600.0, 86400.0  # [s]

Date = tuple[int, int, int, int, int]
"""Year, month, day, hour and minute (GMT)."""


def seconds_of(date: Date) -> float:
    """Return the time of a date on the source's axis [s]: days since the year 0, as in `calcdatenum`.

    Raises:
        ValueError: there is no such date.
    """
    year, month, day, hour, minute = date
    days = datetime.date(year, month, day).toordinal() + 366
    if not (0 <= hour < 24 and 0 <= minute < 60):
        raise ValueError(f"{hour}:{minute:02d} is not a time of day")
    return days * _DAY + hour * _HOUR + minute * 60.0


@dataclass(frozen=True)
class Constituent:
    """Harmonic part of a tide: amplitude [m/s], phase [deg] and speed [deg/h]."""

    amplitude: float
    phase: float
    speed: float

    def at(self, time: float) -> float:
        """Return the part's speed [m/s] at a time [s]; the current is a quarter of a period behind the height."""
        turned = math.radians(self.speed) / _HOUR * time + math.radians(self.phase)
        return self.amplitude * math.cos(turned - math.pi / 2)


def table_speed(times: Sequence[float], speeds: Sequence[float], time: float) -> float:
    """Return the speed of a table [m/s] between its entries; before the first and after the last, it is theirs."""
    index = bisect_right(times, time)
    if index in (0, len(times)):
        return speeds[max(index - 1, 0)]
    share = (time - times[index - 1]) / (times[index] - times[index - 1])
    return speeds[index - 1] + share * (speeds[index] - speeds[index - 1])


def tide_velocity(speed: float, ebb: float, flood: float) -> tuple[float, float]:
    """Return the velocity of a tide to the north and the east [m/s].

    Args:
        speed: speed [m/s], positive for the flood.
        ebb: direction of the ebb [deg].
        flood: direction of the flood [deg].
    """
    angle = math.radians(flood if speed > 0 else ebb)
    return -math.cos(angle) * speed, -math.sin(angle) * speed


def read_tide_table(text: str) -> tuple[list[Date], list[float]]:
    """Return dates and speeds [cm/s] of a table of NOAA: `date, event, speed`, without slack water.

    Of neighbouring entries with the same sign, only the first counts.

    Raises:
        ValueError: a line is invalid; the message has its number.
    """
    dates: list[Date] = []
    speeds: list[float] = []
    for line_number, line in enumerate(text.splitlines()[1:], 2):
        cells = [cell.strip() for cell in line.split(",")]
        if not line.strip() or (len(cells) > 1 and cells[1] == "slack"):
            continue
        try:
            date = datetime.datetime.strptime(cells[0], "%Y-%m-%d %H:%M")
            speed = float(cells[2])
        except (ValueError, IndexError):
            raise ValueError(
                f"line {line_number}: found {line!r:.60}; expected YYYY-MM-DD HH:MM, event, cm/s"
            ) from None
        dates.append((date.year, date.month, date.day, date.hour, date.minute))
        speeds.append(speed)
    signs = [(speed > 0) - (speed < 0) for speed in speeds]
    kept = [i for i in range(len(speeds)) if i == 0 or signs[i] != signs[i - 1]]
    return [dates[i] for i in kept], [speeds[i] for i in kept]
