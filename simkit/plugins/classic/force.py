"""Force on a link in Gazebo Classic: `libgazebo_ros_force.so`."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit.params import Params
from simkit.plugins.base import NEVER, ModelPlugin
from simkit.plugins.endpoints import listens
from simkit.plugins.find_entities import find_named_link
from simkit.plugins.one_time_warnings import are_usable
from simkit.plugins.options import Options, OptionsOf, choice, text
from simkit.pose import Vector, quat_rotate

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.msgs import Wrench
    from simkit.runtime import Model
    from simkit.scene import SceneModel

WRENCH: Final = "geometry_msgs/msg/Wrench"


class GazeboRosForceOptions(Options):
    """Options of `GazeboRosForce`."""

    body_name: str = text(element="bodyName", required=True)
    topic_name: str = text(element="topicName", required=True)
    link_name: str = text(required=True)
    force_frame: str = choice(("world", "link"), "world")


class GazeboRosForce(ModelPlugin):
    """Applies the wrench of the last message to a link at its centre of mass, at every step.

    In ROS 2, `<link_name>` names the link, `<force_frame>` is world (default) or link, and the topic is
    `gazebo_ros_force`. In ROS 1, `<bodyName>` names the link, `<topicName>` is the topic, and the wrench is always in
    the world's axes.
    """

    endpoints = (listens("gazebo_ros_force", WRENCH, named_by=("topicName",)),)
    options = OptionsOf(GazeboRosForceOptions)
    filenames = ("libgazebo_ros_force.so",)
    drives = True

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        is_ros_1 = params.has("bodyName") or params.has("topicName")
        self._scoped = find_named_link(scene, "bodyName" if is_ros_1 else "link_name", params)
        self._topic = self.options.topic_name if is_ros_1 else "gazebo_ros_force"
        self._turns = self.options.force_frame == "link"

    def load(self, parent: Model, params: Params) -> None:
        self._wrench = np.zeros(6)
        # a wrench in the link's axes rotates with the link, so every step sets it again
        self.before_step_rate = None if self._turns else NEVER
        self.listen(self._topic, WRENCH, self._on_wrench)

    def _on_wrench(self, message: Wrench) -> None:
        f, t = message.force, message.torque
        wrench = np.array((f.x, f.y, f.z, t.x, t.y, t.z), float)
        if not are_usable(*wrench):
            self._once.not_finite("a wrench")
            return
        self._wrench = wrench
        if not self._turns:
            self._apply_constant_wrench()

    def _apply_constant_wrench(self, *, are_applied: bool = False) -> None:
        self.sim.engine.wrenches.set(self, self._constant_wrench(), are_applied=are_applied)

    def _constant_wrench(self) -> dict[str, Vector]:
        return {self._scoped: self._wrench} if self._wrench.any() else {}

    def set_state(self, state: Mapping[str, object]) -> None:
        """Restore a state from `get_state`."""
        super().set_state(state)
        if not self._turns:
            self._apply_constant_wrench(are_applied=True)

    def before_step(self) -> None:
        if not self._turns or not self._wrench.any():
            return
        link = self.sim.link(self._scoped)
        turn = link.pose.quaternion
        link.apply_wrench(quat_rotate(turn, self._wrench[:3]), quat_rotate(turn, self._wrench[3:]))
