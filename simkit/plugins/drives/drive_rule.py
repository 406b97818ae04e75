"""Array rule of differential drives: the command of a twist, velocity servos, and odometry from wheels."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from simkit.elementary_functions import arctan2
from simkit.plugins.drives.odometry import OdometryRows, TrueMotion, rim_speeds
from simkit.plugins.drives.odometry_noise import NoisyOdometry
from simkit.runtime.array_rules import (
    Bools,
    CannotBatchError,
    Floats,
    Ids,
    PluginRule,
    PresentNumbers,
    SetCommand,
    Ticks,
    TopicRule,
)

if TYPE_CHECKING:
    from simkit.compiler import ActuatorRef
    from simkit.plugins.base import ModelPlugin
    from simkit.runtime import Joint
    from simkit.runtime.state_arrays import StateArrays

_COMMAND_FIELDS = ("linear.x", "angular.z")


@dataclass(frozen=True, slots=True)
class DriveWheel:
    """Wheel of a drive: joint, servo, side (0 left, 1 right), distance to the opposite wheel [m] and radius [m]."""

    joint: Joint
    servo: ActuatorRef
    side: int
    separation: float
    radius: float


class DifferentialDriveRule(PluginRule):
    """One differential drive in n simulations.

    Args:
        plugin: drive of the simulation that resets all others.
        command_topic: topic of its commands.
        wheels: its wheels.

    Attributes:
        target: forward speed [m/s] and turning rate [rad/s] of the last command, shape (n, 2).
        odometry: odometry from the wheels.
        observes_wheels: True if the odometry from wheels is read.

    Raises:
        CannotBatchError: a wheel has no plain joint.
    """

    odometry: OdometryRows
    reads_poses = False

    def __init__(self, plugin: ModelPlugin, command_topic: str, wheels: Sequence[DriveWheel]) -> None:
        if any(wheel.joint.dof != 1 or not math.isfinite(wheel.radius) for wheel in wheels):
            raise CannotBatchError(f"its wheels of plugin {type(plugin).__name__}")
        self._plugin, self._command_topic, self._wheels = plugin, command_topic, list(wheels)
        self._clock = plugin.sim.engine.clock
        self.grid = self._clock.grid(plugin.after_step_rate or 0.0)
        self.grids = (self.grid,)
        self.observes_wheels = False

    def bind(self, states: StateArrays) -> None:
        engine, wheels = states.sim.engine, self._wheels
        self._states = states
        columns = [states.servos.column(engine.names.actuator(wheel.servo)) for wheel in wheels]
        self._columns = np.array(columns, dtype=np.intp)
        self._limits = np.array([engine.speed_limit(wheel.servo) for wheel in wheels])
        self._radii = np.array([wheel.radius for wheel in wheels])
        self._separations = np.array([wheel.separation for wheel in wheels])
        self._is_right = np.array([wheel.side == 1 for wheel in wheels])
        # the first wheel of each side measures the odometry
        self._first = [next(wheel for wheel in wheels if wheel.side == side) for side in (0, 1)]
        joints = [engine.names.joint(wheel.joint.scoped) for wheel in self._first]
        self._places = np.array([joint.qpos[0] for joint in joints], dtype=np.intp)
        self._dofs = np.array([joint.dofs[0] for joint in joints], dtype=np.intp)
        self.target = np.zeros((states.count, 2))
        self._noisy: list[tuple[NoisyOdometry, int]] = []  # with the time of the last update [ns]

    # ------------------------------------------------------------------ commands

    def command(self, topic: str, fields: Sequence[str]) -> SetCommand | None:
        if topic != self._command_topic:
            return None
        columns = [fields.index(field) if field in fields else -1 for field in _COMMAND_FIELDS]

        def set_command(ids: Ids, numbers: Floats) -> None:
            values = np.zeros((len(ids), 2))
            for to, column in enumerate(columns):
                if column >= 0:
                    values[:, to] = numbers[:, column]
            self.aim(ids, values)

        return set_command

    def aim(self, ids: Ids, targets: Floats) -> None:
        """Set forward speed [m/s] and turning rate [rad/s] of some simulations, shape (n, 2)."""
        self.target[ids] = targets

    def rims(self, speeds: Floats) -> Floats:
        """Return the rim speeds of all wheels [m/s] for forward speeds and turning rates, shape (n, 2)."""
        left, right = rim_speeds(speeds[:, :1], speeds[:, 1:], self._separations)
        rims: Floats = left.copy()
        rims[:, self._is_right] = right[:, self._is_right]
        return rims

    def turn_wheels(self, ids: Ids, rims: Floats, changed: Bools) -> None:
        """Command the changed rim speeds [m/s] in some simulations, within the velocity limits of the joints."""
        velocities = np.maximum(-self._limits, np.minimum(self._limits, rims / self._radii))
        self._states.servos.command(ids, self._columns, velocities, changed)

    # ------------------------------------------------------------------ readings

    def wheel_angles(self, ids: Ids) -> Floats:
        """Return the present angles of the first left and right wheel [rad], shape (n, 2)."""
        return self._states.qpos[ids[:, None], self._places]

    def wheel_velocities(self, ids: Ids) -> Floats:
        """Return the present velocities of these wheels [rad/s], shape (n, 2)."""
        return self._states.qvel[ids[:, None], self._dofs]

    def take_noise(self, row: int, odometry: NoisyOdometry, time_ns: int) -> None:
        """Copy an odometry with noise, whose last update was at a time [ns], to one row."""
        copied = odometry.independent_copy()
        self._noisy = self._noisy or [(copied, time_ns)] * self._states.count
        self._noisy[row] = copied, time_ns

    @property
    def has_noise(self) -> bool:
        """True if the odometry has noise."""
        return bool(self._noisy)

    def advance_noise(self, ids: Ids, ticks: Ticks) -> None:
        """Advance the odometry with noise of some simulations, and store its numbers."""
        for row, tick, angles in zip(ids.tolist(), ticks.tolist(), self.wheel_angles(ids).tolist(), strict=True):
            (odometry, last_ns), now = self._noisy[row], self._clock.time_ns(tick)
            odometry.advance(*angles, (now - last_ns) * 1e-9)
            self._noisy[row] = odometry, now
            way, twist = odometry.reckoning, odometry.twist
            self.odometry.values[row] = way.x, way.y, way.yaw, *twist.linear[:2], twist.angular[2]

    def wheel_odometry(self) -> TopicRule:
        """Return the rule of the odometry from the wheels."""
        self.observes_wheels = True

        def read(ids: Ids, _: Ticks) -> Floats:
            values: Floats = self.odometry.values[ids]
            values[:, 2] = arctan2(np.sin(values[:, 2]), np.cos(values[:, 2]))
            return values

        return PresentNumbers(self.grid, read)

    def true_odometry(self, motion: TrueMotion) -> TopicRule:
        """Return the rule of the true motion of the model."""
        return PresentNumbers(self.grid, lambda ids, _: motion.rows(self._states, ids))
