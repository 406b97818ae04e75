"""ros2_control_node: controls the robot of the description without a simulator, as with mock hardware."""

from __future__ import annotations

import sys

import rclpy
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import String

from simkit_launch.mock_robot import hardware_names, mock_robot
from simkit_launch.model_spawning import SpawnError, spawn_model
from simkit_launch.plugin_arguments import ros_element
from simkit_launch.program_simulation import current_simulation
from simkit_launch.robot_description import DescriptionError
from simkit_nodes.host import current_host, current_program

WARNING = 10.0
"""Time after which the node says again that it waits for a description [s]."""

DISCOVERY = 0.1
"""Time in which the node finds a manager of a simulator that exists [s]."""


def description_of(node: Node) -> str:
    """Return the description in the parameter `robot_description`, else wait for one on the topic."""
    value = node.declare_parameter("robot_description", "").value
    if value:
        return str(value)
    received: list[str] = []
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    for topic in ("robot_description", "~/robot_description"):
        node.create_subscription(String, topic, lambda message: received.append(message.data), latched)
    node.get_logger().info("Subscribing to 'robot_description' topic for robot description.")
    clock = node.get_clock()
    said = clock.now().nanoseconds
    while not received:
        rclpy.spin_once(node, timeout_sec=1.0)
        if not received and clock.now().nanoseconds - said >= WARNING * 1e9:
            said = clock.now().nanoseconds
            node.get_logger().warning("Waiting for data on 'robot_description' topic to finish initialization")
    return received[0]


def main() -> int:
    """Add the robot with its controller manager to the world, and wait for the end of the run."""
    rclpy.init()
    program, simulation = current_program(), current_simulation()
    node = Node("controller_manager", start_parameter_services=False)
    name, namespace, log = node.get_name(), node.get_namespace(), node.get_logger()
    description = description_of(node)
    service = f"{namespace.rstrip('/')}/{name}/list_controllers"
    rclpy.spin_once(node, timeout_sec=DISCOVERY)
    if service in dict(node.get_service_names_and_types()):
        log.warning(f"The simulation has a controller manager {name!r} already; this one has no effect beside it")
        current_host().wait()
    ros = ros_element(program, namespace, frozenset(("robot_description", "use_sim_time")), name)
    node.destroy_node()
    try:
        text = mock_robot(description, name, ros)
        model = spawn_model(simulation, text, "", None, may_rename=True)
    except (DescriptionError, SpawnError) as error:
        log.fatal(str(error))
        return 1
    for hardware in hardware_names(description):
        log.info(f"Successful initialization of hardware '{hardware}'")
    reason = "it is fixed to the world, without gravity and contacts, as with mock hardware"
    simulation.engine.reports.note("SK-LAUNCH-067", f"ros2_control_node has spawned the robot {model!r}: {reason}")
    current_host().wait()
    return 0


if __name__ == "__main__":
    sys.exit(main())
