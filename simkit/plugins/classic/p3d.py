"""Ground truth pose of a link as odometry in Gazebo Classic, in both spellings: `libgazebo_ros_p3d.so`."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from simkit.diagnostics import did_you_mean
from simkit.linear_algebra import norm
from simkit.params import Params
from simkit.plugins.base import ModelPlugin
from simkit.plugins.drives.odometry_messages import ODOMETRY, BodyTwist, odometry_message
from simkit.plugins.endpoints import publishes
from simkit.plugins.find_entities import find_named_link
from simkit.plugins.options import Options, OptionsOf, number, text, vector3, without_effect
from simkit.plugins.publish_on_demand import count_instants, publish_while_subscribed
from simkit.pose import Pose, Vector, quat_conjugate, quat_from_rpy, quat_multiply, quat_rotate

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.runtime import Model
    from simkit.scene import SceneModel

_INERTIAL = {"world", "map"}


class GazeboRosP3DOptions(Options):
    """Options of `GazeboRosP3D`."""

    ros_1_marks = ("robotNamespace", "bodyName", "topicName", "frameName", "gaussianNoise", "updateRate")

    body_name: str = text(required=True, ros_1="bodyName")
    topic_name: str = text(element="topicName", required=True)
    frame_name: str = text("world", ros_1="frameName")
    always_on: bool = without_effect(ros_1="alwaysOn")
    gaussian_noise: float = number(0.0, minimum=0.0, maximum=1e100, ros_1="gaussianNoise")
    update_rate: float = number(0.0, "Hz", minimum=0.0, ros_1="updateRate")
    xyz_offsets: tuple[float, float, float] = vector3(unit="m", ros_1="xyzOffset")
    xyz_offset: tuple[float, float, float] = vector3(unit="m", instead="xyz_offsets", ros_1="xyzOffset")
    rpy_offsets: tuple[float, float, float] = vector3(unit="rad", ros_1="rpyOffset")
    rpy_offset: tuple[float, float, float] = vector3(unit="rad", instead="rpy_offsets", ros_1="rpyOffset")


class GazeboRosP3D(ModelPlugin):
    """Publishes the true pose and twist of the link `<body_name>` on `odom` (ROS 1: `<topicName>`).

    Pose and twist are in the world's axes. If `<frame_name>` names a link, they are relative to that link and in its
    axes. The linear velocity is measured at the origin of `<body_name>`. The twist is never in the axes of
    `<body_name>`. `<xyz_offset>` is added to the position, along the axes of the frame, and `<rpy_offset>` turns the
    orientation about them; neither changes the twist. `<gaussian_noise>` is the standard deviation of the noise on each
    component of the twist [m/s, rad/s]; its square is on the diagonals of both covariances. `<update_rate>` is in Hz; 0
    means every step.

    If `<frame_name>` is a rotating link, Gazebo multiplies orientations in the wrong order, turns velocities in the
    wrong direction and omits the velocity due to the rotation. In simkit the twist is the rate of change of the pose.
    """

    endpoints = (publishes("odom", ODOMETRY, named_by=("topicName",)),)
    options = OptionsOf(GazeboRosP3DOptions)
    filenames = ("libgazebo_ros_p3d.so",)
    only_publishes = True

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        options = self.options
        self._frame = options.frame_name.strip("/")
        self._topic = options.topic_name if options.is_ros_1 else "odom"
        _ = options.always_on
        self._deviation, self._rate = options.gaussian_noise, options.update_rate
        self._shift, self._turn = np.array(options.xyz_offset), quat_from_rpy(*options.rpy_offset)
        self._is_shifted = bool(self._shift.any()) or self._turn.tolist() != [1.0, 0.0, 0.0, 0.0]
        self._body = find_named_link(scene, options.element_of("body_name"), params)
        self._reference = self._find_reference(scene, self._frame, params)

    def _find_reference(self, scene: SceneModel, frame: str, params: Params) -> str:
        """Return the scoped name of the link whose frame the poses use; empty for the world."""
        if frame in _INERTIAL:
            return ""
        links = {link.name: link.scoped for link in scene.all_links()}
        links |= {link.scoped.removeprefix(f"{scene.scoped}::"): link.scoped for link in scene.all_links()}
        if frame not in links:
            message = f"plugin {self.name!r}: frame {frame!r} is not a link of model {scene.scoped!r}"
            hint = did_you_mean(frame, [*links, *_INERTIAL])
            params.diagnostics.warning("SK-PLUGIN-054", f"{message}; poses are in the world frame", self.where, hint)
        return links.get(frame, "")

    def load(self, parent: Model, params: Params) -> None:
        self._link = self.sim.link(self._body)
        self._base = self.sim.link(self._reference) if self._reference else None
        self._stream = self.random("gaussian_noise", 6) if self._deviation > 0 else None
        self._spread = np.diag([self._deviation**2] * 6).reshape(36)
        self._out = self.advertise(self._topic, ODOMETRY)
        publish_while_subscribed(self, self._out, self._rate, "publish")

    def publish(self) -> None:
        """Publish the odometry."""
        pose, motion = self._reading()
        # the noise depends on this number of instants, and therefore not on the subscribers
        index = count_instants(self, self._rate)
        self._out.publish_later(partial(self._message, self.sim.time_ns, pose, motion, index))

    def _reading(self) -> tuple[Pose, Vector]:
        """Return the pose with its offset, and the twist (linear, angular), both in the axes of `<frame_name>`."""
        link, base = self._link, self._base
        pose, velocity = link.pose, link.spatial_velocity()
        linear, angular = velocity[3:], velocity[:3]
        if base is not None:
            frame, turning = base.pose, base.angular_velocity
            back = quat_conjugate(frame.quaternion)
            carried = base.linear_velocity + np.cross(turning, pose.position - frame.position)
            linear, angular = quat_rotate(back, linear - carried), quat_rotate(back, angular - turning)
            pose = frame.inverse() @ pose
        if not self._is_shifted and _is_unchanged_by_zero_offset(pose):
            return pose, np.concatenate((linear, angular))
        shifted = Pose(pose.position + self._shift, quat_multiply(self._turn, pose.quaternion))
        return shifted, np.concatenate((linear, angular))

    def _message(self, time_ns: int, pose: Pose, motion: Vector, index: int) -> object:
        if self._stream is not None:
            motion = motion + self._deviation * self._stream.normal(index)
        twist = BodyTwist(motion[:3].tolist(), motion[3:].tolist())
        return odometry_message(time_ns, self._frame, self._link.name, pose, twist, self._spread)


def _is_unchanged_by_zero_offset(pose: Pose) -> bool:
    """Check whether a zero offset changes no bit of a pose: no number is zero, and the quaternion is unit."""
    turn = pose.quaternion
    return abs(norm(turn) - 1.0) <= 1e-15 and bool(pose.position.all() and turn.all())
