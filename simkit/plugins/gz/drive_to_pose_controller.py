"""Pose controller of Gazebo for drives: `gz::sim::systems::DriveToPoseController`."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

from simkit import msgs
from simkit.msgs.topic_names import valid_topic
from simkit.params import Params
from simkit.plugins.base import NEVER, ModelPlugin
from simkit.pose import rpy_from_quat, wrap_angle

if TYPE_CHECKING:
    from simkit.runtime import Model

Planar = tuple[float, float, float]
"""Planar pose: x, y [m] and yaw [rad]."""

POSE: Final = "geometry_msgs/msg/Pose"
TWIST: Final = "geometry_msgs/msg/Twist"
TARGETS: Final = ("geometry_msgs/msg/PoseArray", "geometry_msgs/msg/PoseStamped", POSE, "tf2_msgs/msg/TFMessage")


class DriveToPoseController(ModelPlugin):
    """Drives a robot to a pose: the robot turns towards the target, drives there, and turns to the target's heading.

    The plugin reads the target from `/model/<model>/cmd_pose`, and the pose of the robot from `/model/<model>/pose`,
    which an odometry publisher publishes. The forward speed is the distance times `<linear_p_gain>`; the turning rate
    is the angle error times `<angular_p_gain>`. At most one of these two speeds is not zero. Both are published at
    every step as a twist on `/model/<model>/cmd_vel`. An error within `<linear_deviation>` or `<angular_deviation>`
    counts as zero. The final pose is published on `/model/<model>/reached_pose`. The two gains and the two deviations
    are live parameters.
    """

    filenames = ("gz-sim-drive-to-pose-controller-system",)
    names = ("gz::sim::systems::DriveToPoseController",)
    drives = True

    def load(self, parent: Model, params: Params) -> None:
        self._linear_gain = self.declare(
            "linear_p_gain", 1.0, minimum=0.0, description="forward speed [m/s] per metre of remaining distance"
        )
        self._angular_gain = self.declare(
            "angular_p_gain", 2.0, minimum=0.0, description="turning rate [rad/s] per radian of remaining angle"
        )
        self._position_tolerance = self.declare(
            "linear_deviation", 0.1, minimum=0.0, description="distance at which the position counts as reached [m]"
        )
        self._angle_tolerance = self.declare(
            "angular_deviation", 0.05, minimum=0.0, description="angle at which a direction counts as reached [rad]"
        )
        self._target: Planar | None = None
        self._robot_pose: Planar | None = None
        self._pose: msgs.Message = None
        model_topic = f"/model/{parent.name}"
        self._speed = self.advertise(valid_topic(f"{model_topic}/cmd_vel"), TWIST)
        self._reached = self.advertise(valid_topic(f"{model_topic}/reached_pose"), POSE)
        self._pose_topic = valid_topic(f"{model_topic}/pose")
        self.subscribe(self._pose_topic, self._on_pose)
        self.listen(valid_topic(f"{model_topic}/cmd_pose"), TARGETS, self._on_target)
        self._set_pace()

    # ------------------------------------------------------------------ messages

    def _on_target(self, message: msgs.PoseArray | msgs.PoseStamped | msgs.Pose | msgs.TFMessage) -> None:
        pose = _first_pose(message)
        target = None if pose is None else _planar(pose)
        if pose is None:
            self._once.left_out("empty", "a target message without a pose is ignored")
        elif target is None:
            self._once.not_finite("a target")
        else:
            self._target = target
            self._warn_about_missing_plugins()
            self._set_pace()

    def _on_pose(self, message: msgs.Message) -> None:
        pose = _first_pose(message)
        planar = None if pose is None else _planar(pose)
        if planar is not None:
            self._robot_pose, self._pose = planar, pose

    def _warn_about_missing_plugins(self) -> None:
        """Warn if no plugin publishes the robot's pose, or if no plugin subscribes to the published speeds."""
        topics = self.sim.communication.bus.topics()
        if self._robot_pose is None and self._pose_topic not in topics:
            message = f"no publisher on {self._pose_topic} gives the robot's pose, so the robot does not start"
            self._once.warn("SK-PLUGIN-132", "place", message, "add an OdometryPublisher to the model")
        ends = self.sim.communication.bus.endpoints(self._speed.topic)
        if not self._speed.wanted and not any(does == "takes" for *_, does in ends):
            message = f"no plugin subscribes to the speeds on {self._speed.topic}"
            hint = "add a DiffDrive to the model, or set the <topic> of its drive to this name"
            self._once.warn("SK-PLUGIN-132", "speed", message, hint)

    def _set_pace(self) -> None:
        """Call `after_step` at every step while there is a target, otherwise not at all."""
        self._set_after_step_rate(NEVER if self._target is None else None)

    # ------------------------------------------------------------------ driving

    def after_step(self) -> None:
        """Publish the speeds that bring the robot nearer to its target."""
        if self._target is None or self._robot_pose is None:
            return
        ahead, turn = self._errors(self._target, self._robot_pose)
        linear, angular = self._linear_gain.value * ahead, self._angular_gain.value * turn
        self._speed.publish(msgs.make(TWIST, linear={"x": linear}, angular={"z": angular}))
        if ahead == 0.0 and turn == 0.0:
            self._target = None
            if self._reached.wanted:
                self._reached.publish(_as_pose(self._pose))
            self._set_pace()

    def _errors(self, target: Planar, robot: Planar) -> tuple[float, float]:
        """Return the remaining distance [m] and the remaining angle [rad]; at most one of them is not zero."""
        x, y = target[0] - robot[0], target[1] - robot[1]
        distance = math.hypot(x, y)
        is_there = distance <= self._position_tolerance.value
        heading = target[2] if is_there else math.atan2(y, x)
        turn = wrap_angle(heading - robot[2])
        if abs(turn) > self._angle_tolerance.value:
            return 0.0, turn
        return (0.0 if is_there else distance), 0.0


def _first_pose(message: msgs.Message) -> msgs.Message:
    """Return the first Pose or Transform of a message, or None if there is no pose."""
    if hasattr(message, "transforms"):
        return message.transforms[0].transform if message.transforms else None
    if hasattr(message, "poses"):
        return message.poses[0] if message.poses else None
    return getattr(message, "pose", message)


def _position_and_rotation(pose: msgs.Message) -> tuple[msgs.Message, msgs.Message]:
    return (pose.position, pose.orientation) if hasattr(pose, "position") else (pose.translation, pose.rotation)


def _planar(pose: msgs.Message) -> Planar | None:
    """Return x [m], y [m] and yaw [rad] of a pose; None if a number is NaN or infinite.

    A quaternion of zeros, as in an empty message, counts as no rotation.
    """
    place, turn = _position_and_rotation(pose)
    quaternion = (turn.w, turn.x, turn.y, turn.z)
    yaw = float(rpy_from_quat(quaternion)[2]) if any(quaternion) else 0.0
    x_y_yaw = float(place.x), float(place.y), yaw
    return x_y_yaw if all(map(math.isfinite, x_y_yaw)) else None


def _as_pose(pose: msgs.Message) -> msgs.Message:
    place, turn = _position_and_rotation(pose)
    return msgs.make(
        POSE,
        position={"x": place.x, "y": place.y, "z": place.z},
        orientation={"w": turn.w, "x": turn.x, "y": turn.y, "z": turn.z},
    )
