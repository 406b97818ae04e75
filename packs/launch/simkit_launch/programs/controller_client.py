"""Client of the services of a controller manager, for spawners and for `ros2 control`."""

from __future__ import annotations

from typing import Any

import rclpy
from builtin_interfaces.msg import Duration
from controller_manager_msgs.srv import (
    ConfigureController,
    ListControllers,
    LoadController,
    SwitchController,
    UnloadController,
)
from rclpy.node import Node

DISCOVERY = 0.1
"""Time in which a client finds a service that exists [s]."""

LOOK = 10.0
"""Time after which a client says again that it waits for a service [s]."""


class NoServiceError(Exception):
    """Error for a service that does not exist in time."""


class ControllerClient:
    """Client of a controller manager.

    Args:
        node: node of the client.
        manager: name of the manager; relative to the namespace of the node.
        timeout: longest time to wait for a service [s]; 0 for no limit.
    """

    def __init__(self, node: Node, manager: str, timeout: float = 0.0) -> None:
        self.node = node
        namespace = node.get_namespace().rstrip("/")
        self.manager = manager if manager.startswith("/") else f"{namespace}/{manager}"
        self._timeout = timeout
        self._clients: dict[str, Any] = {}

    def call(self, service: str, kind: Any, request: Any) -> Any:
        """Call a service of the manager as soon as it exists, and return its response.

        Raises:
            NoServiceError: the service does not exist in time.
        """
        name = f"{self.manager}/{service}"
        if name not in self._clients:
            self._clients[name] = self.node.create_client(kind, name)
        client, log = self._clients[name], self.node.get_logger()
        if not client.wait_for_service(DISCOVERY):
            log.info(f"waiting for service {name} to become available...")
            while not client.wait_for_service(self._timeout or LOOK):
                if self._timeout:
                    raise NoServiceError(f"Could not contact service {name}")
                log.warning(f"Could not contact service {name}")
        future = client.call_async(request)
        rclpy.spin_until_future_complete(self.node, future)
        return future.result()

    @property
    def is_ros1(self) -> bool:
        """True if the manager is that of ROS 1, which has no parameters of its own."""
        names = {name for name, _ in self.node.get_service_names_and_types()}
        return f"{self.manager}/list_controllers" in names and f"{self.manager}/set_parameters" not in names

    def controllers(self) -> dict[str, Any]:
        """Return the loaded controllers by name."""
        response = self.call("list_controllers", ListControllers, ListControllers.Request())
        return {controller.name: controller for controller in response.controller}

    def state(self, controller: str) -> str:
        """Return the state of a controller; empty if it is not loaded."""
        found = self.controllers().get(controller)
        return str(found.state) if found is not None else ""

    def load(self, controller: str) -> bool:
        """Load a controller."""
        request = LoadController.Request(name=controller)
        return bool(self.call("load_controller", LoadController, request).ok)

    def configure(self, controller: str) -> bool:
        """Configure a loaded controller."""
        request = ConfigureController.Request(name=controller)
        return bool(self.call("configure_controller", ConfigureController, request).ok)

    def unload(self, controller: str) -> bool:
        """Unload a controller that is not active."""
        request = UnloadController.Request(name=controller)
        return bool(self.call("unload_controller", UnloadController, request).ok)

    def switch(self, activate: list[str], deactivate: list[str], *, is_strict: bool = True) -> bool:
        """Activate and deactivate controllers."""
        kind = SwitchController.Request
        request = kind(activate_controllers=activate, deactivate_controllers=deactivate, timeout=Duration(sec=5))
        request.strictness = kind.STRICT if is_strict else kind.BEST_EFFORT
        return bool(self.call("switch_controller", SwitchController, request).ok)
