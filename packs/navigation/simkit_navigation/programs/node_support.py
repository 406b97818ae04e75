"""Common parts of programs that stand for nodes of ROS: the states of a server of Nav2, the run, and warnings."""

import contextlib
import sys

import rclpy
from rclpy.exceptions import InvalidParameterTypeException
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.lifecycle import LifecycleNode, TransitionCallbackReturn

from simkit.extend import Where
from simkit_nodes.host import current_host
from simkit_nodes.parameter_overrides import parameter_places

_KINDS = {bool: "true or false", int: "an integer", float: "a number", str: "a text", list: "a list"}


class ServerNode(LifecycleNode):
    """Node that logs the changes of its state as a server of Nav2."""

    _is_active = False

    def declare_parameter(self, name, value=None, *arguments, **options):
        """Declare a parameter; one of another type has its default, and a warning says so."""
        try:
            return super().declare_parameter(name, value, *arguments, **options)
        except InvalidParameterTypeException:
            given = self._parameter_overrides[name].value
            warn_of_type(self, name, given, value)
            return super().declare_parameter(name, value, *arguments, ignore_override=True)

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


def warn_of_type(node, name, given, default):
    """Warn that a parameter has a value of another type than its default, which is used."""
    expected = _KINDS.get(type(default), "a list")
    if isinstance(default, float) and isinstance(given, int) and not isinstance(given, bool):
        expected = f"a number with a decimal point, {float(given)!r}"
    elif isinstance(default, list) and default:
        expected = f"a list, such as {default!r}"
    where = parameter_places(node.get_fully_qualified_name(), node.context.arguments).get(name)
    warn(node, "SK-NAV-005", f"{name} is {given!r:.80}; expected {expected}; the default {default!r} is used", where)


def warn(node, code, text, where=None):
    """Report a warning; its place is the executable, unless the line of a parameter file is known."""
    text = f"{node.get_fully_qualified_name()}: {text}"
    simulation = current_host().simulation
    if simulation is None:
        node.get_logger().warning(text)
    else:
        simulation.engine.reports.warning(code, text, where or Where(sys.argv[0]))
