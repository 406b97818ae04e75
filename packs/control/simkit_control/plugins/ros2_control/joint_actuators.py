"""Actuators of the hardware's joints: each joint has one MuJoCo actuator, which acts as a servo or as a motor.

The force of an actuator is its state − kp · position − kv · velocity, within the effort limit. For a servo, the state
is kp · reference + kv · velocity of the reference + the effort that balances gravity. For a motor, the state is the
commanded effort. MuJoCo moves the reference at every step, also between two updates of the controllers, so that a
hundred commands per second do not cause steps in the motion. A position command is the target for the end of the next
period, and the reference moves from the last command to the new one. The reference of a velocity servo is the integral
of the commanded velocities, close enough to the joint that the servo does not wind up (see `velocity_references.py`). A
velocity servo therefore loses no distance under load, and it holds its position when it stops.

Joint damping and dry friction in a file represent losses inside the drive (40 N·m·s/rad on an arm whose motors give 43
N·m at up to 1.95 rad/s). A servo compensates these losses, so its effort is the effort at the link. While a servo
drives a joint, the joint therefore has no damping and no dry friction. The joint has both losses under an effort
command, under a PID loop from the file, and when it is not driven.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit.extend import SharedByCopies, Vector
from simkit.linear_algebra import squared_length
from simkit.runtime.engine.physics_step import CONTROL
from simkit_control.plugins.ros2_control.actuator_modes import (
    FREE,
    POSITION_MODE,
    SPRING_MODE,
    ActiveModes,
    ControlLoops,
)
from simkit_control.plugins.ros2_control.gravity_efforts import GravityEfforts
from simkit_control.plugins.ros2_control.hardware_interfaces import POSITION, VELOCITY, Indices, array_index
from simkit_control.plugins.ros2_control.velocity_references import advance_references

if TYPE_CHECKING:
    import mujoco

    from simkit import Simulation
    from simkit.compiler import ActuatorRef
    from simkit.extend import SpecBuilder
    from simkit_control.plugins.ros2_control.hardware_joint import HardwareJoint, PidGains

_LARGEST_CONTROL: Final = 9e9  # MuJoCo treats controls of 1e10 or more as invalid


class JointActuators(SharedByCopies):
    """Actuators of all joints that have command interfaces.

    Attributes:
        joints: commanded joints.
        actuators: actuators of the joints, in the same order.
        pids: PID gains that replace a servo, by joint and interface.
        modes: current mode of each joint.
        targets: references of the servos [rad or m]; these positions are held if there is no command.
        integrals: integral parts of the PID loops [N·m or N].
        groups: number of the controller that has claimed each joint; 0 for an unclaimed joint.
        gravity_shares: part of the effort against gravity that does not count for the effort limit of each joint, from
            0 to 1; None if the limits are those of the whole efforts, as in Gazebo.
    """

    def __init__(
        self,
        joints: Sequence[HardwareJoint] = (),
        actuators: Sequence[ActuatorRef] = (),
        pids: Mapping[str, Mapping[str, PidGains]] = MappingProxyType({}),
    ) -> None:
        self.joints, self.actuators, self.pids = tuple(joints), tuple(actuators), pids
        self.modes = self.groups = np.zeros(0, np.intp)
        self.targets = self.integrals = np.zeros(0)
        self.gravity_shares: Vector | None = None
        self._is_loaded = False
        self._model: mujoco.MjModel | None = None
        self._cached: ActiveModes | None = None

    @classmethod
    def prepare(
        cls,
        builder: SpecBuilder,
        owner: str,
        joints: Sequence[HardwareJoint],
        pids: Mapping[str, Mapping[str, PidGains]],
    ) -> JointActuators:
        """Add the actuators to the specification; `pids` are gains that replace a servo, by joint and interface."""
        actuators = [
            builder.add_drive(
                j.scoped,
                max_effort=j.max_effort,
                max_velocity=j.max_velocity,
                owner=owner,
                has_rotor=bool({POSITION, VELOCITY} & set(j.command_interfaces)) and not j.has_gain_commands,
            )
            for j in joints
        ]
        return cls(joints, actuators, pids)

    def load(self, sim: Simulation) -> None:
        """Bind the actuators to a simulation; joints with a position interface hold their current position."""
        self._sim, self._gravity = sim, GravityEfforts(sim, [joint.scoped for joint in self.joints])
        self._is_loaded = True
        count = len(self.joints)
        self.integrals, self.groups = np.zeros(count), np.zeros(count, np.intp)
        self._bind()
        self.targets = np.array(sim.mj_data.qpos[self._qpos])
        is_held = [POSITION in joint.command_interfaces and not joint.has_gain_commands for joint in self.joints]
        idle = [POSITION_MODE if held else FREE for held in is_held]
        self.modes = np.full(count, -1)
        self.switch(np.array(idle, np.intp))

    def _bind(self) -> None:
        """Look up the addresses of joints and actuators in MuJoCo's model, which is replaced when entities change."""
        sim = self._sim
        is_first, self._model = self._model is None, sim.mj_model
        model = self._model
        self._cached = None
        bindings = [sim.engine.names.joint(joint.scoped) for joint in self.joints]
        self._ids = np.array([sim.engine.names.actuator(ref) for ref in self.actuators], np.intp)
        # addresses of the actuators' states; slices are faster
        self._states = np.array(model.actuator_actadr[self._ids], np.intp)
        self._state_index, self._control_index = array_index(self._states.tolist()), array_index(self._ids.tolist())
        self._qpos = np.array([b.qpos[0] for b in bindings], np.intp)
        self._dofs = np.array([b.dofs[0] for b in bindings], np.intp)
        if is_first:
            self._read_limits()
            ids = np.array([b.joint_ids[0] for b in bindings], np.intp)
            self._loops = ControlLoops(model, ids, self.joints, self.pids)

    def _read_limits(self) -> None:
        """Store limits and mimic relations as arrays."""
        joints = self.joints
        index = {joint.name: k for k, joint in enumerate(joints)}
        self._leaders = np.array([index.get(j.leader, k) for k, j in enumerate(joints)], np.intp)
        self._is_leader = self._leaders == np.arange(len(joints))
        self._mimic_law = np.array([(j.multiplier, j.offset) for j in joints], float).reshape(-1, 2).T
        self._position_limits = np.array([(j.lower, j.upper) for j in joints], float).reshape(-1, 2).T
        self._max_velocities = np.array([j.max_velocity for j in joints], float)
        self._has_mimics = not self._is_leader.all()

    # ------------------------------------------------------------------ run time

    def set_springs(self, springs: Mapping[str, tuple[float, float]]) -> None:
        """Set stiffness and damping of joints in `SPRING_MODE`: effort = command − kp · position − kd · velocity.

        The engine computes the springs at every step, so they are stable at any update rate of the controllers. Gains
        that would oscillate at the engine's time step are reduced to stable gains.

        Args:
            springs: kp [N·m/rad or N/m] and kd [N·m·s/rad or N·s/m] by joint.
        """
        indices = [k for k, joint in enumerate(self.joints) if joint.name in springs]
        if indices:
            kp, kd = np.array([springs[self.joints[k].name] for k in indices]).T
            self.set_gains(np.array(indices, np.intp), kp, kd)

    def set_gains(self, indices: Indices, kp: Vector, kd: Vector) -> None:
        """Set stiffness and damping of joints in `SPRING_MODE`, while they are driven; stable gains bound them.

        Args:
            indices: indices in `joints`.
            kp: stiffness of each joint [N·m/rad or N/m].
            kd: damping of each joint [N·m·s/rad or N·s/m].
        """
        self._rebind_if_needed()
        gains = np.minimum(np.stack((kp, kd), 1), self._loops.stable_springs[indices])
        if np.array_equal(gains, self._loops.gains[indices, SPRING_MODE]):
            return
        self._loops.gains[indices, SPRING_MODE] = gains
        self._cached = None
        now, biases = self._active_modes(), self._sim.engine.touch("actuator_biasprm")
        biases[self._ids, 1], biases[self._ids, 2] = -now.kp, -now.kv

    def stable_gains(self, joint: str) -> tuple[float, float] | None:
        """Return the largest kp and kd of a joint that do not oscillate at the engine's step; None without actuator."""
        index = next((k for k, other in enumerate(self.joints) if other.name == joint), None)
        if index is None:
            return None
        kp, kd = self._loops.stable_springs[index].tolist()
        return kp, kd

    def spring_gains(self, joints: Sequence[str]) -> tuple[Vector, Vector]:
        """Return the current kp and kd of joints in `SPRING_MODE`, after a reduction to stable gains."""
        index = {joint.name: k for k, joint in enumerate(self.joints)}
        kp, kd = self._loops.gains[[index[name] for name in joints], SPRING_MODE].T
        return kp.copy(), kd.copy()

    def switch(self, modes: Indices) -> None:
        """Switch each joint to a mode; a servo starts at the joint's current position."""
        if not self._is_loaded or not len(self.joints) or np.array_equal(modes, self.modes):
            return
        self._rebind_if_needed()
        sim = self._sim
        changed, self.modes = modes != self.modes, np.array(modes)
        data = sim.mj_data
        self.integrals[changed] = 0.0
        self.targets[changed] = data.qpos[self._qpos[changed]]
        now = self._active_modes()
        biases = sim.engine.touch("actuator_biasprm")
        biases[self._ids, 1], biases[self._ids, 2] = -now.kp, -now.kv
        for loss in ("dof_damping", "dof_frictionloss"):
            losses = sim.engine.touch(loss)
            losses[self._dofs] = np.where(now.is_compensated, 0.0, sim.engine.original(loss)[self._dofs])
        self._limit_efforts(now)
        # hold the joint against gravity until its controller writes the first effort
        holding_states = (
            now.kp * self.targets + np.maximum(now.compensation, now.effort_share) * self._gravity.efforts()
        )
        data.act[self._states[changed]] = holding_states[changed]
        data.ctrl[self._ids[changed]] = 0.0
        sim.engine.physics.changed(CONTROL)

    def _limit_efforts(self, now: ActiveModes) -> None:
        """Set the effort limits of the current modes in the engine."""
        is_bound = np.isfinite(now.lowest) | np.isfinite(now.highest)
        if self.gravity_shares is not None:  # `write` limits these efforts, because their limits change at every step
            is_bound[:] = False
        if is_bound.any() or self.gravity_shares is not None:
            limited, ranges = (
                self._sim.engine.touch("actuator_forcelimited"),
                self._sim.engine.touch("actuator_forcerange"),
            )
            limited[self._ids] = is_bound
            ranges[self._ids] = np.clip(np.stack((now.lowest, now.highest), 1), -_LARGEST_CONTROL, _LARGEST_CONTROL)

    def _active_modes(self) -> ActiveModes:
        """Return the gains and bounds of the current modes."""
        cached = self._cached
        if cached is not None and cached.modes is self.modes and cached.claimed_groups is self.groups:
            return cached
        addresses = self._ids, self._qpos, self._dofs
        tops = np.array([self._sim.engine.bounded_limit(limit) for limit in self._max_velocities.tolist()])
        self._cached = ActiveModes(self.modes, self.groups, self._loops, addresses, tops)
        return self._cached

    def _rebind_if_needed(self) -> None:
        if self._model is not self._sim.engine.physics.model:
            self._bind()

    def write(self, commands: Vector, period: float) -> None:
        """Set the states and the controls of the actuators.

        Args:
            commands: command of each joint [rad, rad/s or N·m; m, m/s or N]. NaN means no command: a joint driven by
                position holds its position, and other joints get velocity or effort 0.
            period: time since the last call [s].
        """
        if not self.joints:
            return
        self._rebind_if_needed()
        now, physics = self._active_modes(), self._sim.engine.physics
        data = physics.data
        if self._has_mimics:  # the command of a mimic joint is computed from its leader's command
            offset = np.where(now.is_position, self._mimic_law[1], 0.0)
            commands = np.where(self._is_leader, commands, self._mimic_law[0] * commands[self._leaders] + offset)
        if commands.dot(now.zeros) != 0.0:  # fast check: 0 times NaN or infinity is not 0, for every processor
            commands = np.where(np.isfinite(commands), commands, np.where(now.is_position, self.targets, 0.0))
        reference, rate = self._move_references(now, commands, period)
        weight = self._gravity.efforts()
        state = now.servo_stiffness * reference
        state += now.kv * rate
        state += weight if now.all_compensated else now.compensation * weight
        if now.has_integral:
            state += self._integrate(now, reference, rate, period)
        if now.has_effort:
            state += now.effort_share * commands
        if self.gravity_shares is not None:
            shift = self.gravity_shares * weight
            effort = state - now.kp * data.qpos.take(self._qpos) - now.kv * data.qvel.take(self._dofs)
            state += np.minimum(np.maximum(effort, now.lowest + shift), now.highest + shift) - effort
        if not squared_length(state, _LARGEST_CONTROL**2) < _LARGEST_CONTROL**2:
            state = np.minimum(np.maximum(state, -_LARGEST_CONTROL), _LARGEST_CONTROL)
        data.act[self._state_index] = state
        data.ctrl[self._control_index] = now.servo_stiffness * rate
        physics.changed(CONTROL)

    def _move_references(self, now: ActiveModes, commands: Vector, period: float) -> tuple[Vector, Vector]:
        """Return the references [rad or m] and their rates for the next period [rad/s or m/s], within the limits."""
        targets = self.targets
        if period <= 0.0:
            return targets, np.zeros_like(targets)
        data = self._sim.engine.physics.data
        if now.period != period:
            now.period, now.highest_move = period, self._max_velocities * period
            now.lowest_move = -now.highest_move
        # a blocked joint must not jump when it is released, so its reference stays within `largest_lag` of the joint
        positions, reach = data.qpos.take(self._qpos), now.largest_lag
        targets = np.minimum(np.maximum(targets, positions - reach), positions + reach)
        move = np.minimum(np.maximum(commands, self._position_limits[0]), self._position_limits[1])
        move -= targets
        move = np.minimum(np.maximum(move, now.lowest_move), now.highest_move)
        if now.all_position:
            self.targets = targets + move
            return targets, move / period
        references, speeds = self._advance_velocity_references(now, commands, period)
        rate, ahead, reference = move / period, targets + move, targets
        for (k, *_), position, speed in zip(now.velocity_joints, references, speeds, strict=True):
            reference[k] = ahead[k] = position
            rate[k] = speed
        self.targets = ahead
        return reference, rate

    def _advance_velocity_references(
        self, now: ActiveModes, commands: Vector, period: float
    ) -> tuple[list[float], list[float]]:
        """Return references and rates of the joints in `now.velocity_joints`, which are not driven by position."""
        data = self._sim.engine.physics.data
        control, position, velocity = data.ctrl.item, data.qpos.item, data.qvel.item
        target, speed = self.targets.item, commands.item
        previous_speeds, references, speeds, positions, velocities = [], [], [], [], []
        # only a few joints, so plain numbers are faster than arrays
        for k, actuator, qpos, dof, stiffness, top in now.velocity_joints:
            previous, commanded = control(actuator) / stiffness, speed(k)
            previous_speeds.append(previous)
            references.append(target(k) + previous * period)
            if commanded > top or commanded < -top:
                if top > 0.0:  # it is 0 for an effort
                    self._sim.engine.report_bound(self.actuators[k], commanded)
                commanded = math.copysign(top, commanded)
            speeds.append(commanded)
            positions.append(position(qpos))
            velocities.append(velocity(dof))
        return advance_references(
            references,
            speeds,
            positions=positions,
            velocities=velocities,
            previous_speeds=previous_speeds,
            slacks=now.slacks,
            catch_up_times=now.catch_up_times,
            groups=now.groups,
        )

    def _integrate(self, now: ActiveModes, reference: Vector, rate: Vector, period: float) -> Vector:
        """Advance the integral parts of the file's PID loops, and return them [N·m or N]."""
        data, (ki, lowest, highest) = self._sim.engine.physics.data, now.integral
        error = np.where(now.is_position, reference - data.qpos.take(self._qpos), rate - data.qvel.take(self._dofs))
        self.integrals = np.minimum(np.maximum(self.integrals + ki * error * period, lowest), highest)
        return self.integrals

    def efforts(self) -> Vector:
        """Return the current effort of each actuator [N·m or N]."""
        now, data = self._active_modes(), self._sim.engine.physics.data
        force = data.act.take(self._states) - now.kp * data.qpos.take(self._qpos) - now.kv * data.qvel.take(self._dofs)
        if self.gravity_shares is not None:
            return np.asarray(force)
        effort: Vector = np.minimum(np.maximum(force, now.lowest), now.highest)
        return effort
