"""Acceleration of a body with the added mass of the water around it."""

from __future__ import annotations

import numpy as np

from simkit.extend import SceneLink, Vector


class SmoothedAcceleration:
    """Acceleration of the last steps, smoothed so that the force of an added mass does not diverge.

    The force -M·dν/dt of the added mass M follows from the acceleration of the last step. Applied as it is, it diverges
    if the added mass is larger than the mass m of the link. Smoothing by the factor m / (m + M) in each axis avoids
    this: a body in open water accelerates as one with the mass m + M, from the second step on.

    Args:
        inertia: Mass [kg] three times, then the moments of inertia [kg·m²] of the link; shape (6,).
        added: Added masses and moments of inertia, shape (6,).
    """

    def __init__(self, inertia: Vector, added: Vector) -> None:
        self._factors = inertia / (inertia + np.maximum(added, 0.0))
        self._last: Vector | None = None  # velocity of the last step
        self._acceleration = np.zeros(6)

    def update(self, velocity: Vector, period: float) -> Vector:
        """Return the acceleration, shape (6,).

        Args:
            velocity: Linear [m/s] and angular velocity [rad/s] in the axes of the link, shape (6,).
            period: Time since the last update [s].
        """
        if self._last is not None:
            self._acceleration += self._factors * ((velocity - self._last) / period - self._acceleration)
        self._last = velocity
        return self._acceleration


def own_inertia(link: SceneLink | None) -> Vector:
    """Return the mass of a link three times, then its moments of inertia, shape (6,)."""
    if link is None:
        return np.ones(6)
    return np.array([link.inertial.mass] * 3 + [*link.inertial.inertia[:3]])
