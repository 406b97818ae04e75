"""Motion of a rigid body over a step without forces, for free bodies that spin while they touch something.

The engine's implicit integrator turns the torque of a contact with the gyroscopic torque, by the angle of the spin in a
step. The torque then does work: a top at 200 rad/s stands up by 7° in 3 s at a step of 1 ms. It also damps the spin. A
step here is a kick and a drift. Forces first change the velocities at the place of the start, then the body moves
without forces. The drift keeps the angular momentum, and is exact for a body with two equal moments of inertia. For
other bodies it consists of rotations about the principal axes (McLachlan 1993). This is of second order, and the error
of the energy does not grow with time.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final

import mujoco
import numpy as np

MAX_NUTATION: Final = 2.0
"""Largest rotation [rad] of the angular velocity about the angular momentum in a step; faster spins are not resolved.

The effect of a contact force on the velocities at the end of the step rotates with it. A top gains 0.4 % of its energy
in 3 s at 1.6 rad, and 1.6 % at 2.4 rad. The engine's integrator damps this rotation and stays stable.
"""

Numbers = Sequence[float]

_NEXT_AXES: Final = ((1, 2), (2, 0), (0, 1))


class RigidRotation:
    """Motion of one free body of a compiled model without forces.

    Coordinates and velocities are those of the engine's free joint: position of the body's origin [m] and quaternion
    (w, x, y, z); velocity of the origin in the world frame [m/s] and angular velocity in the body's frame [rad/s].

    Args:
        model: MuJoCo's model.
        joint: number of the free joint.

    Attributes:
        coordinates: indices of its coordinates.
        dofs: indices of its degrees of freedom.
    """

    def __init__(self, model: mujoco.MjModel, joint: int) -> None:
        body, first, dof = int(model.jnt_bodyid[joint]), int(model.jnt_qposadr[joint]), int(model.jnt_dofadr[joint])
        self.coordinates, self.dofs = slice(first, first + 7), slice(dof, dof + 6)
        self._centre: list[float] = model.body_ipos[body].tolist()
        self._has_lever = any(self._centre)
        self._frame: list[float] = model.body_iquat[body].tolist()
        self._is_aligned = self._frame == [1.0, 0.0, 0.0, 0.0]
        matrix = np.empty(9)
        mujoco.mju_quat2Mat(matrix, model.body_iquat[body])
        self._axes: list[float] = matrix.tolist()
        self._moments: list[float] = model.body_inertia[body].tolist()
        self._least, self._middle, _ = sorted(self._moments)
        rates = [1.0 / moment - 1.0 / self._middle for moment in self._moments]
        # the middle axis, with the rate 0, needs no rotation; the slower one of the others is the outer one
        _, outer, inner = sorted(range(3), key=lambda axis: abs(rates[axis]))
        parts = ((0.5 * rates[outer], outer), (rates[inner], inner), (0.5 * rates[outer], outer))
        self._turns = [(rate, axis) for rate, axis in parts if rate != 0.0]

    def is_resolved(self, spin: Numbers, step: float) -> bool:
        """Check whether steps of this length [s] resolve the motion at an angular velocity."""
        x, y, z = spin if self._is_aligned else self._in_principal_axes(spin)
        a, b, c = self._moments
        return bool(math.hypot(a * x, b * y, c * z) * step < MAX_NUTATION * self._least)

    def gyroscopic_acceleration(self, quaternion: Numbers, spin: Numbers) -> list[float]:
        """Return the accelerations of the degrees of freedom without forces, shape (6,)."""
        x, y, z = self.gyroscopic_rate(spin, spin)
        change = [-0.5 * x, -0.5 * y, -0.5 * z]
        if not self._has_lever:
            return [0.0, 0.0, 0.0, *change]
        x, y, z = _cross(change, self._centre)
        u, v, w = _cross(spin, _cross(spin, self._centre))
        return [*_rotated(quaternion, (-x - u, -y - v, -z - w)), *change]

    def gyroscopic_rate(self, spin: Numbers, acceleration: Numbers) -> Numbers:
        """Return how fast the gyroscopic acceleration decreases in the body's frame, I⁻¹ (ω × I α + α × I ω) [rad/s³].

        Args:
            spin: angular velocity ω [rad/s].
            acceleration: angular acceleration α [rad/s²].
        """
        is_aligned, (a, b, c) = self._is_aligned, self._moments
        x, y, z = spin if is_aligned else self._in_principal_axes(spin)
        u, v, w = acceleration if is_aligned else self._in_principal_axes(acceleration)
        rate = (c - b) / a * (y * w + z * v), (a - c) / b * (z * u + x * w), (b - a) / c * (x * v + y * u)
        return rate if is_aligned else self._in_body_axes(rate)

    def moved(self, position: Numbers, velocity: Numbers, step: float) -> tuple[list[float], list[float]]:
        """Return coordinates and velocities after a step [s] without forces, shapes (7,) and (6,)."""
        x, y, z, *quaternion = position
        u, v, w, *spin = velocity
        if self._has_lever:  # from the origin of the body to its centre of mass
            x, y, z = _added((x, y, z), _rotated(quaternion, self._centre), 1.0)
            u, v, w = _added((u, v, w), _rotated(quaternion, _cross(spin, self._centre)), 1.0)
        quaternion, spin = self._turned(quaternion, spin, step)
        x, y, z = x + u * step, y + v * step, z + w * step
        if self._has_lever:
            x, y, z = _added((x, y, z), _rotated(quaternion, self._centre), -1.0)
            u, v, w = _added((u, v, w), _rotated(quaternion, _cross(spin, self._centre)), -1.0)
        return [x, y, z, *quaternion], [u, v, w, *spin]

    def _turned(self, quaternion: Numbers, spin: Numbers, step: float) -> tuple[list[float], list[float]]:
        """Return quaternion and angular velocity after a step without forces."""
        is_aligned, (a, b, c) = self._is_aligned, self._moments
        x, y, z = spin if is_aligned else self._in_principal_axes(spin)
        momentum, share = [a * x, b * y, c * z], step / self._middle
        w, x, y, z = quaternion if is_aligned else _multiplied(quaternion, self._frame)
        # all three moments equal to the middle one: a rotation about the angular momentum
        w, *vector = _multiplied((w, x, y, z), _rotation([share * component for component in momentum]))
        for rate, axis in self._turns:  # what the other moments change: rotations about principal axes
            angle, (j, k) = rate * step * momentum[axis], _NEXT_AXES[axis]
            cosine, sine = math.cos(angle), math.sin(angle)
            p, q = momentum[j], momentum[k]
            momentum[j], momentum[k] = cosine * p + sine * q, cosine * q - sine * p
            cosine, sine = math.cos(0.5 * angle), math.sin(0.5 * angle)
            o, p, q = vector[axis], vector[j], vector[k]
            vector[axis], vector[j], vector[k] = cosine * o + sine * w, cosine * p + sine * q, cosine * q - sine * p
            w = cosine * w - sine * o
        x, y, z = vector
        if not is_aligned:
            o, p, q, r = self._frame
            w, x, y, z = _multiplied((w, x, y, z), (o, -p, -q, -r))
        size = math.sqrt(w * w + x * x + y * y + z * z)
        after = [momentum[0] / a, momentum[1] / b, momentum[2] / c]
        return [w / size, x / size, y / size, z / size], after if is_aligned else self._in_body_axes(after)

    def _in_principal_axes(self, vector: Numbers) -> list[float]:
        (x, y, z), (a, b, c, d, e, f, g, h, i) = vector, self._axes
        return [a * x + d * y + g * z, b * x + e * y + h * z, c * x + f * y + i * z]

    def _in_body_axes(self, vector: Numbers) -> list[float]:
        (x, y, z), (a, b, c, d, e, f, g, h, i) = vector, self._axes
        return [a * x + b * y + c * z, d * x + e * y + f * z, g * x + h * y + i * z]


def _added(first: Numbers, other: Numbers, factor: float) -> list[float]:
    return [first[0] + factor * other[0], first[1] + factor * other[1], first[2] + factor * other[2]]


def _cross(first: Numbers, other: Numbers) -> list[float]:
    (a, b, c), (x, y, z) = first, other
    return [b * z - c * y, c * x - a * z, a * y - b * x]


def _rotated(quaternion: Numbers, vector: Numbers) -> list[float]:
    """Return a vector rotated by a unit quaternion."""
    w, *axis = quaternion
    u, v, x = _cross(axis, vector)
    return _added(vector, _added(_cross(axis, (u, v, x)), (u, v, x), w), 2.0)


def _multiplied(first: Numbers, other: Numbers) -> list[float]:
    """Return the product of two quaternions."""
    (a, b, c, d), (w, x, y, z) = first, other
    return [
        a * w - b * x - c * y - d * z,
        a * x + b * w + c * z - d * y,
        a * y - b * z + c * w + d * x,
        a * z + b * y - c * x + d * w,
    ]


def _rotation(vector: Numbers) -> list[float]:
    """Return the quaternion of a rotation vector [rad]."""
    x, y, z = vector
    angle = math.sqrt(x * x + y * y + z * z)
    share = math.sin(0.5 * angle) / angle if angle > 0.0 else 0.0
    return [math.cos(0.5 * angle), share * x, share * y, share * z]
