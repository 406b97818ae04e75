"""Odometry of Gazebo from the true motion: `gz::sim::systems::OdometryPublisher`."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

import mujoco
import numpy as np

from simkit.params import LARGEST, Params
from simkit.plugins.base import ModelPlugin
from simkit.plugins.drives.odometry import MEAN_STEPS, TrueMotion
from simkit.plugins.drives.odometry_messages import ODOMETRY, TRANSFORMS, BodyTwist, odometry_message, transforms
from simkit.plugins.drives.odometry_noise import ErringOdometry, WheellessOdometryNoiseOptions, odometry_noise
from simkit.plugins.find_entities import read_topic
from simkit.plugins.options import Options, OptionsOf, block, integer, number, text, vector3
from simkit.pose import IDENTITY, Pose, Vector, quat_conjugate, quat_from_rpy, quat_multiply, quat_rotate
from simkit.runtime.array_rules import CannotBatchError, Floats, Ids, PluginRule, Ticks, TopicRule, next_due

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.runtime import Model
    from simkit.runtime.state_arrays import StateArrays
    from simkit.scene import SceneModel


class OdometryPublisherOptions(Options):
    """Options of `OdometryPublisher`."""

    dimensions: int = integer(2)
    odom_publish_frequency: float = number(50.0, "Hz", minimum=0)
    rpy_offset: tuple[float, float, float] = vector3(unit="rad")
    xyz_offset: tuple[float, float, float] = vector3(unit="m")
    gaussian_noise: float = number(0.0, minimum=0.0, maximum=LARGEST)
    odom_covariance_topic: str = text()
    odom_topic: str = text()
    tf_topic: str = text()
    odometry_noise: WheellessOdometryNoiseOptions = block(WheellessOdometryNoiseOptions)


class OdometryPublisher(ModelPlugin):
    """Publishes the true pose and motion of the model in the world, as odometry and as a transform.

    With two dimensions (the default), the height and all motion out of the plane are zero, but the orientation has all
    three angles. `<xyz_offset>` and `<rpy_offset>` are the pose of the base frame in the model. `<gaussian_noise>` is
    the standard deviation of the noise on each component of the twist [m/s, rad/s]; its square is on the diagonals of
    the odometry with covariance. The twist is the mean over the last ten steps, as in Gazebo, which is a delay of 4.5
    steps. `<odometry_noise>` (simkit's own) replaces pose and twist by those of wheels with errors.
    """

    options = OptionsOf(OdometryPublisherOptions)
    filenames = ("gz-sim-odometry-publisher-system",)
    names = ("gz::sim::systems::OdometryPublisher",)
    only_publishes = True

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        self._canonical = scene.canonical_link
        self._dimensions = self.options.dimensions
        if self._dimensions not in (2, 3):
            element = params.child("dimensions") or params
            element.error("SK-PARAM-002", f"found <dimensions>{self._dimensions}</dimensions>; expected 2 or 3")
        # a frequency of zero means every step, as in Gazebo
        self.after_step_rate = self.options.odom_publish_frequency
        turn = quat_from_rpy(*self.options.rpy_offset)
        self._offset = Pose(self.options.xyz_offset, turn)
        self._noise = self.options.gaussian_noise

    def load(self, parent: Model, params: Params) -> None:
        model_topic = f"/model/{parent.name}"
        self._frame = params.text("odom_frame", f"{parent.name}/odom")
        self._base = params.text("robot_base_frame", f"{parent.name}/base_footprint")
        self._true = TrueMotion(parent, self.sim.link(self._canonical))
        self._trail: deque[tuple[float, ...]] = deque(maxlen=MEAN_STEPS)
        self._stream = self.random("gaussian_noise", 6) if self._noise > 0 else None
        self._index = 0
        self._erring: ErringOdometry | None = None
        noise = odometry_noise(self.options.odometry_noise)
        if noise is not None:
            sizes = self.options.odometry_noise.wheel_radius, self.options.odometry_noise.wheel_separation
            stream = self.random("odometry_noise", 2)
            self._erring = ErringOdometry(noise, *sizes, stream, self._reading()[0], self.sim.time_ns)
        covariance = read_topic(params, "odom_covariance_topic", f"{model_topic}/odometry_with_covariance")
        self._odom = self.advertise(read_topic(params, "odom_topic", f"{model_topic}/odometry"), ODOMETRY)
        self._noisy = self.advertise(covariance, ODOMETRY)
        self._tf = self.advertise(read_topic(params, "tf_topic", f"{model_topic}/pose"), TRANSFORMS)
        self._tf.present = lambda: transforms(self.sim.time_ns, (self._frame, self._base, self._present_pose()))

    def before_step(self) -> None:
        """Store the pose of the model."""
        self._trail.append(self._true.place())

    def after_step(self) -> None:
        """Publish odometry and its transform."""
        self._index += 1  # counted even without subscribers, because the noise depends on this number
        erring = self._erring
        spread: tuple[Vector, ...] = ()
        if erring is not None:
            erring.follow(self._reading()[0], self.sim.time_ns)
            spread = erring.covariances
        if not (self._odom.wanted or self._noisy.wanted or self._tf.wanted):
            return
        now, (pose, twist) = self.sim.time_ns, self._reading()
        if erring is not None:
            pose, twist = erring.pose(pose), erring.twist
        if self._odom.wanted:
            self._odom.publish_later(partial(odometry_message, now, self._frame, self._base, pose, twist))
        if self._noisy.wanted:
            spread = spread or (np.diag([self._noise**2] * 6).reshape(36),)
            self._noisy.publish_later(partial(odometry_message, now, self._frame, self._base, pose, twist, *spread))
        if self._tf.wanted:
            self._tf.publish_later(partial(transforms, now, (self._frame, self._base, pose)))

    def _present_pose(self) -> Pose:
        pose = self._reading()[0]
        return pose if self._erring is None else self._erring.pose(pose)

    def _reading(self) -> tuple[Pose, BodyTwist]:
        return self.reading_of(np.array((*self._trail, self._true.place())))

    def reading_of(self, trail: Vector) -> tuple[Pose, BodyTwist]:
        """Return the base frame's world pose, and its mean twist in the base frame's axes.

        Args:
            trail: poses of the model (x, y, z, qw, qx, qy, qz) before the last steps and at present, shape (n, 7).
        """
        positions, turns = self._base_frames(trail)
        pose = Pose(positions[-1], turns[-1])
        linear, angular = self._mean_twist(positions, turns) if len(trail) > 1 else (np.zeros(3), np.zeros(3))
        if self._dimensions == 2:
            linear, angular = linear * (1.0, 1.0, 0.0), angular * (0.0, 0.0, 1.0)
            x, y, _ = pose.position
            pose = Pose((x, y, 0.0), pose.quaternion)
        noise: Vector = np.zeros(6) if self._stream is None else self._noise * self._stream.normal(self._index)
        return pose, BodyTwist((linear + noise[:3]).tolist(), (angular + noise[3:]).tolist())

    def _base_frames(self, trail: Vector) -> tuple[Vector, Vector]:
        """Return positions (n, 3) and quaternions (n, 4) of the base frame for poses (n, 7) of the model."""
        if self._offset == IDENTITY:
            return trail[:, :3], trail[:, 3:]
        poses = [Pose(row[:3], row[3:]) @ self._offset for row in trail]
        return np.array([p.position for p in poses]), np.array([p.quaternion for p in poses])

    def _mean_twist(self, positions: Vector, turns: Vector) -> tuple[Vector, Vector]:
        """Return the mean linear and angular velocity of several steps.

        The velocity of each step is in the base frame's axes at the end of that step. With two dimensions these axes
        are turned by the yaw alone.
        """
        step = self.period
        linear, angular = np.zeros(3), np.zeros(3)
        for k in range(1, len(turns)):
            back = quat_conjugate(turns[k])
            # the rotation axis has the same components in the frames before and after the step
            turned = np.empty(3)
            mujoco.mju_quat2Vel(turned, quat_multiply(quat_conjugate(turns[k - 1]), turns[k]), step)
            angular += turned
            if self._dimensions == 2:
                back = quat_from_rpy(0.0, 0.0, -Pose((0.0, 0.0, 0.0), turns[k]).rpy[2])
            linear += quat_rotate(back, positions[k] - positions[k - 1]) / step
        count = len(turns) - 1
        return linear / count, angular / count

    def array_rule(self) -> OdometryPublisherRule:
        return OdometryPublisherRule(self)


class OdometryPublisherRule(PluginRule):
    """Odometry from the true motion in n simulations."""

    reads_poses = False

    def __init__(self, plugin: OdometryPublisher) -> None:
        self._plugin = plugin

    def bind(self, states: StateArrays) -> None:
        self._states = states

    def reading(self, topic: str) -> TopicRule | None:
        plugin = self._plugin
        if topic not in (plugin._odom.topic, plugin._noisy.topic):
            return None
        poses = plugin._true.place_rows(self._states)
        if plugin._stream is not None or plugin._erring is not None:
            name = "gaussian_noise" if plugin._stream is not None else "odometry_noise"
            raise CannotBatchError(f"topic {plugin._odom.topic} with <{name}>")
        return MeanMotionRows(plugin, self._states.count, poses)


class MeanMotionRows(TopicRule):
    """Pose of a model and its mean twist over the last steps, in n simulations.

    Args:
        plugin: publisher of the simulation that resets all others.
        count: number of simulations.
        poses: function that returns the present poses of the model (x, y, z, qw, qx, qy, qz) in some simulations.
    """

    def __init__(self, plugin: OdometryPublisher, count: int, poses: Callable[[Ids], Floats]) -> None:
        self.grid = plugin.sim.engine.clock.grid(plugin.after_step_rate or 0.0)
        self._plugin, self._poses = plugin, poses
        # poses before the last steps, at the index of the tick modulo their number
        self._trails, self._first_tick = np.zeros((count, MEAN_STEPS, 7)), np.zeros(count, np.int64)

    def take(self, row: int) -> None:
        trail, tick = self._plugin._trail, self._plugin.sim.tick
        self._first_tick[row] = tick - len(trail)
        for back, pose in enumerate((self._plugin._true.place(), *reversed(trail))):
            if back < MEAN_STEPS:  # the present pose takes the place of the oldest one
                self._trails[row, (tick - back) % MEAN_STEPS] = pose

    def next_stop(self, tick: int) -> int:
        return max(tick + 1, next_due(self.grid, tick) - MEAN_STEPS)

    def note(self, ids: Ids, ticks: Ticks) -> None:
        self._trails[ids, ticks % MEAN_STEPS] = self._poses(ids)

    def read(self, ids: Ids, ticks: Ticks) -> Floats:
        values = np.zeros((len(ids), 6))
        for values_of_row, row, tick, pose in zip(values, ids.tolist(), ticks.tolist(), self._poses(ids), strict=True):
            before = range(max(tick - MEAN_STEPS, int(self._first_tick[row])), tick)
            trail = np.vstack((*(self._trails[row, k % MEAN_STEPS] for k in before), pose))
            place, twist = self._plugin.reading_of(trail)
            yaw = Pose((0.0, 0.0, 0.0), place.quaternion).rpy[2]  # of the quaternion that the message would have
            values_of_row[:] = *place.position[:2], yaw, *twist.linear[:2], twist.angular[2]
        return values
