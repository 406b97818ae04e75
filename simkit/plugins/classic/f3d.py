"""The force sensor of Gazebo Classic on ROS 1 that hangs on a model: `libgazebo_ros_f3d.so`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from simkit.params import Params
from simkit.plugins.classic.ft_sensor import GazeboRosFtSensor
from simkit.plugins.lookups import find_named_link

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.scene import SceneModel


class GazeboRosF3D(GazeboRosFtSensor):
    """Publishes on `<topicName>` the sum of all that acts on the link `<bodyName>`, at every step.

    In the world's axes, gravity included: the link's mass times the acceleration of its centre of mass [N], and the
    change of its angular momentum [N·m]. `<frameName>` (`world`) is only said.
    """

    filenames = ("libgazebo_ros_f3d.so",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        self._topic = params.text("topicName", required=True)
        self._joint, self._link = "", find_named_link(scene, "bodyName", params)
        self._frame = params.text("frameName", "world").strip("/") or "world"
        self._deviation = 0.0
        params.child("alwaysOn")
