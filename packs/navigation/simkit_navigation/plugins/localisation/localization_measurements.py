"""Measurements of `ekf_node` from messages: poses, twists, attitudes, turning rates and accelerations.

A flag says which quantities of a sensor are used. If a measurement is rotated into another frame, the flags are
rotated, too: a quantity is used if a used one has a part in it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from simkit import Pose, msgs
from simkit.extend import Vector
from simkit.linear_algebra import matmul, norm
from simkit.pose import quat_conjugate, quat_from_rpy, quat_multiply, quat_rotate, quat_to_matrix
from simkit.pose import rpy_from_quat as rpy
from simkit_navigation.plugins.localisation import extended_kalman_filter as ekf
from simkit_navigation.plugins.localisation.extended_kalman_filter import Measurement

Flags = npt.NDArray[np.bool_]
_LEAST_PART: Final = 1e-6  # of a used quantity in a rotated one
_PLANAR_VARIANCE: Final = 1e-6


@dataclass
class MeasuredBlock:
    """Values of one sensor at one time, before they become a measurement.

    Attributes:
        part: states that are measured: pose, attitude, twist, turning rates or acceleration.
        values: values, three or six.
        covariance: their covariance.
        used: flags of the values.
    """

    part: slice
    values: Vector
    covariance: Vector
    used: Flags

    @property
    def is_finite(self) -> bool:
        """True if no used value, and no covariance of two of them, is NaN or infinite."""
        covariance = self.covariance[np.ix_(self.used, self.used)]
        return bool(np.isfinite(self.values[self.used]).all() and np.isfinite(covariance).all())

    def measurement(self, time_ns: int, threshold: float, *, is_planar: bool) -> Measurement:
        """Return the measurement; in two dimensions, the states out of the plane are measured as zero."""
        values, covariance = np.zeros(ekf.SIZE), np.zeros((ekf.SIZE, ekf.SIZE))
        used = np.zeros(ekf.SIZE, bool)
        values[self.part], covariance[self.part, self.part], used[self.part] = self.values, self.covariance, self.used
        if is_planar:
            for index in ekf.NOT_PLANAR:
                values[index], used[index] = 0.0, True
                covariance[index], covariance[:, index] = 0.0, 0.0
                covariance[index, index] = _PLANAR_VARIANCE
        return Measurement(time_ns, values, covariance, used, threshold)


@dataclass(eq=False)
class PreviousPose:
    """Pose of a sensor's last message, with its covariance and time [ns]."""

    pose: Pose
    covariance: Vector
    time_ns: int


def pose_of(message: msgs.Pose) -> Pose | None:
    """Return a pose with a unit quaternion; None for NaN. A quaternion of zeros is the identity."""
    p, q = message.position, message.orientation
    position, quaternion = (float(p.x), float(p.y), float(p.z)), unit_quaternion(q)
    if quaternion is None or not all(map(math.isfinite, position)):
        return None
    return Pose(position, quaternion)


def unit_quaternion(q: msgs.Quaternion) -> Vector | None:
    """Return w, x, y, z of a message's quaternion with length 1; None for NaN."""
    quaternion = np.array((q.w, q.x, q.y, q.z), np.float64)
    with np.errstate(over="ignore"):
        length = norm(quaternion)
    if not math.isfinite(length):
        return None
    return quaternion / length if length > 0 else np.array((1.0, 0.0, 0.0, 0.0))


def vector_of(message: msgs.Vector3) -> Vector:
    """Return x, y and z of a message."""
    return np.array((message.x, message.y, message.z), np.float64)


def rotated(part: slice, values: Vector, covariance: Vector, used: Flags, quaternion: Vector) -> MeasuredBlock:
    """Return a block of three or six values whose covariance and flags are rotated; the values are used as they are."""
    size = len(values)
    matrix = np.asarray(covariance, np.float64).reshape(size, size)
    if quaternion[0] == 1.0:
        return MeasuredBlock(part, values, matrix, used)
    turn = np.zeros((size, size))
    for k in range(0, size, 3):
        turn[k : k + 3, k : k + 3] = quat_to_matrix(quaternion)
    shares = np.sqrt(matmul(turn**2, used.astype(np.float64)))
    with np.errstate(invalid="ignore", over="ignore"):  # the filter leaves out NaN and infinite numbers
        turned = matmul(turn, matrix, turn.T)
    return MeasuredBlock(part, values, turned, shares >= _LEAST_PART)


def pose_block(pose: Pose, covariance: Vector, used: Flags, frame: Pose) -> MeasuredBlock:
    """Return the block of a pose in a frame whose pose in the world frame is given."""
    in_frame = frame @ pose
    return rotated(ekf.POSE, np.concatenate((in_frame.position, in_frame.rpy)), covariance, used, frame.quaternion)


def pose_difference_block(
    pose: Pose, covariance: Vector, used: Flags, time_ns: int, before: PreviousPose
) -> MeasuredBlock | None:
    """Return the mean twist since the last message; None without a time between them.

    The covariance is the sum of both covariances times the period, as in robot_localization.
    """
    period = (time_ns - before.time_ns) * 1e-9
    if period <= 0:
        return None
    moved = before.pose.inverse() @ pose
    values = np.concatenate((moved.position, moved.rpy)) / period
    total = (np.asarray(covariance, np.float64).reshape(6, 6) + before.covariance) * period
    return MeasuredBlock(ekf.TWIST, values, total, used)


def twist_block(
    linear: Vector, angular: Vector, covariance: Vector, used: Flags, mount: Pose, rates: Vector
) -> MeasuredBlock:
    """Return the block of a twist at a place of the robot.

    Args:
        linear: velocity in the axes of the twist's own frame [m/s].
        angular: turning rates in these axes [rad/s].
        covariance: covariance of the twist.
        used: flags of the six values.
        mount: pose of that frame in the base.
        rates: turning rates of the base [rad/s]: at a distance from the base's origin, they cause a velocity.
    """
    (x, y, z), (p, q, r) = mount.position.tolist(), rates.tolist()
    turned = mount.quaternion
    lever = np.array((y * r - z * q, z * p - x * r, x * q - y * p))
    velocity = quat_rotate(turned, linear) + lever
    values = np.concatenate((velocity, quat_rotate(turned, angular)))
    return rotated(ekf.TWIST, values, covariance, used, turned)


def attitude_block(attitude: Vector, covariance: Vector, used: Flags, mount: Pose) -> MeasuredBlock:
    """Return the block of an IMU's attitude: the attitude of the base that carries it."""
    base = quat_multiply(attitude, quat_conjugate(mount.quaternion))
    yaw = quat_from_rpy(0.0, 0.0, float(mount.rpy[2]))  # roll of an IMU mounted sideways is pitch of the base
    return rotated(ekf.ANGLES, rpy(base), covariance, used, yaw)


def acceleration_block(
    acceleration: Vector, covariance: Vector, used: Flags, mount: Pose, attitude: Vector | None, gravity: float
) -> MeasuredBlock:
    """Return the block of an accelerometer.

    Args:
        acceleration: specific force in the IMU's axes [m/s²].
        covariance: its covariance.
        used: flags of its three values.
        mount: pose of the IMU in the base; the acceleration at its distance from the base's origin is not corrected.
        attitude: attitude of the IMU, so that gravity is removed; None if it stays.
        gravity: gravitational acceleration [m/s²].
    """
    if attitude is not None:
        acceleration = acceleration - quat_rotate(quat_conjugate(attitude), (0.0, 0.0, gravity))
    values = quat_rotate(mount.quaternion, acceleration)
    return rotated(ekf.ACCELERATION, values, covariance, used, mount.quaternion)
