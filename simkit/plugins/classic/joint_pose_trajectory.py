"""Joint trajectories in Gazebo Classic that set positions: `libgazebo_ros_joint_pose_trajectory.so`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from simkit.errors import InputError
from simkit.number_text import counted
from simkit.params import Params
from simkit.plugins.base import ModelPlugin
from simkit.plugins.endpoints import listens
from simkit.plugins.joints.joint_axis import suggest_names
from simkit.plugins.joints.joint_trajectory import nanoseconds
from simkit.plugins.one_time_warnings import are_usable
from simkit.plugins.options import Options, OptionsOf, choice, number, text

if TYPE_CHECKING:
    from simkit.msgs import JointTrajectory
    from simkit.runtime import Joint, Link, Model

TRAJECTORY: Final = "trajectory_msgs/msg/JointTrajectory"
_WORLD: Final = frozenset({"", "world", "map"})
_NEVER: Final = 1e18  # [ns]


class GazeboRosJointPoseTrajectoryOptions(Options):
    """Options of `GazeboRosJointPoseTrajectory`."""

    topic_name: str = text("set_joint_trajectory", element="topicName")
    service_name: str = text(element="serviceName")
    update_rate_ros_1: float = number(0.0, "Hz", element="updateRate", minimum=0.0)
    update_rate: float = number(100.0, "Hz", minimum=0.0)
    point_times: str = choice(("chained", "from_start"), "chained")


class GazeboRosJointPoseTrajectory(ModelPlugin):
    """Sets joints to the positions of a `JointTrajectory`, point by point; between two points the joints move freely.

    As in Gazebo, the first point is set at once, or at the time in the header if that is later. The `time_from_start`
    of a point is the delay between this point and the next point. If `<simkit:point_times>` is from_start, each point
    is set at its own `time_from_start` instead. At most one point is set per update; `<update_rate>` is 100 Hz by
    default in ROS 2, and 0 means every step.

    The header's `frame_id` is `world`, `map`, or the name of a link, in this model or another. With a link, the joints
    belong to the link's model, and the link's pose does not change when the joints are set. The topic is
    `set_joint_trajectory` in ROS 2 and `<topicName>` in ROS 1, where points can be set at every step. Gazebo on ROS 1
    pauses the physics while a trajectory plays; in simkit the physics continues.
    """

    endpoints = (listens("set_joint_trajectory", TRAJECTORY, named_by=("topicName",)),)
    options = OptionsOf(GazeboRosJointPoseTrajectoryOptions)
    filenames = ("libgazebo_ros_joint_pose_trajectory.so",)
    drives = True

    def load(self, parent: Model, params: Params) -> None:
        self._model = parent
        is_ros_1 = any(params.has(name) for name in ("topicName", "serviceName", "updateRate", "robotNamespace"))
        if is_ros_1:
            _ = self.options.update_rate_ros_1  # Gazebo reads this element but does not use the value
            _ = self.options.service_name  # Gazebo is built without this service
            message = f"plugin {self.name!r}: the physics continues while a trajectory plays; Gazebo on ROS 1 pauses it"
            params.diagnostics.note("SK-PLUGIN-046", message, self.where)
            rate, topic = 0.0, self.options.topic_name
        else:
            rate, topic = self.options.update_rate, "set_joint_trajectory"
        self._period = round(min(1e9 / rate, _NEVER)) if rate > 0.0 else 0
        self._is_chained = self.options.point_times == "chained"
        self._points: list[tuple[tuple[float, ...], int]] = []
        self._names: tuple[str, ...] = ()
        self._model_name, self._fixed = parent.scoped, ""
        self._index, self._due, self._start, self._last = 0, 0, 0, 0
        if topic:
            self.listen(topic, TRAJECTORY, self._on_trajectory)

    # ------------------------------------------------------------------ commands

    def _on_trajectory(self, message: JointTrajectory) -> None:
        frame = str(message.header.frame_id).strip("/")
        link = self._reference(frame)
        if link is None and frame not in _WORLD:
            return
        model = self._model if link is None else self.sim.model(link.scoped.rsplit("::", 1)[0])
        names = tuple(str(name) for name in message.joint_names)
        known = model.below("joints")
        unknown = [name for name in names if name not in known]
        if unknown:
            problem = f"a trajectory is ignored: model {model.scoped!r} has no joint {unknown[0]!r}"
            self._once.left_out(unknown[0], problem, suggest_names(unknown[0], list(known)))
            return
        points = [(tuple(float(v) for v in p.positions), nanoseconds(p.time_from_start)) for p in message.points]
        for i, (positions, _) in enumerate(points):
            if not are_usable(*positions):
                self._once.left_out("finite", f"a trajectory is ignored: point {i} has a NaN or infinite number")
                return
        self._names, self._points, self._model_name = names, points, model.scoped
        self._fixed = link.scoped if link is not None else ""
        self._start = self._due = max(nanoseconds(message.header.stamp), self.sim.time_ns)
        self._index = 0

    def _reference(self, frame: str) -> Link | None:
        """Return the link whose pose does not change when the joints are set; None for the world or after a report."""
        if frame in _WORLD:
            return None
        links: dict[str, Link] = self.sim.contents.handles.tables["link"]
        scoped_frame = f"{self.scoped}::{frame}"
        reference = links.get(scoped_frame) or links.get(frame)
        reference = reference or next((link for scoped, link in links.items() if scoped.endswith("::" + frame)), None)
        if reference is None:
            problem = f"a trajectory is ignored: its frame_id {frame!r} is not 'world', 'map' or a link"
            self._once.left_out(f"frame {frame}", problem, suggest_names(frame, list(links)))
        return reference

    def before_step(self) -> None:
        if self._index >= len(self._points):
            return
        now = self.sim.time_ns
        positions, time = self._points[self._index]
        due = self._due if self._is_chained else self._start + time
        if now < due or now - self._last < self._period:
            return
        if len(positions) == len(self._names):
            self._set_joints(positions)
        else:
            counts = f"{counted(len(positions), 'position')} for {len(self._names)} joint names"
            self._once.left_out(counts, f"point {self._index} of a trajectory has {counts}; the point is ignored")
        self._last = now
        self._due += time
        self._index += 1

    def _set_joints(self, positions: tuple[float, ...]) -> None:
        """Set the joints; the pose of the reference link, or else of the model, does not change."""
        model = self.sim.model(self._model_name)
        link = self.sim.link(self._fixed) if self._fixed else None
        before = model.pose if link is None else link.pose
        for name, position in zip(self._names, positions, strict=True):
            joint: Joint = model.joint(name)
            if joint.dof != 1:
                problem = f"joint {joint.scoped!r} is {joint.type} and is not set; expected a joint with one axis"
                self._once.left_out(joint.scoped, problem)
                continue
            try:
                joint.set_position(position)
            except InputError as error:
                self._once.left_out(joint.scoped, str(error))
        after = model.pose if link is None else link.pose
        if after != before:
            model.set_pose(before @ after.inverse() @ model.pose)
