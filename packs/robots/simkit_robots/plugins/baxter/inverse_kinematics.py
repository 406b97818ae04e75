"""Inverse kinematics of an arm of Baxter: the service `IKService` of the robot's SDK."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Final

import mujoco
import numpy as np

from simkit import Pose
from simkit.extend import SharedByCopies, Vector
from simkit.linear_algebra import norm
from simkit.plugins.joints.inverse_kinematics import PoseError, find_positions
from simkit_robots.controllers.baxter_controllers import limb_joints

if TYPE_CHECKING:
    from simkit import Link, Model, Simulation
    from simkit.msgs import PoseStamped, SolvePositionIK_Request
    from simkit_control.plugins.ros2_control.hardware_joint import HardwareJoint

IK_SERVICE: Final = "ExternalTools/{}/PositionKinematicsNode/IKService"
IK_TYPE: Final = "baxter_core_msgs/srv/SolvePositionIK"
_USER, _CURRENT, _FIXED = 1, 2, 3  # kinds of seeds
_SEEDS: Final = (
    (0.0, -0.55, 0.0, 0.75, 0.0, 1.26, 0.0),
    (-0.8, -0.5, 0.5, 1.4, -0.5, 0.9, -1.0),
    (0.8, -0.5, -0.5, 1.4, 0.5, 0.9, 1.0),
    (0.0, 0.3, 0.0, 1.2, 0.0, 0.2, 0.0),
    (0.0, -1.0, 1.5, 1.5, -1.5, 1.0, 0.0),
    (0.0, -1.0, -1.5, 1.5, 1.5, 1.0, 0.0),
    (0.0, -0.3, 2.5, 1.2, 0.0, -0.8, 1.5),
    (0.0, -0.3, -2.5, 1.2, 0.0, -0.8, -1.5),
)
"""Fixed seeds [rad]; the first one is the neutral pose."""
_MOST_POSES: Final = 100  # a pose without a solution takes 0.1 s of processor time
_STEPS: Final = 150
_LONGEST_STEP: Final = 0.3  # [rad], of one joint
_DAMPING: Final = 1e-4
_PRECISION: Final = 1e-5  # [m] and [rad]


class ArmInverseKinematics(SharedByCopies):
    """Solver for one arm: damped least squares on a copy of the state, within the limits of the joints.

    Args:
        sim: simulation.
        model: robot.
        side: side of the arm, left or right.
        joints: joints of the arm.
        tip: link that the poses describe.
    """

    def __init__(self, sim: Simulation, model: Model, side: str, joints: Sequence[HardwareJoint], tip: Link) -> None:
        self._sim, self._robot, self._names, self._joints, self._tip = sim, model, limb_joints(side), joints, tip
        self._low, self._high = np.array([(joint.lower, joint.upper) for joint in joints]).T

    def solve_all(self, request: SolvePositionIK_Request) -> dict[str, object]:
        """Return the response: the angles of the joints for each pose, and the kind of the seed that led to them.

        Only the first 100 poses are solved; the others have no solution.
        """
        angles, kinds = [], []
        for index, stamped in enumerate(request.pose_stamp):
            target = self._target(stamped) if index < _MOST_POSES else None
            seed = request.seed_angles[index] if index < len(request.seed_angles) else None
            user = {} if seed is None else dict(zip(map(str, seed.name), map(float, seed.position), strict=False))
            solution, kind = self._first_solution(target, self._seeds(user, int(request.seed_mode)))
            angles.append({} if solution is None else {"name": list(self._names), "position": solution})
            kinds.append(kind)
        return {"joints": angles, "is_valid": [kind > 0 for kind in kinds], "result_type": kinds}

    def _first_solution(self, target: Pose | None, seeds: Iterator[tuple[int, Vector]]) -> tuple[Vector | None, int]:
        """Return the angles from the first seed that leads to a pose, and the kind of the seed; None and 0 without."""
        if target is None:
            return None, 0
        for kind, seed in seeds:
            solution = self._solve(target, seed)
            if solution is not None:
                return solution, kind
        return None, 0

    def _target(self, stamped: PoseStamped) -> Pose | None:
        """Return a pose in the world; None if its frame or a number is invalid."""
        place, turn = stamped.pose.position, stamped.pose.orientation
        numbers = np.array([place.x, place.y, place.z, turn.w, turn.x, turn.y, turn.z], float)
        frame, links = str(stamped.header.frame_id).lstrip("/") or "base", self._robot.links
        if not np.isfinite(numbers).all() or not 1e-3 < np.abs(numbers[3:]).max() < 1e6:
            return None
        pose = Pose(numbers[:3], numbers[3:] / norm(numbers[3:]))
        if frame == "world":
            return pose
        return links[frame].pose @ pose if frame in links else None

    def _seeds(self, user: Mapping[str, float], mode: int) -> Iterator[tuple[int, Vector]]:
        """Yield the kind and the angles of each seed; a mode other than 0 selects one kind."""
        current = np.array([float(joint.handle.position) for joint in self._joints])
        if mode in (0, _USER) and user:
            yield _USER, np.array([user.get(name, now) for name, now in zip(self._names, current, strict=True)])
        if mode in (0, _CURRENT):
            yield _CURRENT, current
        if mode in (0, _FIXED):
            yield from ((_FIXED, np.array(seed)) for seed in _SEEDS)

    def _solve(self, target: Pose, seed: Vector) -> Vector | None:
        """Return the angles at which the tip has a pose, near a seed; None if the iteration does not lead to them."""
        if not np.isfinite(seed).all():
            return None
        names, physics = self._sim.engine.names, self._sim.engine.physics
        model, data = physics.model, mujoco.MjData(physics.model)
        data.qpos[:] = physics.data.qpos
        bindings = [names.joint(joint.scoped) for joint in self._joints]
        qpos, dofs = [b.qpos[0] for b in bindings], [b.dofs[0] for b in bindings]
        tip, jacobian = names.link(self._tip.scoped), np.zeros((6, model.nv))
        wanted = np.array([target.transform(axis) for axis in np.eye(3)]) - target.position

        def pose_error(angles: Vector) -> PoseError:
            data.qpos[qpos] = angles
            mujoco.mj_kinematics(model, data)
            mujoco.mj_comPos(model, data)
            pose = Pose(data.xpos[tip.body], data.xquat[tip.body]) @ tip.offset
            axes = np.array([pose.transform(axis) for axis in np.eye(3)]) - pose.position
            turn = 0.5 * np.cross(axes, wanted).sum(axis=0)
            error = np.concatenate([np.asarray(target.position) - pose.position, turn])
            mujoco.mj_jac(model, data, jacobian[:3], jacobian[3:], np.array(pose.position, float), tip.body)
            is_reached = np.abs(error).max() < _PRECISION and np.einsum("ij,ij", axes, wanted) > 0.0
            return PoseError(error, jacobian[:, dofs], bool(is_reached))

        return find_positions(
            pose_error,
            np.clip(seed, self._low, self._high),
            self._low,
            self._high,
            damping=lambda _: _DAMPING,
            longest_step=_LONGEST_STEP,
            steps=_STEPS,
        )
