"""Conversion of messages into other frames, and the functions that each buffer of transforms has."""

from __future__ import annotations

import sys
from collections.abc import Callable
from copy import deepcopy
from importlib import import_module
from typing import Any, Final

from simkit_nodes.host import current_program
from simkit_nodes.interfaces import ROS2, type_name_of
from simkit_nodes.message_transforms import Transforms
from simkit_nodes.ros_modules.rclpy.duration import Duration

__all__ = [
    "BufferInterface",
    "ConvertRegistration",
    "NotImplementedException",
    "Stamped",
    "TransformRegistration",
    "TypeException",
    "convert",
]

_PACKAGES: Final = ("tf2_geometry_msgs", "tf2_kdl", "tf2_sensor_msgs")
"""Packages whose import makes messages transformable."""

_NO_WAIT: Final = Duration()


class TypeException(Exception):
    """A type of objects cannot be transformed or converted.

    Attributes:
        errstr: description.
    """

    def __init__(self, errstr: str) -> None:
        super().__init__(errstr)
        self.errstr = errstr


class NotImplementedException(Exception):
    """A buffer has no lookups."""

    def __init__(self) -> None:
        self.errstr = "CanTransform or LookupTransform not implemented"
        super().__init__(self.errstr)


class BufferInterface:
    """Buffer of transforms that converts objects into other frames."""

    def __init__(self) -> None:
        self.registration = TransformRegistration()

    def transform(
        self, object_stamped: Any, target_frame: str, timeout: Duration = _NO_WAIT, new_type: object = None
    ) -> Any:
        """Return an object with a header in another frame.

        Args:
            object_stamped: message of a type that an imported package makes transformable, such as
                `tf2_geometry_msgs`.
            target_frame: frame of the result.
            timeout: longest wait for the transform.
            new_type: type to which the result is converted.

        Raises:
            TypeException: the type cannot be transformed.
            TransformException: the transform is not known.
        """
        do_transform = self.registration.get(type(object_stamped))
        header = object_stamped.header
        result = do_transform(
            object_stamped, self.lookup_transform(target_frame, header.frame_id, header.stamp, timeout)
        )
        return result if new_type is None else convert(result, new_type)

    def transform_full(
        self,
        object_stamped: Any,
        target_frame: str,
        target_time: object,
        fixed_frame: str,
        timeout: Duration = _NO_WAIT,
        new_type: object = None,
    ) -> Any:
        """Return an object with a header in another frame at another time; `fixed_frame` does not move meanwhile."""
        do_transform = self.registration.get(type(object_stamped))
        header = object_stamped.header
        result = do_transform(
            object_stamped,
            self.lookup_transform_full(target_frame, target_time, header.frame_id, header.stamp, fixed_frame, timeout),
        )
        return result if new_type is None else convert(result, new_type)

    def lookup_transform(self, target_frame: str, source_frame: str, time: object, timeout: Duration = _NO_WAIT) -> Any:
        """Return a transform; see `Buffer`."""
        raise NotImplementedException

    def lookup_transform_full(
        self,
        target_frame: str,
        target_time: object,
        source_frame: str,
        source_time: object,
        fixed_frame: str,
        timeout: Duration = _NO_WAIT,
    ) -> Any:
        """Return a transform between two times; see `Buffer`."""
        raise NotImplementedException

    def can_transform(self, target_frame: str, source_frame: str, time: object, timeout: Duration = _NO_WAIT) -> Any:
        """Check whether a transform is known; see `Buffer`."""
        raise NotImplementedException

    def can_transform_full(
        self,
        target_frame: str,
        target_time: object,
        source_frame: str,
        source_time: object,
        fixed_frame: str,
        timeout: Duration = _NO_WAIT,
    ) -> Any:
        """Check whether a transform between two times is known; see `Buffer`."""
        raise NotImplementedException


def Stamped(obj: Any, stamp: Any, frame_id: str) -> Any:
    """Give an object a header."""
    obj.header = ROS2.message_class("std_msgs/msg/Header")(frame_id=frame_id, stamp=stamp)
    return obj


def _registered(table: str) -> dict[Any, Callable[..., object]]:
    """Return what the present program has registered."""
    tables: dict[str, dict[Any, Callable[..., object]]] = current_program().data.setdefault("tf2_ros", {})
    return tables.setdefault(table, {})


def _of_packages(table: str, kind: object) -> Callable[..., object] | None:
    """Return the function for a type in a table of an imported package."""
    for package in _PACKAGES:
        if package in sys.modules:
            module = import_module(f"simkit_nodes.ros_modules.{package}.{package}")
            functions: Transforms = getattr(module, table, {})
            function = functions.get(type_name_of(kind) if hasattr(kind, "_ros_type") else kind)
            if function is not None:
                return function
    return None


def _required(function: Callable[..., object] | None, key: object) -> Callable[..., object]:
    if function is None:
        raise TypeException(f"Type {key} is not loaded or supported")
    return function


class TransformRegistration:
    """Functions that transform objects, by type of the objects; each program has its own."""

    def print_me(self) -> None:
        """Print all functions that the program has added."""
        print(_registered("transform"))  # noqa: T201 - what the function is for

    def add(self, key: object, callback: Callable[[Any, Any], object]) -> None:
        """Add a function of an object and a `TransformStamped` for a type."""
        _registered("transform")[key] = callback

    def get(self, key: object) -> Callable[[Any, Any], object]:
        """Return the function for a type.

        Raises:
            TypeException: there is none.
        """
        return _required(_registered("transform").get(key) or _of_packages("TRANSFORMS", key), key)


class ConvertRegistration:
    """Functions that convert objects to messages and back, by type of the objects; each program has its own."""

    def add_from_msg(self, key: object, callback: Callable[[Any], object]) -> None:
        """Add a function from a message to an object of a type."""
        _registered("from_msg")[key] = callback

    def add_to_msg(self, key: object, callback: Callable[[Any], object]) -> None:
        """Add a function from an object of a type to a message."""
        _registered("to_msg")[key] = callback

    def add_convert(self, key: tuple[Any, Any], callback: Callable[[Any], object]) -> None:
        """Add a function from one type to another."""
        _registered("convert")[key] = callback

    def get_from_msg(self, key: object) -> Callable[[Any], object]:
        """Return the function from a message to an object of a type; TypeException if there is none."""
        return _required(_registered("from_msg").get(key) or _message_function("FROM_MESSAGE", key), key)

    def get_to_msg(self, key: object) -> Callable[[Any], object]:
        """Return the function from an object of a type to a message; TypeException if there is none."""
        return _required(_registered("to_msg").get(key) or _message_function("TO_MESSAGE", key), key)

    def get_convert(self, key: tuple[Any, Any]) -> Callable[[Any], object]:
        """Return the function from one type to another; TypeException if there is none."""
        return _required(_registered("convert").get(key), key)


def _message_function(table: str, kind: object) -> Callable[[Any], object] | None:
    """Return the function from a message, or to one; messages that can be transformed stay as they are."""
    is_message = hasattr(kind, "_ros_type") and _of_packages("TRANSFORMS", kind) is not None
    return (lambda message: message) if is_message else _of_packages(table, kind)


def convert(a: object, b_type: object) -> Any:
    """Return an object converted to a type.

    Raises:
        TypeException: there is no conversion.
    """
    registration = ConvertRegistration()
    function = _registered("convert").get((type(a), b_type))
    if function is not None:
        return function(a)
    if type(a) is b_type:
        return deepcopy(a)
    return registration.get_from_msg(b_type)(registration.get_to_msg(type(a))(a))
