"""Lifecycle manager of Nav2: configures, activates, pauses and shuts down the nodes of `node_names` in their order."""

import sys

import rclpy
from lifecycle_msgs.srv import ChangeState, GetState
from nav2_msgs.srv import ManageLifecycleNodes
from node_support import run, warn
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from std_srvs.srv import Trigger

CONFIGURE, CLEANUP, ACTIVATE, DEACTIVATE = 1, 2, 3, 4
SHUTDOWN_OF_STATE = {1: 5, 2: 6, 3: 7}
TEXTS = {CONFIGURE: "Configuring", CLEANUP: "Cleaning up", ACTIVATE: "Activating", DEACTIVATE: "Deactivating"}
PATIENCE = 5.0  # [s] Nav2 waits for ever


class LifecycleManager(Node):
    """Node with the services `~/manage_nodes` and `~/is_active`."""

    def __init__(self):
        super().__init__("lifecycle_manager")
        self._names = list(self.declare_parameter("node_names", [""]).value or [])
        self._names = [name for name in self._names if name]
        is_automatic = self.declare_parameter("autostart", False).value
        for name, value in (
            ("bond_timeout", 4.0),
            ("service_timeout", 5.0),
            ("bond_respawn_max_duration", 10.0),
            ("attempt_respawn_reconnection", True),
        ):
            self.declare_parameter(name, value)
        self._is_active = False
        self._missing = set()
        name, namespace = f"{self.get_name()}_service_client", self.get_namespace()
        self._client_node = Node(name, namespace=namespace, use_global_arguments=False)
        self._executor_of_clients = SingleThreadedExecutor()
        self._executor_of_clients.add_node(self._client_node)
        self.create_service(ManageLifecycleNodes, "~/manage_nodes", self._on_manage)
        self.create_service(Trigger, "~/is_active", self._on_is_active)
        if is_automatic:
            self._start_timer = self.create_timer(0.0, self._on_start)

    def _on_start(self):
        self._start_timer.cancel()
        self._start_up()

    def _on_manage(self, request, response):
        commands = {
            request.STARTUP: self._start_up,
            request.PAUSE: lambda: self._bring("Pausing", "paused", False, DEACTIVATE, reverse=True),
            request.RESUME: lambda: self._bring("Resuming", "active", True, ACTIVATE),
            request.RESET: lambda: self._bring("Resetting", "reset", False, DEACTIVATE, CLEANUP, reverse=True),
            request.SHUTDOWN: self._shut_down,
        }
        command = commands.get(request.command)
        response.success = command is not None and command()
        return response

    def _on_is_active(self, request, response):
        response.success = self._is_active
        return response

    def _start_up(self):
        return self._bring("Starting", "active", True, CONFIGURE, ACTIVATE)

    def _bring(self, verb, state, is_active, *transitions, reverse=False):
        """Apply transitions to all nodes; return False after the first one that fails."""
        self.get_logger().info(f"{verb} managed nodes bringup...")
        names = self._names[::-1] if reverse else self._names
        for transition in transitions:
            for name in names:
                if name not in self._missing and not self._change(name, transition):
                    self.get_logger().error("Failed to bring up all requested nodes. Aborting bringup.")
                    return False
        self._is_active = is_active
        self.get_logger().info(f"Managed nodes are {state}")
        return True

    def _shut_down(self):
        self.get_logger().info("Shutting down managed nodes...")
        self._is_active = False
        for name in reversed(self._names):
            state = 0 if name in self._missing else self._state_of(name)
            if state in SHUTDOWN_OF_STATE:
                self._call(ChangeState, f"{name}/change_state", _request(SHUTDOWN_OF_STATE[state]))
        self.get_logger().info("Managed nodes have been shut down")
        return True

    def _change(self, name, transition):
        """Apply a transition to a node; a node that does not exist is left out after a warning."""
        self.get_logger().info(f"{TEXTS[transition]} {name}")
        response = self._call(ChangeState, f"{name}/change_state", _request(transition))
        if response is None:
            self._missing.add(name)
            warn(self, "SK-NAV-003", f"no node {name!r} after {PATIENCE:g} s; the others are managed without it")
            return True
        if not response.success:
            self.get_logger().error(f"Failed to change state for node: {name}")
        return response.success

    def _state_of(self, name):
        response = self._call(GetState, f"{name}/get_state", GetState.Request())
        return 0 if response is None else response.current_state.id

    def _call(self, kind, name, request):
        """Return the response of a service; None if there is no service."""
        client = self._client_node.create_client(kind, name)
        try:
            if not client.wait_for_service(timeout_sec=PATIENCE):
                return None
            future = client.call_async(request)
            self._executor_of_clients.spin_until_future_complete(future)
            return future.result()
        finally:
            self._client_node.destroy_client(client)


def _request(transition):
    request = ChangeState.Request()
    request.transition.id = transition
    return request


def main():
    """Run the node."""
    rclpy.init(args=sys.argv)
    node = LifecycleManager()
    run(node)


if __name__ == "__main__":
    main()
