"""Plugin of Gazebo Classic that pulls a link to a frame of tf, in both spellings: `libgazebo_ros_hand_of_god.so`."""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import partial
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit.linear_algebra import norm
from simkit.params import Params
from simkit.plugins.base import NEVER, ModelPlugin
from simkit.plugins.drives.odometry_messages import TRANSFORMS, transforms
from simkit.plugins.find_entities import find_named_link
from simkit.plugins.options import Options, OptionsOf, number, text
from simkit.pose import IDENTITY, Pose

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.msgs import TFMessage
    from simkit.runtime import Model
    from simkit.scene import SceneModel

_WORLD: Final = "world"
_FARTHEST: Final = 1e9  # [m]


class GazeboRosHandOfGodOptions(Options):
    """Options of `GazeboRosHandOfGod`."""

    ros_1_marks = ("linkName", "frameId")

    link_name: str = text(required=True, ros_1="linkName")
    frame_id: str = text("world", ros_1="frameId")
    kl: float = number(200.0, minimum=0.0, maximum=1000000000.0)
    ka: float = number(200.0, minimum=0.0, maximum=1000000000.0)


class GazeboRosHandOfGod(ModelPlugin):
    """Compensates the weight of a link, and pulls the link to the frame `<frame_id>_desired` from `/tf`.

    The force is `<kl>` [N/m] times the distance to the target, damped critically for the link's mass. The torque is
    `<ka>` [N·m/rad] times half the angle to the target, damped by 2 √(ka Ixx), as in Gazebo. The link's pose is
    published on `/tf` as `<frame_id>_actual`. The desired frame may be the end of a chain of frames that begins with
    `world`. The ROS 1 names are `<linkName>` and `<frameId>`.
    """

    reads_at_load = ("inertial",)  # its springs follow from the mass

    options = OptionsOf(GazeboRosHandOfGodOptions)
    filenames = ("libgazebo_ros_hand_of_god.so",)
    drives = True

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        self._scoped = find_named_link(scene, self.options.element_of("link_name"), params)
        self._frame = self.options.frame_id
        self._stiffness = np.array([self.options.kl, self.options.ka])
        link = next((candidate for candidate in scene.all_links() if candidate.scoped == self._scoped), None)
        self._mass, self._inertia = (1.0, 1.0) if link is None else (link.inertial.mass, link.inertial.inertia[0])
        self._has_weight = link is not None and link.gravity

    def load(self, parent: Model, params: Params) -> None:
        self._damping = 2.0 * np.sqrt(self._stiffness * (self._mass, self._inertia))
        self._link = self.sim.link(self._scoped)
        self._frames: dict[str, tuple[str, Pose]] = {}
        self.before_step_rate = NEVER
        self._compensate_weight()
        self._tf = self.advertise("/tf", TRANSFORMS)
        for topic in ("/tf", "/tf_static"):
            self.subscribe(topic, self._on_transforms)

    def set_state(self, state: Mapping[str, object]) -> None:
        """Restore a state from `get_state`."""
        super().set_state(state)
        self._compensate_weight(are_applied=True)

    def _compensate_weight(self, *, are_applied: bool = False) -> None:
        """Apply a force against gravity at the link's centre of mass."""
        force = -self._mass * np.asarray(self.sim.gravity) if self._has_weight else np.zeros(3)
        lift = {self._scoped: np.array([*force, 0.0, 0.0, 0.0])} if force.any() else {}
        self.sim.engine.wrenches.set(self, lift, are_applied=are_applied)

    def _on_transforms(self, message: TFMessage) -> None:
        model_frame = f"{self._frame}_actual"
        for transform in message.transforms:
            child = transform.child_frame_id.lstrip("/")
            t, q = transform.transform.translation, transform.transform.rotation
            position, turn = (t.x, t.y, t.z), (q.w, q.x, q.y, q.z)
            if child == model_frame:
                continue
            if not all(abs(number) <= _FARTHEST for number in position) or not 1e-6 <= math.hypot(*turn) <= 1e6:
                self._once.left_out(child, f"frame {child!r} is ignored: its transform is not a valid pose")
                continue
            self._frames[child] = transform.header.frame_id.lstrip("/"), Pose(position, turn)
        self._set_before_step_rate(NEVER if self._desired() is None else None)

    def _desired(self) -> Pose | None:
        """Return the desired pose of the link in the world; None if `/tf` does not contain this pose yet."""
        frame, pose = f"{self._frame}_desired", IDENTITY
        for _ in range(len(self._frames)):  # the bound ends the loop for a cycle of frames
            if frame not in self._frames:
                return None
            frame, step = self._frames[frame]
            pose = step @ pose
            if frame == _WORLD:
                return pose
        return None

    def before_step(self) -> None:
        """Apply force and torque towards the desired pose."""
        desired = self._desired()
        if desired is None:
            return
        link, (kl, ka), (cl, ca) = self._link, self._stiffness, self._damping
        pose = link.pose
        turn = (pose.inverse() @ desired).quaternion
        turn = turn if turn[0] >= 0.0 else -turn
        sine = norm(turn[1:])
        # the quaternion's logarithm: half the angle
        half = turn[1:] * (math.atan2(sine, float(turn[0])) / sine) if sine > 1e-12 else turn[1:]
        force = kl * (desired.position - pose.position) - cl * link.linear_velocity
        link.apply_wrench(force, pose.rotate(ka * half) - ca * link.angular_velocity)
        if self._tf.wanted:
            self._tf.publish_later(partial(transforms, self.sim.time_ns, (_WORLD, f"{self._frame}_actual", pose)))
