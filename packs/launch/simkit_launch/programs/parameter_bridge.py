"""`ros_gz_bridge parameter_bridge`: connects topics and services of Gazebo with those of ROS."""

from __future__ import annotations

import sys
from contextlib import closing, suppress
from pathlib import Path

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.utilities import remove_ros_args

from simkit_launch.bridge_rules import (
    BridgeError,
    BridgeRule,
    pair_fault,
    rule_of_word,
    rules_of_entries,
    rules_of_file,
)
from simkit_launch.program_simulation import current_simulation
from simkit_launch.topic_bridge import TopicBridge
from simkit_nodes.host import current_program

_SOON, _LATER, _MANY = 0.02, 0.5, 100
_ARROWS = {"GZ_TO_ROS": "GZ->ROS", "ROS_TO_GZ": "ROS->GZ"}
_WITHOUT_EFFECT = {
    "override_timestamps_with_wall_time": "all stamps are simulated time, because runs must repeat",
    "override_frame_id": "the messages keep the frames of the simulation",
    "publish_optical_frame": "name the frame with <optical_frame_id> of the camera",
}


class ParameterBridge(Node):
    """Node of the bridge.

    Args:
        words: words of the command line, each with a rule.
    """

    def __init__(self, words: list[str]) -> None:
        super().__init__("ros_gz_bridge", allow_undeclared_parameters=True)
        self.lazy = bool(self.declare_parameter("lazy", False).value)
        self._expands = bool(self.declare_parameter("expand_gz_topic_names", False).value)
        self.declare_parameter("subscription_heartbeat", 1000)
        file = str(self.declare_parameter("config_file", "").value)
        rules = [rule_of_word(word) for word in words]
        rules += rules_of_file(Path(file)) if file else []
        rules += self._rules_of_parameters()
        for name, reason in _WITHOUT_EFFECT.items():
            if self.declare_parameter(name, "" if name == "override_frame_id" else False).value:
                self.get_logger().warn(f"parameter {name} has no effect: {reason}")
        self._bridge = TopicBridge(current_simulation(), self.get_fully_qualified_name(), self.get_logger().error)
        for rule in rules:
            self._add(rule)
        self._looks = 0
        self._timer = self.create_timer(_SOON, self._look)
        self._bridge.connect()
        current_program().on_report.append(self._bridge.report_missing)

    def _rules_of_parameters(self) -> list[BridgeRule]:
        """Return the rules of the parameters `bridges.NAME.KEY` for the names in `bridge_names`."""
        names = self.declare_parameter("bridge_names", [""]).value or []
        entries = []
        overrides = {name: value.value for name, value in self._parameter_overrides.items()}
        for each in filter(None, names):
            prefix = f"bridges.{each}."
            entry = {key.removeprefix(prefix): value for key, value in overrides.items() if key.startswith(prefix)}
            entries.append({key: value for key, value in entry.items() if "." not in key})
        return rules_of_entries(entries, "bridge_names")

    def _add(self, rule: BridgeRule) -> None:
        log = self.get_logger()
        if rule.is_service:
            self._add_service(rule)
            return
        gz = self.resolve_topic_name(rule.gz_name, only_expand=True) if self._expands else rule.gz_name
        ros = self.resolve_topic_name(rule.ros_name)
        fault = pair_fault(rule)
        if fault:
            log.warn(
                f"Failed to create a bridge for topic [{rule.ros_name}] with ROS2 type [{rule.ros_type}] "
                f"to topic [{gz}] with Gazebo Transport type [{rule.gz_type}]: {fault}"
            )
            return
        ends = {"GZ": f"{gz} ({rule.gz_type})", "ROS": f"{rule.ros_name} ({rule.ros_type})"}
        for arrow in [_ARROWS[rule.direction]] if rule.direction in _ARROWS else _ARROWS.values():
            first, second = arrow.split("->")
            log.info(f"Creating {arrow} Bridge: [{ends[first]} -> {ends[second]}] (Lazy {int(self.lazy)})")
        self._bridge.add(rule, gz, ros)

    def _add_service(self, rule: BridgeRule) -> None:
        """Offer a service of the simulation under a further name."""
        name = self.resolve_service_name(rule.ros_name)
        self.get_logger().info(f"Creating ROS->GZ service bridge [{rule.gz_name} ({rule.ros_type})]")
        if name == rule.gz_name:
            return
        self._bridge.add_service(self._graph_node, name, rule.gz_name, rule.ros_type)

    def _look(self) -> None:
        """Connect what has appeared; a model that is spawned later is found within half a second."""
        self._bridge.connect()
        self._looks += 1
        if self._bridge.is_complete:
            self.destroy_timer(self._timer)
        elif self._looks == _MANY:
            self.destroy_timer(self._timer)
            self._timer = self.create_timer(_LATER, self._look)

    def close(self) -> None:
        """Close all connections."""
        self._bridge.close()


def main() -> int:
    """Run the bridge until the end of the run; return the exit code."""
    rclpy.init(args=sys.argv)
    try:
        node = ParameterBridge(remove_ros_args(sys.argv)[1:])
    except BridgeError as error:
        sys.stderr.write(f"parameter_bridge: {error}\n")
        return 255
    with closing(node), suppress(KeyboardInterrupt, ExternalShutdownException):
        rclpy.spin(node)
    return 0


if __name__ == "__main__":
    sys.exit(main())
