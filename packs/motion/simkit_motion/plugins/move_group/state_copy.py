"""Copy of the simulated state with other joint positions, and poses of Pinocchio's class."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import mujoco
import numpy as np
import numpy.typing as npt

from simkit import Pose
from simkit.extend import Vector

if TYPE_CHECKING:
    from pinocchio import SE3

    from simkit import Model, Simulation


def se3(pose: Pose) -> SE3:
    """Convert a pose to Pinocchio's class."""
    import pinocchio

    matrix = np.zeros(9)
    mujoco.mju_quat2Mat(matrix, np.array(pose.quaternion, dtype=float))
    return pinocchio.SE3(matrix.reshape(3, 3), np.array(pose.position, dtype=float))


def quaternion_of(matrix: npt.NDArray[np.float64]) -> Vector:
    """Return the quaternion (w, x, y, z) of a rotation matrix, shape (3, 3) or (9,)."""
    quaternion = np.zeros(4)
    mujoco.mju_mat2Quat(quaternion, np.ascontiguousarray(matrix, dtype=float).ravel())
    return quaternion


def link_pose_at(sim: Simulation, data: mujoco.MjData, link: str) -> Pose:
    """Return the pose of a link in the world, in a copy of the state."""
    binding = sim.engine.names.link(link)
    return Pose(data.xpos[binding.body], data.xquat[binding.body]) @ binding.offset


def copied_state(
    sim: Simulation, robot: Model, state: Mapping[str, float], held: Mapping[int, int] | None = None
) -> mujoco.MjData:
    """Return a copy of the present state with other positions of some joints; held objects move with their links."""
    model, now = sim.mj_model, sim.engine.physics.fresh()
    data = mujoco.MjData(model)
    for name in ("qpos", "mocap_pos", "mocap_quat"):
        getattr(data, name)[...] = getattr(now, name)
    mujoco.mj_kinematics(model, data)
    roots = {int(model.body_rootid[model.geom_bodyid[geom]]): carrier for geom, carrier in (held or {}).items()}
    inside = {
        root: Pose(data.xpos[c], data.xquat[c]).inverse() @ Pose(data.xpos[root], data.xquat[root])
        for root, c in roots.items()
    }
    for name, value in state.items():
        binding = sim.engine.names.joint(robot.joints[name].scoped)
        data.qpos[binding.qpos[0]] = value
        for f in binding.followers:
            data.qpos[f.qpos] = model.qpos0[f.qpos] + f.offset + f.ratio * value
    mujoco.mj_kinematics(model, data)
    for root, carrier in roots.items():
        pose = Pose(data.xpos[carrier], data.xquat[carrier]) @ inside[root]
        start = int(model.jnt_qposadr[model.body_jntadr[root]])
        data.qpos[start : start + 3], data.qpos[start + 3 : start + 7] = pose.position, pose.quaternion
    mujoco.mj_kinematics(model, data)
    return data
