"""Message classes of ROS 2, as `rosidl_generator_py` of ROS 2 Jazzy generates them (rosidl_python 0.22).

Attributes are properties that check each value. A constructor has keywords only. Sequences of numbers are
`array.array`, arrays of numbers are NumPy arrays, all other sequences are lists. Constants are attributes of the class
and of each message.
"""

from __future__ import annotations

import re
from array import array
from collections.abc import Callable
from operator import attrgetter
from typing import Any, ClassVar, Final

import numpy as np

from simkit_nodes.interfaces import slot_types, workspaces
from simkit_nodes.interfaces.message_fields import Field, MessageFields, fields_of, interface_part, number_type
from simkit_nodes.interfaces.message_flavour import TYPE_ATTRIBUTE, MessageFlavour, number_array, numpy_array
from simkit_nodes.interfaces.ros2_field_checks import Check, check_of, length_check_of


def snake_case(name: str) -> str:
    """Return the name of the module of a ROS 2 interface without its `_`: `AddTwoInts` is in `_add_two_ints`."""
    name = re.sub("(.)([A-Z][a-z]+)", r"\1_\2", name)
    return re.sub("([a-z0-9])([A-Z])", r"\1_\2", name).lower()


class Ros2MessageType(type):
    """Type of the classes of ROS 2 messages. It protects their constants, because all programs share a class."""

    _constants: dict[str, object]

    def __setattr__(cls, name: str, value: object) -> None:
        if name in cls._constants:
            raise AttributeError(f"property {name!r} of 'Metaclass_{cls.__name__}' object has no setter")
        super().__setattr__(name, value)

    @property
    def SLOT_TYPES(cls) -> tuple[object, ...]:  # noqa: N802 - the name in ROS
        """Type of each field, as an object of `rosidl_parser.definition`."""
        return tuple(map(slot_types.slot_type, fields_of(getattr(cls, TYPE_ATTRIBUTE)).fields))


class Ros2Message:
    """Base of the classes of ROS 2 messages."""

    __slots__: Any = ()
    _fields_and_field_types: ClassVar[dict[str, str]]
    _number_sequences: ClassVar[frozenset[str]]
    _number_arrays: ClassVar[frozenset[str]]
    _extra_slots: ClassVar[dict[str, object]] = {"_check_fields": True}

    @property
    def SLOT_TYPES(self) -> tuple[object, ...]:  # noqa: N802 - the name in ROS
        """Type of each field, as an object of `rosidl_parser.definition`."""
        return Ros2MessageType.SLOT_TYPES.fget(type(self))  # type: ignore[attr-defined,no-any-return]

    @classmethod
    def get_fields_and_field_types(cls) -> dict[str, str]:
        """Return the type of each field in ROS 2's interface language."""
        return dict(cls._fields_and_field_types)

    def __repr__(self) -> str:
        *package, _ = type(self).__module__.split(".")
        values = []
        for name in self._fields_and_field_types:
            value = getattr(self, name)
            text = repr(value)
            if name in self._number_sequences:
                text = text[len("array('d', ") : -1] if len(value) else "[]"
            values.append(f"{name}={text}")
        return f"{'.'.join([*package, type(self).__name__])}({', '.join(values)})"

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, type(self)):
            return False
        for name in self._fields_and_field_types:
            value, other_value = getattr(self, name), getattr(other, name)
            if (any(value != other_value)) if name in self._number_arrays else value != other_value:
                return False
        return True

    __hash__ = None  # type: ignore[assignment]  # as in ROS 2

    def __reduce_ex__(self, protocol: object) -> Any:
        if TYPE_ATTRIBUTE not in vars(type(self)):  # a class that a program derived
            return super().__reduce_ex__(2)
        # no module of the process has the class: another process finds it by the name of its type
        values = {name: getattr(self, name) for name in self.__slots__}
        return new_message, (getattr(self, TYPE_ATTRIBUTE),), (None, values)


class Ros2Messages(MessageFlavour):
    """Classes of messages as programs with rclpy know them."""

    name = "ROS 2"

    def fields_of(self, type_name: str) -> MessageFields:
        """Return the fields of a message type."""
        workspaces.define(interface_part(type_name)[0])
        return fields_of(type_name)

    def slot(self, field: Field) -> str:
        """Return the attribute that stores the value of a field."""
        return f"_{field.name}"

    def make_class(self, fields: MessageFields) -> type:
        """Return a new class for a message type."""
        short = fields.type_name.rpartition("/")[2]
        package, kind, interface = interface_part(fields.type_name)[0].split("/")
        constants = {name: _constant(kind, value) for name, (kind, value) in fields.constants.items()}
        constants |= {f"{f.name.upper()}__DEFAULT": default_of(f) for f in fields.fields if f.default is not None}
        checks = {field.name: check_of(field, self.message_class) for field in fields.fields}
        namespace = {
            "__module__": f"{package}.{kind}._{snake_case(interface)}",
            "__doc__": f"Message class '{short}'.",
            "__slots__": [*map(self.slot, fields.fields), "_check_fields"],
            "__init__": _constructor(fields, self.message_class),
            "_constants": constants,
            "_fields_and_field_types": {field.name: _idl_type(field) for field in fields.fields},
            "_number_sequences": frozenset(f.name for f in fields.fields if f.array_code and f.shape == "sequence"),
            "_number_arrays": frozenset(f.name for f in fields.fields if f.array_code and f.shape == "array"),
            TYPE_ATTRIBUTE: fields.type_name,
            **constants,
        }
        cls = Ros2MessageType(short, (Ros2Message,), namespace)
        for field in fields.fields:
            setattr(cls, field.name, _property(field.name, cls.__dict__[self.slot(field)], checks[field.name]))
        return cls

    # ------------------------------------------------------------------ conversion

    def value_to_program(self, field: Field, value: str, names: dict[str, object]) -> str:
        """Return code that converts a value of simkit."""
        kind = field.type_name
        if field.array_code:
            make: Callable[[str], object] = numpy_array if field.shape == "array" else number_array
            names[f"{field.shape}_{field.array_code}"] = make(field.array_code)
            return f"{field.shape}_{field.array_code}({value})"
        if field.shape:
            return f"[{_single_to_program(kind, 'i')} for i in {value}]"
        return _single_to_program(kind, value)

    def value_to_simkit(self, field: Field, value: str, names: dict[str, object]) -> str:
        """Return code that converts a value of a program."""
        kind = field.type_name
        if field.array_code:
            names[f"numbers_{field.array_code}"] = numpy_array(field.array_code)
            return f"numbers_{field.array_code}({self.list_to_simkit(field, value, names)})"
        if field.is_text:
            names["text"] = _encodable
        if kind == "byte" and not field.shape:
            return f"({value}[0] ^ 128) - 128"  # simkit, as rosbags, has single bytes with a sign
        if not field.shape:
            return _single_to_simkit(kind, value)
        items = f"[{_single_to_simkit(kind, 'i')} for i in {self.list_to_simkit(field, value, names)}]"
        if field.is_text:
            return items
        names[f"numbers_{kind}"] = numpy_array("bool" if kind == "bool" else "uint8")
        return f"numbers_{kind}({items})"

    def list_to_simkit(self, field: Field, value: str, names: dict[str, object]) -> str:
        """Return code that checks the length of a list. As in ROS 2, an item can be any object with the attributes."""
        if not field.size or (field.array_code and field.shape == "array"):
            return value  # no limit, or a NumPy array, which has no `append`
        name = f"check{len(names)}"  # another field of another message may have the same name
        names[name] = length_check_of(field, self.message_class)
        return f"{name}({value})"


def _single_to_program(kind: str, value: str) -> str:
    if kind == "byte":
        return f"bytes((int({value}) & 255,))"
    return f"{_PYTHON_CONVERSIONS.get(kind, 'int')}({value})"


def _single_to_simkit(kind: str, value: str) -> str:
    if kind == "byte":
        return f"{value}[0]"
    if kind in ("string", "wstring"):
        return f"text({value})"
    return f"{_PYTHON_CONVERSIONS.get(kind, 'int')}({value})"


_PYTHON_CONVERSIONS: Final = {
    "bool": "bool",
    "float32": "float32",
    "float64": "float",
    "string": "str",
    "wstring": "str",
}


def _encodable(text: object) -> str:
    """Return a text; raise the error of rclpy if it cannot be sent."""
    if not isinstance(text, str):
        raise TypeError("bad argument type for built-in operation")
    if not text.isascii():
        text.encode()
    return str(text)


# ---------------------------------------------------------------------- classes


def _idl_type(field: Field) -> str:
    """Return the type of a field as `get_fields_and_field_types` names it."""
    if field.is_message:
        item = f"{field.type_name.split('/')[0]}/{field.type_name.rpartition('/')[2]}"
    else:
        item = slot_types.idl_name(field.type_name)
        item += f"<{field.text_bound}>" if field.text_bound else ""
    if field.shape == "array":
        return f"{item}[{field.size}]"
    if field.shape == "sequence":
        return f"sequence<{item}, {field.size}>" if field.size else f"sequence<{item}>"
    return item


def _constant(kind: str, value: Any) -> object:
    return bytes((value & 255,)) if kind == "byte" else value


def default_of(field: Field) -> Any:
    """Return a new default value of a field that has no messages."""
    values: Any = field.default
    is_array = field.shape == "array"
    if field.array_code:
        items = [0] * (field.size if is_array else 0) if values is None else values
        return np.array(items, number_type(field.array_code)) if is_array else array(field.array_code, items)
    zero = {"bool": False, "float32": 0.0, "float64": 0.0, "string": "", "wstring": ""}.get(field.type_name, 0)
    if field.shape:
        values = [zero] * (field.size if is_array else 0) if values is None else values
        return [_constant(field.type_name, value) for value in values]
    return _constant(field.type_name, zero if values is None else values)


def _property(name: str, slot: Any, check: Check) -> property:
    store = slot.__set__

    def set_value(message: object, value: object) -> None:
        store(message, check(value))

    return property(attrgetter(f"_{name}"), set_value, doc=f"Message field '{name}'.")


def _constructor(fields: MessageFields, message_class: Callable[[str], type]) -> object:
    """Return the function `__init__` of a class, generated so that a message without arguments is created fast."""
    names: dict[str, object] = {"array": array, "default_of": default_of}
    lines = ["def __init__(self, **kwargs):"]
    for index, field in enumerate(fields.fields):
        lines.append(f" self._{field.name} = {_default_code(field, index, names, message_class)}")
    lines += [" self._check_fields = True", " if kwargs: fill(self, kwargs)"]
    conversions = {field.name: _argument_conversion(field) for field in fields.fields}

    def fill(message: object, arguments: dict[str, Any]) -> None:
        unknown = [name for name in arguments if name not in conversions and name != "check_fields"]
        if unknown:
            raise AssertionError(f"Invalid arguments passed to constructor: {', '.join(sorted(unknown))}")
        for name, convert in conversions.items():
            if name in arguments:
                setattr(message, name, convert(arguments[name]))

    names["fill"] = fill
    exec("\n".join(lines), names)  # the names in it are those of fields, which the parser has checked
    constructor: Any = names["__init__"]
    constructor.__qualname__ = f"{fields.type_name.rpartition('/')[2]}.__init__"
    return constructor


def _default_code(field: Field, index: int, names: dict[str, object], message_class: Callable[[str], type]) -> str:
    """Return the code of a field's default value; objects that it uses are added to the names."""
    if field.is_message:
        names[f"C{index}"] = message_class(field.type_name)
        if not field.shape:
            return f"C{index}()"
        return f"[C{index}() for _ in range({field.size})]" if field.shape == "array" else "[]"
    if not field.shape:
        return repr(default_of(field))
    if field.shape == "sequence" and field.default is None:
        return f"array({field.array_code!r})" if field.array_code else "[]"
    if field.array_code and field.default is None:
        names |= {"zeros": np.zeros, f"T{index}": number_type(field.array_code)}
        return f"zeros({field.size}, T{index})"
    names[f"F{index}"] = field
    return f"default_of(F{index})"


def _argument_conversion(field: Field) -> Callable[[Any], object]:
    """Return what a constructor does with an argument before it is checked."""
    if field.array_code and field.shape == "sequence":
        return lambda value: array(field.array_code, value)
    return lambda value: value


ROS2: Final = Ros2Messages()
"""Classes of messages for programs with rclpy."""


def new_message(type_name: str) -> object:
    """Return a message without values; `pickle` and `copy` fill it."""
    return object.__new__(ROS2.message_class(type_name))
