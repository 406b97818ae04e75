"""Names in rospy: relative to the node of the program, and after the remappings of its command line."""

from __future__ import annotations

from simkit_nodes.ros1_modules.rospy.exceptions import ROSException
from simkit_nodes.ros1_modules.rospy.ros_node import ros_node
from simkit_nodes.ros1_names import (
    ANYTYPE,
    GLOBALNS,
    REMAP,
    SEP,
    canonicalize_name,
    get_ros_namespace,
    is_global,
    is_private,
    load_mappings,
    make_global_ns,
    namespace,
    ns_join,
)

__all__ = [
    "ANYTYPE",
    "GLOBALNS",
    "REMAP",
    "SEP",
    "SERVICE_ANYTYPE",
    "TOPIC_ANYTYPE",
    "canonicalize_name",
    "get_caller_id",
    "get_mappings",
    "get_name",
    "get_namespace",
    "get_ros_namespace",
    "is_global",
    "is_private",
    "load_mappings",
    "make_global_ns",
    "namespace",
    "ns_join",
    "remap_name",
    "resolve_name",
    "resolve_name_without_node_name",
    "scoped_name",
]

TOPIC_ANYTYPE = SERVICE_ANYTYPE = ANYTYPE


def get_name() -> str:
    """Return the full name of the node; `/unnamed` before `init_node`."""
    return ros_node().name


get_caller_id = get_name


def get_namespace() -> str:
    """Return the namespace of the node, with a slash at the end."""
    return ros_node().namespace


def get_mappings() -> dict[str, str]:
    """Return the new names by the old ones, as on the command line."""
    return ros_node().mappings


def resolve_name(name: str, caller_id: str | None = None) -> str:
    """Return the global form of a name after the remappings.

    Args:
        name: global, relative or private name; an empty one is the namespace.
        caller_id: full name of the node to which the name is relative; None for the node of the program.
    """
    return ros_node().resolve(name, caller_id)


def resolve_name_without_node_name(name: str) -> str:
    """Return the global form of a name before `init_node`."""
    return ros_node().resolve_endpoint(name)


def remap_name(name: str, caller_id: str | None = None, resolved: bool = True) -> str:
    """Return the global form of a name that is remapped, and any other name as it is."""
    node = ros_node()
    return node.resolve(node.mappings[name], caller_id) if name in node.mappings else name


def scoped_name(caller_id: str, name: str) -> str:
    """Return a global name without the namespace of a node.

    Raises:
        ROSException: the name of the node is not global.
    """
    if not is_global(caller_id):
        raise ROSException("caller_id must be global")
    return canonicalize_name(name)[len(namespace(caller_id)) :]
