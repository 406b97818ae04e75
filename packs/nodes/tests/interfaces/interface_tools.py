"""Access to the classes of interfaces as programs have it."""

from __future__ import annotations

import importlib.abc
import importlib.machinery
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from types import ModuleType
from typing import Any

from rosbags.serde import SerdeError

from simkit import msgs
from simkit_nodes.interfaces import ROS2, MessageFlavour, interface_module, type_name_of


def ros2_module(name: str) -> ModuleType:
    module = interface_module(name, ROS2)
    if module is None:
        raise ModuleNotFoundError(name)
    return module


def near(item: str, cls: type) -> type:
    """The class of a field's type such as `geometry_msgs/Point`; parts of a service are near their service."""
    package, name = item.split("/")
    kind = "msg" if "_" not in name else type_name_of(cls).split("/")[1]
    return ROS2.message_class(f"{package}/{kind}/{name}")


def serialize(message: Any) -> bytes:
    name = type_name_of(type(message))
    return msgs.serialize(ROS2.to_simkit(name)(message))


def deserialize(data: bytes, cls: type) -> Any:
    name = type_name_of(cls)
    return ROS2.to_program(name)(msgs.deserialize(data, name))


ROS2_TOOLS = (ros2_module, near, serialize, deserialize)


def ros2_message_of(class_name: str, digits: str) -> Any:
    """The message of a class such as `geometry_msgs.msg.Twist` and of rclpy's bytes as hexadecimal digits."""
    data = bytes.fromhex(digits)
    cls = ROS2.message_class(class_name.replace(".", "/"))
    for more in range(0, len(data), 4):  # rclpy appends unset bytes, but simkit accepts no more than three of them
        try:
            return deserialize(data[: len(data) - more], cls)
        except SerdeError as error:
            if "size mismatch" not in str(error):
                raise
    raise AssertionError(digits)


class _Finder(importlib.abc.MetaPathFinder, importlib.abc.Loader):
    """Finder for one test; programs have a finder of their own."""

    def __init__(self, flavour: MessageFlavour) -> None:
        self.flavour = flavour
        self.names: list[str] = []

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> importlib.machinery.ModuleSpec | None:
        module = interface_module(fullname, self.flavour)
        if module is None:
            return None
        self.names.append(fullname)
        is_package = hasattr(module, "__path__")
        return importlib.machinery.ModuleSpec(fullname, self, loader_state=module, is_package=is_package)

    def create_module(self, spec: importlib.machinery.ModuleSpec) -> ModuleType:
        module = spec.loader_state
        assert isinstance(module, ModuleType)
        return module

    def exec_module(self, module: ModuleType) -> None:
        """The module is complete."""


@contextmanager
def imports_of(flavour: MessageFlavour) -> Iterator[None]:
    """Let `import` find the modules of interfaces, and forget these modules at the end."""
    finder = _Finder(flavour)
    sys.meta_path.append(finder)
    try:
        yield
    finally:
        sys.meta_path.remove(finder)
        for name in finder.names:
            sys.modules.pop(name, None)
