"""Description of message classes by their behaviour, to compare simkit's classes with those of a real ROS 2.

The real ROS 2 runs this file with its own Python: `ROS_PYTHON_CHECK_FIELDS=1 python probe.py std_msgs sensor_msgs`.
"""

import array
import importlib
import json
import re
import sys
from collections import UserList, UserString

import numpy

VALUES = [
    None, True, 0, 1, -1, 127, 128, 255, 256, -129, 2**15, 2**16, 2**31, 2**32, 2**63, 2**64, -(2**63), -(2**63) - 1,
    0.0, 1.5, -2.5, 1e39, -1e39, float("inf"), "", "a", "text", UserString("u"), b"", b"a", b"ab", bytearray(b"a"),
    [], [0], [1.0], [1], [True], ["a"], [b"a"], [0.0] * 9, [0] * 9, [1.0] * 36, [256], [-1], [1e39], [None],
    (), (1.0,), (1,), ("a",), UserList([1.0]), UserList(["a"]), range(3), range(16), {},
    array.array("d", [1.0]), array.array("f", [1.0]), array.array("B", [1]), array.array("i", [1]),
    numpy.zeros(9), numpy.zeros(36), numpy.zeros(12), numpy.zeros(9, numpy.float32), numpy.zeros(16, numpy.uint8),
    numpy.zeros((3, 3)), numpy.float64(1.0), numpy.float32(1.0), numpy.int32(1), numpy.bool_(True), object,
]  # fmt: skip
"""Values that are assigned to every field."""


def outcome(action):
    """The representation of what a function returns, or the class and the text of its exception."""
    try:
        return repr(action())
    except Exception as error:  # noqa: BLE001 - it is what is compared
        return f"{type(error).__name__}: {error}"


def assigned(message, name, value):
    setattr(message, name, value)
    return getattr(message, name)


def slot_type(kind):
    """The text of an entry of SLOT_TYPES."""
    names = ("typename", "namespaces", "name", "maximum_size", "size")
    inner = slot_type(kind.value_type) if hasattr(kind, "value_type") else ""
    return f"{type(kind).__name__}({inner}{[getattr(kind, name) for name in names if hasattr(kind, name)]})"


def filled(cls, find, count):
    """A message with a value other than the default in each field.

    Args:
        cls: class of the message.
        find: function that returns the class of a type such as `geometry_msgs/Point`, near a class.
        count: items of each sequence.
    """
    message = cls()
    for number, (name, kind) in enumerate(cls.get_fields_and_field_types().items()):
        sizes = re.fullmatch(r"(?:sequence<)?(.+?)(?:, (\d+))?(?:>|\[(\d+)\])?", kind)
        item, bound, size = sizes[1], sizes[2], sizes[3]
        if kind.startswith("string<"):
            item, size = "string", None
        if not kind.startswith("sequence<") and size is None:
            setattr(message, name, value_of(item, cls, find, count, number))
        else:
            length = int(size) if size else min(count, int(bound or count))
            setattr(message, name, [value_of(item, cls, find, count, number + index) for index in range(length)])
    return message


def value_of(item, cls, find, count, number):
    """A value of a basic type, or a message of another type."""
    if "/" in item:
        return filled(find(item, cls), find, count)
    if item.startswith(("string", "wstring")):
        return f"é{number}"[: 2 if "<" in item else None]
    if item == "boolean":
        return number % 2 == 0
    if item == "octet":
        return bytes([200 + number % 50])
    if item in ("float", "double"):
        return number / 3 - 0.1
    return number + 1


def near(item, cls):
    """The class of a type such as `geometry_msgs/Point`; parts of services are in the module of their service."""
    package, name = item.split("/")
    module = sys.modules.get(cls.__module__)
    if hasattr(module, name) and package == cls.__module__.split(".")[0]:
        return getattr(module, name)
    return getattr(importlib.import_module(f"{package}.msg"), name)


def describe_message(cls):
    """Everything that a program can see of a message class, as texts."""
    message = cls()
    fields = cls.get_fields_and_field_types()
    lines = [
        cls.__module__, cls.__name__, cls.__qualname__, repr(message), repr(fields), repr(cls.__slots__),
        *map(slot_type, cls.SLOT_TYPES),
        repr(message == cls()), repr(message == 1), outcome(lambda: hash(message)), outcome(lambda: cls(1)),
        outcome(lambda: cls(no_such_field=1, another=2)), outcome(lambda: setattr(message, "no_such_field", 1)),
        outcome(lambda: cls(check_fields=True)),
    ]  # fmt: skip
    constants = [name for name in dir(cls) if name.isupper() and name != "SLOT_TYPES"]
    lines += [f"{name}={getattr(cls, name)!r}={getattr(message, name)!r}" for name in constants]
    lines += [outcome(lambda name=name: setattr(cls, name, 1)).split(":")[0] for name in constants[:1]]
    for name in fields:
        for value in VALUES:
            what = f"{name} = {type(value).__name__} {value!r:.40}"
            lines.append(f"{what} -> {outcome(lambda: assigned(cls(), name, value))}")  # noqa: B023
            lines.append(f"{cls.__name__}({what}) -> {outcome(lambda: getattr(cls(**{name: value}), name))}")  # noqa: B023
    return lines


def serialized(cls, find, serialize, deserialize):
    """The bytes of filled messages of a class as hexadecimal digits, and the message that is read from these bytes."""
    pairs = []
    for count in (0, 1, 5):
        data = serialize(filled(cls, find, count))
        pairs.append([data.hex(), repr(deserialize(data, cls))])
    return pairs


def describe_package(package, load, find, serialize, deserialize):
    """The description of every class of a package.

    Args:
        package: name of the package.
        load: function that returns a module by its name.
        find: function that returns the class of a field's type.
        serialize: function that returns the bytes of a message.
        deserialize: function that returns the message of bytes and a class.
    """
    described = {}
    for folder in ("msg", "srv", "action"):
        try:
            module = load(f"{package}.{folder}")
        except ModuleNotFoundError:
            continue
        for name in dir(module):
            cls = getattr(module, name)
            if not isinstance(cls, type):
                continue
            if hasattr(cls, "get_fields_and_field_types"):
                described[f"{package}.{folder}.{name}"] = describe_message(cls)
                described[f"{package}.{folder}.{name} in bytes"] = serialized(cls, find, serialize, deserialize)
            else:
                parts = ("Request", "Response", "Event", "Goal", "Result", "Feedback")
                names = [getattr(cls, part).__name__ for part in parts if hasattr(cls, part)]
                described[f"{package}.{folder}.{name}"] = [cls.__module__, cls.__qualname__, *names, outcome(cls)]
    return described


if __name__ == "__main__":
    from rclpy.serialization import deserialize_message, serialize_message

    tools = importlib.import_module, near, serialize_message, deserialize_message
    sys.stdout.write(json.dumps({name: describe_package(name, *tools) for name in sys.argv[1:]}))
