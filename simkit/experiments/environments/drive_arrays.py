"""Differential drives of all environments of a batch, as arrays.

Each row of an array belongs to one environment. The formulas and their order are those of the plugins, so that a batch
has the bits of single environments.
"""

from __future__ import annotations

import abc
import copy
import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import numpy.typing as npt

from simkit.elementary_functions import arctan2
from simkit.experiments.environments.array_view import ArrayView
from simkit.experiments.environments.cannot_batch import CannotBatchError
from simkit.experiments.environments.due_ticks import NEVER, Grid, is_due, last_due, next_due, next_odometry_tick
from simkit.experiments.environments.servo_arrays import ServoArrays
from simkit.plugins.classic.diff_drive import GazeboRosDiffDrive, GazeboRosSkidSteerDrive
from simkit.plugins.drives.odometry import DeadReckoning, TrueMotion, WheelOdometry, wheel_angles
from simkit.plugins.drives.odometry_noise import NoisyOdometry
from simkit.plugins.drives.speed_limits import SpeedLimiterArrays
from simkit.plugins.gz.diff_drive import DiffDrive
from simkit.runtime.engine.random_streams import RandomStream

if TYPE_CHECKING:
    from simkit.compiler import ActuatorRef
    from simkit.runtime import Joint

Floats = npt.NDArray[np.float64]
Bools = npt.NDArray[np.bool_]
Ids = npt.NDArray[np.intp]
Ticks = npt.NDArray[np.int64]
Read = Callable[[Ids], Floats]

_LARGEST: Final = 9e9
_CLOSE: Final = 0.01  # [m/s] as in the plugin of Gazebo Classic
_STRIDE: Final = WheelOdometry.stride
_WINDOW: Final = WheelOdometry.mean_steps


@dataclass(frozen=True)
class Wheel:
    """Wheel of a drive: joint, servo, side (-1 left, 1 right), distance to the opposite wheel [m] and radius [m]."""

    joint: Joint
    servo: ActuatorRef
    side: float
    separation: float
    radius: float


class DriveArrays(abc.ABC):
    """One differential drive in all environments.

    Args:
        plugin: drive of the environment that resets all others.
        servos: velocity servos of all environments.
        view: state of all environments.

    Attributes:
        command: forward speed [m/s] and turning rate [rad/s] of the last command.
        grid: ticks of the odometry.
        odometry: x, y [m], yaw [rad], forward speed, speed to the left [m/s] and turning rate [rad/s] of the wheels, at
            the last tick of the odometry; only if it is observed.
        observes_wheels: True if the odometry from wheels is observed.
    """

    def __init__(self, plugin: Any, servos: ServoArrays, view: ArrayView) -> None:
        sim, count, wheels = plugin.sim, view.count, self.wheels_of(plugin)
        self.plugin, self._servos, self._view, self._clock = plugin, servos, view, sim.engine.clock
        actuators = [sim.engine.names.actuator(wheel.servo) for wheel in wheels]
        self._columns = np.array([servos.column(actuator) for actuator in actuators], dtype=np.intp)
        limits = [sim.engine.speed_limit(wheel.servo) for wheel in wheels]
        self._limits = np.minimum(_LARGEST, limits)
        self._radii = np.array([wheel.radius for wheel in wheels])
        self._arms = np.array([wheel.side * wheel.separation for wheel in wheels])
        # the first wheel of each side measures the odometry
        first = [next(wheel for wheel in wheels if wheel.side == side) for side in (-1.0, 1.0)]
        self._places = np.array([wheel.joint._first_qpos for wheel in first], dtype=np.intp)
        self._dofs = np.array([wheel.joint._one_dof for wheel in first], dtype=np.intp)
        self._radius, self._separation = first[0].radius, first[0].separation
        self.command = np.zeros((count, 2))
        self._angles, self._reckonings = np.zeros((count, 2)), [DeadReckoning() for _ in range(count)]
        self.odometry, self.observes_wheels = np.zeros((count, 6)), False
        self.grid: Grid = self._clock.grid(plugin.after_step_rate)
        self._noisy: list[tuple[NoisyOdometry, int]] = []  # with the time of the last update [ns]

    # ------------------------------------------------------------------ each drive

    @staticmethod
    @abc.abstractmethod
    def wheels_of(plugin: Any) -> list[Wheel]:
        """Return the wheels of a plugin."""

    @abc.abstractmethod
    def take(self, row: int, tick: int) -> None:
        """Copy the state of the plugin at the present tick to one environment."""

    @abc.abstractmethod
    def next_stop(self, ids: Ids, tick: int) -> int:
        """Return the first tick after a tick at which some environments must call the hooks."""

    @abc.abstractmethod
    def before_step(self, ids: Ids, ticks: Ticks) -> None:
        """Set the velocities of the wheels, as the plugin does, at the present tick of each environment."""

    @abc.abstractmethod
    def after_step(self, ids: Ids, ticks: Ticks) -> None:
        """Integrate the observed odometry, as the plugin does."""

    @abc.abstractmethod
    def outputs(self) -> Iterable[tuple[Any, Read, bool]]:
        """Yield each publisher of odometry (or None), its reading function, and true for a truth with added errors."""

    # ------------------------------------------------------------------ all drives

    @classmethod
    def obstacle(cls, plugin: Any) -> str:
        """Return why a drive cannot be computed as arrays; empty if it can."""
        wheels = cls.wheels_of(plugin)
        is_known = all(wheel.joint.dof == 1 and math.isfinite(wheel.radius) for wheel in wheels)
        return "" if is_known else "its wheels"

    def aim(self, ids: Ids, forward: Floats, turn: Floats) -> None:
        """Set the command of some environments: forward speed [m/s] and turning rate [rad/s]."""
        self.command[ids, 0], self.command[ids, 1] = forward, turn

    def bind(self, topic: str) -> Read | None:
        """Return the function that reads the odometry on a topic at the ticks of `grid`; None for another topic.

        Raises:
            CannotBatchError: the ground truth has added errors.
        """
        for publisher, read, has_errors in self.outputs():
            if publisher is not None and publisher.topic == topic:
                if has_errors:
                    raise CannotBatchError(f"topic {topic}: ground truth with <odometry_noise>")
                self.observes_wheels |= read == self.read_wheels
                return read
        return None

    def read_wheels(self, ids: Ids) -> Floats:
        """Return the odometry of the wheels in some environments; the yaw is from -π to π."""
        found: Floats = self.odometry[ids]
        found[:, 2] = arctan2(np.sin(found[:, 2]), np.cos(found[:, 2]))
        return found

    def _rims(self, speeds: Floats) -> Floats:
        """Return the rim speeds of all wheels [m/s] for forward speeds and turning rates, shape (n, 2)."""
        rims: Floats = speeds[:, :1] + speeds[:, 1:] * self._arms / 2
        return rims

    def _turn_wheels(self, ids: Ids, rims: Floats, changed: Bools) -> None:
        """Command the changed rim speeds [m/s] in some environments, within the velocity limits of the joints."""
        velocities = np.maximum(-self._limits, np.minimum(self._limits, rims / self._radii))
        self._servos.command(ids, self._columns, velocities, changed)

    def _wheel_angles(self, ids: Ids) -> Floats:
        found: Floats = self._view.qpos[ids[:, None], self._places]
        return found

    def _roll(self, ids: Ids, angles: Floats) -> None:
        """Advance the poses of some environments along one arc, up to the angles of the wheels."""
        rolled = (angles - self._angles[ids]) * self._radius
        self._angles[ids] = angles
        for row, (left, right) in zip(ids.tolist(), rolled.tolist(), strict=True):
            self._reckonings[row].advance(left, right, self._separation)

    def _take_noise(self, row: int, odometry: NoisyOdometry, time_ns: int) -> None:
        """Copy an odometry with noise to one environment, whose episode has its own seed."""
        mine, stream = copy.copy(odometry), odometry._stream
        mine.reckoning = copy.copy(odometry.reckoning)
        seed = self.plugin.sim.engine.streams._folded_seed
        mine._stream = RandomStream(seed, stream.scoped, stream.channel, stream.width)
        self._noisy = self._noisy or [(mine, time_ns)] * self._view.count
        self._noisy[row] = mine, time_ns

    def _store_with_noise(self, ids: Ids, ticks: Ticks) -> None:
        """Advance the odometry with noise of some environments, and store it."""
        for row, tick, angles in zip(ids.tolist(), ticks.tolist(), self._wheel_angles(ids).tolist(), strict=True):
            (odometry, last_ns), now = self._noisy[row], self._clock.time_ns(tick)
            odometry.advance(*angles, (now - last_ns) * 1e-9)
            self._noisy[row] = odometry, now
            way, twist = odometry.reckoning, odometry.twist
            self.odometry[row] = way.x, way.y, way.yaw, *twist.linear[:2], twist.angular[2]

    def _store(self, ids: Ids, rolled: Floats, time: Floats | float) -> None:
        """Store the poses of some environments, and the twists while the wheels roll some way [m] in some time [s]."""
        ways, (left, right) = [self._reckonings[row] for row in ids.tolist()], rolled.T
        self.odometry[ids, :3] = [(way.x, way.y, way.yaw) for way in ways]
        self.odometry[ids, 3] = (left + right) / 2 / time
        self.odometry[ids, 5] = (right - left) / self._separation / time


class ClassicDriveArrays(DriveArrays):
    """Drive of Gazebo Classic, with any number of pairs of wheels."""

    plugin: GazeboRosDiffDrive

    def __init__(self, plugin: Any, servos: ServoArrays, view: ArrayView) -> None:
        super().__init__(plugin, servos, view)
        self._rim_speeds, self._last_ns = np.zeros((view.count, len(self._columns))), np.zeros(view.count)

    @staticmethod
    def wheels_of(plugin: GazeboRosDiffDrive) -> list[Wheel]:
        pairs = [pair for pair in plugin.options.pairs for _ in range(2)]
        rows = zip(plugin._wheels, plugin._servos, pairs, strict=True)
        return [
            Wheel(joint, servo, 1.0 if i % 2 else -1.0, pair.separation, pair.radius)
            for i, (joint, servo, pair) in enumerate(rows)
        ]

    def take(self, row: int, tick: int) -> None:
        plugin = self.plugin
        self.command[row], self._last_ns[row] = plugin._command, plugin._last_ns
        self._rim_speeds[row], self._angles[row] = plugin._rims, plugin._angles
        self._reckonings[row] = copy.copy(plugin._reckoning)
        if plugin._erring is not None:
            self._take_noise(row, plugin._erring, plugin._last_read_ns)

    def next_stop(self, ids: Ids, tick: int) -> int:
        return next_due(self.grid, tick)

    def before_step(self, ids: Ids, ticks: Ticks) -> None:
        """Move each wheel's rim speed towards its target, by at most the acceleration limit."""
        if not is_due(self.grid, int(ticks[0])):
            return
        now = np.array([self._clock.time_ns(tick) for tick in ticks.tolist()], float)
        elapsed = (now - self._last_ns[ids]) * 1e-9
        self._last_ns[ids] = now
        target, before = self._rims(self.command[ids]), self._rim_speeds[ids]
        speed, largest = target, self.plugin.options.max_wheel_acceleration
        if largest:
            step = largest * elapsed[:, None]
            ramped = before + np.maximum(-step, np.minimum(step, target - before))
            speed = np.where(np.abs(target - before) < _CLOSE, target, ramped)
        self._rim_speeds[ids] = speed
        self._turn_wheels(ids, speed, speed != before)

    def after_step(self, ids: Ids, ticks: Ticks) -> None:
        """Integrate the travel of the wheels, as the plugin does with odometry from encoders."""
        if not self.observes_wheels or not is_due(self.grid, int(ticks[0])):
            return
        if self._noisy:
            self._store_with_noise(ids, ticks)
        else:
            self._roll(ids, self._wheel_angles(ids))
            self._store(ids, self._view.qvel[ids[:, None], self._dofs] * self._radius, 1.0)

    def outputs(self) -> Iterable[tuple[Any, Read, bool]]:
        plugin, truth = self.plugin, true_odometry(self._view, self.plugin._true)
        measured = self.read_wheels if plugin.options.from_encoders else truth
        yield plugin._outputs._odom, measured, plugin._followed is not None
        yield plugin._truth, truth, False


class GazeboDriveArrays(DriveArrays):
    """Drive of Gazebo Sim, with limits of speed, acceleration and jerk.

    The limited speeds change at every step until they have reached the command. The odometry has an arc for every ten
    steps, and the mean twist of the last ten steps.
    """

    plugin: DiffDrive

    def __init__(self, plugin: Any, servos: ServoArrays, view: ArrayView) -> None:
        super().__init__(plugin, servos, view)
        count = view.count
        self._limiters, self._step = SpeedLimiterArrays(plugin._limiters), plugin.period
        self._last, self._before_last = np.zeros((count, 2)), np.zeros((count, 2))
        self._settled, self._enabled = np.zeros(count, np.bool_), np.zeros(count, np.bool_)
        # angles of the wheels before the last steps, at the index of the tick modulo their number
        self._recent, self._first_tick = np.zeros((count, _WINDOW, 2)), np.zeros(count, np.int64)

    @staticmethod
    def wheels_of(plugin: DiffDrive) -> list[Wheel]:
        return [
            Wheel(plugin.sim.joint(name), servo, side, plugin._separation, plugin._radius)
            for side, names, servos in zip((-1.0, 1.0), plugin._joint_names, plugin._servos, strict=True)
            for name, servo in zip(names, servos, strict=True)
        ]

    def take(self, row: int, tick: int) -> None:
        plugin = self.plugin
        self.command[row], self._last[row], self._before_last[row] = plugin._target, plugin._last, plugin._before_last
        self._settled[row], self._enabled[row] = plugin._settled, plugin._enabled
        if plugin._noisy is not None:
            self._take_noise(row, plugin._noisy, plugin._last_ns)
        elif self.observes_wheels:
            self._take_odometry(row, tick, plugin._odometry)

    def _take_odometry(self, row: int, tick: int, odometry: WheelOdometry) -> None:
        """Copy the stored angles, and integrate them up to the last complete arc."""
        odometry.catch_up()
        noted, present = odometry._noted, wheel_angles(*self.plugin._pair)
        self._reckonings[row] = copy.copy(odometry.reckoning)
        self._angles[row] = odometry._at if odometry._at is not None else (*noted, present)[0]
        for angles in (*noted, present)[_STRIDE::_STRIDE]:
            self._roll(np.array([row]), np.array([angles]))
        recent = [*odometry._recent, *noted][-_WINDOW:]
        self._first_tick[row] = tick - len(recent)
        self._recent[row] = (*recent, present)[0]
        for back, angles in enumerate((present, *reversed(recent))):
            if back < _WINDOW:  # the present angles take the place of the oldest ones
                self._recent[row, (tick - back) % _WINDOW] = angles

    # ------------------------------------------------------------------ steps

    def aim(self, ids: Ids, forward: Floats, turn: Floats) -> None:
        is_on = self._enabled[ids]
        super().aim(ids[is_on], forward[is_on], turn[is_on])
        self._settled[ids[is_on]] = False

    def next_stop(self, ids: Ids, tick: int) -> int:
        if not self._settled[ids].all():
            return tick + 1
        return next_odometry_tick(self.grid, tick) if self.observes_wheels else NEVER

    def before_step(self, ids: Ids, ticks: Ticks) -> None:
        """Advance the limited speeds by one step towards the command."""
        ids = ids[~self._settled[ids]]
        if not len(ids):
            return
        last, before_last = self._last[ids], self._before_last[ids]
        speeds = self._limiters.limit(self.command[ids], last, before_last, self._step)
        self._settled[ids] = ((speeds == last) & (last == before_last)).all(axis=1)
        self._before_last[ids], self._last[ids] = last, speeds
        rims = self._rims(speeds)
        self._turn_wheels(ids, rims, np.ones(rims.shape, np.bool_))

    def after_step(self, ids: Ids, ticks: Ticks) -> None:
        tick = int(ticks[0])
        if not self.observes_wheels or next_odometry_tick(self.grid, tick - 1) != tick:
            return
        is_message = is_due(self.grid, tick)
        if self._noisy:
            if is_message:
                self._store_with_noise(ids, ticks)
            return
        slots, angles = ticks % _WINDOW, self._wheel_angles(ids)
        if is_message or (tick - last_due(self.grid, tick)) % _STRIDE == 0:
            self._roll(ids, angles)
        if is_message:
            elapsed = np.minimum(_WINDOW, ticks - self._first_tick[ids]) * self._step
            self._store(ids, (angles - self._recent[ids, slots]) * self._radius, elapsed)
        self._recent[ids, slots] = angles

    def outputs(self) -> Iterable[tuple[Any, Read, bool]]:
        plugin = self.plugin
        yield plugin._odom, self.read_wheels, False
        yield plugin._truth, true_odometry(self._view, plugin._true), False


DRIVE_ARRAYS: Final[Mapping[type, type[DriveArrays]]] = {
    GazeboRosDiffDrive: ClassicDriveArrays,
    GazeboRosSkidSteerDrive: ClassicDriveArrays,
    DiffDrive: GazeboDriveArrays,
}
"""Arrays of each class of drives; a derived class may behave differently and needs an entry of its own."""


def true_odometry(view: ArrayView, motion: TrueMotion) -> Read:
    """Return the function that reads the ground truth of a model, with the numbers of an observed odometry."""
    name, link, arm = motion._frame.scoped, motion._link.scoped, np.array(motion._arm)

    def read(ids: Ids) -> Floats:
        position, quaternion = view.position(name)[ids], view.quaternion(name)[ids]
        linear = _rotate_back(quaternion, view.linear_velocity(link)[ids])
        spin = _rotate_back(quaternion, view.angular_velocity(link)[ids])
        linear = linear + np.cross(spin, arm)
        w, x, y, z = quaternion.T
        yaw = arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
        return np.column_stack((position[:, 0], position[:, 1], yaw, linear[:, 0], linear[:, 1], spin[:, 2]))

    return read


def _rotate_back(quaternions: Floats, vectors: Floats) -> Floats:
    """Rotate vectors by the inverses of unit quaternions w, x, y, z."""
    w, v = quaternions[:, :1], -quaternions[:, 1:]
    twice = 2.0 * np.cross(v, vectors)
    found: Floats = vectors + w * twice + np.cross(v, twice)
    return found
