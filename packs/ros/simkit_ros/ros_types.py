"""Classes of rclpy for the names of message, service and action types."""

from __future__ import annotations

import importlib
from typing import Any, NamedTuple

from simkit_ros import opaque_types
from simkit_ros.type_support import installed_hash


class RosType(NamedTuple):
    """Class of rclpy for a type.

    Attributes:
        name: full name of the type, such as `sensor_msgs/msg/Imu`.
        cls: class for publishers, subscriptions and services.
        is_opaque: True for a class whose values are CDR, because the type is not installed.
    """

    name: str
    cls: Any
    is_opaque: bool = False

    def to_cdr(self, value: Any) -> bytes:
        """Return the CDR of a message, or of a service's request or response."""
        if self.is_opaque:
            return bytes(value.cdr)
        from rclpy.serialization import serialize_message

        return bytes(serialize_message(value))

    def from_cdr(self, data: bytes, cls: type) -> object:
        """Return the object of a class of this type from its CDR."""
        if self.is_opaque:
            return cls(data)
        from rclpy.serialization import deserialize_message

        return deserialize_message(data, cls)


class TypeUnavailable(Exception):
    """Error for a type that the bridge cannot pass on; the message has the reason."""


class TypeFinder:
    """Finder of the classes for types.

    Attributes:
        hashes: type hashes of the simulation's types (`RIHS01_…`), by the name of the type.
    """

    def __init__(self) -> None:
        self.hashes: dict[str, str] = {}
        self._found: dict[str, RosType] = {}

    def find(self, name: str) -> RosType:
        """Return the installed class of a message or service type, else an opaque class.

        The type hash of an installed class must be that of the simulation, because its messages would otherwise have
        other fields.

        Raises:
            TypeUnavailable: the type is installed with other fields, or it is not installed and cannot be opaque.
        """
        if name not in self._found:
            installed = _installed_class(name)
            if installed is None:
                self._found[name] = RosType(name, self._opaque_class(name), True)
            else:
                self._check_hash(name, installed)
                self._found[name] = RosType(name, installed)
        return self._found[name]

    def _check_hash(self, name: str, installed: type) -> None:
        expected, present = self.hashes.get(name, ""), installed_hash(installed)
        if expected and present and expected != present:
            raise TypeUnavailable(f"the installed {name} has other fields than simkit's")

    def _opaque_class(self, name: str) -> type:
        try:
            make = opaque_types.message_class if "/msg/" in name or "_Feedback" in name else opaque_types.service_class
            return make(name, self.hashes.get(name, ""))
        except (OSError, AttributeError, ValueError) as error:
            raise TypeUnavailable(f"{name} is not installed in this Python ({error})") from None


def _installed_class(name: str) -> type | None:
    """Return the class of an installed type; None if it is not installed.

    The parts of an action, such as `pkg/action/Name_SendGoal`, are attributes of the action's class.
    """
    package, kind, short = name.split("/")
    base, _, part = short.rpartition("_") if kind == "action" else (short, "", "")
    try:
        cls = getattr(importlib.import_module(f"{package}.{kind}"), base)
        wanted = cls if not part else getattr(cls.Impl, _ACTION_PARTS[part])
        if wanted.__class__._TYPE_SUPPORT is None:
            wanted.__class__.__import_type_support__()
    except (ImportError, AttributeError, KeyError):
        return None
    installed: type = wanted
    return installed


_ACTION_PARTS = {
    "SendGoal": "SendGoalService",
    "GetResult": "GetResultService",
    "FeedbackMessage": "FeedbackMessage",
}
