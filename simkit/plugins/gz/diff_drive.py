"""Differential drive of Gazebo, also with several wheels on each side: `gz::sim::systems::DiffDrive`."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from simkit.msgs.topic_names import valid_topic
from simkit.params import Params
from simkit.plugins.drives.odometry import LONGEST, MEAN_STEPS, TrueMotion, WheelOdometry, wheel_angles
from simkit.plugins.drives.odometry_messages import ODOMETRY, odometry_message, planar_odometry, planar_transform
from simkit.plugins.drives.odometry_noise import NoisyOdometry, OdometryNoiseOptions, odometry_noise
from simkit.plugins.drives.speed_limits import speed_limits
from simkit.plugins.drives.twist_drive import Speeds, TwistDrive, WheeledDriveOptions
from simkit.plugins.options import OptionsOf, block, boolean, texts
from simkit.pose import Pose, Vector

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.msgs import Bool
    from simkit.runtime import Model
    from simkit.scene import SceneModel


class DiffDriveOptions(WheeledDriveOptions):
    """Options of `DiffDrive`."""

    left_joint: tuple[str, ...] = texts(required=True)
    right_joint: tuple[str, ...] = texts(required=True)
    odometry_noise: OdometryNoiseOptions = block(OdometryNoiseOptions)
    publish_ground_truth: bool = boolean()


class DiffDrive(TwistDrive):
    """Drives the wheels from `/model/<model>/cmd_vel`, and publishes wheel odometry on `/model/<model>/odometry`.

    The odometry is computed from the first pair of wheels. Its pose starts at zero and describes the point between
    these wheels. Its twist is the mean over the last ten steps. Two options do not exist in Gazebo.
    `<publish_ground_truth>` publishes the true pose on `/model/<model>/ground_truth/odom`. `<odometry_noise>` adds
    errors to the odometry, with their covariance.
    """

    options = OptionsOf(DiffDriveOptions)
    filenames = ("gz-sim-diff-drive-system",)
    names = ("gz::sim::systems::DiffDrive",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        self._separation = self.options.wheel_separation
        self._radius = self.options.wheel_radius
        self._limiters = speed_limits(self.options)
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
        truth = valid_topic(f"/model/{parent.name}/ground_truth/odom")
        self._truth = self.advertise(truth, ODOMETRY) if self.options.publish_ground_truth else None

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
        half = angular * self._separation / 2
        self.turn_wheels((linear - half, linear + half))

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
        if self._truth is not None and self._truth.wanted:
            self._truth.publish(odometry_message(now, "world", self._child, *self._true.state()))


class DriveFleet:
    """Group of all drives of a simulation in document order, whose wheels are read with one array operation."""

    def __init__(self, drives: Sequence[DiffDrive]) -> None:
        self._drives, self._sim = list(drives), drives[0].sim
        self._physics = self._sim.engine.physics
        self._wheels = np.array([wheel._first_qpos for drive in drives for wheel in drive._pair], dtype=np.intp)
        self._rows: list[Vector] = []
        self._odometries = [drive._odometry for drive in drives]
        for odometry in self._odometries:
            odometry.catch_up()  # with the angles that the previous fleet has stored for this drive
            odometry.noter = self.hand_over
        self._radius = np.array([odometry._radius for odometry in self._odometries])
        self._separation = np.array([odometry._separation for odometry in self._odometries])
        # wheel angles after the last integration, and at the steps before
        self._reckoned: tuple[Vector, list[Vector]] | None = None
        self._twists: list[tuple[float, float]] = []

    def holds(self, drives: Sequence[DiffDrive]) -> bool:
        """Check whether the fleet consists of these drives with their current odometry objects."""
        return len(drives) == len(self._drives) and all(
            drive is mine and drive._odometry is odometry
            for drive, mine, odometry in zip(drives, self._drives, self._odometries, strict=True)
        )

    # ------------------------------------------------------------------ before a step

    def before_step(self, rota: Iterable[DiffDrive]) -> None:
        """Run `DiffDrive.before_step` for all drives."""
        if self._drives[0]._odometry is not self._odometries[0]:
            for drive in rota:  # a state was restored, and the schedule still has the fleet of the old odometry objects
                drive.before_step()
            return
        self._rows.append(self._physics.data.qpos.take(self._wheels))
        if len(self._rows) >= LONGEST:
            self.hand_over()
        if [True for drive in self._drives if not drive._settled]:
            for drive in rota:
                if not drive._settled:
                    drive._command()

    # ------------------------------------------------------------------ after a step

    def after_step(self, rota: Iterable[DiffDrive]) -> None:
        """Run `DiffDrive.after_step` for all drives."""
        if self._drives[0]._odometry is not self._odometries[0] or not self._take_over():
            for drive in rota:
                drive.after_step()
            return
        self._reckon()
        now, physics, tick = self._sim.time_ns, self._physics, self._physics.tick
        for drive, odometry, twist in zip(rota, self._odometries, self._twists, strict=True):
            way, odom, tf = odometry.reckoning, drive._odom, drive._tf
            fields = now, drive._frame, drive._child, way.x, way.y, way.yaw
            if odom.wanted:
                odom.publish_later(partial(planar_odometry, *fields, *twist))
            if tf.wanted:
                tf.publish_later(partial(planar_transform, *fields))
            if drive._truth is not None and drive._truth.wanted:
                drive._truth.publish(odometry_message(now, "world", drive._child, *drive._true.state()))
            if physics.tick != tick:  # a subscriber restored another state
                return

    def _take_over(self) -> bool:
        """Copy the state of the odometries into the fleet, which then continues their integration.

        Returns:
            False if the fleet cannot integrate: the odometries have different numbers of stored steps, or one has
                noise.
        """
        if self._reckoned is not None:
            return True
        first, all_of = self._odometries[0], self._odometries
        if first._at is None or first._noted or not first._recent:
            return False
        for drive, odometry in zip(self._drives, all_of, strict=True):
            alike = odometry._at is not None and len(odometry._recent) == len(first._recent)
            if not alike or odometry._noted or drive._noisy is not None:
                return False
        at = np.array([odometry._at for odometry in all_of]).reshape(-1)
        recent = np.array([odometry._recent for odometry in all_of])  # drive, step, wheel
        self._reckoned = at, list(recent.transpose(1, 0, 2).reshape(len(first._recent), -1))
        return True

    def _reckon(self) -> None:
        """Integrate the odometry of all drives, with the same results as `WheelOdometry.reckon`."""
        assert self._reckoned is not None
        (last, recent), rows = self._reckoned, self._rows
        mean, step = MEAN_STEPS, self._odometries[0]._step
        angles = self._physics.data.qpos.take(self._wheels)
        for point in (*rows[mean::mean], angles):
            rolled = (point - last).reshape(-1, 2) * self._radius[:, None]
            for odometry, (left, right) in zip(self._odometries, rolled.tolist(), strict=True):
                odometry.reckoning.advance(left, right, odometry._separation)
            last = point
        recent = [*recent, *rows][-mean:]
        self._reckoned, self._rows = (angles, recent), []
        left, right = ((angles - recent[0]).reshape(-1, 2) * self._radius[:, None]).T
        elapsed = len(recent) * step
        ahead, turn = (left + right) / 2 / elapsed, (right - left) / self._separation / elapsed
        self._twists = list(zip(ahead.tolist(), turn.tolist(), strict=True))

    # ------------------------------------------------------------------ results for the odometries

    def hand_over(self) -> None:
        """Copy the fleet's stored angles and results into the odometry of each drive."""
        held, self._reckoned = self._reckoned, None
        if held is not None:
            ends, before = held[0].reshape(-1, 2).tolist(), np.stack(held[1]).reshape(len(held[1]), -1, 2)
            recent = before.transpose(1, 0, 2).tolist()
            for odometry, end, steps, twist in zip(self._odometries, ends, recent, self._twists, strict=True):
                odometry.take((end[0], end[1]), [(left, right) for left, right in steps], twist)
        if self._rows:
            columns = np.stack(self._rows).reshape(len(self._rows), -1, 2).transpose(1, 0, 2).tolist()
            self._rows = []
            for odometry, steps in zip(self._odometries, columns, strict=True):
                odometry.note_all([(left, right) for left, right in steps])


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
