"""Series of numbers over time, from a bag or from a running simulation."""

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
    """Numbers of a curve.

    Attributes:
        label: name in the legend.
        unit: SI unit; empty if unknown.
        is_angle: True for an angle that wraps around after a full turn.
        times: times [s], shape (n,).
        values: numbers, shape (n,); NaN for messages without the number.
        base_unit: SI unit of the quantity that replaces time.
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
        inside = (self.times >= low - 1e-9) & (self.times <= high + 1e-9)
        return replace(self, times=self.times[inside], values=self.values[inside])

    def summary(self) -> dict[str, object]:
        """Return name, unit, number of finite values, and their minimum, maximum, mean and last value."""
        finite = self.values[np.isfinite(self.values)]
        if not finite.size:
            return {"label": self.label, "unit": self.unit, "count": 0}
        numbers = {"min": finite.min(), "max": finite.max(), "mean": finite.mean(), "last": finite[-1]}
        statistics = {name: float(number) for name, number in numbers.items()}
        return {"label": self.label, "unit": self.unit, "count": int(finite.size), **statistics}


def bag_series(bag: BagReader, curves: Sequence[Curve]) -> list[Series]:
    """Return the numbers of a bag.

    Raises:
        InputError: SK-CLI-035 the bag is truncated; SK-CLI-036 a message does not match its type.
    """
    collector = _SeriesCollector(curves)
    topics = list(dict.fromkeys(curve.topic for curve in curves))
    origin = bag.time_origin
    for message in bag.messages(topics) if topics else ():
        collector.take(message.topic, (message.time_ns - origin) * 1e-9, bag.decode(message))
    return collector.series()


class SeriesTap:
    """Collector of numbers from a running simulation; a context manager.

    Args:
        sim: simulation to read; a sensor with a collected topic measures.
        curves: curves to collect.
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
        """Stop collecting."""
        for tap in self._taps:
            tap.close()
        self._taps.clear()

    def series(self) -> list[Series]:
        """Return the numbers collected so far."""
        return self._collector.series()


class _SeriesCollector:
    """Collector of the numbers of several curves."""

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
                continue  # without this item, e.g. from another publisher of /tf
            times.append(time)
            values.append(value)

    def series(self) -> list[Series]:
        return [
            Series(c.label, c.unit, c.is_angle, times=np.array(times), values=np.array(values))
            for c, (times, values) in zip(self._curves, self._rows, strict=True)
        ]


def series_over(series: Sequence[Series], base: Series) -> list[Series]:
    """Return series over a base series instead of time; at each time, the base's newest value is used.

    Args:
        series: series for the vertical axis.
        base: series for the horizontal axis.
    """
    over_base = []
    for curve in series:
        index = np.searchsorted(base.times, curve.times + 1e-9, side="right") - 1
        known = index >= 0
        x_values, values = base.values[index[known]], curve.values[known]
        over_base.append(replace(curve, times=x_values, values=values, base_unit=base.unit))
    return over_base
