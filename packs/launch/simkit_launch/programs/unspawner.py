"""Deactivates and unloads controllers, as controller_manager's unspawner."""

from __future__ import annotations

import argparse
import sys

import rclpy
from controller_client import ControllerClient, NoServiceError
from rclpy.node import Node
from rclpy.utilities import remove_ros_args


def main() -> int:
    """Unload the controllers of the command line."""
    rclpy.init()
    parser = argparse.ArgumentParser(prog="unspawner")
    parser.add_argument("controllers", nargs="+")
    parser.add_argument("-c", "--controller-manager", default="/controller_manager")
    parser.add_argument("--switch-timeout", type=float, default=5.0)
    options = parser.parse_args(remove_ros_args(sys.argv)[1:])
    node = Node(f"unspawner_{options.controllers[0]}")
    client, log = ControllerClient(node, options.controller_manager), node.get_logger()
    try:
        active = [name for name in options.controllers if client.state(name) in ("active", "running")]
        if active and client.switch([], active):
            log.info("Deactivated controller")
        for name in options.controllers:
            if not client.unload(name):
                log.info("Failed to unload controller")
                return 1
            log.info("Unloaded controller")
    except NoServiceError as error:
        log.fatal(str(error))
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
