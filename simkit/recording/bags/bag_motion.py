"""Motion of a bag: the poses and joint positions in its messages, set in a world that does not run."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit import msgs
from simkit.errors import SimkitError
from simkit.linear_algebra import norm
from simkit.msgs.message_types import Message
from simkit.pose import IDENTITY, Pose

if TYPE_CHECKING:
    from simkit.runtime import Model, Simulation

JOINT_STATE: Final = "sensor_msgs/msg/JointState"
ODOMETRY: Final = "nav_msgs/msg/Odometry"
SCAN: Final = "sensor_msgs/msg/LaserScan"
TRANSFORMS: Final = "tf2_msgs/msg/TFMessage"
_TRUE_POSES: Final = "pose/info"  # end of the topics with the poses of a world's models
_ROOTS: Final = frozenset({"odom", "map", "world"})
_NEAR: Final = 0.05  # [m] up to which the first pose lies at the model's pose in the world, so that it is a world pose


class BagMotion:
    """Setter of the state that the messages of a bag describe.

    True poses (`/world/W/dynamic_pose/info`) are used as they are. Without them, a model moves by its odometry; without
    odometry, by the transforms from `odom`, `map` or `world`. Poses of odometry are relative to the model's pose in the
    world, unless the first one is at that pose.

    Args:
        sim: loaded world, which does not run.
        topics: type of each topic of the bag.

    Attributes:
        topics: topics of the bag that describe the state.
        moved: names of the models that messages have moved.
        links_by_frame: scoped names of the links that messages place, by their frames.
    """

    def __init__(self, sim: Simulation, topics: Mapping[str, str]) -> None:
        self._sim = sim
        self.moved: set[str] = set()
        self.links_by_frame: dict[str, str] = {}
        self._origins: dict[str, Pose] = {}
        self._edges: dict[str, tuple[str, Pose]] = {}
        self._joints = {joint.name: joint for model in sim.models.values() for joint in model.joints.values()}
        moving = [model for model in sim.models.values() if not model.static]
        self._links = {name: (model, link) for model in reversed(moving) for name, link in model.links.items()}
        only = next(iter(moving[0].links)) if len(moving) == 1 and moving[0].links else ""
        self._only = self._links.get(only)
        self._has_truth = any(name.endswith(_TRUE_POSES) for name in topics)
        self._has_odometry = ODOMETRY in topics.values()
        self._setters: dict[str, Callable[[str, Message], None]] = {
            JOINT_STATE: self._set_joints,
            TRANSFORMS: self._take_transforms,
        }
        if not self._has_truth:
            self._setters[ODOMETRY] = lambda _, message: self._place(message.child_frame_id, msgs.pose(message))
        self.topics = [name for name, type_name in topics.items() if type_name in self._setters]

    def take(self, topic: str, message: Message) -> None:
        """Set the state of one message; values that no model can have are left out."""
        setter = self._setters.get(message.__msgtype__)
        if setter is not None:
            try:
                setter(topic, message)
            except SimkitError:  # NaN or infinite values
                return

    def frame_pose(self, frame: str) -> Pose | None:
        """Return the pose of a link, a sensor or a frame of the transforms in the world; None if it is unknown."""
        offset = IDENTITY
        for _ in range(len(self._edges) + 1):
            name = _plain(frame)
            if name in self._links:
                return self._links[name][1].pose @ offset
            sensor = next((s for s in self._sim.contents.sensors.values() if name and s.name == name), None)
            if sensor is not None:
                pose: Pose = sensor.pose
                return pose @ offset
            if frame not in self._edges or frame in self._origins:
                break
            frame, edge = self._edges[frame]
            offset = edge @ offset
        return None if self._only is None else self._only[1].pose @ offset

    def scan_pose(self, topic: str, message: Message) -> Pose | None:
        """Return the pose of a scan in the world: that of the world's sensor on its topic, or that of its frame."""
        sensors = (sensor.pose for sensor in self._sim.contents.sensors.values() if sensor.topic == topic)
        return next(sensors, None) or self.frame_pose(message.header.frame_id)

    def _take_transforms(self, topic: str, message: Message) -> None:
        for stamped in message.transforms:
            child, parent, pose = stamped.child_frame_id, stamped.header.frame_id, msgs.pose(stamped)
            model = self._sim.models.get(child)
            if topic.endswith(_TRUE_POSES):
                if model is not None and not model.static:
                    self._move(model, pose)
                continue
            self._edges[child] = parent, pose
            if not (self._has_truth or self._has_odometry) and _plain(parent) in _ROOTS:
                self._place(child, pose)

    def _place(self, frame: str, pose: Pose) -> None:
        """Place the model whose link has the name of the frame; an unknown frame is that of the only moving model."""
        owner = self._links.get(_plain(frame), self._only)
        if owner is None:
            return
        model, link = owner
        if frame not in self._origins:
            is_world = norm(link.pose.position[:2] - pose.position[:2]) < _NEAR
            self._origins[frame] = IDENTITY if is_world else link.pose
            self.links_by_frame[frame.strip("/")] = link.scoped
        self._move(model, self._origins[frame] @ pose @ link.pose.inverse() @ model.pose)

    def _move(self, model: Model, pose: Pose) -> None:
        model.set_pose(pose)
        self.moved.add(model.name)

    def _set_joints(self, _: str, message: Message) -> None:
        for name, position in zip(message.name, message.position, strict=False):
            joint = self._joints.get(_plain(name))
            if joint is not None and joint.dof == 1 and np.isfinite(position):
                joint.set_position(float(position))


def _plain(name: str) -> str:
    """Return a name without the namespace before it."""
    return name.strip("/").rpartition("/")[2]
