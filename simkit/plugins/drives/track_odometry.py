"""Odometry of a vehicle by what its tracks are told: no wheel turns that could be measured."""

from __future__ import annotations

import copy

from simkit.plugins.drives.odometry import BodyTwist, DeadReckoning
from simkit.pose import Pose


class TrackOdometry:
    """Where a vehicle would be if its tracks were wheels that do not slip; begins at zero.

    Args:
        separation: between the tracks [m].
        now: time [ns].
    """

    def __init__(self, separation: float, now: int) -> None:
        self._separation, self._since = separation, now
        self._speeds = (0.0, 0.0)
        self._reckoning = DeadReckoning()

    def drive(self, left: float, right: float, now: int) -> None:
        """From `now` [ns] on the tracks run at these speeds [m/s]."""
        self._reckoning, self._since = self._reckoned(now), now
        self._speeds = left, right

    def at(self, now: int) -> tuple[Pose, BodyTwist]:
        """Pose and twist in the body's axes at `now` [ns]."""
        left, right = self._speeds
        turning = (right - left) / self._separation
        return self._reckoned(now).pose, BodyTwist(((left + right) / 2, 0.0, 0.0), (0.0, 0.0, turning))

    def _reckoned(self, now: int) -> DeadReckoning:
        reckoning, elapsed = copy.copy(self._reckoning), (now - self._since) * 1e-9
        left, right = self._speeds
        reckoning.advance(left * elapsed, right * elapsed, self._separation)
        return reckoning
