"""Waiting for times of a running simulation from outside, whatever its pace."""

from __future__ import annotations

import time
from typing import Any

LONGEST = 1e6  # [s] of wall time for which a command sleeps at most
_LOOK = 0.05  # [s] of wall time between two looks at its clock, at most
_SLOWEST = 1e-3  # real-time factor below which it counts as standing still


class SimClock:
    """The clock of a running simulation; a reset takes it back.

    Args:
        client: the connection.
        by_wall: goes by the clock on the wall instead.
    """

    def __init__(self, client: Any, *, by_wall: bool = False) -> None:
        self._client, self._by_wall = client, by_wall
        self._seen: tuple[float, int] | None = None
        self._speed = 1.0

    def now_ns(self) -> int:
        """The time now [ns]."""
        if self._by_wall:
            return time.monotonic_ns()
        now_ns, wall = self.sim_ns(), time.monotonic()
        if self._seen is not None and wall > self._seen[0]:
            self._speed = max((now_ns - self._seen[1]) * 1e-9 / (wall - self._seen[0]), 0.0)
        self._seen = wall, now_ns
        return now_ns

    def sim_ns(self) -> int:
        """The simulated time now [ns]."""
        return int(self._client.state()["time_ns"])

    def wait_until(self, due_ns: int, since_ns: int) -> bool:
        """Waits for a time [ns]; False where the clock was taken back behind `since_ns` before."""
        while True:
            now = self.now_ns()
            if now < since_ns:
                return False
            if now >= due_ns:
                return True
            speed = 1.0 if self._by_wall else max(self._speed, _SLOWEST)
            time.sleep(min(_LOOK, (due_ns - now) * 1e-9 / speed))
