"""Modules that a program imports for interfaces: `geometry_msgs`, `geometry_msgs.msg`, `geometry_msgs.msg._twist`."""

from __future__ import annotations

from functools import partial
from importlib import import_module
from types import ModuleType
from typing import Final

from simkit.diagnostics import did_you_mean
from simkit_nodes.interfaces import workspaces
from simkit_nodes.interfaces.interface_classes import (
    MakeClass,
    classes_of,
    folders_of,
    module_of,
)
from simkit_nodes.interfaces.message_flavour import MessageFlavour
from simkit_nodes.interfaces.ros1_messages import ROS1

FOLDERS: Final = ("msg", "srv", "action")

_IMPORTED_BY_RCLPY: Final = ("builtin_interfaces", "rcl_interfaces", "rosgraph_msgs")
"""Packages whose `msg` a program can read after `import rclpy` without an import of its own."""


class InterfaceModule(ModuleType):
    """Module whose classes are made at their first use: a package has up to 100 types, and a program uses a few.

    Args:
        name: full name of the module.
        classes: function that makes each class, by its name.
    """

    def __init__(self, name: str, classes: dict[str, MakeClass]) -> None:
        super().__init__(name, f"Interfaces of ROS: {', '.join(sorted(classes)) or name}.")
        self._make_class = classes
        if classes:
            self.__all__ = sorted(classes)  # `from geometry_msgs.msg import *` reads it

    def __getattr__(self, name: str) -> type | ModuleType:
        make = self.__dict__.get("_make_class", {}).get(name)
        if name == "msg" and self.__name__ in _IMPORTED_BY_RCLPY:
            return import_module(f"{self.__name__}.msg")
        if make is None:
            raise AttributeError(f"module {self.__name__!r} has no attribute {name!r}")
        cls: type = make()
        setattr(self, name, cls)
        return cls

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__(), *self._make_class} - {"_make_class"})


def interface_module(name: str, flavour: MessageFlavour) -> ModuleType | None:
    """Return a new module for the dotted name of a package of interfaces, or of a module in it.

    Args:
        name: such as `geometry_msgs`, `geometry_msgs.msg` or `geometry_msgs.msg._twist`.
        flavour: `ROS1` or `ROS2`, for the classes of the module.

    Returns:
        The module, with `__path__` if it is a package; None if there is no such module.

    Raises:
        ImportError: the name is that of a class which a known package does not have; the message suggests the closest
            name. Python asks for it as a module when `from geometry_msgs.msg import Twst` finds no class.
    """
    package, *rest = name.split(".")
    if len(rest) > 2 or not workspaces.package_is_known(package):
        return None
    if not rest:
        return _package(name, {})
    interfaces = workspaces.names_in(package, folders_of(flavour, rest[0]))
    if not interfaces:
        return None
    classes: dict[str, MakeClass] = {
        class_name: partial(_defined_class, interface, flavour, make)
        for interface in interfaces
        for class_name, make in classes_of(interface, flavour).items()
        if len(rest) == 1 or rest[1] in (module_of(class_name, interface, flavour), class_name)
    }
    if len(rest) == 1:
        return _package(name, classes)
    if rest[1].startswith("_"):
        return InterfaceModule(name, classes) if classes else None
    return _unknown_class(rest[1], f"{package}.{rest[0]}", flavour)


def _defined_class(interface_name: str, flavour: MessageFlavour, make: MakeClass) -> type:
    """Return a class, after a check that the workspace of the program has the definition that is in use."""
    workspaces.define(interface_name, is_ros1=flavour is ROS1)
    return make()


def _package(name: str, classes: dict[str, MakeClass]) -> ModuleType:
    module = InterfaceModule(name, classes)
    module.__path__ = []  # it has modules, but no folder
    return module


def _unknown_class(name: str, module_name: str, flavour: MessageFlavour) -> ModuleType | None:
    """Raise ImportError for a name that looks like one of a class; return None for any other name."""
    if not name[:1].isupper():
        return None
    module = interface_module(module_name, flavour)
    known = getattr(module, "__all__", [])
    if name in known:
        return None
    hint = did_you_mean(name, known)
    raise ImportError(f"cannot import name {name!r} from {module_name!r}; {hint}".rstrip("; "), name=module_name)
