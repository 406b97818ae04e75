"""Functions of the whole run so far: extremes, averages, times, path lengths and collisions.

An argument that depends only on one topic is evaluated when the topic receives a message. Other arguments are evaluated
after each step, and the positions of a path at 100 Hz.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit.linear_algebra import dot
from simkit.pose import Vector
from simkit.testing.conditions import value_types as kinds
from simkit.testing.conditions.bound_expression import BoundNode, ExpressionBinder, Function
from simkit.testing.conditions.syntax_tree import Call, UndecidedValue
from simkit.testing.conditions.world_functions import contact_query, entity_argument

if TYPE_CHECKING:
    from simkit.testing.conditions.world_view import Contacts, Entity, WorldView

_PATH_RATE: Final = 100.0
"""Rate at which a path is sampled [Hz]. At 1 m/s, a piece of the path has 1 cm; noise of contacts is left out."""

_NOTHING: Final = object()


class HistoryValue(ABC):
    """Value that is computed from the present state and from earlier states.

    Args:
        view: world.
        part: argument whose values are observed; None if the value has no argument of this kind.

    Attributes:
        rate: rate of the observations [Hz]; None for every step.
    """

    rate: float | None = None

    def __init__(self, view: WorldView, part: BoundNode | None = None) -> None:
        self._clock, self._part = view.clock, part
        self._time = math.nan
        self._seen: object = _NOTHING
        self._feed = None if part is None else part.feed
        self.topic = "" if self._feed is None else self._feed.topic
        """Topic whose messages are observed; empty for observations at `rate`."""

    def observe(self) -> None:
        """Add the present state, once for each simulated time or message."""
        now = self._clock.time
        if not now >= self._time:  # the first observation, or the first one after a reset
            self._time, self._seen = now, _NOTHING
            self.begin()
        try:
            seen = now if self._feed is None else self._feed.latest()
            if seen is self._seen or (self._feed is None and seen == self._seen):
                return
            elapsed, self._time, self._seen = now - self._time, now, seen
            self.add(now, elapsed)
        except UndecidedValue:
            return

    @abstractmethod
    def begin(self) -> None:
        """Forget earlier states."""

    @abstractmethod
    def add(self, now: float, elapsed: float) -> None:
        """Add the present state.

        Args:
            now: simulated time [s].
            elapsed: time since the last observation [s]; 0 for the first one.
        """

    def read(self) -> float:
        """Return the value up to now.

        Raises:
            UndecidedValue: no state had a known value.
        """
        self.observe()
        return self.result()

    @abstractmethod
    def result(self) -> float:
        """Return the value of the observations."""

    def _present(self) -> float:
        assert self._part is not None
        return float(self._part.get())


class _Extreme(HistoryValue):
    """Smallest or largest value."""

    sign = 1.0

    def begin(self) -> None:
        self._best = math.nan

    def add(self, now: float, elapsed: float) -> None:
        value = self._present()
        if not self._best * self.sign <= value * self.sign and value == value:
            self._best = value

    def result(self) -> float:
        if self._best != self._best:
            raise UndecidedValue("the value was never known")
        return self._best


class _Highest(_Extreme):
    sign = -1.0


class _Average(HistoryValue):
    """Mean of all observed values."""

    def begin(self) -> None:
        self._sum, self._count = 0.0, 0

    def add(self, now: float, elapsed: float) -> None:
        self._sum += self._present()
        self._count += 1

    def result(self) -> float:
        if not self._count:
            raise UndecidedValue("the value was never known")
        return self._sum / self._count


class _Integral(HistoryValue):
    """Integral over simulated time, by the rule of trapezoids."""

    def begin(self) -> None:
        self._sum, self._last = 0.0, math.nan

    def add(self, now: float, elapsed: float) -> None:
        value = self._present()
        if self._last == self._last:
            self._sum += 0.5 * (self._last + value) * elapsed
        self._last = value

    def result(self) -> float:
        return self._sum


class _FirstTime(HistoryValue):
    """Simulated time at which a condition first held [s]."""

    def begin(self) -> None:
        self._first = math.nan

    def add(self, now: float, elapsed: float) -> None:
        if self._first != self._first and self._present():
            self._first = now

    def result(self) -> float:
        if self._first != self._first:
            raise UndecidedValue("the condition has not held")
        return self._first


class _TimeTrue(HistoryValue):
    """Simulated time for which a condition held [s]."""

    def begin(self) -> None:
        self._sum = 0.0

    def add(self, now: float, elapsed: float) -> None:
        if self._present():
            self._sum += elapsed

    def result(self) -> float:
        return self._sum


class _PathLength(HistoryValue):
    """Length of the path of a model or link [m]."""

    rate = _PATH_RATE

    def __init__(self, view: WorldView, entity: Entity) -> None:
        super().__init__(view)
        self._entity = entity

    def begin(self) -> None:
        self._sum = 0.0
        self._last: Vector | None = None

    def add(self, now: float, elapsed: float) -> None:
        here = np.array(self._entity.pose().position)
        if self._last is not None:
            gap = here - self._last
            self._sum += math.sqrt(dot(gap, gap))
        self._last = here

    def result(self) -> float:
        return self._sum


class _Collisions(HistoryValue):
    """Number of contacts that began; a contact at the start counts."""

    def __init__(self, view: WorldView, touching: Contacts) -> None:
        super().__init__(view)
        self._touching = touching

    def begin(self) -> None:
        self._count, self._touches = 0, False

    def add(self, now: float, elapsed: float) -> None:
        touches = bool(self._touching.now())
        self._count += touches and not self._touches
        self._touches = touches

    def result(self) -> float:
        return float(self._count)


def _bind_observed(kind: type[HistoryValue], usage: str, *, is_condition: bool = False) -> Function:
    """Return a function of the expression language that observes a number, or a condition."""

    def make(binder: ExpressionBinder, call: Call) -> BoundNode:
        part = (binder.truth if is_condition else binder.number)(call.arguments[0])
        return _observed(binder, call, kind(binder.view, part))

    return Function(usage, 1, 1, make)


def _observed(binder: ExpressionBinder, call: Call, value: HistoryValue) -> BoundNode:
    """Bind a call to an observed value."""
    binder.view.add_history(value)
    return BoundNode(call, kinds.NUMBER, value.read)


def _path_length(binder: ExpressionBinder, call: Call) -> BoundNode:
    entity = entity_argument(binder, call, 0)
    return _observed(binder, call, _PathLength(binder.view, entity))


def _collisions(binder: ExpressionBinder, call: Call) -> BoundNode:
    touching = contact_query(binder, call)
    return _observed(binder, call, _Collisions(binder.view, touching))


HISTORY_FUNCTIONS: Final[dict[str, Function]] = {
    "lowest": _bind_observed(_Extreme, "lowest(number)"),
    "highest": _bind_observed(_Highest, "highest(number)"),
    "average": _bind_observed(_Average, "average(number)"),
    "integral": _bind_observed(_Integral, "integral(number)"),
    "first_time": _bind_observed(_FirstTime, "first_time(condition)", is_condition=True),
    "time_true": _bind_observed(_TimeTrue, "time_true(condition)", is_condition=True),
    "path_length": Function("path_length('model or link')", 1, 1, _path_length),
    "collisions": Function("collisions('model or link'[, 'another'])", 1, 2, _collisions),
}
