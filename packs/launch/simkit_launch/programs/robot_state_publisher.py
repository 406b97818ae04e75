"""`robot_state_publisher`: transforms of a robot from its description and the states of its joints."""

from __future__ import annotations

import os
import sys
from contextlib import suppress

import rclpy
from geometry_msgs.msg import TransformStamped
from rcl_interfaces.msg import SetParametersResult
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, qos_profile_sensor_data
from rclpy.time import Time
from rclpy.utilities import remove_ros_args
from sensor_msgs.msg import JointState
from std_msgs.msg import String
from tf2_ros import StaticTransformBroadcaster, TransformBroadcaster

from simkit.input_file import read_input_text
from simkit.pose import IDENTITY
from simkit_launch.mock_robot import shown_robot
from simkit_launch.model_spawning import SpawnError, spawn_model
from simkit_launch.program_simulation import current_simulation, ros1_parameter, skip_early_messages
from simkit_launch.robot_description import DescriptionError
from simkit_launch.robot_display import SHOWN_ROBOT
from simkit_launch.robot_frames import RobotFrames, robot_frames

_LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class RobotStatePublisher(Node):
    """Node with the parameters and topics of `robot_state_publisher`.

    Args:
        description: description of the robot from a file; empty for the parameter.
    """

    def __init__(self, description: str) -> None:
        super().__init__("robot_state_publisher")
        self._robot = RobotFrames()
        self._model = ""
        self._published_at: dict[str, int] = {}
        self._called_at = 0
        from_topic = self.declare_parameter("use_robot_description_topic", False).value
        self._out = None
        if from_topic:
            self.create_subscription(String, "robot_description", self._take_description, _LATCHED)
        else:
            given = str(self.declare_parameter("robot_description", "").value or self._of_ros1("robot_description", ""))
            self._out = self.create_publisher(String, "robot_description", _LATCHED)
            description = given or description
        rate = self._of_ros1("publish_frequency", 20.0)
        self._rate = float(self.declare_parameter("publish_frequency", float(rate)).value)
        self._prefix = str(self.declare_parameter("frame_prefix", self._ros1_prefix()).value)
        self._ignores_stamps = bool(
            self.declare_parameter("ignore_timestamp", bool(self._of_ros1("ignore_timestamp", False))).value
        )
        self._transforms, self._static = TransformBroadcaster(self), StaticTransformBroadcaster(self)
        if not 0.0 < self._rate <= 1000.0:
            raise RuntimeError("publish_frequency must be between 0 (exclusive) and 1000")
        if not from_topic:
            if not description:
                raise RuntimeError("robot_description parameter must not be empty")
            self._set_description(description)
            self.add_on_set_parameters_callback(self._change)
        states = self.create_subscription(JointState, "joint_states", self._take_states, qos_profile_sensor_data)
        skip_early_messages(states, lambda: 0 if self._ignores_stamps else int(1000.0 / self._rate) * 1_000_000)

    def _of_ros1(self, name: str, default: object) -> object:
        value = ros1_parameter(self.get_fully_qualified_name(), name)
        return default if value is None else value

    def _ros1_prefix(self) -> str:
        prefix = str(self._of_ros1("tf_prefix", ""))
        return f"{prefix}/" if prefix else ""

    # ------------------------------------------------------------------ description

    def _take_description(self, message: String) -> None:
        try:
            self._set_description(message.data)
        except DescriptionError as error:
            self.get_logger().error(f"Failed to parse robot description from topic: {error}")

    def _set_description(self, description: str) -> None:
        self._robot = robot_frames(description)
        if os.environ.get(SHOWN_ROBOT) and not self._model:
            self._show(description)
        if self._out is not None:
            self._out.publish(String(data=description))
        self.get_logger().info("Robot initialized")
        self._publish_fixed()

    def _show(self, description: str) -> None:
        """Spawn the robot without gravity and contacts, because the launch file starts no simulator."""
        sim = current_simulation()
        try:
            self._model = spawn_model(sim, shown_robot(description), "", None, may_rename=True)
        except (SpawnError, DescriptionError) as error:
            sim.engine.reports.warning("SK-LAUNCH-064", f"{self.get_name()}: the robot is not shown: {error}")
            return
        text = f"{self.get_name()} shows {self._model!r} without gravity and contacts: no simulator is started"
        sim.engine.reports.note("SK-LAUNCH-064", text)

    def _change(self, parameters) -> SetParametersResult:
        for parameter in parameters:
            value = parameter.value
            if parameter.name == "robot_description":
                if not value:
                    return SetParametersResult(successful=False, reason="Empty URDF is not allowed")
                try:
                    self._set_description(value)
                except DescriptionError as error:
                    self.get_logger().warn(str(error))
                    return SetParametersResult(successful=False, reason=str(error))
            elif parameter.name == "publish_frequency":
                if not 0.0 < value <= 1000.0:
                    reason = "publish_frequency must be between 0.0 (exclusive) and 1000.0"
                    return SetParametersResult(successful=False, reason=reason)
                self._rate = value
            elif parameter.name == "frame_prefix":
                self._prefix = value
                self._publish_fixed()
            elif parameter.name == "ignore_timestamp":
                self._ignores_stamps = value
        return SetParametersResult(successful=True)

    # ------------------------------------------------------------------ transforms

    def _transform(self, joint, pose, stamp) -> TransformStamped:
        message = TransformStamped()
        message.header.stamp = stamp
        message.header.frame_id = self._prefix + joint.parent
        message.child_frame_id = self._prefix + joint.child
        place, turn = message.transform.translation, message.transform.rotation
        place.x, place.y, place.z = map(float, pose.position)
        turn.w, turn.x, turn.y, turn.z = map(float, pose.quaternion)
        return message

    def _publish_fixed(self) -> None:
        stamp = self.get_clock().now().to_msg()
        fixed = [self._transform(joint, joint.pose, stamp) for _, joint in sorted(self._robot.fixed.items())]
        if fixed:
            self._static.sendTransform(fixed)

    def _take_states(self, state: JointState) -> None:
        if len(state.name) != len(state.position):
            if state.position:
                self.get_logger().error("Robot state publisher ignored an invalid JointState message")
            else:
                text = 'Robot state publisher ignored a JointState message about joint(s) "%s"(,...) whose position'
                self.get_logger().warn(text % state.name[0] + " member was empty.")
            return
        now, stamp = self.get_clock().now().nanoseconds, Time.from_msg(state.header.stamp).nanoseconds
        if now < self._called_at:
            self.get_logger().warn("Moved backwards in time, re-publishing joint transforms!")
            self._published_at.clear()
        self._called_at = now
        oldest = min([now, *(self._published_at.get(name, 0) for name in state.name)])
        if not self._ignores_stamps and stamp < oldest + int(1000.0 / self._rate) * 1_000_000:
            return
        positions: dict[str, float] = {}
        for name, position in zip(state.name, state.position, strict=True):
            positions.setdefault(name, position)
        for name, rule in self._robot.mimics.items():
            if rule.joint in positions:
                positions.setdefault(name, positions[rule.joint] * rule.multiplier + rule.offset)
        moving = self._robot.moving
        transforms = [
            self._transform(moving[name], moving[name].pose_at(position), state.header.stamp)
            for name, position in sorted(positions.items())
            if name in moving
        ]
        if self._model:
            shown = {name: position for name, position in positions.items() if name in moving}
            model = current_simulation().model(self._model)
            model.set_joint_positions(shown)
            if "world" not in self._robot.links:
                model.set_pose(IDENTITY)
                model.set_velocity((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
        if transforms:
            self._transforms.sendTransform(transforms)
        self._published_at.update(dict.fromkeys(state.name, stamp))


def main() -> None:
    """Run the node until the end of the run; the first argument may be a file with the description."""
    rclpy.init(args=sys.argv)
    words = remove_ros_args(sys.argv)[1:]
    try:
        description = read_input_text(words[0]) if words and not words[0].startswith("-") else ""
        node = RobotStatePublisher(description)
    except OSError as error:
        sys.exit(f"{words[0]}: cannot be read: {error.strerror}")
    except (DescriptionError, RuntimeError) as error:
        sys.exit(f"robot_state_publisher: {error}")
    with suppress(KeyboardInterrupt, ExternalShutdownException):
        rclpy.spin(node)


if __name__ == "__main__":
    main()
