"""Modes in which a joint is driven, with the gains, effort bounds and losses of each."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Final

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.compiler.servo_gains import drive_gains, felt_inertias
from simkit.plugins.ros2_control.hardware_interfaces import POSITION, VELOCITY, Indices
from simkit.pose import Vector

if TYPE_CHECKING:
    from simkit.plugins.ros2_control.hardware_joint import HardwareJoint, PidGains

Mask = npt.NDArray[np.bool_]

FREE, POSITION_MODE, VELOCITY_MODE, EFFORT_MODE, SPRING_MODE = range(5)

_VELOCITY_DAMPING: Final = 0.5
"""Damping of a velocity servo, times step over inertia. Contacts are solved without what the integrator knows of it: a
wheel slips in proportion (2 mm/s at 1 and 0.8 m/s²)."""

_CATCH_UP_TIME: Final = 0.05
"""[s] in which a velocity servo makes up for what it lost."""

_POSITION_REACH: Final = 2.0
"""Times the whole effort that a position servo asks for at most: what damping takes off leaves the whole."""


class ControlLoops:
    """The loop of every joint in each mode: that of the file where it has one, else a servo's.

    Args:
        model: the engine's.
        ids: of the joints in it.
        joints: the same, with their limits.
        pids: the file's loops, by joint and interface.

    Attributes:
        gains: kp [N·m/rad or N/m] and kv [N·m·s/rad or N·s/m], shape (joints, modes, 2).
        integral: ki, and the bounds of the integral's part [N·m or N], shape (joints, modes, 3).
        is_given: whether the loop is the file's, shape (joints, modes).
        bounds: lowest and highest effort [N·m or N], shape (joints, modes, 2).
        calm: the highest kp and kv of a spring that do not ring, shape (joints, 2).
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
        self.is_given, self.calm = np.zeros((count, 5), bool), np.zeros((count, 2))
        self.bounds = np.repeat(np.stack((-limits, limits), 1)[:, None], 5, 1)
        if not count:
            return
        least, most = felt_inertias(model, ids)
        self.calm = np.stack((0.25 * least / step**2, least / step), 1)
        is_slide = model.jnt_type[ids] == int(mujoco.mjtJoint.mjJNT_SLIDE)
        self.gains[:, POSITION_MODE] = np.stack(drive_gains(limits, is_slide, least, most, step), 1)
        damping = _VELOCITY_DAMPING * least / step
        self.gains[:, VELOCITY_MODE] = np.stack((damping / _CATCH_UP_TIME, damping), 1)
        for k, joint in enumerate(joints):
            for mode, interface in ((POSITION_MODE, POSITION), (VELOCITY_MODE, VELOCITY)):
                given = pids.get(joint.name, {}).get(interface)
                if given:
                    wanted = (given.p, given.d) if mode == POSITION_MODE else (0.0, given.p)
                    self.gains[k, mode] = min(wanted[0], least[k] / step**2), min(wanted[1], least[k] / step)
                    self.integral[k, mode] = given.i, given.i_min, given.i_max
                    self.bounds[k, mode] = max(given.u_min, -limits[k]), min(given.u_max, limits[k])
                    self.is_given[k, mode] = True


class ActiveModes:
    """Gains, bounds and losses of the present modes, one value for each joint; made anew when the modes change.

    Args:
        modes: of the joints.
        groups: number of the controller that has claimed each joint; 0 for none.
        loops: of the joints.
        addresses: of the joints' actuators, positions and velocities in the engine.
        fastest: top speeds [rad/s or m/s].

    Attributes:
        modes: that it is of.
        zeros: zeros; their product with the commands shows whether one is not finite.
        kp, kv: gains of the actuators [N·m/rad or N/m, N·m·s/rad or N·s/m].
        servo_stiffness: kp of the servos; 0 for the others.
        lowest, highest: bounds of the effort [N·m or N].
        integral: ki of the file's loops, and the bounds of that part [N·m or N].
        is_position: whether by position.
        is_compensated, compensation: whether gravity and friction are compensated; the same as 1 or 0.
        effort_share: 1 where the command is an effort.
        all_compensated, all_position: whether all joints are compensated, driven by position.
        largest_lag: largest distance of a reference from its joint [rad or m].
        velocity_joints: those that are not driven by position: place, addresses, stiffness and top speed.
        slacks, catch_up_times, groups: of those joints, as `advance_references` takes them.
        claimed_groups: the array of groups that `groups` are of.
        has_effort, has_integral: whether any joint has such a part.
        period: the time in which references move by `lowest_move` to `highest_move` [s].
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
        is_compensated = is_servo & ~loops.is_given[rows, modes]
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
