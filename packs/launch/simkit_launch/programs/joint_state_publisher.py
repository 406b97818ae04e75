"""`joint_state_publisher` (also with sliders): states of all joints of a description, by default at rest."""

from __future__ import annotations

import sys
from contextlib import suppress

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.utilities import remove_ros_args
from sensor_msgs.msg import JointState
from std_msgs.msg import String

from simkit.input_file import read_input_text
from simkit_launch.program_simulation import report_second_joint_states, ros1_parameter
from simkit_launch.robot_description import DescriptionError
from simkit_launch.robot_frames import RobotFrames, robot_frames

_LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class JointStatePublisher(Node):
    """Node with the parameters of `joint_state_publisher`; the sliders of the variant with a window stay at rest.

    Args:
        description: description of the robot from a file; empty for the parameter or the topic.
    """

    def __init__(self, description: str) -> None:
        super().__init__(
            "joint_state_publisher",
            allow_undeclared_parameters=True,
            automatically_declare_parameters_from_overrides=True,
        )
        self._robot = RobotFrames()
        self._positions: dict[str, float] = {}
        self._velocities: dict[str, float] = {}
        self._efforts: dict[str, float] = {}
        self._has_told = False
        self._uses_mimics = self._option("use_mimic_tags", True)
        self._publishes = {
            "position": self._option("publish_default_positions", True),
            "velocity": self._option("publish_default_velocities", False),
            "effort": self._option("publish_default_efforts", False),
        }
        self._out = self.create_publisher(JointState, "joint_states", 10)
        for source in self._option("source_list", []):
            self.create_subscription(JointState, source, self._take, 10)
        description = description or str(self._option("robot_description", ""))
        if description:
            self._set_description(description)
        else:
            self.get_logger().info("Waiting for robot_description to be published on the robot_description topic...")
        self.create_subscription(
            String, "robot_description", lambda message: self._set_description(message.data), _LATCHED
        )
        self.create_timer(1.0 / float(self._option("rate", 10)), self._publish)

    def _option(self, name, default):
        if self.has_parameter(name):
            return self.get_parameter(name).value
        value = ros1_parameter(self.get_fully_qualified_name(), name)
        return default if value is None else value

    def _set_description(self, description: str) -> None:
        try:
            self._robot = robot_frames(description)
        except DescriptionError as error:
            self.get_logger().error(f"Invalid robot description: {error}")
            return
        zeros = self.get_parameters_by_prefix("zeros")
        mimics = self._robot.mimics if self._uses_mimics else {}
        for name in self._robot.moving:
            low, high = self._robot.limits.get(name, (-1.0, 1.0))
            rest = (low + high) / 2 if low > 0.0 or high < 0.0 else 0.0
            if name not in mimics:
                self._positions[name] = float(zeros[name].value) if name in zeros else rest

    def _take(self, message: JointState) -> None:
        """Take the states of a topic in `source_list`."""
        for values, known in (
            (message.position, self._positions),
            (message.velocity, self._velocities),
            (message.effort, self._efforts),
        ):
            for name, value in zip(message.name, values, strict=False):
                if name in self._robot.moving:
                    known[name] = value

    def _publish(self) -> None:
        if not self._positions:
            return
        message = JointState()
        message.header.stamp = self.get_clock().now().to_msg()
        positions = dict(self._positions)
        for name, rule in self._robot.mimics.items() if self._uses_mimics else ():
            if rule.joint in positions:
                positions[name] = positions[rule.joint] * rule.multiplier + rule.offset
        message.name = [name for name in self._robot.moving if name in positions]
        if self._publishes["position"]:
            message.position = [positions[name] for name in message.name]
        for kind, known in (("velocity", self._velocities), ("effort", self._efforts)):
            if known or self._publishes[kind]:
                setattr(message, kind, [known.get(name, 0.0) for name in message.name])
        self._out.publish(message)
        if not self._has_told:
            self._has_told = report_second_joint_states(self.get_name(), self._out.topic_name)


def main() -> None:
    """Run the node until the end of the run; the first argument may be a file with the description."""
    rclpy.init(args=sys.argv)
    words = [word for word in remove_ros_args(sys.argv)[1:] if not word.startswith("-")]
    try:
        description = read_input_text(words[0]) if words else ""
    except OSError as error:
        sys.exit(f"{words[0]}: cannot be read: {error.strerror}")
    node = JointStatePublisher(description)
    with suppress(KeyboardInterrupt, ExternalShutdownException):
        rclpy.spin(node)


if __name__ == "__main__":
    main()
