"""Functions of `rospy.core`: the log, and the shutdown of the node."""

from __future__ import annotations

from collections.abc import Callable

from simkit_nodes.ros1_modules.rospy import log
from simkit_nodes.ros1_modules.rospy.client import on_shutdown
from simkit_nodes.ros1_modules.rospy.log import *  # noqa: F403 - the functions of the log, by level and form
from simkit_nodes.ros1_modules.rospy.names import get_caller_id, get_name, get_namespace, resolve_name
from simkit_nodes.ros1_modules.rospy.ros_node import ros_node

__all__ = [
    *log.__all__,
    "add_client_shutdown_hook",
    "add_preshutdown_hook",
    "add_shutdown_hook",
    "get_caller_id",
    "get_name",
    "get_namespace",
    "get_node_uri",
    "get_ros_root",
    "is_initialized",
    "is_shutdown",
    "is_shutdown_requested",
    "parse_rosrpc_uri",
    "resolve_name",
    "signal_shutdown",
]

add_client_shutdown_hook = on_shutdown


def is_shutdown() -> bool:
    """Check whether the node was shut down."""
    node = ros_node()
    node.poll()
    return node.is_shutdown


def is_shutdown_requested() -> bool:
    """Check whether the shutdown has begun."""
    return ros_node().is_shutting_down


def is_initialized() -> bool:
    """Check whether the program has called `init_node`."""
    return ros_node().is_initialized


def signal_shutdown(reason: str) -> None:
    """Shut the node down: call the functions of `on_shutdown` and end all waits."""
    ros_node().shut_down(str(reason))


def add_preshutdown_hook(h: Callable[[str], object]) -> None:
    """Call a function with the reason when the node is shut down."""
    on_shutdown(lambda: h("shutdown"))


add_shutdown_hook = add_preshutdown_hook


def get_node_uri() -> str:
    """Return an address of the node; simkit's nodes have no port."""
    return f"simkit:/{ros_node().name}"


def get_ros_root(required: bool = False, env: object = None) -> str | None:
    """Return the value of ROS_ROOT; simkit has no installation of ROS 1."""
    return None


def parse_rosrpc_uri(uri: str) -> tuple[str, int]:
    """Return host and port of an address such as `rosrpc://host:1234`.

    Raises:
        ValueError: the address has another form.
    """
    host, _, port = uri.removeprefix("rosrpc://").partition("/")[0].partition(":")
    if not uri.startswith("rosrpc://") or not port.isdigit():
        raise ValueError(f"Invalid protocol for ROS service URL: {uri}")
    return host, int(port)
