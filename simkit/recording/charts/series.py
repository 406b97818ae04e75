"""Collect numbers over time from a bag, or from a simulation while it runs."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from simkit.msgs.message_types import Message
from simkit.recording.charts.fields import Curve

if TYPE_CHECKING:
    from simkit.recording.bags.reader import BagReader
    from simkit.runtime import Simulation


@dataclass
class Series:
    """A curve's numbers.

    Attributes:
        label: what a legend calls it.
        unit: SI; empty where none is known.
        is_angle: whether it comes back to where it began after a turn.
        times: [s].
        values: as many; NaN where a message had none.
        base_unit: SI unit of what is in the place of time.
    """

    label: str
    unit: str = ""
    is_angle: bool = False
    base_unit: str = "s"
    times: NDArray[np.float64] = field(default_factory=lambda: np.empty(0))
    values: NDArray[np.float64] = field(default_factory=lambda: np.empty(0))

    @property
    def count(self) -> int:
        """Number of finite values."""
        return int(np.count_nonzero(np.isfinite(self.values)))

    def between(self, start: float | None, end: float | None) -> Series:
        """Return the part between two times [s]."""
        low, high = -math.inf if start is None else start, math.inf if end is None else end
        kept = (self.times >= low - 1e-9) & (self.times <= high + 1e-9)
        return replace(self, times=self.times[kept], values=self.values[kept])

    def summary(self) -> dict[str, object]:
        """Name, unit, number of finite values, and the least, the greatest, the mean and the last of them."""
        finite = self.values[np.isfinite(self.values)]
        if not finite.size:
            return {"label": self.label, "unit": self.unit, "count": 0}
        numbers = {"min": finite.min(), "max": finite.max(), "mean": finite.mean(), "last": finite[-1]}
        told = {name: float(number) for name, number in numbers.items()}
        return {"label": self.label, "unit": self.unit, "count": int(finite.size), **told}


def bag_series(bag: BagReader, curves: Sequence[Curve]) -> list[Series]:
    """The numbers of a bag.

    Raises:
        InputError: SK-CLI-035 the bag breaks off; SK-CLI-036 a message is not of its type.
    """
    found = _SeriesCollector(curves)
    topics = list(dict.fromkeys(curve.topic for curve in curves))
    origin = bag.time_origin
    for message in bag.messages(topics) if topics else ():
        found.take(message.topic, (message.time_ns - origin) * 1e-9, bag.decode(message))
    return found.series()


class SeriesTap:
    """Takes the numbers of a simulation while it runs; a context manager.

    Args:
        sim: the simulation; listening to a sensor makes it measure.
        curves: which numbers.
    """

    def __init__(self, sim: Simulation, curves: Sequence[Curve]) -> None:
        self._sim, self._collector = sim, _SeriesCollector(curves)
        topics = dict.fromkeys(curve.topic for curve in curves)
        self._taps = [sim.communication.bus.tap(topic, partial(self._take, topic)) for topic in topics]

    def __enter__(self) -> SeriesTap:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _take(self, topic: str, message: object) -> None:
        self._collector.take(topic, self._sim.time, message)

    def close(self) -> None:
        """Listens no more."""
        for tap in self._taps:
            tap.close()
        self._taps.clear()

    def series(self) -> list[Series]:
        """Return what came until now."""
        return self._collector.series()


class _SeriesCollector:
    def __init__(self, curves: Sequence[Curve]) -> None:
        self._curves = list(curves)
        self._rows: list[tuple[list[float], list[float]]] = [([], []) for _ in self._curves]
        self._of: dict[str, list[tuple[Curve, list[float], list[float]]]] = {}
        for curve, (times, values) in zip(self._curves, self._rows, strict=True):
            self._of.setdefault(curve.topic, []).append((curve, times, values))

    def take(self, topic: str, time: float, message: Message) -> None:
        for curve, times, values in self._of[topic]:
            if message.__msgtype__ != curve.type_name:
                continue
            value = curve.read(message)
            if "[" in curve.path and math.isnan(value):
                continue  # a message without that item, as of another publisher of /tf, is no gap
            times.append(time)
            values.append(value)

    def series(self) -> list[Series]:
        return [
            Series(c.label, c.unit, c.is_angle, times=np.array(times), values=np.array(values))
            for c, (times, values) in zip(self._curves, self._rows, strict=True)
        ]


def series_over(series: Sequence[Series], base: Series) -> list[Series]:
    """The same numbers over another one in place of time: its newest at or before each of theirs.

    Args:
        series: what is drawn upwards.
        base: what is drawn to the right.
    """
    found = []
    for one in series:
        at = np.searchsorted(base.times, one.times + 1e-9, side="right") - 1
        known = at >= 0
        beside, values = base.values[at[known]], one.values[known]
        found.append(replace(one, times=beside, values=values, base_unit=base.unit))
    return found
