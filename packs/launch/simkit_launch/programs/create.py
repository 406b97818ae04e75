"""`ros_gz_sim create`: spawns a model from a file, a text, a parameter or a topic, and ends."""

from __future__ import annotations

import sys

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.utilities import remove_ros_args
from std_msgs.msg import String

from simkit_launch.model_spawning import CREATE_FLAGS, FlagError, SpawnError, parse_flags, pose_of, spawn_model
from simkit_launch.program_simulation import current_simulation, report_other_world


def _options(node: Node, words: list[str]) -> dict[str, str | float | bool]:
    """Return the options: a parameter of the node comes before a flag of the command line."""
    values = parse_flags(words, CREATE_FLAGS)
    for name, default in CREATE_FLAGS.items():
        if name == "param":
            continue
        value = node.declare_parameter(name, default).value
        if value:
            values[name] = value
    return values


def _description_on(node: Node, topic: str) -> str:
    """Wait for a description on a topic and return it."""
    received: list[str] = []
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    node.create_subscription(String, topic, lambda message: received.append(message.data), latched)
    asked = -1.0
    while not received:
        now = node.get_clock().now().nanoseconds / 1e9
        if asked < 0 or now >= asked + 1.0:
            node.get_logger().info(f"Waiting messages on topic [{topic}].")
            asked = now
        rclpy.spin_once(node, timeout_sec=1.0)
    return received[0]


def _source(node: Node, options: dict[str, str | float | bool]) -> str | None:
    """Return the file, URI or text of the model; None after an error."""
    if options["file"]:
        return str(options["file"])
    if options["param"]:
        name = str(options["param"])
        text = node.declare_parameter(name, "").value
        if not text:
            node.get_logger().error(f"Failed to get XML from param [{name}].")
        return text or None
    if options["string"]:
        return str(options["string"])
    if options["topic"]:
        return _description_on(node, str(options["topic"]))
    node.get_logger().error("Must specify either -file, -param, -string or -topic")
    return None


def main() -> int:
    """Spawn the model; return the exit code."""
    rclpy.init(args=sys.argv)
    node = rclpy.create_node("ros_gz_sim")
    log = node.get_logger()
    try:
        options = _options(node, remove_ros_args(sys.argv)[1:])
    except FlagError as error:
        sys.stderr.write(f"ERROR: {error}\n")
        return 1
    try:
        if not options["world"]:
            log.info("Requesting list of world names.")
        source = _source(node, options)
        if source is None:
            return 255
        if options["world"]:
            report_other_world(node.get_name(), str(options["world"]))
        name, may_rename = str(options["name"]), bool(options["allow_renaming"])
        spawn_model(current_simulation(), source, name, pose_of(options), may_rename=may_rename)
    except (KeyboardInterrupt, ExternalShutdownException):
        return 0
    except SpawnError as error:
        log.error(f"Entity creation failed.\n {error}")
        return 1
    log.info("Entity creation successfull.")  # codespell:ignore successfull - the text of ros_gz_sim
    return 0


if __name__ == "__main__":
    sys.exit(main())
