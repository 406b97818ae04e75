"""Message classes of ROS 1, as the package `genpy` generates them, with conversions from and to messages of simkit.

simkit has the types of ROS 2. Those of ROS 1 differ: a header has `seq`, times are objects, and a few fields have other
names. Attributes can have any value until the message is published. Sequences of numbers are tuples when a message
arrives, and `uint8[]` is `bytes`.
"""

from __future__ import annotations

import struct
from collections.abc import Callable
from dataclasses import replace
from operator import index
from typing import Any, Final

import numpy as np

from simkit.msgs.definition_parser import NAME
from simkit.msgs.message_types import Message as SimkitMessage
from simkit.msgs.message_types import type_of, type_store
from simkit_nodes.interfaces import ros1_definitions, workspaces
from simkit_nodes.interfaces.message_fields import ARRAY_CODES, Field, MessageFields, fields_of, interface_part
from simkit_nodes.interfaces.message_flavour import TYPE_ATTRIBUTE, MessageFlavour, ToSimkit
from simkit_nodes.interfaces.ros1_bytes import fill_message, message_bytes
from simkit_nodes.interfaces.ros1_message import Message, SerializationError
from simkit_nodes.interfaces.ros1_time import Duration, Time

HEADER: Final = "std_msgs/msg/Header"
_TIMES: Final = {"builtin_interfaces/msg/Time": "time", "builtin_interfaces/msg/Duration": "duration"}
_CODES: Final = ARRAY_CODES | {"byte": "b", "bool": "?"}
_ERRORS: Final = (TypeError, ValueError, AttributeError, OverflowError, struct.error, SerializationError)


class Ros1Messages(MessageFlavour):
    """Classes of messages as programs with rospy know them."""

    name = "ROS 1"

    def fields_of(self, type_name: str) -> MessageFields:
        """Return the fields of a message type with the names and types of ROS 1."""
        workspaces.define(interface_part(type_name)[0], is_ros1=True)
        ros2 = fields_of(type_name)
        names = ros1_definitions.field_names.get(ros2.type_name, {})
        fields = [
            replace(f, name=names.get(f.name, f.name), type_name=_TIMES.get(f.type_name, f.type_name))
            for f in ros2.fields
        ]
        if ros2.type_name == HEADER:
            fields.insert(0, Field("seq", "", "uint32"))
        constants = {names.get(name, name): value for name, value in ros2.constants.items()}
        return MessageFields(ros2.type_name, constants, tuple(fields))

    def slot(self, field: Field) -> str:
        """Return the attribute that stores the value of a field."""
        return field.name

    def make_class(self, fields: MessageFields) -> type:
        """Return a new class for a message type."""
        name = ros1_name(fields.type_name)
        package, _, short = name.partition("/")
        kind = "srv" if "/srv/" in fields.type_name else "msg"
        module = short_name(interface_part(fields.type_name)[0]) if kind == "srv" else short
        namespace = {
            "__module__": f"{package}.{kind}._{module}",
            "__doc__": f"Message class '{short}'.",
            "__slots__": [field.name for field in fields.fields],
            "_slot_types": [_slot_type(field) for field in fields.fields],
            "_type": name,
            "_md5sum": "*",
            "_has_header": any(field.type_name == HEADER and not field.shape for field in fields.fields),
            "_set_defaults": self._defaults(fields),
            "__init__": _constructor(short),
            "serialize": _serialize,
            "deserialize": _deserialize,
            "__reduce_ex__": _reduce,
            TYPE_ATTRIBUTE: fields.type_name,
            **{constant: value for constant, (_, value) in fields.constants.items()},
        }
        return type(short, (Message,), namespace)

    def _defaults(self, fields: MessageFields) -> object:
        """Return a function that sets the fields of a message to their default values."""
        names: dict[str, object] = {"Time": Time, "Duration": Duration}
        lines = ["def _set_defaults(self):", " pass"]
        for number, field in enumerate(fields.fields):
            if field.is_message:
                names[f"C{number}"] = self.message_class(field.type_name)
            lines.append(f" self.{field.name} = {_default(field, f'C{number}')}")
        exec("\n".join(lines), names)  # the names in it are those of fields, which the parser has checked
        return names["_set_defaults"]

    # ------------------------------------------------------------------ conversion

    def to_simkit(self, type_name: str) -> ToSimkit:
        """Return the function that converts a message of a program to a message of simkit.

        It raises SerializationError for a value that its field cannot have.
        """
        known = self._to_simkit.get(type_name)
        if known is None:
            convert = super().to_simkit(type_name)

            def checked(message: Any) -> SimkitMessage:
                try:
                    return convert(message)
                except _ERRORS as error:
                    if not isinstance(message, Message):
                        raise SerializationError(f"{message!r:.80} is not a message of type {type_name}") from None
                    message._check_types(error)
                    raise

            known = self._to_simkit[type_name] = checked
        return known

    def value_to_program(self, field: Field, value: str, names: dict[str, object]) -> str:
        """Return code that converts a value of simkit."""
        if not field.simkit_name:
            return "0"
        kind = field.type_name
        names |= {"time": _time, "duration": _duration, "octets": _octets}
        if not field.shape:
            return f"{_CONVERSIONS.get(kind, 'int')}({value})"
        if kind in ("uint8", "char"):
            return f"octets({value})"
        if kind in ("bool", "string", "wstring", "time", "duration"):
            return f"[{_CONVERSIONS[kind]}(i) for i in {value}]"
        return f"tuple({value}.tolist())"

    def value_to_simkit(self, field: Field, value: str, names: dict[str, object]) -> str:
        """Return code that converts a value of a program."""
        kind = field.type_name
        if kind in ("time", "duration"):
            name, function = f"simkit_{kind}", _simkit_time(kind)
        elif kind in ("string", "wstring"):
            name, function = "text", _text
        elif field.shape:
            name, function = f"numbers_{kind}_{field.size}", _numbers(field)
        elif kind in ("float32", "float64", "bool"):
            name, function = f"number_{kind}", _NUMBERS[kind]
        else:
            name, function = f"integer_{kind}", _integer(_CODES[kind])
        names[name] = function
        if field.shape and (kind in _TIMES.values() or field.is_text):
            return f"[{name}(i) for i in {self.list_to_simkit(field, value, names)}]"
        return f"{name}({value})"

    def list_to_simkit(self, field: Field, value: str, names: dict[str, object]) -> str:
        """Return code that checks the length of a list."""
        name = f"list_{field.shape}_{field.size}"
        names[name] = _sized_list(field)
        return f"{name}({value})"


_ZEROS: Final = {"bool": "False", "float32": "0.", "float64": "0.", "string": "''", "wstring": "''"}
_CONVERSIONS: Final = {
    "bool": "bool",
    "float32": "float32",
    "float64": "float",
    "string": "str",
    "wstring": "str",
    "time": "time",
    "duration": "duration",
}


def ros1_name(type_name: str) -> str:
    """Return the name of a type in ROS 1: `example_interfaces/srv/AddTwoInts_Request` is `…/AddTwoIntsRequest`."""
    interface, part = interface_part(type_name)
    return f"{type_name.split('/')[0]}/{short_name(interface)}{part}"


def short_name(interface_name: str) -> str:
    """Return the last part of the name of an interface in ROS 1."""
    return ros1_definitions.type_names.get(interface_name) or interface_name.rpartition("/")[2]


def _slot_type(field: Field) -> str:
    item = ros1_name(field.type_name) if field.is_message else field.type_name.replace("wstring", "string")
    return f"{item}[{field.size or ''}]" if field.shape else item


def _default(field: Field, message_class: str) -> str:
    """Return the code of a field's default value. ROS 1 has no default values in definitions."""
    zero = _ZEROS.get(field.type_name, "0")
    if field.is_message or field.type_name in ("time", "duration"):
        zero = f"{message_class if field.is_message else field.type_name.capitalize()}()"
    if not field.shape:
        return zero
    count = field.size if field.shape == "array" else 0
    if field.type_name in ("uint8", "char"):
        return f"bytes({count})"
    return f"[{zero} for _ in range({count})]" if count else "[]"


def _constructor(name: str) -> object:
    """Return the function `__init__` of a class."""

    def __init__(self: Message, *args: object, **kwds: object) -> None:  # noqa: N807 - it is one
        if args or kwds:
            Message.__init__(self, *args, **kwds)
        else:
            self._set_defaults()

    __init__.__qualname__ = f"{name}.__init__"
    return __init__


def _reduce(message: Message, _: object) -> Any:
    """Return what `pickle` and `copy` need; no module of the process has the class."""
    if TYPE_ATTRIBUTE not in vars(type(message)):  # a class that a program derived
        return object.__reduce_ex__(message, 2)
    return new_message, (getattr(message, TYPE_ATTRIBUTE),), message.__getstate__()


# ---------------------------------------------------------------------- bytes


def _serialize(self: Message, buff: Any) -> None:
    """Write the bytes of the message into a file-like object; SerializationError for a value that is not valid."""
    buff.write(message_bytes(self))


def _deserialize(self: Message, str: bytes) -> Message:
    """Set the fields to those that the bytes of a message have; DeserializationError if they are no message."""
    fill_message(self, str, message_of_type)
    return self


def message_of_type(kind: str) -> Message:
    """Return a new message of a type such as `geometry_msgs/Point`."""
    package, _, short = kind.partition("/")
    message: Message = ROS1.message_class(f"{package}/msg/{short}")()
    return message


# ---------------------------------------------------------------------- from simkit


def _time(value: Any) -> Time:
    result = Time.__new__(Time)  # a stamp may be negative, which the constructor refuses
    result.secs, result.nsecs = int(value.sec), int(value.nanosec)
    return result


def _duration(value: Any) -> Duration:
    return Duration(int(value.sec), int(value.nanosec))


def _octets(values: Any) -> bytes:
    return np.ascontiguousarray(values, np.uint8).tobytes()


# ---------------------------------------------------------------------- to simkit; struct decides what a number is


def _simkit_time(kind: str) -> Callable[[Any], SimkitMessage]:
    cls = type_of(f"builtin_interfaces/msg/{kind.capitalize()}")
    return lambda value: cls(sec=index(value.secs), nanosec=index(value.nsecs))


def _text(value: Any) -> str:
    if isinstance(value, bytes):
        return value.decode(errors="replace")
    if not isinstance(value, str):
        raise TypeError(f"{value!r:.80} is not a text")
    return value


def _number(value: Any) -> float:
    if type(value) is float:
        return value
    return float(struct.unpack("d", struct.pack("d", value))[0])


def _float32(value: Any) -> float:
    return float(struct.unpack("f", struct.pack("f", value))[0])


def _boolean(value: Any) -> bool:
    return bool(struct.pack("B", value)[0])


_NUMBERS: Final[dict[str, Callable[[Any], object]]] = {"float32": _float32, "float64": _number, "bool": _boolean}


def _integer(code: str) -> Callable[[Any], int]:
    pack = struct.Struct(code).pack

    def convert(value: Any) -> int:
        pack(value)
        return index(value)

    return convert


def _check_count(field: Field, count: int) -> None:
    if field.shape == "array" and count != field.size:
        raise struct.error(f"pack expected {field.size} items for packing (got {count})")


def _sized_list(field: Field) -> Callable[[Any], object]:
    def checked(values: Any) -> Any:
        _check_count(field, len(values))
        return values

    return checked


def _numbers(field: Field) -> Callable[[Any], np.ndarray[Any, Any]]:
    code = _CODES[field.type_name]
    dtype = np.dtype("uint8" if field.type_name == "byte" else code)

    def convert(values: Any) -> np.ndarray[Any, Any]:
        if isinstance(values, np.ndarray):
            result = np.array(values, dtype).reshape(-1)
        elif isinstance(values, (bytes, bytearray, memoryview)) and code == "B":
            result = np.frombuffer(values, dtype).copy()
        else:
            data = struct.pack(f"{len(values)}{code}", *values)
            result = np.frombuffer(data, dtype).copy()  # the array of the bytes cannot be changed
        _check_count(field, len(result))
        return result

    return convert


# ---------------------------------------------------------------------- actions

_GOAL_ID: Final = "actionlib_msgs/msg/GoalID"
_GOAL_STATUS: Final = "actionlib_msgs/msg/GoalStatus"


def action_types(action_name: str) -> dict[str, str]:
    """Return the message types that ROS 1 has for an action, by the name of the class.

    The types with a header and a goal's number exist only in ROS 1. They are registered as messages of the package.

    Args:
        action_name: full name, such as `move_base_msgs/action/MoveBase`.
    """
    package, short = action_name.split("/")[0], short_name(action_name)
    parts = ("Goal", "Result", "Feedback")
    types = {f"{short}{part}": f"{action_name}_{part}" for part in parts}
    return types | {f"{short}Action{part}": f"{package}/msg/{short}Action{part}" for part in (*parts, "")}


def register_action(action_name: str) -> None:
    """Register the message types of ROS 1 for an action.

    Raises:
        MessageError: the action is unknown.
    """
    package, short = action_name.split("/")[0], short_name(action_name)
    prefix = f"{package}/msg/{short}Action"
    if prefix in type_store().fielddefs:
        return
    status = {"header": HEADER, "status": _GOAL_STATUS}
    types: dict[str, dict[str, str]] = {
        f"{prefix}Goal": {"header": HEADER, "goal_id": _GOAL_ID, "goal": f"{action_name}_Goal"},
        f"{prefix}Result": status | {"result": f"{action_name}_Result"},
        f"{prefix}Feedback": status | {"feedback": f"{action_name}_Feedback"},
        prefix: {f"action_{part}": f"{prefix}{part.capitalize()}" for part in ("goal", "result", "feedback")},
    }
    for name, members in types.items():
        fields: Any = [(field, (NAME, type_name)) for field, type_name in members.items()]
        type_store().register({name: ([], fields)})


ROS1: Final = Ros1Messages()
"""Classes of messages for programs with rospy."""


def new_message(type_name: str) -> object:
    """Return a message without values; `pickle` and `copy` fill it."""
    return object.__new__(ROS1.message_class(type_name))
