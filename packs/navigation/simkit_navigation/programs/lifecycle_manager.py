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
CONFIGURE_COMMAND, CLEANUP_COMMAND = 5, 6  # of the service in Jazzy
PATIENCE = 5.0  # [s] Nav2 waits for ever


class LifecycleManager(Node):
    """Node with the services `~/manage_nodes` and `~/is_active`."""

    def __init__(self):
        super().__init__("lifecycle_manager")
        self._names = list(self.declare_parameter("node_names", [""]).value or [])
        self._names = [name for name in self._names if name]
        is_automatic = self.declare_parameter("autostart", False).value
        self._bond_timeout = self.declare_parameter("bond_timeout", 4.0).value
        self._longest_respawn = self.declare_parameter("bond_respawn_max_duration", 10.0).value
        self._respawns = self.declare_parameter("attempt_respawn_reconnection", True).value
        self._exits = self.declare_parameter("exit_on_failure", False).value  # of simkit alone: `--nav` sets it
        self.declare_parameter("service_timeout", 5.0)
        self._is_active = False
        self._missing = set()
        self._lost = {}  # seconds since which a node is lost, by its name
        self._respawn_timer = None
        name, namespace = f"{self.get_name()}_service_client", self.get_namespace()
        self._client_node = Node(name, namespace=namespace, use_global_arguments=False)
        self._executor_of_clients = SingleThreadedExecutor()
        self._executor_of_clients.add_node(self._client_node)
        self.create_service(ManageLifecycleNodes, "~/manage_nodes", self._on_manage)
        self.create_service(Trigger, "~/is_active", self._on_is_active)
        self._states = {name: self._client_node.create_client(GetState, f"{name}/get_state") for name in self._names}
        if self._bond_timeout > 0:
            self.create_timer(1.0, self._check_bonds)
        if is_automatic:
            self._start_timer = self.create_timer(0.0, self._on_start)

    def _on_start(self):
        self._start_timer.cancel()
        if not self._start_up() and self._exits:
            sys.exit("a node did not become active; its error is above")

    def _on_manage(self, request, response):
        commands = {
            request.STARTUP: self._start_up,
            request.PAUSE: lambda: self._bring("Pausing", "paused", False, DEACTIVATE, reverse=True),
            request.RESUME: lambda: self._bring("Resuming", "active", True, ACTIVATE),
            request.RESET: lambda: self._bring("Resetting", "reset", False, DEACTIVATE, CLEANUP, reverse=True),
            request.SHUTDOWN: self._shut_down,
            CONFIGURE_COMMAND: lambda: self._bring("Configuring", "configured", False, CONFIGURE),
            CLEANUP_COMMAND: lambda: self._bring("Cleaning up", "cleaned up", False, CLEANUP, reverse=True),
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

    def _now(self):
        return self.get_clock().now().nanoseconds * 1e-9

    def _is_there(self, name):
        """Check whether a node has its services; a node that was missing from the beginning counts."""
        return name in self._missing or self._states[name].service_is_ready()

    def _check_bonds(self):
        """Take all nodes down if one of them has ended, as Nav2 does after `bond_timeout` without a heartbeat."""
        if not self._is_active:
            self._lost.clear()
            return
        now = self._now()
        for name in self._names:
            if self._is_there(name):
                self._lost.pop(name, None)
            elif now - self._lost.setdefault(name, now) >= self._bond_timeout:
                self._take_down(name)
                return

    def _take_down(self, name):
        """Reset the nodes that are left, and wait for the one that has ended."""
        self.get_logger().error(
            f"CRITICAL FAILURE: SERVER {name} IS DOWN after not receiving a heartbeat for "
            f"{round(self._bond_timeout * 1e3)} ms. Shutting down related nodes."
        )
        self._is_active = False
        self._lost.clear()
        for transition in (DEACTIVATE, CLEANUP):
            for other in reversed(self._names):
                if self._states[other].service_is_ready():
                    self._change(other, transition)
        if self._respawns:
            self._respawn_end = self._now() + self._longest_respawn
            self._respawn_timer = self.create_timer(1.0, self._check_respawn)

    def _check_respawn(self):
        """Start all nodes again as soon as the one that has ended is back."""
        is_back = all(map(self._is_there, self._names))
        if not is_back and self._now() < self._respawn_end:
            return
        self.destroy_timer(self._respawn_timer)
        if is_back:
            self.get_logger().info("Successfully re-established connections from server respawns, starting back up.")
            self._start_up()
        else:
            end = f"after maximum timeout: {self._longest_respawn:g} s."
            self.get_logger().error(f"Failed to re-establish connection from a server crash {end}")

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
