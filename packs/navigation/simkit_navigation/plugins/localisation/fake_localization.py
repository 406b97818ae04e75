"""Plugin that publishes the true pose of a robot in place of a localisation, as ROS's `fake_localization`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from simkit import Params, Plugin, msgs
from simkit.errors import ArgumentValueError, InputError, TransformError
from simkit.extend import Options, OptionsOf, number, text
from simkit.plugins.drives.odometry_messages import TRANSFORMS, transforms
from simkit_navigation.plugins.navigation.robot_link import links_of_frame

if TYPE_CHECKING:
    from simkit import Link, Model, Simulation


class FakeLocalizationOptions(Options):
    """Options of `FakeLocalization`."""

    global_frame_id: str = text("map")
    odom_frame_id: str = text("odom")
    base_frame_id: str = text("base_footprint")
    update_rate: float = number(30.0, "Hz", minimum=0.1, maximum=1000)


class FakeLocalization(Plugin):
    """Publishes the transform from the map to the odometry, so that the robot's pose in the map is the true one.

    The frame of the map lies at the origin of the world. The true pose is that of the link `<base_frame_id>`; for
    `<base_frame_id>robot/base_link</base_frame_id>`, of the link `base_link` of the model `robot`. It is also published
    on `amcl_pose`. A real localisation, such as AMCL, replaces this plugin.
    """

    filenames = ("libsimkit_fake_localization.so",)
    names = ("simkit::FakeLocalization",)
    parent_kind = ("world", "model")
    options = OptionsOf(FakeLocalizationOptions)

    def load(self, parent: Simulation | Model, params: Params) -> None:
        self.after_step_rate = self.options.read_all().update_rate
        self._models: tuple[str, ...] = ()
        self._link: Link | None = None
        self._transforms = self.advertise("/tf", TRANSFORMS)
        self._pose = self.advertise("amcl_pose", "geometry_msgs/msg/PoseWithCovarianceStamped")

    def _find_link(self) -> Link | None:
        """Return the only link with the name of the robot's frame; None after a warning."""
        models = tuple(self.sim.models)
        if models == self._models:
            return self._link  # a search takes longer than all the rest
        links = links_of_frame(self.sim, self.options.base_frame_id)
        self._models, self._link = models, links[0] if len(links) == 1 else None
        if self._link is None:
            message = f"{len(links)} models have a link {self.options.base_frame_id!r}, so there is no true pose"
            self._once.warn("SK-PLUGIN-132", "link", message, "set <base_frame_id> to LINK, or to MODEL/LINK")
        return self._link

    def after_step(self) -> None:
        options, link = self.options, self._find_link()
        if link is None:
            return
        try:
            odometry = self.sim.tf.lookup(options.odom_frame_id, options.base_frame_id)
        except (TransformError, ArgumentValueError):
            return  # there is no odometry yet, or a frame without a name
        try:
            pose = link.pose
        except InputError:  # the robot was removed, and another one with its name was added
            self._models = ()
            return
        item = options.global_frame_id, options.odom_frame_id, pose @ odometry.inverse()
        self._transforms.publish(transforms(self.sim.time_ns, item))
        if self._pose.wanted:
            fields = {"pose": msgs.pose_message(pose)}
            header = msgs.header(self.sim.time_ns, options.global_frame_id)
            self._pose.publish(msgs.make(self._pose.type_name, header=header, pose=fields))
