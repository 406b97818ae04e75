"""Type support of ROS 2 in memory, read and written with `ctypes`: structures, libraries and type hashes.

The structures are those of `rosidl_runtime_c` since ROS 2 Iron: `message_type_support_struct.h`,
`service_type_support_struct.h`, `type_hash.h` and `type_description/*_struct.h`.
"""

from __future__ import annotations

import ctypes
from typing import Any, ClassVar, TypeAlias

POINTER, SIZE = ctypes.c_void_p, ctypes.c_size_t
Fields: TypeAlias = "list[tuple[str, type[ctypes._CDataType]]]"  # quoted: only type checkers know the class
GETTER = ctypes.CFUNCTYPE(POINTER, POINTER)
"""Function that returns a hash, a description or the sources of a type support."""


class Text(ctypes.Structure):
    """Text of `rosidl_runtime_c`."""

    _fields_: ClassVar[Fields] = [("data", ctypes.c_char_p), ("size", SIZE), ("capacity", SIZE)]


class Sequence(ctypes.Structure):
    """Sequence of `rosidl_runtime_c`; empty unless it is filled."""

    _fields_: ClassVar[Fields] = [("data", POINTER), ("size", SIZE), ("capacity", SIZE)]


class TypeDescription(ctypes.Structure):
    """Description of a type: its name, its fields, and the types of its fields."""

    _fields_: ClassVar[Fields] = [("type_name", Text), ("fields", Sequence), ("referenced", Sequence)]


class TypeHash(ctypes.Structure):
    """Type hash: the number of its method (1) and 32 bytes."""

    _fields_: ClassVar[Fields] = [("version", ctypes.c_uint8), ("value", ctypes.c_uint8 * 32)]


class MessageTypeSupport(ctypes.Structure):
    """Type support of a message."""

    _fields_: ClassVar[Fields] = [
        *(("identifier", POINTER), ("data", POINTER), ("find", POINTER)),
        *(("hash", GETTER), ("description", GETTER), ("sources", GETTER)),
    ]


class ServiceTypeSupport(ctypes.Structure):
    """Type support of a service."""

    _fields_: ClassVar[Fields] = [
        *(("identifier", POINTER), ("data", POINTER), ("find", POINTER)),
        *(("request", POINTER), ("response", POINTER), ("event", POINTER)),
        *(("create_event", POINTER), ("destroy_event", POINTER)),
        *(("hash", GETTER), ("description", GETTER), ("sources", GETTER)),
    ]


def hash_text(type_hash: TypeHash) -> str:
    """Return a type hash as text (`RIHS01_…`)."""
    return f"RIHS{type_hash.version:02d}_{bytes(type_hash.value).hex()}"


def hash_of_text(text: str) -> TypeHash:
    """Return a type hash from its text; the unset hash for an empty text."""
    digits = text.removeprefix("RIHS01_")
    return TypeHash(1 if digits else 0, (ctypes.c_uint8 * 32)(*bytes.fromhex(digits)))


def installed_hash(cls: Any) -> str:
    """Return the type hash of an installed message or service class; empty for a ROS without type hashes."""
    kind = ServiceTypeSupport if hasattr(cls, "Request") else MessageTypeSupport
    api = ctypes.pythonapi
    api.PyCapsule_GetName.restype, api.PyCapsule_GetName.argtypes = ctypes.c_char_p, [ctypes.py_object]
    api.PyCapsule_GetPointer.restype, api.PyCapsule_GetPointer.argtypes = POINTER, [ctypes.py_object, ctypes.c_char_p]
    capsule = cls.__class__._TYPE_SUPPORT
    address = api.PyCapsule_GetPointer(capsule, api.PyCapsule_GetName(capsule))
    support = ctypes.cast(address, ctypes.POINTER(kind)).contents
    type_hash = support.hash(address) if support.hash else None
    return hash_text(ctypes.cast(type_hash, ctypes.POINTER(TypeHash)).contents) if type_hash else ""


def capsule(address: int) -> object:
    """Return a capsule of Python around an address; rclpy takes type supports and functions from capsules."""
    new = ctypes.pythonapi.PyCapsule_New
    new.restype, new.argtypes = ctypes.py_object, [POINTER, ctypes.c_char_p, POINTER]
    return new(address, None, None)


def address_of(function: ctypes._CDataType) -> int:
    """Return the address of a function of `ctypes`."""
    address = ctypes.cast(function, POINTER).value
    assert address is not None
    return address


def library(name: str) -> ctypes.CDLL:
    """Return a shared library that rclpy has loaded, by the start of its file name.

    Raises:
        OSError: the library is not loaded.
    """
    with open("/proc/self/maps", encoding="utf-8") as maps:
        for line in maps:
            path = line.split(maxsplit=5)[-1].strip()
            if path.rpartition("/")[2].startswith(name):
                return ctypes.CDLL(path)
    raise OSError(f"no library {name} is loaded")
