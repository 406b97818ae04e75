"""The force sensor of Gazebo Classic on ROS 1 that hangs on a model: `libgazebo_ros_f3d.so`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from simkit.params import Params
from simkit.plugins.classic.ft_sensor import GazeboRosFtSensor
from simkit.plugins.endpoints import publishes
from simkit.plugins.find_entities import find_named_link
from simkit.plugins.options import Options, OptionsOf, text, without_effect

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.scene import SceneModel


class GazeboRosF3DOptions(Options):
    """Options of `GazeboRosF3D`."""

    topic_name: str = text(element="topicName", required=True)
    body_name: str = text(element="bodyName", required=True)
    frame_name: str = text("world", element="frameName")
    always_on: bool = without_effect(element="alwaysOn")


class GazeboRosF3D(GazeboRosFtSensor):
    """Publishes on `<topicName>` the sum of all that acts on the link `<bodyName>`, at every step.

    In the world's axes, gravity included: the link's mass times the acceleration of its centre of mass [N], and the
    change of its angular momentum [N·m]. `<frameName>` (`world`) is only said.
    """

    endpoints = (publishes("{topicName}", "geometry_msgs/msg/WrenchStamped", named_by=("topicName",)),)
    options = OptionsOf(GazeboRosF3DOptions)  # type: ignore[assignment]  # it reads none of the other one's
    filenames = ("libgazebo_ros_f3d.so",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        self._topic = self.options.topic_name
        self._joint, self._link = "", find_named_link(scene, "bodyName", params)
        self._frame = self.options.frame_name.strip("/") or "world"
        self._deviation = 0.0
        _ = self.options.always_on
