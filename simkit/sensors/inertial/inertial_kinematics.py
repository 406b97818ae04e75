"""Kinematics of a sensor: attitude, angular rate and specific force from the motion of its body."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import Any

from simkit.pose import hamilton_product

# A float, or an array with one float for each of several sensors.
Number = Any
Numbers = tuple[Number, ...]

QuaternionTuple = tuple[float, float, float, float]
"""Quaternion (w, x, y, z)."""

NO_ROTATION: QuaternionTuple = (1.0, 0.0, 0.0, 0.0)


def sensor_motion(
    numbers: Iterable[Number],
    arm: Iterable[Number],
    mount: Iterable[Number] | None,
    rotation: Iterable[Number],
    reference: Iterable[Number] | None,
) -> tuple[Numbers, Numbers]:
    """Return the attitude, and the angular rate and specific force in the sensor's frame.

    Each number is a float, or an array with one float for each of several sensors. Both give the same bits.

    Args:
        numbers: state of the body, 31 numbers: quaternion (4) and rotation matrix (9) in the world, position (3),
            reference point (3) of the spatial motion, spatial velocity (6) and spatial acceleration (6). Spatial
            vectors have the rotation first and are in world axes.
        arm: position of the sensor in the body [m].
        mount: quaternion of the sensor in the body; None if the axes of both are parallel.
        rotation: rotation matrix of the sensor in the body, nine numbers.
        reference: quaternion of the world in the reference frame of the attitude; None for the world.

    Returns:
        Attitude (w, x, y, z), and six numbers: rate [rad/s] and specific force [m/s²].
    """
    qw, qx, qy, qz, a, b, c, d, e, f, g, h, i, px, py, pz, ox, oy, oz, *motion = numbers
    wx, wy, wz, vx, vy, vz, dx, dy, dz, fx, fy, fz = motion
    attitude: Numbers = (qw, qx, qy, qz)
    # lever arm from the reference point to the sensor, in world axes
    ax, ay, az = arm
    x = px - ox + a * ax + b * ay + c * az
    y = py - oy + d * ax + e * ay + f * az
    z = pz - oz + g * ax + h * ay + i * az
    # not in place, because the numbers may be rows of an array
    vx = vx + (wy * z - wz * y)
    vy = vy + (wz * x - wx * z)
    vz = vz + (wx * y - wy * x)
    # acceleration of the sensor's own point: a spatial acceleration lacks the term ω × v
    fx = fx + (dy * z - dz * y + wy * vz - wz * vy)
    fy = fy + (dz * x - dx * z + wz * vx - wx * vz)
    fz = fz + (dx * y - dy * x + wx * vy - wy * vx)
    # from the world's axes to the body's, then to the sensor's
    wx, wy, wz = wx * a + wy * d + wz * g, wx * b + wy * e + wz * h, wx * c + wy * f + wz * i
    fx, fy, fz = fx * a + fy * d + fz * g, fx * b + fy * e + fz * h, fx * c + fy * f + fz * i
    if mount is not None:
        attitude = hamilton_product(attitude, mount)
        a, b, c, d, e, f, g, h, i = rotation
        wx, wy, wz = wx * a + wy * d + wz * g, wx * b + wy * e + wz * h, wx * c + wy * f + wz * i
        fx, fy, fz = fx * a + fy * d + fz * g, fx * b + fy * e + fz * h, fx * c + fy * f + fz * i
    if reference is not None:
        attitude = hamilton_product(reference, attitude)
    return attitude, (wx, wy, wz, fx, fy, fz)


def quaternion_of_rotation_vector(vector: Sequence[float]) -> QuaternionTuple:
    """Return the quaternion (w, x, y, z) of a rotation vector [rad]."""
    x, y, z = vector
    angle = math.sqrt(x * x + y * y + z * z)
    factor = math.sin(angle / 2) / angle if angle else 0.5
    return math.cos(angle / 2), x * factor, y * factor, z * factor
