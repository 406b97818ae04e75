"""Common parts of programs that stand for nodes of ROS: the states of a server of Nav2, the run, and warnings."""

import contextlib
import sys

import rclpy
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.lifecycle import LifecycleNode, TransitionCallbackReturn

from simkit.extend import Where
from simkit_nodes.host import current_host


class ServerNode(LifecycleNode):
    """Node that logs the changes of its state as a server of Nav2."""

    _is_active = False

    def on_configure(self, state):
        """Log the change."""
        return self._log("Configuring")

    def on_activate(self, state):
        """Log the change, and note that the node is active."""
        self._is_active = True
        return self._log("Activating")

    def on_deactivate(self, state):
        """Log the change, and note that the node is not active."""
        self._is_active = False
        return self._log("Deactivating")

    def on_cleanup(self, state):
        """Log the change."""
        return self._log("Cleaning up")

    def on_shutdown(self, state):
        """Log the change."""
        self._is_active = False
        return self._log("Shutting down")

    def _log(self, text):
        self.get_logger().info(text)
        return TransitionCallbackReturn.SUCCESS


def run(node, executor=None):
    """Run a node until the end of the program."""
    executor = executor or SingleThreadedExecutor()
    executor.add_node(node)
    with contextlib.suppress(KeyboardInterrupt, ExternalShutdownException):
        executor.spin()
    rclpy.try_shutdown()


def warn(node, code, text):
    """Report a warning; its place is the executable, because files of parameters are often temporary ones."""
    text = f"{node.get_fully_qualified_name()}: {text}"
    simulation = current_host().simulation
    if simulation is None:
        node.get_logger().warning(text)
    else:
        simulation.engine.reports.warning(code, text, Where(sys.argv[0]))
