"""Differential drive of Gazebo, also with several wheels on each side: `gz::sim::systems::DiffDrive`."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from simkit.msgs.topic_names import valid_topic
from simkit.params import Params
from simkit.plugins.drives.drive_rule import DifferentialDriveRule, DriveWheel
from simkit.plugins.drives.ground_truth import GroundTruth
from simkit.plugins.drives.odometry import FleetOdometry, TrueMotion, WheelOdometry, WheelOdometryRows, rim_speeds
from simkit.plugins.drives.odometry_messages import planar_odometry, planar_transform
from simkit.plugins.drives.odometry_noise import NoisyOdometry, odometry_noise
from simkit.plugins.drives.speed_limits import limit_each, speed_limits
from simkit.plugins.drives.twist_drive import Speeds, TwistDrive, WheeledDriveOptions
from simkit.plugins.options import OptionsOf, boolean, texts
from simkit.pose import Pose
from simkit.runtime.array_rules import NEVER, CannotBatchError, Floats, Ids, Ticks, TopicRule, is_due
from simkit.runtime.handles.joint import wheel_angles

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.msgs import Bool
    from simkit.runtime import Model
    from simkit.runtime.state_arrays import StateArrays
    from simkit.scene import SceneModel


class DiffDriveOptions(WheeledDriveOptions):
    """Options of `DiffDrive`."""

    left_joint: tuple[str, ...] = texts(required=True)
    right_joint: tuple[str, ...] = texts(required=True)
    publish_ground_truth: bool = boolean()


class DiffDrive(TwistDrive):
    """Drives the wheels from `/model/<model>/cmd_vel`, and publishes wheel odometry on `/model/<model>/odometry`.

    The odometry is computed from the first pair of wheels. Its pose starts at zero and describes the point between
    these wheels. Its twist is the mean over the last ten steps. Three options do not exist in Gazebo.
    `<publish_ground_truth>` publishes the true pose on `/model/<model>/ground_truth/odom`, and the slip of the wheels
    on `/model/<model>/ground_truth/wheel_slip`. `<odometry_noise>` adds errors to the odometry, with their covariance.
    `<actuation_error>` makes the wheels turn faster or slower.
    """

    options = OptionsOf(DiffDriveOptions)
    filenames = ("gz-sim-diff-drive-system",)
    names = ("gz::sim::systems::DiffDrive",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        self._separation = self.options.wheel_separation
        self._radius = self.options.wheel_radius
        self._limiters = speed_limits(self.options)
        self.actuation = self.options.actuation_error.motion_errors
        self._canonical = scene.canonical_link
        # a frequency of zero means every step, as in Gazebo
        self.after_step_rate = self.options.odom_publish_frequency
        sides = {"left wheel": self.options.left_joint, "right wheel": self.options.right_joint}
        self.add_wheels(scene, builder, sides)

    def load(self, parent: Model, params: Params) -> None:
        self.start()
        self._pair = (self.sim.joint(self._joint_names[0][0]), self.sim.joint(self._joint_names[1][0]))
        self._true = TrueMotion(parent, self.sim.link(self._canonical))
        self._enabled = True
        self._odometry = WheelOdometry(self._radius, self._separation, self.period)
        noise = odometry_noise(self.options.odometry_noise)
        self._noisy: NoisyOdometry | None = None
        if noise is not None:
            stream = self.random("odometry_noise", 2)
            self._noisy = NoisyOdometry(noise, self._radius, self._separation, stream, wheel_angles(*self._pair))
        self._last_ns = self.sim.time_ns
        self.open_topics(parent, params)
        self.listen(valid_topic(f"/model/{parent.name}/enable"), "std_msgs/msg/Bool", self._on_enable)
        joints = [name for side in self._joint_names for name in side]
        truth = parent, self._true, joints, f"{valid_topic(f'/model/{parent.name}')}/", self._child
        self._truth = GroundTruth(self, *truth) if self.options.publish_ground_truth else None

    # ------------------------------------------------------------------ commands

    def speed_bounds(self, _: str) -> tuple[tuple[float, float], tuple[float, float]]:
        """Return the limits of the commands: smallest and largest forward speed [m/s] and turning rate [rad/s]."""
        linear, angular = self._limiters
        return linear.velocity, angular.velocity

    def aim(self, speeds: Speeds) -> None:
        if self._enabled:
            super().aim(speeds)

    def _on_enable(self, message: Bool) -> None:
        self._enabled = bool(message.data)
        if not self._enabled:
            super().aim((0.0, 0.0))

    def before_step(self) -> None:
        """Store the wheel angles, and advance the limited speeds by one step towards the command."""
        self._odometry.note(wheel_angles(*self._pair))
        if not self._settled:
            self._command()

    @classmethod
    def before_step_together(cls, drives: Sequence[DiffDrive]) -> Callable[[Iterable[DiffDrive]], None]:
        """Return a function that runs `before_step` of many drives at once."""
        return DriveFleet(drives).before_step

    @classmethod
    def after_step_together(cls, drives: Sequence[DiffDrive]) -> Callable[[Iterable[DiffDrive]], None]:
        """Return a function that runs `after_step` of many drives at once."""
        return fleet_of(drives).after_step

    def _command(self) -> None:
        linear, angular = self.next_speeds()
        self.turn_wheels(rim_speeds(linear, angular, self._separation))

    # ------------------------------------------------------------------ readings

    def odometry_pose(self) -> Pose:
        return (self._noisy or self._odometry).reckoning.pose

    def after_step(self) -> None:
        """Publish odometry and its transform."""
        now, noisy, odometry = self.sim.time_ns, self._noisy, self._odometry
        angles = wheel_angles(*self._pair)
        odometry.reckon(angles)
        if noisy is None:
            self.publish_odometry(odometry.reckoning.pose, odometry.twist)
        else:
            elapsed, self._last_ns = (now - self._last_ns) * 1e-9, now
            noisy.advance(*angles, elapsed)
            covariances = noisy.messages_covariance() if noisy.noise.wheel_variance else ()
            self.publish_odometry(noisy.reckoning.pose, noisy.twist, *covariances)
        if self._truth is not None:
            self._truth.publish()

    def publish_planar(self, ahead: float, turn: float) -> None:
        """Publish the pose of `odometry` and a forward speed [m/s] and turning rate [rad/s], as `after_step` does."""
        way, now = self._odometry.reckoning, self.sim.time_ns
        fields = now, self._frame, self._child, way.x, way.y, way.yaw
        if self._odom.wanted:
            self._odom.publish_later(partial(planar_odometry, *fields, ahead, turn))
        if self._tf.wanted:
            self._tf.publish_later(partial(planar_transform, *fields))
        if self._truth is not None:
            self._truth.publish()

    # ------------------------------------------------------------------ many simulations

    def array_rule(self) -> DiffDriveRule:
        return DiffDriveRule(self)


class DriveFleet:
    """Group of all drives of a simulation in document order, whose wheels are read with one array operation."""

    def __init__(self, drives: Sequence[DiffDrive]) -> None:
        self._drives, self._sim = list(drives), drives[0].sim
        self._physics = self._sim.engine.physics
        names = self._sim.engine.names
        sides = [[names.joint(drive._pair[side].scoped).qpos[0] for drive in drives] for side in (0, 1)]
        self._wheels = np.array(sides, dtype=np.intp)
        self._odometries = [drive._odometry for drive in drives]
        for odometry in self._odometries:
            odometry.catch_up()  # with the angles that the previous fleet has stored for this drive
            odometry.noter = self.hand_over
        self._odometry = FleetOdometry(self._odometries)

    def holds(self, drives: Sequence[DiffDrive]) -> bool:
        """Check whether the fleet consists of these drives with their current odometry objects."""
        return len(drives) == len(self._drives) and all(
            drive is mine and drive._odometry is odometry
            for drive, mine, odometry in zip(drives, self._drives, self._odometries, strict=True)
        )

    def hand_over(self) -> None:
        """Give the odometry of each drive the fleet's stored angles and results."""
        self._odometry.hand_over()

    # ------------------------------------------------------------------ before a step

    def before_step(self, rota: Iterable[DiffDrive]) -> None:
        """Run `DiffDrive.before_step` for all drives."""
        if self._drives[0]._odometry is not self._odometries[0]:
            for drive in rota:  # a state was restored, and the schedule still has the fleet of the old odometry objects
                drive.before_step()
            return
        self._odometry.note(self._physics.data.qpos.take(self._wheels))
        if [True for drive in self._drives if not drive._settled]:
            for drive in rota:
                if not drive._settled:
                    drive._command()

    # ------------------------------------------------------------------ after a step

    def after_step(self, rota: Iterable[DiffDrive]) -> None:
        """Run `DiffDrive.after_step` for all drives."""
        is_restored = self._drives[0]._odometry is not self._odometries[0]
        if is_restored or any(drive._noisy is not None for drive in self._drives) or not self._odometry.join():
            for drive in rota:
                drive.after_step()
            return
        self._odometry.reckon(self._physics.data.qpos.take(self._wheels))
        physics, tick = self._physics, self._physics.tick
        for drive, twist in zip(rota, self._odometry.twists(), strict=True):
            drive.publish_planar(*twist)
            if physics.tick != tick:  # a subscriber restored another state
                return


def fleet_of(drives: Sequence[DiffDrive]) -> DriveFleet:
    """Return the fleet of exactly these drives, or `SeparateReadings` if there is no such fleet."""
    noter = getattr(drives[0]._odometry.noter, "__self__", None)
    return noter if isinstance(noter, DriveFleet) and noter.holds(drives) else SeparateReadings(drives)


class SeparateReadings(DriveFleet):
    """Drives that publish in the same step but are only a part of a fleet; each drive's wheels are read separately."""

    def __init__(self, drives: Sequence[DiffDrive]) -> None:
        self._drives = list(drives)

    def after_step(self, rota: Iterable[DiffDrive]) -> None:
        for drive in rota:
            tick = drive.sim.tick
            drive.after_step()
            if drive.sim.tick != tick:
                return


class DiffDriveRule(DifferentialDriveRule):
    """Drive of Gazebo Sim in n simulations.

    The limited speeds change at every step until they have reached the command.
    """

    def __init__(self, plugin: DiffDrive) -> None:
        wheels = [
            DriveWheel(plugin.sim.joint(name), servo, side, plugin._separation, plugin._radius)
            for side, wheels_of_side in enumerate(plugin.wheels)
            for name, servo in wheels_of_side
        ]
        if plugin.actuation is not None:
            raise CannotBatchError(f"<actuation_error> of plugin {type(plugin).__name__}")
        super().__init__(plugin, plugin.command_topic, wheels)
        self._drive = plugin

    def bind(self, states: StateArrays) -> None:
        super().bind(states)
        count, drive = states.count, self._drive
        self._last, self._before_last = np.zeros((count, 2)), np.zeros((count, 2))
        self._settled, self._enabled = np.zeros(count, np.bool_), np.zeros(count, np.bool_)
        self.odometry: WheelOdometryRows = WheelOdometryRows(
            count, drive._radius, drive._separation, drive.period, self.grid
        )

    def take(self, row: int, tick: int) -> None:
        drive = self._drive
        self.target[row], self._last[row], self._before_last[row] = drive.speed_history
        self._settled[row], self._enabled[row] = drive._settled, drive._enabled
        if drive._noisy is not None:
            self.take_noise(row, drive._noisy, drive._last_ns)
        elif self.observes_wheels:
            self.odometry.take(row, tick, drive._odometry, wheel_angles(*drive._pair))

    # ------------------------------------------------------------------ steps

    def aim(self, ids: Ids, targets: Floats) -> None:
        is_on = self._enabled[ids]
        super().aim(ids[is_on], targets[is_on])
        self._settled[ids[is_on]] = False

    def next_stop(self, ids: Ids, tick: int) -> int:
        if not self._settled[ids].all():
            return tick + 1
        return self.odometry.next_stop(tick) if self.observes_wheels else NEVER

    def before_step(self, ids: Ids, ticks: Ticks) -> None:
        """Advance the limited speeds by one step towards the command."""
        ids = ids[~self._settled[ids]]
        if not len(ids):
            return
        last, before_last, drive = self._last[ids], self._before_last[ids], self._drive
        limited = limit_each(drive._limiters, self.target[ids].T, last.T, before_last.T, drive.period)
        speeds = np.stack(limited, axis=1)
        self._settled[ids] = ((speeds == last) & (last == before_last)).all(axis=1)
        self._before_last[ids], self._last[ids] = last, speeds
        rims = self.rims(speeds)
        self.turn_wheels(ids, rims, np.ones(rims.shape, np.bool_))

    def after_step(self, ids: Ids, ticks: Ticks) -> None:
        if not self.observes_wheels:
            return
        if not self.has_noise:
            self.odometry.note(ids, ticks, self.wheel_angles(ids))
        elif is_due(self.grid, int(ticks[0])):
            self.advance_noise(ids, ticks)

    def reading(self, topic: str) -> TopicRule | None:
        drive = self._drive
        if topic == drive._odom.topic:
            return self.wheel_odometry()
        if drive._truth is not None and topic == drive._truth.odometry_topic:
            return self.true_odometry(drive._true)
        return None
