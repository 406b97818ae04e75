"""Velocity of a point of a body."""

from __future__ import annotations

import mujoco
import numpy as np

from simkit.pose import Vector

_BODY = int(mujoco.mjtObj.mjOBJ_XBODY)
_object_velocity = mujoco.mj_objectVelocity


def point_velocity(model: mujoco.MjModel, data: mujoco.MjData, body: int, lever: Vector) -> Vector:
    """Velocity [m/s] in the world frame of a point that is fixed to a body, shape (3,).

    Args:
        lever: from the body's origin to the point, in world axes [m], shape (3,).
    """
    motion = np.empty(6)
    _object_velocity(model, data, _BODY, body, motion, 0)
    wx, wy, wz, vx, vy, vz = motion.tolist()
    x, y, z = lever.tolist()
    return np.array((vx + wy * z - wz * y, vy + wz * x - wx * z, vz + wx * y - wy * x))
