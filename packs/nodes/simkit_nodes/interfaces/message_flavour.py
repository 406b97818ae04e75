"""Classes of messages for programs, and their conversion from and to messages of simkit.

ROS 2 and ROS 1 have different classes for the same types: `Ros2Messages` and `Ros1Messages` say how a class looks. The
generator of the conversions is common. It writes one Python function for each type and direction, in which nested
messages are created in place. This is the function that creates a `geometry_msgs.msg.Vector3Stamped` of ROS 2:

    def to_program(m):
        o1 = new(C1)
        m2 = m.header
        o2 = new(C2)
        m3 = m2.stamp
        o3 = new(C3)
        o3._sec = int(m3.sec)
        ...

Every conversion copies arrays and lists: two programs never share memory that one of them can change.
"""

from __future__ import annotations

import threading
from abc import ABC, abstractmethod
from array import array
from collections.abc import Callable
from ctypes import c_float
from typing import Any, Final

import numpy as np

from simkit.msgs.message_types import Message, type_of
from simkit_nodes.interfaces.message_fields import Field, MessageFields, number_type

ProgramMessage = Any
"""Message of a program: an object of a class that is made at run time from the definition of its type."""

ToProgram = Callable[[Message], ProgramMessage]
ToSimkit = Callable[[ProgramMessage], Message]

TYPE_ATTRIBUTE: Final = "_ros_type"
"""Attribute of each class with the full name of its type."""


def float32(value: float) -> float:
    """Round a number to single precision, as it is after its way through ROS."""
    return c_float(value).value


class MessageFlavour(ABC):
    """Classes and conversions of messages in the style of one ROS.

    Attributes:
        name: name of the ROS, such as `ROS 2`.
    """

    name: str

    def __init__(self) -> None:
        self._classes: dict[str, type] = {}
        self._to_program: dict[str, ToProgram] = {}
        self._to_simkit: dict[str, ToSimkit] = {}
        self._lock = threading.RLock()  # two threads of programs must get the same class

    # ------------------------------------------------------------------ what differs between ROS 1 and ROS 2

    @abstractmethod
    def fields_of(self, type_name: str) -> MessageFields:
        """Return the fields of a message type with the names of this ROS.

        Raises:
            MessageError: the type is unknown.
        """

    @abstractmethod
    def make_class(self, fields: MessageFields) -> type:
        """Return a new class for a message type."""

    @abstractmethod
    def slot(self, field: Field) -> str:
        """Return the attribute that stores the value of a field."""

    @abstractmethod
    def value_to_program(self, field: Field, value: str, names: dict[str, object]) -> str:
        """Return Python code that converts the value of a field without messages for the program.

        Args:
            field: field with numbers or texts.
            value: code of the value of simkit's message.
            names: objects that the code uses, by name; the method adds its own.
        """

    @abstractmethod
    def value_to_simkit(self, field: Field, value: str, names: dict[str, object]) -> str:
        """Return Python code that converts the value of a field without messages for simkit."""

    @abstractmethod
    def list_to_simkit(self, field: Field, value: str, names: dict[str, object]) -> str:
        """Return Python code that checks a list of a program."""

    # ------------------------------------------------------------------ classes and conversions

    def message_class(self, type_name: str) -> type[ProgramMessage]:
        """Return the class of a message type; all programs have the same one.

        Raises:
            MessageError: the type is unknown.
        """
        known = self._classes.get(type_name)
        if known is not None:
            return known
        with self._lock:
            if type_name not in self._classes:
                fields = self.fields_of(type_name)
                if fields.type_name not in self._classes:
                    self._classes[fields.type_name] = self.make_class(fields)
                self._classes[type_name] = self._classes[fields.type_name]  # also by its short name
            return self._classes[type_name]

    def to_program(self, type_name: str) -> ToProgram:
        """Return the function that converts a message of simkit to a message of a program.

        Raises:
            MessageError: the type is unknown.
        """
        known = self._to_program.get(type_name)
        if known is None:
            with self._lock:
                known = self._to_program[type_name] = _Generator(self, type_name).to_program()
        return known

    def to_simkit(self, type_name: str) -> ToSimkit:
        """Return the function that converts a message of a program to a message of simkit.

        Raises:
            MessageError: the type is unknown.
        """
        known = self._to_simkit.get(type_name)
        if known is None:
            with self._lock:
                known = self._to_simkit[type_name] = _Generator(self, type_name).to_simkit()
        return known


class _Generator:
    """Generator of the conversions of one type."""

    def __init__(self, flavour: MessageFlavour, type_name: str) -> None:
        self._flavour, self._type_name = flavour, type_name
        self._names: dict[str, object] = {"new": object.__new__, "float32": float32}
        self._lines: list[str] = []
        self._count = 0

    def to_program(self) -> ToProgram:
        """Return the function from simkit to the program."""
        result = self._to_program(self._type_name, "m")
        return self._function("to_program", result)

    def to_simkit(self) -> ToSimkit:
        """Return the function from the program to simkit."""
        result = self._to_simkit(self._type_name, "m")
        return self._function("to_simkit", result)

    def _function(self, name: str, result: str) -> Callable[[Any], object]:
        source = "\n ".join([f"def {name}(m):", *self._lines, f"return {result}"])
        exec(source, self._names)  # the names in it are those of fields, which the parser has checked
        function: Callable[[Any], object] = self._names[name]  # type: ignore[assignment]
        return function

    def _variable(self, prefix: str, value: object = None) -> str:
        """Return a new name; a value is made known to the code under this name."""
        self._count += 1
        name = f"{prefix}{self._count}"
        if value is not None:
            self._names[name] = value
        return name

    def _to_program(self, type_name: str, source: str) -> str:
        """Write the lines that create a message of the program, and return the name of the message."""
        result = self._variable("o")
        message_class = self._flavour.message_class(type_name)
        self._lines.append(f"{result} = new({self._variable('C', message_class)})")
        for field in self._flavour.fields_of(type_name).fields:
            value = f"{source}.{field.simkit_name}" if field.simkit_name else ""
            if not field.is_message:
                code = self._flavour.value_to_program(field, value, self._names)
            elif field.shape:
                convert = self._variable("f", self._flavour.to_program(field.type_name))
                code = f"[{convert}(i) for i in {value}]"
            else:
                inner = self._variable("m")
                self._lines.append(f"{inner} = {value}")
                code = self._to_program(field.type_name, inner)
            self._lines.append(f"{result}.{self._flavour.slot(field)} = {code}")
        self._lines += [f"{result}.{name} = {value!r}" for name, value in extra_slots(message_class).items()]
        return result

    def _to_simkit(self, type_name: str, source: str) -> str:
        """Write the lines that read a message of the program, and return the code that creates simkit's message."""
        arguments = []
        for field in self._flavour.fields_of(type_name).fields:
            value = f"{source}.{field.name}"  # an object that a program appended to a list may lack the slots
            if not field.simkit_name:
                continue
            if not field.is_message:
                code = self._flavour.value_to_simkit(field, value, self._names)
            elif field.shape:
                convert = self._variable("f", self._flavour.to_simkit(field.type_name))
                code = f"[{convert}(i) for i in {self._flavour.list_to_simkit(field, value, self._names)}]"
            else:
                inner = self._variable("m")
                self._lines.append(f"{inner} = {value}")
                code = self._to_simkit(field.type_name, inner)
            arguments.append(f"{field.simkit_name}={code}")
        return f"{self._variable('C', type_of(type_name))}({', '.join(arguments)})"


def extra_slots(message_class: type) -> dict[str, object]:
    """Return attributes that every new message of a class has beside its fields, with their values."""
    slots: dict[str, object] = getattr(message_class, "_extra_slots", {})
    return slots


def number_array(code: str) -> Callable[[Any], array[Any]]:
    """Return a function that copies numbers of simkit into an `array.array` with this type code."""
    dtype = number_type(code)

    def convert(values: Any) -> array[Any]:
        if type(values) is not np.ndarray or values.dtype != dtype or not values.flags.c_contiguous:
            values = np.ascontiguousarray(values, dtype)
        result = array(code)
        if len(values):  # memoryview cannot cast an empty array
            result.frombytes(memoryview(values).cast("B"))
        return result

    return convert


def numpy_array(dtype_name: str) -> Callable[[Any], np.ndarray[Any, Any]]:
    """Return a function that copies numbers into a flat NumPy array."""
    dtype = number_type(dtype_name)

    def convert(values: object) -> np.ndarray[Any, Any]:
        return np.array(values, dtype).reshape(-1)

    return convert
