"""Handle of a joint."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np

from simkit.pose import Pose, Vector, quat_conjugate, quat_rotate
from simkit.runtime.handles import Handle
from simkit.runtime.physics import CONTROL, STALE, VELOCITY

if TYPE_CHECKING:
    from simkit.runtime.simulation import Simulation
    from simkit.scene import SceneJoint

Value = float | Vector


class Joint(Handle):
    """A joint. One degree of freedom is a float, more are an array; angles rad, lengths m.

    Attributes:
        type: the file's joint type.
    """

    def __init__(self, sim: Simulation, scene: SceneJoint) -> None:
        super().__init__(sim, scene.name, scene.scoped)
        self.scene, self.type = scene, scene.type
        axes = scene.axes or ()
        self._effort_limit = np.array([a.effort for a in axes] or [math.inf])
        self._velocity_limit = np.array([a.velocity for a in axes] or [math.inf])

    def _bind(self, names: Any) -> None:
        binding = names.joint(self.scoped)
        self._binding = binding
        self._ids = [int(j) for j in binding.joint_ids]
        self._qpos = np.array(binding.qpos, dtype=int)
        self._dofs = np.array(binding.dofs, dtype=int)
        self._is_ball = len(self._dofs) == 3 and len(self._qpos) == 1
        self._one_qpos = int(self._qpos[0]) if len(self._qpos) == len(self._dofs) == 1 else -1
        self._one_dof = int(self._dofs[0]) if len(self._dofs) == 1 else -1

    # ------------------------------------------------------------------ readings

    @property
    def dof(self) -> int:
        """Degrees of freedom."""
        return len(self._dofs)

    @property
    def mj_dofs(self) -> tuple[int, ...]:
        """Indices among MuJoCo's degrees of freedom."""
        return tuple(int(d) for d in self._dofs)

    @property
    def position(self) -> Value:
        """Angle [rad] or length [m]; a rotation vector (3,) for a ball joint; x y z qw qx qy qz for a floating one."""
        self._check()
        qpos = self._sim.mj_data.qpos
        if self._one_qpos >= 0:
            return float(qpos[self._one_qpos])
        if self._is_ball:
            out = np.zeros(3)
            mujoco.mju_quat2Vel(out, self._ball_quat(), 1.0)
            return out
        if len(self._dofs) == 6:
            return np.array(qpos[self._qpos[0] : self._qpos[0] + 7])
        return np.array(qpos[self._qpos])

    @property
    def velocity(self) -> Value:
        """[rad/s] or [m/s]."""
        self._check()
        qvel = self._sim.mj_data.qvel
        return float(qvel[self._one_dof]) if self._one_dof >= 0 else np.array(qvel[self._dofs])

    @property
    def effort(self) -> Value:
        """Sum of what is applied by commands and actuators [N·m or N], within the effort limit."""
        self._check()
        physics = self._sim.physics
        data = physics.fresh()
        pending = data.qfrc_applied if physics.one_shot else physics.last_applied
        if self._one_dof >= 0:
            limit = float(self._effort_limit[0])
            return max(-limit, min(limit, float(pending[self._one_dof] + data.qfrc_actuator[self._one_dof])))
        total = pending[self._dofs] + data.qfrc_actuator[self._dofs]
        clipped: Vector = np.clip(total, -self._limit(), self._limit())
        return clipped

    @property
    def transmitted_wrench(self) -> tuple[Vector, Vector]:
        """Force [N] and torque [N·m] by the parent on the child, at the joint origin, in the joint frame.

        What motors and springs on the joint's own axis give is part of it only as far as constraints carry it.
        """
        self._check()
        data = self._sim.physics.fresh_accelerations()
        names, binding = self._sim.names, self._binding
        # the body below the joint in the engine's tree carries the force; it may be the file's parent
        sign = -1.0 if binding.is_reversed else 1.0
        child = names.link(self.scene.parent_link if binding.is_reversed else self.scene.child_link)
        body = int(child.body)
        if not body or binding.is_loop:
            return np.zeros(3), np.zeros(3)
        in_link = binding.pose_parent if binding.is_reversed else binding.pose_child
        frame = Pose(data.xpos[body], data.xquat[body]) @ child.offset @ in_link
        com = data.subtree_com[self._sim.mj_model.body_rootid[body]]
        wrench = sign * data.cfrc_int[body]
        force = wrench[3:]
        torque = wrench[:3] + np.cross(com - frame.position, force)
        back = quat_conjugate(frame.quaternion)
        return quat_rotate(back, force), quat_rotate(back, torque)

    # ------------------------------------------------------------------ commands

    def set_position(self, position: float | Sequence[float] | Vector) -> None:
        """Puts the joint at a position, once; visible in every pose read afterwards."""
        self._check()
        qpos = self._sim.mj_data.qpos
        values = self._shaped(position)
        if self._is_ball:
            quat = np.array((1.0, 0.0, 0.0, 0.0))
            mujoco.mju_quatIntegrate(quat, values, 1.0)
            start = int(self._qpos[0])
            qpos[start : start + 4] = quat
        else:
            qpos[self._qpos] = values
        for follower in self._binding.followers:
            qpos[follower.qpos] = self._sim.mj_model.qpos0[follower.qpos] + follower.ratio * values[0]
        self._sim.physics.changed(STALE)

    def set_velocity(self, velocity: float | Sequence[float] | Vector) -> None:
        """Gives the joint a velocity, once."""
        self._check()
        values = self._shaped(velocity)
        self._sim.mj_data.qvel[self._dofs] = values
        for follower in self._binding.followers:
            self._sim.mj_data.qvel[follower.dof] = follower.ratio * values[0]
        self._sim.physics.changed(VELOCITY)

    def set_effort(self, effort: float | Sequence[float] | Vector) -> None:
        """Applies an effort in the next step only, clipped to the effort limit."""
        self._check()
        physics = self._sim.physics
        if self._one_dof >= 0 and isinstance(effort, float) and math.isfinite(effort):
            most = self._effort_limit.item(0)
            physics.data.qfrc_applied[self._one_dof] = max(-most, min(most, effort))
        else:
            limit = self._limit()
            physics.data.qfrc_applied[self._dofs] = np.clip(self._shaped(effort), -limit, limit)
        physics.one_shot = True
        physics.changed(CONTROL)

    # ------------------------------------------------------------------ limits

    @property
    def lower(self) -> Value:
        """Lower limit; -inf where there is none; settable."""
        return self._range(0)

    @lower.setter
    def lower(self, value: float) -> None:
        self._set_range(0, value)

    @property
    def upper(self) -> Value:
        """Upper limit; inf where there is none; settable."""
        return self._range(1)

    @upper.setter
    def upper(self, value: float) -> None:
        self._set_range(1, value)

    @property
    def effort_limit(self) -> Value:
        """[N·m or N]; settable."""
        return float(self._effort_limit[0]) if len(self._effort_limit) == 1 else self._effort_limit.copy()

    @effort_limit.setter
    def effort_limit(self, value: float) -> None:
        self._effort_limit[:] = value

    @property
    def velocity_limit(self) -> Value:
        """[rad/s or m/s]; settable, and then exact at every step."""
        return float(self._velocity_limit[0]) if len(self._velocity_limit) == 1 else self._velocity_limit.copy()

    @velocity_limit.setter
    def velocity_limit(self, value: float) -> None:
        self._velocity_limit[:] = value
        self._sim.limit_velocity(self)

    def clamp_velocity(self, _tick: int = 0) -> None:
        """Brings the velocity within its limit."""
        qvel = self._sim.mj_data.qvel
        for i, dof in enumerate(self._dofs):
            limit = self._velocity_limit[min(i, len(self._velocity_limit) - 1)]
            if abs(qvel[dof]) > limit:
                qvel[dof] = math.copysign(limit, qvel[dof])
                self._sim.physics.changed(VELOCITY)

    def get_state(self) -> tuple[Vector, Vector]:
        """The limits that were set, for a snapshot."""
        return self._effort_limit.copy(), self._velocity_limit.copy()

    def set_state(self, state: tuple[Vector, Vector]) -> None:
        """Back to limits from `get_state`."""
        self._effort_limit, self._velocity_limit = state[0].copy(), state[1].copy()

    # ------------------------------------------------------------------ inside

    def _limit(self) -> Vector:
        if len(self._effort_limit) == len(self._dofs):
            return self._effort_limit
        return np.full(len(self._dofs), self._effort_limit[0])

    def _shaped(self, value: float | Sequence[float] | Vector) -> Vector:
        values = np.atleast_1d(np.asarray(value, dtype=float))
        if len(values) != self.dof or not np.isfinite(values).all():
            raise ValueError(f"joint {self.scoped!r} takes {self.dof} finite number(s), got {value}")
        return values

    def _ball_quat(self) -> Vector:
        start = int(self._qpos[0])
        return np.array(self._sim.mj_data.qpos[start : start + 4])

    def _range(self, side: int) -> Value:
        model = self._sim.mj_model
        ends = (-math.inf, math.inf)
        values = [float(model.jnt_range[j][side]) if model.jnt_limited[j] else ends[side] for j in self._ids]
        return values[0] if len(values) == 1 else np.array(values)

    def _set_range(self, side: int, value: float) -> None:
        self._check()
        ranges, limited = self._sim.touch("jnt_range"), self._sim.touch("jnt_limited")
        for j in self._ids:
            if not limited[j]:
                ranges[j] = (-1e10, 1e10)
            ranges[j, side] = min(max(value, -1e10), 1e10)
            limited[j] = 1
        self._sim.physics.changed(STALE)
