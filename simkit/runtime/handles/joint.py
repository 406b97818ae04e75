"""Handle of a joint."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import mujoco
import numpy as np

from simkit.argument_checks import checked_integer, checked_number, checked_vector, wrong_value
from simkit.errors import InputError
from simkit.linear_algebra import matmul
from simkit.number_text import counted
from simkit.pose import Pose, Vector, quat_conjugate, quat_rotate
from simkit.runtime.engine.physics_state import CONTROL, STALE, VELOCITY
from simkit.runtime.handles import joined_models
from simkit.runtime.handles import joint_mechanics as mechanics
from simkit.runtime.handles.joint_numbers import JointValue, TunableJoint

if TYPE_CHECKING:
    from simkit.compiler.name_map import NameMap
    from simkit.runtime.engine.velocity_limits import LimitedDof
    from simkit.runtime.handles.entity_handles import EntityHandles
    from simkit.scene import SceneJoint


def _checked_limits(value: JointValue, name: str, count: int) -> list[float]:
    """Return one limit for each axis, from one number or a number for each axis."""
    limits = [value] * count if np.ndim(value) == 0 else list(value)  # type: ignore[arg-type]  # a number or numbers
    if len(limits) != count:
        raise wrong_value(name, f"one number or {counted(count, 'number')}", value)
    return [checked_number(limit, name, 0.0, finite=False) for limit in limits]


class Joint(TunableJoint):
    """Joint. One degree of freedom is a float, more are an array; angles in rad, lengths in m.

    Type checkers know the float. Pass the numbers of a ball joint to `numpy.asarray` before other uses.

    Attributes:
        type: joint type in the file.
    """

    _internal_names = TunableJoint._internal_names | frozenset(
        (
            *("axis_velocity_limit", "bind", "check_position", "get_state", "least_velocity_limit"),
            *("limited_dofs", "reading", "set_state"),
        )
    )

    def __init__(self, handles: EntityHandles, scene: SceneJoint) -> None:
        super().__init__(handles, scene.name, scene.scoped)
        self.scene, self.type = scene, scene.type
        axes = scene.axes or ()
        self._effort_limit = np.array([a.effort for a in axes] or [math.inf])
        self._velocity_limit = np.array([a.velocity for a in axes] or [math.inf])

    def bind(self, names: NameMap) -> None:
        """Look up the joint in a compiled model."""
        binding = names.joint(self.scoped)
        self._binding = binding
        self._ids = [int(j) for j in binding.joint_ids]
        self._qpos = np.array(binding.qpos, dtype=int)
        self._dofs = np.array(binding.dofs, dtype=int)
        self._plain_dofs = self._dofs.tolist()
        self._is_ball = len(self._dofs) == 3 and len(self._qpos) == 1
        self._is_floating = self.type == "floating"
        self._one_qpos = int(self._qpos[0]) if len(self._qpos) == len(self._dofs) == 1 else -1
        self._first_qpos = int(self._qpos[0]) if len(self._qpos) else -1
        self._one_dof = int(self._dofs[0]) if len(self._dofs) == 1 else -1
        self._body = int(self._physics.model.dof_bodyid[self._dofs[0]]) if len(self._dofs) else 0

    # ------------------------------------------------------------------ readings

    @property
    def dof(self) -> int:
        """Number of degrees of freedom."""
        return len(self._dofs)

    @property
    def mj_dofs(self) -> tuple[int, ...]:
        """Indices among MuJoCo's degrees of freedom."""
        return tuple(self._plain_dofs)

    @property
    def position(self) -> JointValue:
        """Position of the child's joint frame in the parent's joint frame: angle [rad] or length [m].

        A ball joint has a rotation vector (3,), a planar joint x, y and angle, a floating joint x y z qw qx qy qz.
        """
        self.check_present()
        qpos = self._physics.data.qpos
        if self._one_qpos >= 0:
            return float(qpos[self._one_qpos])
        if self._is_ball:
            out = np.zeros(3)
            mujoco.mju_quat2Vel(out, mechanics.ball_quaternion(self._binding, self._ball_quat()), 1.0)
            return out
        if self._is_floating:
            pose = mechanics.relative_pose(self._engine, self._binding)
            return np.concatenate([pose.position, pose.quaternion])
        return np.array(qpos[self._qpos])

    @property
    def velocity(self) -> JointValue:
        """Velocity [rad/s or m/s]. The velocity of a ball joint is in the child's joint frame.

        A floating joint has the velocity of the child's joint origin in the parent's joint frame (3), then the angular
        velocity in the child's joint frame (3).
        """
        self.check_present()
        qvel = self._physics.data.qvel
        if self._one_dof >= 0:
            return float(qvel[self._one_dof])
        if self._is_floating:
            return mechanics.relative_velocity(self._engine, self._binding)
        return self._to_joint(np.array(qvel[self._dofs]))

    @property
    def effort(self) -> JointValue:
        """Sum of the efforts of commands and actuators [N·m or N], within the effort limit."""
        self.check_present()
        physics = self._physics
        data = physics.fresh()
        pending = data.qfrc_applied if physics.one_shot else physics.last_applied
        if self._one_dof >= 0:
            limit = float(self._effort_limit[0])
            return max(-limit, min(limit, float(pending[self._one_dof] + data.qfrc_actuator[self._one_dof])))
        total = pending[self._dofs] + data.qfrc_actuator[self._dofs]
        return np.clip(self._to_joint(total), -self._limit(), self._limit())

    def reading(self) -> tuple[JointValue, JointValue, JointValue]:
        """Return position, velocity and effort, faster than one by one."""
        if self._one_qpos < 0 or self._one_dof < 0:
            return self.position, self.velocity, self.effort
        self.check_present()
        physics, dof = self._physics, self._one_dof
        data = physics.fresh()
        pending = physics.data.qfrc_applied if physics.one_shot else physics.last_applied
        limit, effort = self._effort_limit.item(0), pending.item(dof) + data.qfrc_actuator.item(dof)
        return data.qpos.item(self._one_qpos), data.qvel.item(dof), max(-limit, min(limit, effort))

    @property
    def transmitted_wrench(self) -> tuple[Vector, Vector]:
        """Force [N] and torque [N·m] of the parent on the child, at the joint origin, in its frame, shape (3,) each.

        The wrench includes the efforts of motor, spring, damper and friction along the joint's axes.
        """
        self.check_present()
        physics = self._physics
        binding = self._binding
        body = binding.moved_body
        if not body:
            return np.zeros(3), np.zeros(3)
        # the engine computes no forces for a sleeping body; awake separate data have those of rest
        is_asleep = physics.sleep.is_asleep(body, physics.fresh())
        data = physics.data_of(physics.hold()) if is_asleep else physics.fresh_accelerations()
        child = self._engine.names.links.get(self.scene.child_link)
        frame = binding.pose_child
        if child is not None:
            frame = Pose(data.xpos[child.body], data.xquat[child.body]) @ child.offset @ frame
        force, torque = mechanics.transmitted_wrench(self._physics.model, data, binding, frame.position)
        back = quat_conjugate(frame.quaternion)
        return quat_rotate(back, force), quat_rotate(back, torque)

    # ------------------------------------------------------------------ commands

    def set_position(self, position: float | Sequence[float] | Vector) -> None:
        """Set the present position of the joint. Poses that are read afterwards include the change.

        Joints that mimic the joint follow. A joint between two models that closes no loop moves one of them: the child,
        or the parent if the child is connected to the world.

        Raises:
            InputError: the joint closes a loop.
        """
        values = self.check_position(position)
        side = joined_models.loose_side(self._engine, self._binding) if self._binding.is_loop else None
        qpos = self._physics.data.qpos
        if self._is_floating:
            mechanics.set_relative_pose(self._engine, self._binding, Pose(values[:3], values[3:]))
        elif self._is_ball:
            quat = np.array((1.0, 0.0, 0.0, 0.0))
            mujoco.mju_quatIntegrate(quat, values, 1.0)
            start = int(self._qpos[0])
            qpos[start : start + 4] = mechanics.stored_quaternion(self._binding, quat)
        else:
            qpos[self._qpos] = values
        for f in self._binding.followers:
            qpos[f.qpos] = self._physics.model.qpos0[f.qpos] + f.offset + f.ratio * values[f.axis]
        if side is not None:
            joined_models.align_poses(self._engine, self._binding, side)
        mechanics.update_loop_joints(self._engine)
        self._physics.changed_body(STALE, self._body)

    def check_position(self, position: float | Sequence[float] | Vector) -> Vector:
        """Return a position as numbers; raise an error if `set_position` would refuse it."""
        self.check_present()
        self._check_settable()
        values = self._shaped(position, 7 if self._is_floating else self.dof, "position")
        if self._is_floating and not values[3:].any():
            raise wrong_value(f"the quaternion of joint {self.scoped!r}", "different from zero", position)
        return values

    def set_velocity(self, velocity: float | Sequence[float] | Vector) -> None:
        """Set the present velocity of the joint.

        Raises:
            InputError: the joint closes a loop.
        """
        self.check_present()
        self._check_settable()
        values = self._shaped(velocity, self.dof, "velocity")
        side = joined_models.loose_side(self._engine, self._binding) if self._binding.is_loop else None
        if self._is_floating:
            mechanics.set_relative_velocity(self._engine, self._binding, values)
        else:
            self._physics.data.qvel[self._dofs] = self._from_joint(values)
        for follower in self._binding.followers:
            self._physics.data.qvel[follower.dof] = follower.ratio * values[follower.axis]
        if side is not None:
            joined_models.align_velocities(self._engine, self._binding, side)
        mechanics.update_loop_joints(self._engine)
        self._physics.changed_body(VELOCITY, self._body)

    def set_effort(self, effort: float | Sequence[float] | Vector) -> None:
        """Apply an effort in the next step only, clipped to the effort limit.

        Raises:
            InputError: the joint is floating.
        """
        self.check_present()
        if self._is_floating:
            raise InputError(
                "SK-JOINT-012",
                f"joint {self.scoped!r} is floating; use Link.apply_wrench on its child",
                shows_code=False,
            )
        physics = self._physics
        if self._one_dof >= 0 and isinstance(effort, float) and math.isfinite(effort):
            most = self._effort_limit.item(0)
            physics.data.qfrc_applied[self._one_dof] = max(-most, min(most, effort))
        else:
            limit = self._limit()
            values = np.clip(self._shaped(effort, self.dof, "effort"), -limit, limit)
            physics.data.qfrc_applied[self._dofs] = self._from_joint(values)
        physics.push_once()
        physics.changed_body(CONTROL, self._body)

    # ------------------------------------------------------------------ limits

    @property
    def lower(self) -> JointValue:
        """Lower limit [rad or m]; -inf if the joint has none; settable."""
        return self._range(0)

    @lower.setter
    def lower(self, value: float) -> None:
        self._set_range(0, value)

    @property
    def upper(self) -> JointValue:
        """Upper limit [rad or m]; inf if the joint has none; settable."""
        return self._range(1)

    @upper.setter
    def upper(self, value: float) -> None:
        self._set_range(1, value)

    @property
    def effort_limit(self) -> JointValue:
        """Effort limit [N·m or N]; settable."""
        self.check_present()
        return float(self._effort_limit[0]) if len(self._effort_limit) == 1 else self._effort_limit.copy()

    @effort_limit.setter
    def effort_limit(self, value: float) -> None:
        self.check_present()
        self._effort_limit = np.array(_checked_limits(value, "effort_limit", len(self._effort_limit)))
        self._engine.numbers.keep("joint", self.scoped, "effort_limit", self._effort_limit.tolist())

    @property
    def velocity_limit(self) -> JointValue:
        """Velocity limit [rad/s or m/s]; settable, and then enforced at every step."""
        self.check_present()
        return float(self._velocity_limit[0]) if len(self._velocity_limit) == 1 else self._velocity_limit.copy()

    @velocity_limit.setter
    def velocity_limit(self, value: float) -> None:
        self.check_present()
        self._velocity_limit = np.array(_checked_limits(value, "velocity_limit", len(self._velocity_limit)))
        self._engine.numbers.keep("joint", self.scoped, "velocity_limit", self._velocity_limit.tolist())
        self._handles.limit_velocity(self)

    @property
    def least_velocity_limit(self) -> float:
        """Least velocity limit of the joint's axes [rad/s or m/s]."""
        least: float = min(self._velocity_limit.tolist())  # faster than NumPy for a few numbers
        return least

    def axis_velocity_limit(self, axis: int) -> float:
        """Return the velocity limit of an axis [rad/s or m/s]."""
        axis = checked_integer(axis, "axis", 0, len(self._velocity_limit) - 1)
        limit: float = self._velocity_limit.item(axis)
        return limit

    def limited_dofs(self) -> list[LimitedDof]:
        """Return the degrees of freedom with their velocity limits; a ball joint has one limit for three of them."""
        limits, least = self._velocity_limit.tolist(), self.least_velocity_limit
        return [(dof, limits[axis] if axis < len(limits) else least) for axis, dof in enumerate(self.mj_dofs)]

    def get_state(self) -> tuple[Vector, Vector]:
        """Return the limits for a snapshot; their arrays are replaced by a change and never written to."""
        return self._effort_limit, self._velocity_limit

    def set_state(self, state: tuple[Vector, Vector]) -> None:
        """Restore limits from `get_state`."""
        self._effort_limit, self._velocity_limit = state

    # ------------------------------------------------------------------ inside

    def _limit(self) -> Vector:
        if len(self._effort_limit) == len(self._dofs):
            return self._effort_limit
        return np.full(len(self._dofs), self._effort_limit[0])

    def _shaped(self, value: float | Sequence[float] | Vector, count: int, noun: str) -> Vector:
        values = [value] if count == 1 and np.ndim(value) == 0 else value
        return checked_vector(values, f"{noun} of joint {self.scoped!r}", count)

    def _check_settable(self) -> None:
        if self._binding.is_loop and joined_models.loose_side(self._engine, self._binding) is None:
            raise InputError(
                "SK-JOINT-012",
                f"joint {self.scoped!r} closes a loop: it follows the other joints of the loop; set those",
                shows_code=False,
            )
        if self._is_floating and not self._binding.free:
            raise InputError(
                "SK-JOINT-012",
                f"floating joint {self.scoped!r} cannot be set: its child has another joint",
                shows_code=False,
            )

    def _to_joint(self, stored: Vector) -> Vector:
        """Convert the engine's velocities or efforts to the joint's frame; only those of a ball joint change."""
        return matmul(mechanics.ball_rotation(self._binding, self._ball_quat()), stored) if self._is_ball else stored

    def _from_joint(self, values: Vector) -> Vector:
        return matmul(mechanics.ball_rotation(self._binding, self._ball_quat()).T, values) if self._is_ball else values

    def _ball_quat(self) -> Vector:
        start = int(self._qpos[0])
        return np.array(self._physics.data.qpos[start : start + 4])

    def _range(self, side: int) -> JointValue:
        self.check_present()
        model = self._physics.model
        ends = (-math.inf, math.inf)
        values = [float(model.jnt_range[j][side]) if model.jnt_limited[j] else ends[side] for j in self._ids]
        return values[0] if len(values) == 1 else np.array(values)

    def _set_range(self, side: int, value: float) -> None:
        self.check_present()
        value = checked_number(value, ("lower", "upper")[side], finite=False)
        ranges, limited = self._engine.touch("jnt_range"), self._engine.touch("jnt_limited")
        for j in self._ids:
            if not limited[j]:
                ranges[j] = (-1e10, 1e10)
            ranges[j, side] = min(max(value, -1e10), 1e10)
            limited[j] = 1
        self._engine.numbers.keep("joint", self.scoped, ("lower", "upper")[side], value)
        self._physics.changed(STALE)


def wheel_angles(left: Joint, right: Joint) -> tuple[float, float]:
    """Return the angles of two joints about their first axes [rad], faster than `Joint.position`."""
    qpos = left._physics.data.qpos
    return qpos.item(left._first_qpos), qpos.item(right._first_qpos)


def joint_angles(joints: Sequence[Joint]) -> tuple[float, ...]:
    """Return the angles of any number of joints about their first axes [rad], as fast as `wheel_angles`."""
    qpos: Vector = joints[0]._physics.data.qpos
    return tuple(qpos.item(joint._first_qpos) for joint in joints)


def first_velocity(joint: Joint) -> float:
    """Return the velocity of a joint about its first axis [rad/s]."""
    if joint._one_dof >= 0:
        return float(joint._physics.data.qvel.item(joint._one_dof))
    return float(np.ravel(joint.velocity)[0])
