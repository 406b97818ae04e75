"""Types of fields as objects, under the names of `rosidl_parser.definition`.

A message class of ROS 2 has them in `SLOT_TYPES`. Programs that walk through messages of any type read them.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from simkit_nodes.interfaces.message_fields import Field

_IDL_NAMES: Final = {"float32": "float", "float64": "double", "bool": "boolean", "byte": "octet", "char": "uint8"}


class AbstractType:
    """Base of all types."""


class AbstractNestableType(AbstractType):
    """Base of types that sequences and arrays can contain."""


@dataclass(frozen=True)
class BasicType(AbstractNestableType):
    """Number, boolean or octet, with its name in ROS 2's interface language."""

    typename: str


@dataclass(frozen=True)
class NamespacedType(AbstractNestableType):
    """Message type."""

    namespaces: list[str]
    name: str

    def namespaced_name(self) -> tuple[str, ...]:
        """Return package, folder and name."""
        return (*self.namespaces, self.name)


class AbstractGenericString(AbstractNestableType):
    """Base of all texts."""

    def has_maximum_size(self) -> bool:
        """Check whether the length of the text has a limit."""
        return isinstance(self, (BoundedString, BoundedWString))


class AbstractString(AbstractGenericString):
    """Base of texts of bytes."""


class AbstractWString(AbstractGenericString):
    """Base of texts of 16-bit units."""


@dataclass(frozen=True)
class BoundedString(AbstractString):
    """Text with a largest length."""

    maximum_size: int


@dataclass(frozen=True)
class UnboundedString(AbstractString):
    """Text of any length."""


@dataclass(frozen=True)
class BoundedWString(AbstractWString):
    """Wide text with a largest length."""

    maximum_size: int


@dataclass(frozen=True)
class UnboundedWString(AbstractWString):
    """Wide text of any length."""


class AbstractNestedType(AbstractType):
    """Base of arrays and sequences."""

    value_type: AbstractNestableType


@dataclass(frozen=True)
class Array(AbstractNestedType):
    """Array of fixed length."""

    value_type: AbstractNestableType
    size: int

    def has_maximum_size(self) -> bool:
        """Check whether the length has a limit."""
        return True


class AbstractSequence(AbstractNestedType):
    """Base of sequences."""

    def has_maximum_size(self) -> bool:
        """Check whether the length has a limit."""
        return isinstance(self, BoundedSequence)


@dataclass(frozen=True)
class BoundedSequence(AbstractSequence):
    """Sequence with a largest length."""

    value_type: AbstractNestableType
    maximum_size: int


@dataclass(frozen=True)
class UnboundedSequence(AbstractSequence):
    """Sequence of any length."""

    value_type: AbstractNestableType


def idl_name(type_name: str) -> str:
    """Return the name of a basic type in ROS 2's interface language."""
    return _IDL_NAMES.get(type_name, type_name)


def slot_type(field: Field) -> AbstractType:
    """Return the type of a field."""
    item = _item_type(field)
    if field.shape == "array":
        return Array(item, field.size)
    if field.shape == "sequence":
        return BoundedSequence(item, field.size) if field.size else UnboundedSequence(item)
    return item


def _item_type(field: Field) -> AbstractNestableType:
    if field.is_message:
        *namespaces, name = field.type_name.split("/")
        return NamespacedType(namespaces, name)
    bound = field.text_bound
    if field.type_name == "string":
        return BoundedString(bound) if bound else UnboundedString()
    if field.type_name == "wstring":
        return BoundedWString(bound) if bound else UnboundedWString()
    return BasicType(idl_name(field.type_name))
