"""Odometry of Gazebo from the true motion: `gz::sim::systems::OdometryPublisher`."""

from __future__ import annotations

from collections import deque
from functools import partial
from typing import TYPE_CHECKING

import mujoco
import numpy as np

from simkit.params import LARGEST, Params
from simkit.plugins.base import ModelPlugin
from simkit.plugins.drives.odometry import MEAN_STEPS, BodyTwist, TrueMotion
from simkit.plugins.drives.odometry_messages import ODOMETRY, TRANSFORMS, odometry_message, transforms
from simkit.plugins.find_entities import read_topic
from simkit.plugins.options import Options, OptionsOf, integer, number, text, vector3
from simkit.pose import IDENTITY, Pose, Vector, quat_conjugate, quat_from_rpy, quat_multiply, quat_rotate

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.runtime import Model
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


class OdometryPublisher(ModelPlugin):
    """Publishes the true pose and motion of the model in the world, as odometry and as a transform.

    With two dimensions (the default), the height and all motion out of the plane are zero, but the orientation has all
    three angles. `<xyz_offset>` and `<rpy_offset>` are the pose of the base frame in the model. `<gaussian_noise>` is
    the standard deviation of the noise on each component of the twist [m/s, rad/s]; its square is on the diagonals of
    the odometry with covariance. The twist is the mean over the last ten steps, as in Gazebo, which is a delay of 4.5
    steps.
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
        own = f"/model/{parent.name}"
        self._frame = params.text("odom_frame", f"{parent.name}/odom")
        self._base = params.text("robot_base_frame", f"{parent.name}/base_footprint")
        self._true = TrueMotion(parent, self.sim.link(self._canonical))
        self._trail: deque[tuple[float, ...]] = deque(maxlen=MEAN_STEPS)
        self._stream = self.random("gaussian_noise", 6) if self._noise > 0 else None
        self._index = 0
        covariance = read_topic(params, "odom_covariance_topic", f"{own}/odometry_with_covariance")
        self._odom = self.advertise(read_topic(params, "odom_topic", f"{own}/odometry"), ODOMETRY)
        self._noisy = self.advertise(covariance, ODOMETRY)
        self._tf = self.advertise(read_topic(params, "tf_topic", f"{own}/pose"), TRANSFORMS)
        self._tf.present = lambda: transforms(self.sim.time_ns, (self._frame, self._base, self._reading()[0]))

    def before_step(self) -> None:
        """Store the pose of the model."""
        self._trail.append(self._true.place())

    def after_step(self) -> None:
        """Publish odometry and its transform."""
        self._index += 1  # counted even without subscribers, because the noise depends on this number
        if not (self._odom.wanted or self._noisy.wanted or self._tf.wanted):
            return
        now, (pose, twist) = self.sim.time_ns, self._reading()
        if self._odom.wanted:
            self._odom.publish_later(partial(odometry_message, now, self._frame, self._base, pose, twist))
        if self._noisy.wanted:
            spread = np.diag([self._noise**2] * 6).reshape(36)
            self._noisy.publish_later(partial(odometry_message, now, self._frame, self._base, pose, twist, spread))
        if self._tf.wanted:
            self._tf.publish_later(partial(transforms, now, (self._frame, self._base, pose)))

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
