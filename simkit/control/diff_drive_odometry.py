"""Odometry of a base from its wheels, as the drive controllers of ros2_controllers reckon it."""

from __future__ import annotations

from collections import deque

from simkit.plugins.drives.odometry import BodyTwist, DeadReckoning

_SHORTEST = 1e-4  # [s]; in less no speed can be told


class RollingOdometry:
    """Where the point between two wheels is by their turning, and the mean of its speeds over the last updates.

    Args:
        window: updates that the twist is the mean of.

    Attributes:
        reckoning: planar pose; it begins at zero.
    """

    def __init__(self, window: int) -> None:
        self.reckoning = DeadReckoning()
        self._speeds: deque[tuple[float, float]] = deque(maxlen=max(1, window))

    def roll(self, left: float, right: float, separation: float, elapsed: float) -> bool:
        """Goes on by what the wheels rolled.

        Args:
            left, right: ways of the two rims [m].
            separation: between the wheels [m].
            elapsed: [s].

        Returns:
            Whether it did: in next to no time it does not.
        """
        if elapsed < _SHORTEST:
            return False
        self.reckoning.advance(left, right, separation)
        self._speeds.append(((left + right) / 2 / elapsed, (right - left) / separation / elapsed))
        return True

    def follow(self, ahead: float, turn: float, elapsed: float) -> None:
        """Goes on as commanded, by a speed ahead [m/s] and a rate of turning [rad/s] over a time [s]."""
        # two wheels 1 m apart
        self.reckoning.advance((ahead - turn / 2) * elapsed, (ahead + turn / 2) * elapsed, 1.0)
        self._speeds.clear()
        self._speeds.append((ahead, turn))  # no mean: it is known

    @property
    def twist(self) -> BodyTwist:
        """Mean over the window, in the body's axes."""
        if not self._speeds:
            return BodyTwist()
        count = len(self._speeds)
        ahead, turn = (sum(speeds) / count for speeds in zip(*self._speeds, strict=True))
        return BodyTwist((ahead, 0.0, 0.0), (0.0, 0.0, turn))
