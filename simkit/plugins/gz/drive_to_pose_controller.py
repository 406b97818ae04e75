"""gz's way to a pose: `gz::sim::systems::DriveToPoseController`."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Final

from simkit import msgs
from simkit.msgs.topic_names import valid_topic
from simkit.params import Params
from simkit.plugins.base import NEVER, ModelPlugin
from simkit.plugins.one_time_warnings import OneTimeWarnings
from simkit.plugins.publish_on_demand import set_after_step_rate
from simkit.pose import rpy_from_quat

if TYPE_CHECKING:
    from simkit.runtime import Model

PoseMessage = Any
"""A message of poses, a pose or a transform in it, or a part of that: types that share no base."""

Planar = tuple[float, float, float]
"""x, y [m] and yaw [rad]."""

POSE: Final = "geometry_msgs/msg/Pose"
TWIST: Final = "geometry_msgs/msg/Twist"
TARGETS: Final = ("geometry_msgs/msg/PoseArray", "geometry_msgs/msg/PoseStamped", POSE, "tf2_msgs/msg/TFMessage")


class DriveToPoseController(ModelPlugin):
    """Sends a robot that takes twists to a pose: it turns to the place, drives there, and turns to the heading.

    The target comes on `/model/<model>/cmd_pose`; where the robot is, it hears on `/model/<model>/pose`, from an
    odometry publisher. The speeds are the errors times `<linear_p_gain>` and `<angular_p_gain>`, one at a time, at
    every step on `/model/<model>/cmd_vel`; an error within `<linear_deviation>` or `<angular_deviation>` is none. The
    pose at which it stops is told on `/model/<model>/reached_pose`. The four numbers are live parameters.
    """

    filenames = ("gz-sim-drive-to-pose-controller-system",)
    names = ("gz::sim::systems::DriveToPoseController",)
    drives = True

    def load(self, parent: Model, params: Params) -> None:
        self.once = OneTimeWarnings(self)
        self._linear_gain = self.declare(
            "linear_p_gain", 1.0, minimum=0.0, description="speed ahead [m/s] for each metre that is left"
        )
        self._angular_gain = self.declare(
            "angular_p_gain", 2.0, minimum=0.0, description="turning [rad/s] for each radian that is left"
        )
        self._near = self.declare(
            "linear_deviation", 0.1, minimum=0.0, description="how near the place is near enough [m]"
        )
        self._straight = self.declare(
            "angular_deviation", 0.05, minimum=0.0, description="how near a direction is near enough [rad]"
        )
        self._target: Planar | None = None
        self._place: Planar | None = None
        self._pose: PoseMessage = None
        own = f"/model/{parent.name}"
        self._speed = self.advertise(valid_topic(f"{own}/cmd_vel"), TWIST)
        self._reached = self.advertise(valid_topic(f"{own}/reached_pose"), POSE)
        self._place_topic = valid_topic(f"{own}/pose")
        self.subscribe(self._place_topic, self._on_place)
        self.listen(valid_topic(f"{own}/cmd_pose"), TARGETS, self._on_target)
        self._set_pace()

    # ------------------------------------------------------------------ messages

    def _on_target(self, message: msgs.PoseArray | msgs.PoseStamped | msgs.Pose | msgs.TFMessage) -> None:
        found = _first_pose(message)
        target = None if found is None else _planar(found)
        if found is None:
            self.once.left_out("empty", "a target without a pose is left out")
        elif target is None:
            self.once.not_finite("a target")
        else:
            self._target = target
            self._check_ends()
            self._set_pace()

    def _on_place(self, message: PoseMessage) -> None:
        found = _first_pose(message)
        place = None if found is None else _planar(found)
        if place is not None:
            self._place, self._pose = place, found

    def _check_ends(self) -> None:
        """Says what is missing: whoever tells where the robot is, or whoever moves it."""
        topics = self.sim.topics()
        if self._place is None and self._place_topic not in topics:
            message = f"nobody tells on {self._place_topic} where the robot is; it does not start"
            self.once.warn("SK-PLUGIN-132", "place", message, "give the model an OdometryPublisher")
        ends = self.sim.communication.bus.endpoints(self._speed.topic)
        if not self._speed.wanted and not any(does == "takes" for *_, does in ends):
            message = f"nobody takes speeds on {self._speed.topic}"
            self.once.warn("SK-PLUGIN-132", "speed", message, "give the model a DiffDrive, or its <topic> that name")

    def _set_pace(self) -> None:
        """Works at every step only while there is a target."""
        set_after_step_rate(self, NEVER if self._target is None else None)

    # ------------------------------------------------------------------ driving

    def after_step(self) -> None:
        """Tells the speeds that bring it nearer."""
        if self._target is None or self._place is None:
            return
        ahead, turn = self._errors(self._target, self._place)
        linear, angular = self._linear_gain.value * ahead, self._angular_gain.value * turn
        self._speed.publish(msgs.make(TWIST, linear={"x": linear}, angular={"z": angular}))
        if ahead == 0.0 and turn == 0.0:
            self._target = None
            if self._reached.wanted:
                self._reached.publish(_as_pose(self._pose))
            self._set_pace()

    def _errors(self, target: Planar, place: Planar) -> tuple[float, float]:
        """What is left to drive [m] and to turn [rad]; one of the two at a time, none of either at the pose."""
        x, y = target[0] - place[0], target[1] - place[1]
        left = math.hypot(x, y)
        is_there = left <= self._near.value
        wanted = target[2] if is_there else math.atan2(y, x)
        turn = math.remainder(wanted - place[2], math.tau)
        if abs(turn) > self._straight.value:
            return 0.0, turn
        return (0.0 if is_there else left), 0.0


def _first_pose(message: PoseMessage) -> PoseMessage:
    """The first pose of a message of poses: a Pose or a Transform; None where there is none."""
    if hasattr(message, "transforms"):
        return message.transforms[0].transform if message.transforms else None
    if hasattr(message, "poses"):
        return message.poses[0] if message.poses else None
    return getattr(message, "pose", message)


def _place_and_turn(pose: PoseMessage) -> tuple[PoseMessage, PoseMessage]:
    return (pose.position, pose.orientation) if hasattr(pose, "position") else (pose.translation, pose.rotation)


def _planar(pose: PoseMessage) -> Planar | None:
    """x, y and yaw; None where they are no numbers. A quaternion of zeros, as an empty message has, is no turn."""
    place, turn = _place_and_turn(pose)
    quaternion = (turn.w, turn.x, turn.y, turn.z)
    yaw = float(rpy_from_quat(quaternion)[2]) if any(quaternion) else 0.0
    found = float(place.x), float(place.y), yaw
    return found if all(map(math.isfinite, found)) else None


def _as_pose(pose: PoseMessage) -> PoseMessage:
    place, turn = _place_and_turn(pose)
    return msgs.make(
        POSE,
        position={"x": place.x, "y": place.y, "z": place.z},
        orientation={"w": turn.w, "x": turn.x, "y": turn.y, "z": turn.z},
    )
