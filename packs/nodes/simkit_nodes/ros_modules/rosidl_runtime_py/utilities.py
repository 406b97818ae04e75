"""Classes of interfaces by their full names."""

from __future__ import annotations

from typing import Any

from simkit_nodes.ros_modules.rosidl_parser.definition import NamespacedType
from simkit_nodes.ros_modules.rosidl_runtime_py.import_message import import_message_from_namespaced_type

__all__ = [
    "get_action",
    "get_action_namespaced_type",
    "get_interface",
    "get_message",
    "get_message_namespaced_type",
    "get_namespaced_type",
    "get_service",
    "get_service_namespaced_type",
    "is_action",
    "is_message",
    "is_service",
]


def get_interface(identifier: str) -> Any:
    """Return the class of an interface, such as `geometry_msgs/msg/Twist`."""
    return import_message_from_namespaced_type(get_namespaced_type(identifier))


def get_message(identifier: str) -> Any:
    """Return the class of a message; `msg` may be missing in its name.

    Raises:
        ValueError: this is no message.
    """
    interface = import_message_from_namespaced_type(get_message_namespaced_type(identifier))
    if not is_message(interface):
        raise ValueError(f"Expected the full name of a message, got '{identifier}'")
    return interface


def get_service(identifier: str) -> Any:
    """Return the class of a service; `srv` may be missing in its name.

    Raises:
        ValueError: this is no service.
    """
    interface = import_message_from_namespaced_type(get_service_namespaced_type(identifier))
    if not is_service(interface):
        raise ValueError(f"Expected the full name of a service, got '{identifier}'")
    return interface


def get_action(identifier: str) -> Any:
    """Return the class of an action; `action` may be missing in its name.

    Raises:
        ValueError: this is no action.
    """
    interface = import_message_from_namespaced_type(get_action_namespaced_type(identifier))
    if not is_action(interface):
        raise ValueError(f"Expected the full name of an action, got '{identifier}'")
    return interface


def get_namespaced_type(identifier: str) -> NamespacedType:
    """Return the object that names an interface."""
    return _named(identifier, None)


def get_message_namespaced_type(identifier: str) -> NamespacedType:
    """Return the object that names a message."""
    return _named(identifier, "msg")


def get_service_namespaced_type(identifier: str) -> NamespacedType:
    """Return the object that names a service."""
    return _named(identifier, "srv")


def get_action_namespaced_type(identifier: str) -> NamespacedType:
    """Return the object that names an action."""
    return _named(identifier, "action")


def is_message(interface: object) -> bool:
    """Check whether a class is that of a message."""
    return hasattr(interface, "SLOT_TYPES")


def is_service(interface: object) -> bool:
    """Check whether a class is that of a service."""
    return hasattr(interface, "Request") and hasattr(interface, "Response")


def is_action(interface: object) -> bool:
    """Check whether a class is that of an action."""
    return all(hasattr(interface, part) for part in ("Goal", "Result", "Feedback"))


def _named(identifier: str, folder: str | None) -> NamespacedType:
    *namespaces, name = identifier.split("/")
    if len(namespaces) == 1 and folder is not None:
        namespaces.append(folder)
    return NamespacedType(namespaces, name)
