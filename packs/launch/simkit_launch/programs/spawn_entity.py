"""`gazebo_ros spawn_entity.py`: spawns a model from a file, a topic or a name, as in Gazebo Classic."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.utilities import remove_ros_args
from std_msgs.msg import String

from simkit_launch.model_spawning import SpawnError, add_entity_arguments, add_spawn_arguments, set_joints, spawn_with
from simkit_launch.program_simulation import current_simulation

_PERIOD = 0.1


def _arguments(words: list[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="spawn_entity.py", description="Spawn an entity in gazebo", allow_abbrev=False
    )
    add_entity_arguments(parser)
    add_spawn_arguments(parser)
    parser.add_argument("-timeout", type=float, default=30.0)
    parser.add_argument("-spawn_service_timeout", type=float)
    parser.add_argument("-pause", action="store_true")
    return parser.parse_args(words)


def _source(node: Node, given: argparse.Namespace) -> str | None:
    """Return the text, file or URI of the model; None after an error."""
    log = node.get_logger()
    if given.file:
        log.info(f"Loading entity XML from file {given.file}")
        if not Path(given.file).is_file():
            kind = "is not a file" if Path(given.file).exists() else "does not exist"
            log.error(f"Error: specified file {given.file} {kind}")
            return None
        return str(given.file)
    if given.database:
        log.info("Loading entity XML from Gazebo Model Database")
        return f"model://{given.database}"
    if given.stdin:
        log.info("Loading entity XML from stdin")
        return sys.stdin.read() or None
    log.info(f"Loading entity published on topic {given.topic}")
    received: list[str] = []
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    node.create_subscription(String, given.topic, lambda message: received.append(message.data), latched)
    while not received:
        log.info(f"Waiting for entity xml on {given.topic}")
        rclpy.spin_once(node)
    return received[0]


def _wait_for(node: Node, name: str) -> None:
    """Wait until a model exists."""
    node.get_logger().info(f"Waiting for entity {name} before proceeding.")
    while name not in current_simulation().models:
        rclpy.spin_once(node, timeout_sec=_PERIOD)


def main() -> int:
    """Spawn the model; return the exit code."""
    rclpy.init(args=sys.argv)
    given = _arguments(remove_ros_args(sys.argv)[1:])
    node = rclpy.create_node("spawn_entity")
    log, sim = node.get_logger(), current_simulation()
    try:
        if given.wait:
            _wait_for(node, given.wait)
        source = _source(node, given)
        if source is None:
            return 1
        if given.pause:
            sim.paused = True
        prefix = given.gazebo_namespace
        log.info(f"Waiting for service {prefix}/spawn_entity, timeout = {given.timeout:.0f}")
        log.info(f"Waiting for service {prefix}/spawn_entity")
        log.info(f"Calling service {prefix}/spawn_entity")
        try:
            name = spawn_with(sim, given, source, given.entity)
            log.info(f"Spawn status: SpawnEntity: Successfully spawned entity [{name}]")
            set_joints(sim, name, given.joints)
        except SpawnError as error:
            log.info(f"Spawn status: {error}")
            log.error("Spawn service failed. Exiting.")
            return 1
        if given.unpause:
            sim.paused = False
        if given.bond:
            log.info(f"Waiting for shutdown to delete entity [{name}]")
            rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    return 0


if __name__ == "__main__":
    sys.exit(main())
