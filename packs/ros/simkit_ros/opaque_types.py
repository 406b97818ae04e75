"""Classes of rclpy for types that are not installed: their values are CDR bytes.

rclpy takes a type's support from capsules of the class's metaclass. The supports here are made at run time, for the
middleware `rmw_fastrtps_cpp`, with the hash of the type and without its fields. A "message" in memory is a block of
CDR without its first four bytes. The libraries are those of ROS 2 Jazzy and Kilted on Linux.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from functools import cache
from typing import Any, ClassVar, TypeVar

from simkit.bridges.simulation_link import CDR_HEADER
from simkit_ros.type_support import (
    GETTER,
    POINTER,
    SIZE,
    Fields,
    MessageTypeSupport,
    Sequence,
    ServiceTypeSupport,
    Text,
    TypeDescription,
    address_of,
    capsule,
    hash_of_text,
    library,
)

_LARGEST = 1 << 31
_CDR = "_ZN8eprosima7fastcdr3Cdr"  # eprosima::fastcdr::Cdr, in the names of the C++ ABI
_ON_MESSAGE = ctypes.CFUNCTYPE(ctypes.c_bool, POINTER, POINTER)


T = TypeVar("T")


class _Block(ctypes.Structure):
    """Message in memory: an allocated block of CDR without its header."""

    _fields_: ClassVar[Fields] = [("data", POINTER), ("size", SIZE)]


class _MessageCallbacks(ctypes.Structure):
    """Functions of `rosidl_typesupport_fastrtps_cpp` for a message."""

    _fields_: ClassVar[Fields] = [
        *(("namespace", ctypes.c_char_p), ("name", ctypes.c_char_p)),
        *(("serialize", POINTER), ("deserialize", POINTER), ("size", POINTER), ("largest", POINTER), ("key", POINTER)),
    ]


class _ServiceCallbacks(ctypes.Structure):
    """Functions of `rosidl_typesupport_fastrtps_cpp` for a service."""

    _fields_: ClassVar[Fields] = [
        *(("namespace", ctypes.c_char_p), ("name", ctypes.c_char_p), ("request", POINTER), ("response", POINTER))
    ]


class _Members(ctypes.Structure):
    """Members of `rosidl_typesupport_introspection_c` for a message; none, which suffices to register the type."""

    _fields_: ClassVar[Fields] = [
        *(("namespace", ctypes.c_char_p), ("name", ctypes.c_char_p), ("count", ctypes.c_uint32), ("size", SIZE)),
        *(("has_key", ctypes.c_bool), ("members", POINTER), ("create", POINTER), ("destroy", POINTER)),
    ]


class _Runtime:
    """Libraries of ROS 2 with their functions, and the functions of Python that they call.

    Attributes:
        kept: objects that must live as long as the process, because ROS has pointers to them.
    """

    def __init__(self) -> None:
        self.kept: list[object] = []
        self._libc = libc = ctypes.CDLL(None)
        libc.malloc.restype, libc.malloc.argtypes = POINTER, [SIZE]
        libc.calloc.restype, libc.calloc.argtypes = POINTER, [SIZE, SIZE]
        libc.free.argtypes = [POINTER]
        cdr = library("libfastcdr")
        self._write_bytes = _member(cdr, "15serialize_arrayEPKcm", POINTER, POINTER, POINTER, SIZE)
        self._position = _member(cdr, "20get_current_positionEv", POINTER, POINTER)
        self._begin = _member(cdr, "18get_buffer_pointerEv", POINTER, POINTER)
        self.fast_id = _identifier("rosidl_typesupport_fastrtps_c")
        self.members_id = _identifier("rosidl_typesupport_introspection_c")
        runtime = library("librosidl_runtime_c.so")
        self.find_message = address_of(runtime.get_message_typesupport_handle_function)
        self.find_service = address_of(runtime.get_service_typesupport_handle_function)
        self._buffer_place: tuple[int, int] | None = None
        function = ctypes.CFUNCTYPE
        self.serialize = self.keep(_ON_MESSAGE(self._serialize))
        self.deserialize = self.keep(_ON_MESSAGE(self._deserialize))
        self.size = self.keep(function(ctypes.c_uint32, POINTER)(lambda message: _block(message).size + 4))
        self.largest = self.keep(function(SIZE, POINTER)(self._largest))
        self.create = self.keep(ctypes.PYFUNCTYPE(POINTER)(lambda: libc.calloc(1, ctypes.sizeof(_Block))))
        self.destroy = self.keep(ctypes.PYFUNCTYPE(None, POINTER)(self._destroy))
        self.from_python = self.keep(ctypes.PYFUNCTYPE(ctypes.c_bool, ctypes.py_object, POINTER)(self._from_python))

    def keep(self, value: T) -> T:
        """Keep an object for ever and return it."""
        self.kept.append(value)
        return value

    def _fill(self, message: int, source: bytes | int, size: int) -> None:
        block = _block(message)
        self._libc.free(block.data)
        block.data, block.size = self._libc.malloc(max(size, 1)), size
        ctypes.memmove(block.data, source, size)

    def _from_python(self, value: Any, message: int) -> bool:
        body = value.cdr[4:]
        self._fill(message, body, len(body))
        return True

    def _destroy(self, message: int) -> None:
        self._libc.free(_block(message).data)
        self._libc.free(message)

    def _serialize(self, message: int, cdr: int) -> bool:
        block = _block(message)
        if block.size:
            self._write_bytes(cdr, block.data, block.size)
        return True

    def _deserialize(self, cdr: int, message: int) -> bool:
        self._fill(message, self._position(cdr), self._remaining(cdr))
        return True

    def _largest(self, is_bounded: int) -> int:
        """Return the largest size of a message; it is unbounded."""
        ctypes.cast(is_bounded, ctypes.POINTER(ctypes.c_bool))[0] = False
        return 0

    def _remaining(self, cdr: int) -> int:
        """Return the number of bytes that a `Cdr` has not read yet.

        `Cdr` has no function for the size of its buffer, and `jump` fails at the end of an empty message. Its reference
        to the `FastBuffer` is therefore found once, by the buffer's address.
        """
        begin = self._begin(cdr)
        words = ctypes.cast(cdr, ctypes.POINTER(SIZE))
        if self._buffer_place is None:
            self._buffer_place = next(
                (i, j)
                for i in range(14, 20)
                if words[i] >= 4096 and words[i] % 8 == 0
                for j in range(2)
                if (inner := ctypes.cast(words[i], ctypes.POINTER(SIZE)))[j] == begin and inner[j + 1] < _LARGEST
            )
        i, j = self._buffer_place
        size = ctypes.cast(words[i], ctypes.POINTER(SIZE))[j + 1]
        return int(size) - (int(self._position(cdr)) - int(begin))


@cache
def _runtime() -> _Runtime:
    return _Runtime()


def _member(loaded_library: ctypes.CDLL, name: str, result: Any, *arguments: Any) -> Any:
    """Return a member function of `Cdr`."""
    function = getattr(loaded_library, _CDR + name)
    function.restype, function.argtypes = result, list(arguments)
    return function


def _identifier(name: str) -> int:
    """Return the address of the identifier of a kind of type support; ROS compares addresses."""
    address = POINTER.in_dll(library(f"lib{name}.so"), f"{name}__identifier").value
    assert address is not None
    return address


def _block(message: int) -> _Block:
    return ctypes.cast(message, ctypes.POINTER(_Block)).contents


def _description(name: str, type_hash: str) -> list[object]:
    """Return the functions that give the hash, the description and the sources of a type."""
    keep = _runtime().keep
    text = keep(ctypes.create_string_buffer(name.encode()))
    described = TypeDescription(Text(ctypes.cast(text, ctypes.c_char_p), len(name), len(name) + 1))
    values = [keep(hash_of_text(type_hash)), keep(described), keep(Sequence())]
    return [keep(GETTER(_constant(ctypes.addressof(each)))) for each in values]


def _constant(address: int) -> Callable[[object], int]:
    return lambda _: address


@cache
def message_class(name: str, type_hash: str = "") -> Any:
    """Return a class for a message type; its objects have one attribute, `cdr`.

    Raises:
        OSError, AttributeError, ValueError: the libraries of ROS are not those of Jazzy or Kilted.
    """
    run, (package, kind, short) = _runtime(), name.split("/")
    names = f"{package}::{kind}".encode(), short.encode()
    functions = [address_of(f) for f in (run.serialize, run.deserialize, run.size, run.largest)]
    callbacks = run.keep(_MessageCallbacks(*names, *functions, None))
    members = run.keep(_Members(f"{package}__{kind}".encode(), short.encode(), 0, ctypes.sizeof(_Block), False))
    described = _description(name, type_hash)
    fast = run.keep(MessageTypeSupport(run.fast_id, ctypes.addressof(callbacks), None, *described))
    plain = run.keep(MessageTypeSupport(run.members_id, ctypes.addressof(members), run.find_message, *described))
    supports = {
        b"rosidl_typesupport_fastrtps_c": ctypes.addressof(fast),
        b"rosidl_typesupport_introspection_c": ctypes.addressof(plain),
    }
    find_type = ctypes.CFUNCTYPE(POINTER, POINTER, POINTER)
    find = run.keep(find_type(lambda _, wanted: supports.get(ctypes.string_at(wanted))))
    fast.find = address_of(find)

    class Opaque:
        """Message of a type that is not installed, as CDR."""

        __slots__ = ("cdr",)

        def __init__(self, cdr: bytes = CDR_HEADER) -> None:
            self.cdr = cdr

    def to_python(message: int) -> object:
        block = _block(message)
        return cls(CDR_HEADER + ctypes.string_at(block.data, block.size))

    result = run.keep(ctypes.PYFUNCTYPE(ctypes.py_object, POINTER)(to_python))
    capsules = {
        "_TYPE_SUPPORT": ctypes.addressof(fast),
        "_CREATE_ROS_MESSAGE": address_of(run.create),
        "_DESTROY_ROS_MESSAGE": address_of(run.destroy),
        "_CONVERT_FROM_PY": address_of(run.from_python),
        "_CONVERT_TO_PY": address_of(result),
    }
    body = {"__slots__": (), "__module__": f"{package}.{kind}", "support": fast}
    cls: Any = _metaclass(capsules)(short, (Opaque,), body)
    return cls


@cache
def service_class(name: str, type_hash: str = "") -> type:
    """Return a class for a service type; its requests and responses have one attribute, `cdr`.

    Raises:
        OSError, AttributeError, ValueError: the libraries of ROS are not those of Jazzy or Kilted.
    """
    run, (package, kind, short) = _runtime(), name.split("/")
    request, response = message_class(f"{name}_Request"), message_class(f"{name}_Response")
    supports = [ctypes.addressof(part.support) for part in (request, response)]
    callbacks = run.keep(_ServiceCallbacks(f"{package}::{kind}".encode(), short.encode(), *supports))
    functions = ctypes.addressof(callbacks), run.find_service, *supports, None, None, None
    support = run.keep(ServiceTypeSupport(run.fast_id, *functions, *_description(name, type_hash)))
    body = {"Request": request, "Response": response, "__module__": f"{package}.{kind}"}
    return _metaclass({"_TYPE_SUPPORT": ctypes.addressof(support)})(short, (), body)


def _metaclass(addresses: dict[str, int]) -> type[type]:
    """Return a metaclass with the capsules of a type, as rclpy's generated classes have."""
    body: dict[str, object] = {name: capsule(address) for name, address in addresses.items()}
    return type("Metaclass", (type,), {**body, "__import_type_support__": classmethod(lambda _: None)})
