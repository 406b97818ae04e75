"""ROS 1's command controller_manager: `spawn`, `load`, `start`, `stop`, `unload`, `kill` and `list`."""

from __future__ import annotations

import sys

import rclpy
from controller_client import ControllerClient
from rclpy.node import Node
from rclpy.utilities import remove_ros_args


def run_verb(client: ControllerClient, verb: str, names: list[str]) -> bool:
    """Run a verb for controllers; return whether it succeeded."""
    if verb in ("list", "ls"):
        for name, controller in client.controllers().items():
            print(f"'{name}' - '{controller.type}' ( {controller.state} )")
        return True
    done = True
    if verb in ("spawn", "load"):
        done = all(bool(client.state(name)) or client.load(name) for name in names)
    if verb in ("spawn", "start"):
        waiting = [name for name in names if client.state(name) not in ("running", "active")]
        done = done and (not waiting or client.switch(waiting, []))
    if verb in ("stop", "kill"):
        running = [name for name in names if client.state(name) in ("running", "active")]
        done = not running or client.switch([], running)
    if verb in ("unload", "kill"):
        done = [client.unload(name) for name in names].count(False) == 0 and done
    return done


def main() -> int:
    """Run the verb of the command line."""
    rclpy.init()
    words = [word for word in remove_ros_args(sys.argv)[1:] if ":=" not in word]
    node = Node("controller_manager_command")
    if not words:
        node.get_logger().error("found no verb; expected spawn, load, start, stop, unload, kill or list")
        return 1
    is_done = run_verb(ControllerClient(node, "controller_manager"), words[0], words[1:])
    if not is_done:
        node.get_logger().error(f"{words[0]} of {', '.join(words[1:])} failed")
    return 0 if is_done else 1


if __name__ == "__main__":
    sys.exit(main())
