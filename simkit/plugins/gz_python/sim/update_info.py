"""The time of an update, as hooks of gz get it, and the event manager, which holds nothing here."""

from __future__ import annotations

from datetime import timedelta


class UpdateInfo:
    """The time of an update.

    Attributes:
        iterations: steps, the one this update belongs to included.
        paused: whether the physics stands still.
    """

    __slots__ = ("_dt_ns", "_time_ns", "iterations", "paused")

    def __init__(self, time_ns: int = 0, dt_ns: int = 0, iterations: int = 0, paused: bool = True) -> None:
        self._time_ns, self._dt_ns = time_ns, dt_ns
        self.iterations, self.paused = iterations, paused

    @property
    def sim_time(self) -> timedelta:
        """Simulated time at the end of the step, to the microsecond."""
        return timedelta(microseconds=self._time_ns / 1000)

    @sim_time.setter
    def sim_time(self, value: timedelta) -> None:
        self._time_ns = _nanoseconds(value)

    @property
    def real_time(self) -> timedelta:
        """The simulated time too: what depends on the machine's clock would make runs differ."""
        return self.sim_time

    @real_time.setter
    def real_time(self, value: timedelta) -> None:
        self._time_ns = _nanoseconds(value)

    @property
    def dt(self) -> timedelta:
        """Length of the step; 0 while paused."""
        return timedelta(microseconds=self._dt_ns / 1000)

    @dt.setter
    def dt(self, value: timedelta) -> None:
        self._dt_ns = _nanoseconds(value)

    def __copy__(self) -> UpdateInfo:
        return UpdateInfo(self._time_ns, self._dt_ns, self.iterations, self.paused)

    def __repr__(self) -> str:
        state = ", paused" if self.paused else ""
        return f"<UpdateInfo iteration {self.iterations}, {self._time_ns / 1e9:g} s{state}>"


def _nanoseconds(value: timedelta) -> int:
    return (value.days * 86400 + value.seconds) * 1_000_000_000 + value.microseconds * 1000


class EventManager:
    """Handed to `configure`; gz's binding offers nothing on it either."""
