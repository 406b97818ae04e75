"""Ground truth pose of a link as odometry by PAL: `libgazebo_world_odometry.so`, on PMB2 and the older TIAGo."""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from simkit.params import Params
from simkit.plugins.base import ModelPlugin
from simkit.plugins.drives.odometry_messages import ODOMETRY, BodyTwist, odometry_message
from simkit.plugins.endpoints import publishes
from simkit.plugins.find_entities import find_named_link
from simkit.plugins.options import Options, OptionsOf, number, text
from simkit.plugins.publish_on_demand import count_instants, publish_while_subscribed
from simkit.pose import Pose, Vector, quat_conjugate, quat_from_rpy, quat_rotate

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.runtime import Model
    from simkit.scene import SceneModel


class GazeboWorldOdometryOptions(Options):
    """Options of `GazeboWorldOdometry`."""

    frame_name: str = text("world", ros_1="frameName")
    body_name: str = text(required=True, ros_1="bodyName")
    topic_name: str = text("ft_data", ros_1="topicName")
    update_rate: float = number(1000.0, "Hz", ros_1="updateRate", minimum=0)


class GazeboWorldOdometry(ModelPlugin):
    """Publishes the true pose of the link `<body_name>` in the world on `<topic_name>`, for any `<frame_name>`.

    As in Gazebo, `<frame_name>` (`world`) sets only the frame of the message, and it names the link if there is no
    `<body_name>`. The linear velocity is in the world's axes, and the angular velocity in the link's axes.
    `<update_rate>` is 1000 Hz by default. Files for ROS 1 write `<bodyName>`, `<topicName>` and so on.

    The live parameters `x_offset`, `y_offset` [m] and `yaw_offset` [rad] shift the published pose. `gaussian_noise`
    adds a random walk: the standard deviation of each step of x and y [m] and of the yaw [rad].
    """

    endpoints = (publishes("ft_data", ODOMETRY, named_by=("topic_name", "topicName")),)
    options = OptionsOf(GazeboWorldOdometryOptions)
    filenames = ("libgazebo_world_odometry.so",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        options = self.options
        self._frame = options.frame_name
        body, frame = options.element_of("body_name"), options.element_of("frame_name")
        self._body = find_named_link(scene, body if params.has(body) or not params.has(frame) else frame, params)
        self._rate = self.options.update_rate

    def load(self, parent: Model, params: Params) -> None:
        self._link = self.sim.link(self._body)
        self._x = self.declare("x_offset", 0.0, minimum=-100, maximum=100, description="added to x [m]")
        self._y = self.declare("y_offset", 0.0, minimum=-100, maximum=100, description="added to y [m]")
        self._yaw = self.declare(
            "yaw_offset", 0.0, minimum=-math.pi, maximum=math.pi, description="added to the yaw [rad]"
        )
        what = "standard deviation of each step of the random walk of x, y [m] and yaw [rad]"
        self._deviation = self.declare(
            "gaussian_noise",
            0.0,
            minimum=0,
            maximum=5,
            description=what,
            on_change=lambda _: self.sim.communication.on_demand.look(),
        )
        self._stream = self.random("gaussian_noise", 3)
        self._walk: Vector = np.zeros(3)
        self._out = self.advertise(self.options.topic_name, ODOMETRY)
        # the noise depends on this number of instants, and therefore not on the subscribers
        publish_while_subscribed(self, self._out, self._rate, "publish", also=lambda: self._deviation.value > 0)

    def publish(self) -> None:
        """Publish the odometry."""
        if self._deviation.value > 0:
            self._walk = self._walk + self._deviation.value * self._stream.normal(count_instants(self, self._rate))
        if not self._out.wanted:
            return
        link, (dx, dy, turn) = self._link, self._walk.tolist()
        pose = link.pose
        roll, pitch, yaw = pose.rpy
        moved = Pose(
            pose.position + np.array([dx + self._x.value, dy + self._y.value, 0.0]),
            quat_from_rpy(roll, pitch, yaw + turn + self._yaw.value),
        )
        angular = quat_rotate(quat_conjugate(pose.quaternion), link.angular_velocity)
        twist = BodyTwist(link.linear_velocity.tolist(), angular.tolist())
        message = partial(odometry_message, self.sim.time_ns, self._frame, link.name, moved, twist)
        self._out.publish_later(message)
