"""Commands of `ros2` in a launch file: `control`, `topic`, `service`, `param`, `action`, `lifecycle` and others."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping

import rclpy
from command_actions import action_command
from command_controllers import control_command
from command_node_list import list_command
from command_parameters import param_command
from command_services import lifecycle_command, service_command
from command_topics import topic_command
from rclpy.node import Node

Command = Callable[[Node, list[str]], int]

COMMANDS: Mapping[str, Command] = {
    "control": control_command,
    "topic": topic_command,
    "service": service_command,
    "param": param_command,
    "action": action_command,
    "lifecycle": lifecycle_command,
    "node": list_command,
}

WITHOUT_EFFECT: Mapping[str, str] = {
    "bag": "use --record FILE to record a run, and --play FILE to send the commands of a bag again",
    "launch": "include the launch file with IncludeLaunchDescription, or start it with simkit launch",
    "daemon": "simkit has no daemon",
    "doctor": "use simkit doctor",
    "interface": "use simkit interface",
    "multicast": "simkit has no network",
    "pkg": "use simkit pkg",
    "component": "load components with ComposableNodeContainer in the launch file",
    "security": "simkit has no network",
    "wtf": "use simkit doctor",
}


def main() -> int:
    """Run the command in the arguments of the program."""
    words = [word for word in sys.argv[1:] if word not in ("--use-sim-time", "--no-daemon", "-s")]
    rclpy.init(args=[])
    node = Node("_ros2cli")
    verb = words[0] if words else ""
    if verb in WITHOUT_EFFECT:
        node.get_logger().warning(f"`ros2 {' '.join(words)}` has no effect here: {WITHOUT_EFFECT[verb]}")
        return 0
    if verb not in COMMANDS:
        allowed = ", ".join(sorted((*COMMANDS, "run")))
        node.get_logger().error(f"`ros2 {' '.join(words)}`: unknown command; here there are: {allowed}")
        return 2
    try:
        return COMMANDS[verb](node, words)
    except KeyboardInterrupt:
        return 0


if __name__ == "__main__":
    sys.exit(main())
