"""Motion of a bag: the poses and joint positions in its messages, set in a world that does not run."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from simkit import msgs
from simkit.errors import SimkitError
from simkit.msgs.message_types import Message
from simkit.pose import Pose
from simkit.recording.pictures.subject import scan_points

if TYPE_CHECKING:
    from simkit.runtime import Model, Simulation

Points = NDArray[np.float64]

_JOINTS: Final = "sensor_msgs/msg/JointState"
_ODOMETRY: Final = "nav_msgs/msg/Odometry"
_TRANSFORMS: Final = "tf2_msgs/msg/TFMessage"
_SCAN: Final = "sensor_msgs/msg/LaserScan"
_GOAL: Final = "geometry_msgs/msg/PoseStamped"
_TRUE_POSES: Final = "pose/info"  # end of the topics with the poses of a world's models


class BagMotion:
    """Setter of the state that the messages of a bag describe.

    True poses (`/world/W/dynamic_pose/info`) are used as they are. Without them, a model moves by its odometry, from
    its pose in the world at the first message of the bag.

    Args:
        sim: loaded world, which does not run.
        topics: type of each topic of the bag.

    Attributes:
        scans: points of the newest scan by topic in the world frame [m], shape (n, 3).
        goals: position of the newest goal by topic [m], shape (3,).
        moved: names of the models that messages have moved.
    """

    def __init__(self, sim: Simulation, topics: dict[str, str]) -> None:
        self._sim = sim
        self.scans: dict[str, Points] = {}
        self.goals: dict[str, Points] = {}
        self.moved: set[str] = set()
        self._starts: dict[str, tuple[Pose, Pose]] = {}
        self._joints = {joint.name: joint for model in sim.models.values() for joint in model.joints.values()}
        has_truth = any(name.endswith(_TRUE_POSES) for name in topics)
        self._setters: dict[str, Callable[[str, Message], None]] = {
            _JOINTS: self._set_joints,
            _TRANSFORMS: self._set_true_poses,
            _SCAN: self._keep_scan,
            _GOAL: self._keep_goal,
        }
        if not has_truth:
            self._setters[_ODOMETRY] = self._set_odometry
        self.topics = [
            name
            for name, type_name in topics.items()
            if type_name in self._setters
            and (type_name != _TRANSFORMS or name.endswith(_TRUE_POSES))
            and (type_name != _GOAL or "goal" in name.rpartition("/")[2])
        ]
        """Topics of the bag that describe the state."""

    def take(self, topic: str, message: Message) -> None:
        """Set the state of one message; values that no model can have are left out."""
        setter = self._setters.get(message.__msgtype__)
        if setter is not None:
            try:
                setter(topic, message)
            except SimkitError:  # NaN or infinite values
                return

    def _set_true_poses(self, _: str, message: Message) -> None:
        for stamped in message.transforms:
            model = self._sim.models.get(stamped.child_frame_id)
            if model is not None and not model.static:
                model.set_pose(msgs.pose(stamped))
                self.moved.add(model.name)

    def _set_odometry(self, topic: str, message: Message) -> None:
        found = self._model_of(message.child_frame_id)
        if found is None:
            return
        model, link_in_model = found
        odometry = msgs.pose(message)
        start, first = self._starts.setdefault(topic, (model.pose @ link_in_model, odometry))
        model.set_pose(start @ first.inverse() @ odometry @ link_in_model.inverse())
        self.moved.add(model.name)

    def _set_joints(self, _: str, message: Message) -> None:
        for name, position in zip(message.name, message.position, strict=False):
            joint = self._joints.get(name)
            if joint is not None and joint.dof == 1 and np.isfinite(position):
                joint.set_position(float(position))

    def _keep_scan(self, topic: str, message: Message) -> None:
        found = self._model_of(message.header.frame_id)
        if found is not None:
            self.scans[topic] = scan_points(message, found[0].pose @ found[1])

    def _keep_goal(self, topic: str, message: Message) -> None:
        self.goals[topic] = msgs.pose(message).position

    def _model_of(self, frame: str) -> tuple[Model, Pose] | None:
        """Return the moving model with a frame, and the pose of the frame's link in the model."""
        name = frame.strip("/").rpartition("/")[2]
        for model in self._sim.models.values():
            if not model.static and name in model.links:
                return model, model.pose.inverse() @ model.links[name].pose
        sensors = (s for s in self._sim.contents.sensors.values() if name and s.name == name)
        for sensor in sensors:
            owner = self._sim.models.get(sensor.scoped.partition("::")[0])
            if owner is not None:
                return owner, owner.pose.inverse() @ sensor.pose
        return None
