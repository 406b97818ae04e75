"""Classes of interfaces by the objects that name them."""

from __future__ import annotations

from importlib import import_module
from typing import Any

__all__ = ["import_message_from_namespaced_type"]


def import_message_from_namespaced_type(message_type: Any) -> Any:
    """Return the class that a `rosidl_parser.definition.NamespacedType` names.

    Raises:
        ModuleNotFoundError: the package is unknown.
        AttributeError: the package has no such type.
    """
    message_type = getattr(message_type, "value_type", message_type)
    module = import_module(".".join(message_type.namespaces))
    name: str = message_type.name
    if name.endswith("_FeedbackMessage"):
        action, _, part = name.rpartition("_")
        return getattr(getattr(module, action).Impl, part)
    return getattr(module, name)
