"""Drive modes of the hardware's joints: the gains, effort bounds and losses of each mode."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Final

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.compiler.servo_gains import drive_gains, effective_inertias
from simkit.extend import Vector
from simkit_control.plugins.ros2_control.hardware_interfaces import POSITION, VELOCITY, Indices

if TYPE_CHECKING:
    from simkit_control.plugins.ros2_control.hardware_joint import HardwareJoint, PidGains

Mask = npt.NDArray[np.bool_]

FREE, POSITION_MODE, VELOCITY_MODE, EFFORT_MODE, SPRING_MODE = range(5)

_VELOCITY_DAMPING: Final = 0.5
"""Damping of a velocity servo, as a multiple of inertia over time step.

MuJoCo solves contacts without the implicit damping of the integrator, so a wheel slips in proportion to this factor (2
mm/s at a factor of 1 and 0.8 m/s²).
"""

_CATCH_UP_TIME: Final = 0.05
"""Time constant with which a velocity servo corrects a position lag [s]."""

_POSITION_REACH: Final = 2.0
"""Largest effort that a position servo requests, as a multiple of its effort limit.

With 2, the servo can still request its full effort after damping has reduced the requested effort.
"""


class ControlLoops:
    """Gains of every joint in each mode: the PID gains in the file, or else gains computed for a servo.

    Args:
        model: compiled MuJoCo model.
        ids: joint ids in the model, shape (joints,).
        joints: hardware joints with their limits, in the same order.
        pids: PID gains from the file, by joint name and interface.

    Attributes:
        gains: kp [N·m/rad or N/m] and kv [N·m·s/rad or N·s/m], shape (joints, modes, 2).
        integral: ki, and the lower and upper bound of the integral part [N·m or N], shape (joints, modes, 3).
        is_from_file: true where the gains come from the file, shape (joints, modes).
        bounds: lowest and highest effort [N·m or N], shape (joints, modes, 2).
        stable_springs: largest kp and kv at which a spring does not oscillate at the engine's time step, shape
            (joints, 2).
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        ids: Indices,
        joints: Sequence[HardwareJoint],
        pids: Mapping[str, Mapping[str, PidGains]],
    ) -> None:
        count, step = len(joints), float(model.opt.timestep)
        limits = np.array([joint.max_effort for joint in joints], float)
        self.gains, self.integral = np.zeros((count, 5, 2)), np.zeros((count, 5, 3))
        self.is_from_file, self.stable_springs = np.zeros((count, 5), bool), np.zeros((count, 2))
        self.bounds = np.repeat(np.stack((-limits, limits), 1)[:, None], 5, 1)
        if not count:
            return
        least, most = effective_inertias(model, ids)
        self.stable_springs = np.stack((0.25 * least / step**2, least / step), 1)
        is_slide = model.jnt_type[ids] == int(mujoco.mjtJoint.mjJNT_SLIDE)
        self.gains[:, POSITION_MODE] = np.stack(drive_gains(limits, is_slide, least, most, step), 1)
        damping = _VELOCITY_DAMPING * least / step
        self.gains[:, VELOCITY_MODE] = np.stack((damping / _CATCH_UP_TIME, damping), 1)
        for k, joint in enumerate(joints):
            for mode, interface in ((POSITION_MODE, POSITION), (VELOCITY_MODE, VELOCITY)):
                pid = pids.get(joint.name, {}).get(interface)
                if pid:
                    kp, kv = (pid.p, pid.d) if mode == POSITION_MODE else (0.0, pid.p)
                    self.gains[k, mode] = min(kp, least[k] / step**2), min(kv, least[k] / step)
                    self.integral[k, mode] = pid.i, pid.i_min, pid.i_max
                    self.bounds[k, mode] = max(pid.u_min, -limits[k]), min(pid.u_max, limits[k])
                    self.is_from_file[k, mode] = True


class ActiveModes:
    """Gains, bounds and losses of the current modes, one value for each joint; recreated when the modes change.

    Args:
        modes: current mode of each joint, shape (joints,).
        groups: number of the controller that has claimed each joint; 0 for an unclaimed joint.
        loops: gains of the joints in all modes.
        addresses: addresses of the joints' actuators, positions and velocities in the engine.
        fastest: velocity limits of the joints [rad/s or m/s].

    Attributes:
        modes: modes that these values belong to.
        zeros: array of zeros. Commands are multiplied by this array to find NaN and infinite commands, because only
            their product is not 0.
        kp, kv: gains of the actuators [N·m/rad or N/m, N·m·s/rad or N·s/m].
        servo_stiffness: kp of the servos; 0 for the other joints.
        lowest, highest: bounds of the effort [N·m or N].
        integral: ki of the file's loops, and the lower and upper bound of the integral part [N·m or N].
        is_position: true for joints driven by position.
        is_compensated: true for joints whose gravity and friction are compensated.
        compensation: `is_compensated` as numbers, 1.0 or 0.0.
        effort_share: 1 for joints whose command is an effort, else 0.
        all_compensated: true if all joints are compensated.
        all_position: true if all joints are driven by position.
        largest_lag: largest distance between a reference and the position of its joint [rad or m].
        velocity_joints: joints that are not driven by position: index, addresses, stiffness and velocity limit.
        slacks, catch_up_times, groups: arguments of `advance_references` for the `velocity_joints`.
        claimed_groups: the argument `groups`, for all joints.
        has_effort: true if any joint has an effort command.
        has_integral: true if any joint has an integral part.
        period: time in which references move by `lowest_move` to `highest_move` [s].
    """

    def __init__(
        self,
        modes: Indices,
        groups: Indices,
        loops: ControlLoops,
        addresses: tuple[Indices, Indices, Indices],
        fastest: Vector,
    ) -> None:
        rows = np.arange(len(modes))
        (kp, kv), bounds = loops.gains[rows, modes].T, loops.bounds[rows, modes]
        is_position = modes == POSITION_MODE
        is_servo = is_position | (modes == VELOCITY_MODE)
        is_compensated = is_servo & ~loops.is_from_file[rows, modes]
        integral = loops.integral[rows, modes].T
        rolls = np.flatnonzero(~is_position)
        stiffness = np.maximum(kp[rolls], 1e-12)
        top = np.where(is_servo, fastest, 0.0)[rolls]
        columns = (rolls, *(address[rolls] for address in addresses), stiffness, top)
        self.modes = modes
        self.zeros = np.zeros(len(modes))
        self.kp, self.kv = kp.copy(), kv.copy()
        self.servo_stiffness = np.where(is_servo, kp, 0.0)
        self.lowest, self.highest = bounds[:, 0].copy(), bounds[:, 1].copy()
        self.integral = (integral[0].copy(), integral[1].copy(), integral[2].copy())
        self.is_position = is_position
        self.is_compensated, self.compensation = is_compensated, is_compensated.astype(float)
        self.effort_share = ((modes == EFFORT_MODE) | (modes == SPRING_MODE)).astype(float)
        self.all_compensated, self.all_position = bool(is_compensated.all()), bool(is_position.all())
        self.largest_lag = np.where(is_position, _POSITION_REACH * bounds[:, 1] / np.maximum(kp, 1e-12), np.inf)
        self.velocity_joints: list[tuple[int, int, int, int, float, float]] = list(
            zip(*(column.tolist() for column in columns), strict=True)
        )
        self.slacks: list[float] = (bounds[rolls, 1] / stiffness).tolist()
        self.catch_up_times: list[float] = (np.maximum(kv[rolls], 1e-12) / stiffness).tolist()
        self.claimed_groups, self.groups = groups, groups[rolls].tolist()
        self.has_effort, self.has_integral = bool((modes >= EFFORT_MODE).any()), bool(integral[0].any())
        self.period, self.lowest_move, self.highest_move = 0.0, np.zeros(0), np.zeros(0)
