"""Modes in which a joint is driven, with the gains, effort bounds and losses of each."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
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


@dataclass(slots=True, eq=False)
class ControlLoops:
    """The loop of every joint in each mode: that of the file where it has one, else a servo's.

    Attributes:
        gains: kp [N·m/rad or N/m] and kv [N·m·s/rad or N·s/m], shape (joints, modes, 2).
        integral: ki, and the bounds of the integral's part [N·m or N], shape (joints, modes, 3).
        is_given: whether the loop is the file's, shape (joints, modes).
        bounds: lowest and highest effort [N·m or N], shape (joints, modes, 2).
        calm: the highest kp and kv of a spring that do not ring, shape (joints, 2).
    """

    gains: Vector
    integral: Vector
    is_given: Mask
    bounds: Vector
    calm: Vector

    @classmethod
    def choose(
        cls,
        model: mujoco.MjModel,
        ids: Indices,
        joints: Sequence[HardwareJoint],
        pids: Mapping[str, Mapping[str, PidGains]],
    ) -> ControlLoops:
        """The loops of joints.

        Args:
            model: the engine's.
            ids: of the joints in it.
            joints: the same, with their limits.
            pids: the file's loops, by joint and interface.
        """
        count, step = len(joints), float(model.opt.timestep)
        limits = np.array([joint.max_effort for joint in joints], float)
        bounds = np.repeat(np.stack((-limits, limits), 1)[:, None], 5, 1)
        made = cls(
            np.zeros((count, 5, 2)), np.zeros((count, 5, 3)), np.zeros((count, 5), bool), bounds, np.zeros((count, 2))
        )
        if not count:
            return made
        least, most = felt_inertias(model, ids)
        made.calm = np.stack((0.25 * least / step**2, least / step), 1)
        is_slide = model.jnt_type[ids] == int(mujoco.mjtJoint.mjJNT_SLIDE)
        made.gains[:, POSITION_MODE] = np.stack(drive_gains(limits, is_slide, least, most, step), 1)
        damping = _VELOCITY_DAMPING * least / step
        made.gains[:, VELOCITY_MODE] = np.stack((damping / _CATCH_UP_TIME, damping), 1)
        for k, joint in enumerate(joints):
            for mode, interface in ((POSITION_MODE, POSITION), (VELOCITY_MODE, VELOCITY)):
                given = pids.get(joint.name, {}).get(interface)
                if given:
                    wanted = (given.p, given.d) if mode == POSITION_MODE else (0.0, given.p)
                    made.gains[k, mode] = min(wanted[0], least[k] / step**2), min(wanted[1], least[k] / step)
                    made.integral[k, mode] = given.i, given.i_min, given.i_max
                    made.bounds[k, mode] = max(given.u_min, -limits[k]), min(given.u_max, limits[k])
                    made.is_given[k, mode] = True
        return made


@dataclass(slots=True)
class ActiveModes:
    """Gains, bounds and losses of the present modes, one value for each joint; made anew when the modes change.

    Attributes:
        modes: that it is of.
        zeros: zeros; their product with the commands shows whether one is not finite.
        kp, kv: gains of the actuators [N·m/rad or N/m, N·m·s/rad or N·s/m].
        servo_stiffness: kp of the servos; 0 for the others.
        lowest, highest: bounds of the effort [N·m or N].
        integral: ki of the file's loops, and the bounds of that part [N·m or N].
        is_position, is_servo: whether by position; whether by position or velocity.
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

    modes: Indices
    zeros: Vector
    kp: Vector
    kv: Vector
    servo_stiffness: Vector
    lowest: Vector
    highest: Vector
    integral: tuple[Vector, Vector, Vector]
    is_position: Mask
    is_servo: Mask
    is_compensated: Mask
    compensation: Vector
    effort_share: Vector
    all_compensated: bool
    all_position: bool
    largest_lag: Vector
    velocity_joints: list[tuple[int, int, int, int, float, float]]
    slacks: list[float]
    catch_up_times: list[float]
    claimed_groups: Indices
    groups: list[int]
    has_effort: bool
    has_integral: bool
    period: float = 0.0
    lowest_move: Vector = field(default_factory=lambda: np.zeros(0))
    highest_move: Vector = field(default_factory=lambda: np.zeros(0))

    @classmethod
    def of(
        cls,
        modes: Indices,
        groups: Indices,
        loops: ControlLoops,
        addresses: tuple[Indices, Indices, Indices],
        fastest: Vector,
    ) -> ActiveModes:
        """Derive gains, bounds and losses from the modes.

        Args:
            modes: of the joints.
            groups: number of the controller that has claimed each joint; 0 for none.
            loops: of the joints.
            addresses: of the joints' actuators, positions and velocities in the engine.
            fastest: top speeds [rad/s or m/s].
        """
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
        return cls(
            modes=modes,
            zeros=np.zeros(len(modes)),
            kp=kp.copy(),
            kv=kv.copy(),
            servo_stiffness=np.where(is_servo, kp, 0.0),
            lowest=bounds[:, 0].copy(),
            highest=bounds[:, 1].copy(),
            integral=(integral[0].copy(), integral[1].copy(), integral[2].copy()),
            is_position=is_position,
            is_servo=is_servo,
            is_compensated=is_compensated,
            compensation=is_compensated.astype(float),
            effort_share=((modes == EFFORT_MODE) | (modes == SPRING_MODE)).astype(float),
            all_compensated=bool(is_compensated.all()),
            all_position=bool(is_position.all()),
            largest_lag=np.where(is_position, _POSITION_REACH * bounds[:, 1] / np.maximum(kp, 1e-12), np.inf),
            velocity_joints=list(zip(*(column.tolist() for column in columns), strict=True)),
            slacks=(bounds[rolls, 1] / stiffness).tolist(),
            catch_up_times=(np.maximum(kv[rolls], 1e-12) / stiffness).tolist(),
            claimed_groups=groups,
            groups=groups[rolls].tolist(),
            has_effort=bool((modes >= EFFORT_MODE).any()),
            has_integral=bool(integral[0].any()),
        )
