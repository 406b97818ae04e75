"""Activates or configures hardware components, as controller_manager's hardware_spawner."""

from __future__ import annotations

import argparse
import sys

import rclpy
from controller_client import ControllerClient, NoServiceError
from controller_manager_msgs.srv import ListHardwareComponents, SetHardwareComponentState
from lifecycle_msgs.msg import State
from rclpy.node import Node
from rclpy.utilities import remove_ros_args


def main() -> int:
    """Set the state of the hardware components of the command line."""
    rclpy.init()
    parser = argparse.ArgumentParser(prog="hardware_spawner")
    parser.add_argument("hardware_component_names", nargs="*")
    parser.add_argument("-c", "--controller-manager", default="/controller_manager")
    parser.add_argument("--controller-manager-timeout", type=float, default=0.0)
    parser.add_argument("--switch-timeout", "--service-call-timeout", type=float, default=5.0)
    parser.add_argument("--activate", action="store_true")
    parser.add_argument("--configure", action="store_true")
    options = parser.parse_args(remove_ros_args(sys.argv)[1:])
    node = Node("hardware_spawner")
    client, log = (
        ControllerClient(node, options.controller_manager, options.controller_manager_timeout),
        node.get_logger(),
    )
    state = State(id=State.PRIMARY_STATE_INACTIVE, label="inactive")
    if options.activate:
        state = State(id=State.PRIMARY_STATE_ACTIVE, label="active")
    try:
        listed = client.call("list_hardware_components", ListHardwareComponents, ListHardwareComponents.Request())
        known = [component.name for component in listed.component]
        for name in options.hardware_component_names:
            if name not in known:
                log.error(f"Hardware Component with name '{name}' does not exists; there are: {', '.join(known)}")
                return 1
            request = SetHardwareComponentState.Request(name=name, target_state=state)
            response = client.call("set_hardware_component_state", SetHardwareComponentState, request)
            log.info(f"Set component '{name}' to state '{response.state.label}'.")
            if not response.ok and options.activate:
                return 1
    except NoServiceError as error:
        log.fatal(str(error))
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
