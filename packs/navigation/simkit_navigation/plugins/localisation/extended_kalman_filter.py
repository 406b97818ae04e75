"""Extended Kalman filter with the 15 states of ROS 2's robot_localization.

The state is the pose of the base in the world frame, its twist and its linear acceleration in the axes of the base:
x, y, z [m], roll, pitch, yaw [rad], velocities [m/s], turning rates [rad/s], accelerations [m/s²]. Velocities change by
the accelerations, turning rates stay constant (T. Moore and D. Stouch: A generalized extended Kalman filter
implementation for the robot operating system, IAS-13, 2014).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from simkit.extend import Vector
from simkit.linear_algebra import inverse, matmul
from simkit.pose import wrap_angle

SIZE: Final = 15
POSE, TWIST, ACCELERATION = slice(0, 6), slice(6, 12), slice(12, 15)
POSITION, ANGLES, VELOCITY, RATES = slice(0, 3), slice(3, 6), slice(6, 9), slice(9, 12)
NOT_PLANAR: Final = (2, 3, 4, 8, 9, 10, 14)
"""Indices of the states that are zero for a planar robot."""

INITIAL_VARIANCE: Final = 1e-9
PROCESS_NOISE: Final = (0.05, 0.05, 0.06, 0.03, 0.03, 0.06, 0.025, 0.025, 0.04, 0.01, 0.01, 0.02, 0.01, 0.01, 0.015)
"""Default variances of the process noise for each second, those of robot_localization."""

_LEAST_VARIANCE: Final = 1e-9  # of a measurement, so that the gain exists
_LEAST_COSINE: Final = 1e-6  # of the pitch, which has no Euler angles at 90 degrees
_NS: Final = 1e-9


@dataclass(frozen=True, eq=False)
class Measurement:
    """Measured values of some states.

    Attributes:
        time_ns: time of the measurement [ns].
        values: values of all states, shape (15,); only those of `used` count.
        covariance: covariance of all states, shape (15, 15).
        used: true for the states that are measured, shape (15,).
        threshold: largest Mahalanobis distance of a measurement that is used.
    """

    time_ns: int
    values: Vector
    covariance: Vector
    used: npt.NDArray[np.bool_]
    threshold: float = math.inf


class ExtendedKalmanFilter:
    """Estimate of the state, with its covariance.

    Args:
        process_noise: covariance of the process noise for each second, shape (15, 15).
        state: first state, shape (15,).
        covariance: first covariance, shape (15, 15).
        has_dynamic_noise: whether the process noise of pose and attitude grows with the square of the speed.

    Attributes:
        time_ns: time of the state [ns]; None before the first measurement.
    """

    def __init__(self, process_noise: Vector, state: Vector, covariance: Vector, *, has_dynamic_noise: bool) -> None:
        self.process_noise, self.has_dynamic_noise = process_noise, has_dynamic_noise
        self.state, self.covariance = state.copy(), covariance.copy()
        self.time_ns: int | None = None

    def take(self, measurement: Measurement) -> None:
        """Predict to the time of a measurement and correct; the first measurement sets the measured states.

        Values that are NaN or infinite are not used, and neither is a measurement with such a covariance.
        """
        used = measurement.used & np.isfinite(measurement.values)
        if not np.isfinite(measurement.covariance[np.ix_(used, used)]).all():
            return
        if self.time_ns is None:
            self.state[used] = measurement.values[used]
            self.covariance[np.ix_(used, used)] = measurement.covariance[np.ix_(used, used)]
            self.time_ns = measurement.time_ns
            return
        if measurement.time_ns > self.time_ns:
            self.predict(measurement.time_ns)
        self.correct(measurement)

    def predict(self, time_ns: int) -> None:
        """Predict the state at a later time [ns]."""
        assert self.time_ns is not None
        period = (time_ns - self.time_ns) * _NS
        noise = self.process_noise
        if self.has_dynamic_noise:
            noise = noise.copy()
            noise[POSE, POSE] *= float(matmul(self.state[TWIST], self.state[TWIST]))
        self.state, jacobian = predict_state(self.state, period)
        self.covariance = matmul(jacobian, self.covariance, jacobian.T) + noise * period
        self.time_ns = time_ns

    def correct(self, measurement: Measurement) -> None:
        """Correct the state by a measurement, unless its Mahalanobis distance is too large."""
        used = np.flatnonzero(measurement.used & np.isfinite(measurement.values))
        if not len(used):
            return
        noise = measurement.covariance[np.ix_(used, used)].copy()
        diagonal = np.arange(len(used))
        noise[diagonal, diagonal] = np.maximum(np.abs(noise[diagonal, diagonal]), _LEAST_VARIANCE)
        innovation = measurement.values[used] - self.state[used]
        is_angle = (used >= ANGLES.start) & (used < ANGLES.stop)
        innovation[is_angle] = wrapped(innovation[is_angle])
        cross = self.covariance[:, used]
        try:
            weights = inverse(cross[used] + noise)
        except np.linalg.LinAlgError:  # values that depend on each other, without noise
            return
        if matmul(innovation, weights, innovation) >= measurement.threshold**2:
            return
        gain = matmul(cross, weights)
        self.state = self.state + matmul(gain, innovation)
        self.state[ANGLES] = wrapped(self.state[ANGLES])
        residual = np.eye(SIZE)
        residual[:, used] -= gain
        # the Joseph form keeps the covariance symmetric and positive
        self.covariance = matmul(residual, self.covariance, residual.T) + matmul(gain, noise, gain.T)


def predict_state(state: Vector, period: float) -> tuple[Vector, Vector]:
    """Return the state after a period [s], and the Jacobian of this function."""
    roll, pitch, yaw = state[ANGLES].tolist()
    sr, cr, sp, sy, cy = math.sin(roll), math.cos(roll), math.sin(pitch), math.sin(yaw), math.cos(yaw)
    cp = math.cos(pitch)
    cp = math.copysign(max(abs(cp), _LEAST_COSINE), cp)
    tp = sp / cp
    rotation = np.array(
        (
            (cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr),
            (sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr),
            (-sp, cp * sr, cp * cr),
        )
    )
    euler = np.array(((1.0, sr * tp, cr * tp), (0.0, cr, -sr), (0.0, sr / cp, cr / cp)))  # rates of the Euler angles
    travel = state[VELOCITY] * period + state[ACCELERATION] * (period**2 / 2)  # in the axes of the base
    moved = matmul(rotation, travel)
    _, q, r = state[RATES].tolist()

    jacobian = np.eye(SIZE)
    jacobian[POSITION, VELOCITY] = rotation * period
    jacobian[POSITION, ACCELERATION] = rotation * (period**2 / 2)
    jacobian[POSITION, 3] = matmul(rotation, (0.0, -travel[2], travel[1]))
    jacobian[POSITION, 4] = (cy * moved[2], sy * moved[2], -sy * moved[1] - cy * moved[0])
    jacobian[POSITION, 5] = (-moved[1], moved[0], 0.0)
    jacobian[ANGLES, RATES] = euler * period
    across, along = (q * cr - r * sr) * period, (q * sr + r * cr) * period
    jacobian[ANGLES, 3] += (across * tp, -along, across / cp)
    jacobian[ANGLES, 4] += (along / cp**2, 0.0, along * tp / cp)
    jacobian[VELOCITY, ACCELERATION] = np.eye(3) * period

    after = state.copy()
    after[POSITION] += moved
    after[ANGLES] = wrapped(state[ANGLES] + matmul(euler, state[RATES]) * period)
    after[VELOCITY] += state[ACCELERATION] * period
    return after, jacobian


def wrapped(angles: Vector) -> Vector:
    """Return angles [rad] between -pi and pi."""
    return np.array([wrap_angle(angle) for angle in angles.tolist()])
