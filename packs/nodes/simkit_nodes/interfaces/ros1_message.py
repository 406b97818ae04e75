"""Base of the message classes of ROS 1, its checks and its text format, with the names of the package `genpy`.

Unlike rclpy, ROS 1 checks the values of a message when the message is published.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Any, ClassVar, Final, NoReturn

import numpy as np
import yaml

from simkit.msgs.definition_parser import INTEGER_RANGES
from simkit_nodes.interfaces.ros1_time import Duration, Time, TVal

_RANGES: Final = INTEGER_RANGES | {"byte": INTEGER_RANGES["int8"]}
_ITEM: Final = re.compile(r"(.+)\[\d*\]")
_HEADER: Final = "std_msgs/Header"


class MessageException(Exception):
    """Base of the errors of messages."""


class SerializationError(MessageException):
    """Error for a message with a value that its field cannot have."""


class DeserializationError(MessageException):
    """Error for bytes that are no message."""


class Message:
    """Base of the classes of ROS 1 messages.

    A message is created with all fields in order, with keywords, or without arguments. Fields that are not given have
    default values.
    """

    __slots__ = ("_connection_header",)
    _slot_types: ClassVar[list[str]] = []
    _type: ClassVar[str] = ""
    _has_header: ClassVar[bool] = False

    def _set_defaults(self) -> None:
        """Set all fields to their default values."""

    def __init__(self, *args: object, **kwds: object) -> None:
        if args and kwds:
            raise TypeError("Message constructor may only use args OR keywords, not both")
        slots = list(self.__slots__)
        if args and len(args) != len(slots):
            raise TypeError(f"Invalid number of arguments, args should be {slots} args are{args}")
        unknown = [name for name in kwds if name not in slots]
        if unknown:
            raise AttributeError(f"{unknown[0]} is not an attribute of {type(self).__name__}")
        self._set_defaults()
        for name, value in (*zip(slots, args, strict=False), *kwds.items()):
            if value is not None:
                setattr(self, name, value)

    def _get_types(self) -> list[str]:
        return self._slot_types

    def _check_types(self, exc: Exception | None = None) -> None:
        """Check the values of all fields.

        Raises:
            SerializationError: a value does not match its field; if none is found, the error has the text of `exc`.
        """
        for name, kind in zip(self.__slots__, self._get_types(), strict=True):
            check_type(name, kind, getattr(self, name))
        if exc is not None:
            raise SerializationError(str(exc))

    def __repr__(self) -> str:
        return strify_message(self)

    def __str__(self) -> str:
        return strify_message(self)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, type(self)):
            return False
        for name in self.__slots__:
            value, other_value = getattr(self, name, None), getattr(other, name, None)
            if type(value) in (list, tuple) and type(other_value) in (list, tuple):
                value, other_value = tuple(value), tuple(other_value)  # type: ignore[arg-type]
            if not value == other_value:
                return False
        return True

    __hash__ = None  # type: ignore[assignment]  # as in ROS 1

    def __getstate__(self) -> list[object]:
        return [getattr(self, name) for name in self.__slots__]

    def __setstate__(self, state: list[object]) -> None:
        for name, value in zip(self.__slots__, state, strict=True):
            setattr(self, name, value)


# ---------------------------------------------------------------------- checks


def check_type(field_name: str, field_type: str, field_val: object) -> None:
    """Check a value against a type such as `int32`, `float64[36]` or `geometry_msgs/Point[]`.

    Raises:
        SerializationError: the value does not match the type.
    """
    item = _ITEM.fullmatch(field_type)
    if item is not None:
        _check_list(field_name, item[1], field_val)
    elif field_type in _RANGES:
        _check_integer(field_name, field_type, field_val)
    elif field_type in ("float32", "float64"):
        if type(field_val) not in (float, int) and not isinstance(field_val, (np.floating, np.integer)):
            _fail(f"field {field_name} must be float type")
    elif field_type == "bool":
        if field_val not in (True, False):
            _fail(f"field {field_name} is not a bool")
    elif field_type == "string":
        if type(field_val) is not bytes and (type(field_val) is not str or not field_val.isascii()):
            what = "is a non-ascii string" if type(field_val) is str else "must be of type bytes or an ascii string"
            _fail(f"field {field_name} {what}")
    elif field_type in ("time", "duration"):
        kind = Time if field_type == "time" else Duration
        if not isinstance(field_val, kind):
            _fail(f"field {field_name} must be of type {kind.__name__}")
    else:
        _check_message(field_name, field_type, field_val)


def _fail(text: str) -> NoReturn:
    raise SerializationError(text)


def _check_integer(name: str, kind: str, value: object) -> None:
    low, high = _RANGES[kind]
    if type(value) is not int or (low == 0 and value < 0):
        _fail(f"field {name} must be {'an integer' if low else 'unsigned integer'} type")
    if not low <= value <= high:
        _fail(f"field {name} exceeds specified width [{kind}]")


def _check_list(name: str, item: str, value: Any) -> None:
    if type(value) in (bytes, str):
        if item not in ("char", "uint8"):
            _fail(f"field {name} must be a list or tuple type. Only uint8[] can be a string")
        return
    if type(value) not in (list, tuple):
        _fail(f"field {name} must be a list or tuple type")
    for entry in value:
        check_type(f"{name}[]", item, entry)


def _check_message(name: str, kind: str, value: object) -> None:
    if not isinstance(value, Message):
        _fail(f"field {name} must be of type [{kind}]")
    if value._type == _HEADER and kind not in (_HEADER, "Header"):
        _fail(f"field {name} must be a Header instead of a {value._type}")
    if value._type not in (kind, _HEADER):
        _fail(f"field {name} must be of type {kind} instead of {value._type}")
    for field, field_type in zip(value.__slots__, value._get_types(), strict=True):
        check_type(f"{name}.{field}", field_type, getattr(value, field))


# ---------------------------------------------------------------------- text


def strify_message(val: Any, indent: str = "", field_filter: Any = None) -> str:
    """Format a message or a value of a field as ROS 1 prints it.

    Args:
        val: message or value.
        indent: spaces before each line; the text begins with a line break if there are any.
        field_filter: function that returns the names of those fields of a message that are printed; None for all.
    """
    if isinstance(val, TVal):
        return f"\n{indent}secs: {val.secs}\n{indent}nsecs: {val.nsecs:>9}"
    if isinstance(val, Message):
        shown: Iterable[str] = val.__slots__ if field_filter is None else list(field_filter(val))
        lines = []
        for name, kind in zip(val.__slots__, val._get_types(), strict=True):
            if name in shown:
                value = getattr(val, name)
                if isinstance(value, bytes) and "uint8[" in kind:
                    value = list(value)
                lines.append(f"{indent}{name}: {strify_message(value, '  ' + indent, field_filter)}")
        return ("\n" if indent else "") + "\n".join(lines)
    if isinstance(val, str):
        return yaml.dump(val, default_style='"').rstrip("\n") if val else "''"
    if isinstance(val, (list, tuple)):
        return _list_text(val, indent, field_filter)
    return str(val)


def _list_text(values: list[Any] | tuple[Any, ...], indent: str, field_filter: object) -> str:
    if not values:
        return "[]"
    if isinstance(values[0], str):
        lines = yaml.dump(list(values)).rstrip("\n").splitlines()
        return "".join(f"\n{indent}{line}" for line in lines)
    if type(values[0]) in (int, float, bool):
        return str(list(values))
    return "\n" + "\n".join(f"{indent}- {strify_message(value, indent + '  ', field_filter)}" for value in values)
