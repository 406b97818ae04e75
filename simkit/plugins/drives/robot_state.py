"""`/tf` of a robot's own joints, as `robot_state_publisher` gives it: with `/tf_static` the tree reaches every link."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

from simkit.params import Params
from simkit.plugins.base import ModelPlugin
from simkit.plugins.drives.odometry import TRANSFORMS
from simkit.plugins.drives.tf import frame_names
from simkit.plugins.heard import publish_while_heard
from simkit.plugins.part_poses import Part, PartPoses, vector_message

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.runtime import Model
    from simkit.scene import SceneModel


class RobotStatePublisher(ModelPlugin):
    """Publishes on `/tf`, `<publish_frequency>` (20) times a second, each link that a joint moves in its parent link.

    Frames have the names that `/tf_static` has. The poses are the true ones, also of joints without an encoder. What
    makes them in ROS, `robot_state_publisher`, is a node of its own that is started beside Gazebo.
    """

    filenames = ("libsimkit_robot_state_publisher.so",)
    names = ("simkit::RobotStatePublisher",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        self._rate = params.number("publish_frequency", 20.0, minimum=1e-3)

    def load(self, parent: Model, params: Params) -> None:
        self._robot = parent
        self._out = self.advertise("/tf", TRANSFORMS)
        publish_while_heard(self, self._out, self._rate, "tell")

    def tell(self) -> None:
        """Publishes."""
        poses: Any = self.sim.names.shared(f"joint frames {id(self)}", self._poses)
        self._out.publish_later(partial(vector_message, self.sim.time_ns, poses.take()))

    def _poses(self) -> PartPoses:
        frames, joints = frame_names(self.sim), list(self._robot.scene.all_joints())
        told = {joint.child_link for joint in joints if joint.type == "fixed"}
        parts = []
        for joint in joints:
            parent, child = joint.parent_link, joint.child_link
            if child in told or parent not in frames or child not in frames:  # no frame has a second parent
                continue
            told.add(child)
            parts.append(Part(frames[parent], frames[child], handle=self.sim.link(child), within=self.sim.link(parent)))
        return PartPoses(self.sim, parts)
