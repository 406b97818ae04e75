"""Encoding of `wstring` fields as CDR, which rosbags does not support.

ROS 2 sends a `wstring` as the number of its UTF-16 code units, followed by each unit in 32 bits
(`rosidl_typesupport_fastrtps_cpp/wstring_conversion.hpp`).
"""

from __future__ import annotations

import copy
import sys
from array import array
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Final

from simkit.msgs.definition_parser import ARRAY, BASE, NAME, SEQUENCE, FieldNode
from simkit.number_text import counted

if TYPE_CHECKING:
    from rosbags.typesys.store import Typestore

_WIDE: Final = "wstring"
_UNITS: Final[list[tuple[str, FieldNode]]] = [("units", (SEQUENCE, ((BASE, ("uint32", 0)), 0)))]


def with_wide_strings(store: Typestore, fielddefs: dict[str, Any], types: dict[str, Any]) -> Typestore:
    """Return a type store whose code also encodes and decodes `wstring` fields.

    Args:
        store: type store to change.
        fielddefs: fields of each type.
        types: class of each type.
    """
    store.fielddefs, store.types = fielddefs, types
    store.cache = codecs = _Codecs(store)
    # one look into a table for each nested message: with rosbags' method, a message with a header takes 10 % longer
    store.get_msgdef = codecs.__getitem__  # type: ignore[method-assign, assignment]
    return store


class _Codecs(dict[str, Any]):
    """Table of generated code by the name of the type; the code of a type is generated at its first use.

    In this code, a `wstring` is a field with the message type `wstring`, whose messages are texts.
    """

    def __init__(self, store: Typestore) -> None:
        super().__init__({_WIDE: _wide_codec()})
        self._store = store

    def __missing__(self, name: str) -> Any:
        constants, fields = self._store.fielddefs[name]
        replaced: Any = [(field, _replaced(node)) for field, node in fields]
        store = copy.copy(self._store)
        store.fielddefs, store.cache = {name: (constants, replaced)}, {}
        definition = self[name] = type(store).get_msgdef(store, name)
        return definition


def _replaced(node: FieldNode) -> FieldNode:
    """Return a field's type with `wstring` as the name of a message type."""
    is_array = int(node[0]) in (ARRAY, SEQUENCE)
    inner = node[1][0] if is_array else node
    if int(inner[0]) != BASE or inner[1][0] != _WIDE:
        return node
    return (node[0], ((NAME, _WIDE), node[1][1])) if is_array else (NAME, _WIDE)


def _wide_codec() -> object:
    """Return the code for texts in the form that rosbags generates for message types."""
    from rosbags.interfaces import Msgdef

    def size(position: int, text: str, _: object) -> int:
        return position + 4 + 4 * len(_units(text))

    def writer(is_swapped: bool) -> Callable[[memoryview, int, str, object], int]:
        def write(data: memoryview, position: int, text: str, _: object) -> int:
            units = _units(text)
            content = array("I", [len(units), *units])
            if is_swapped:
                content.byteswap()
            end = position + 4 * len(content)
            data[position:end] = content.tobytes()
            return end

        return write

    def reader(is_swapped: bool) -> Callable[..., tuple[str, int]]:
        def read(data: memoryview, position: int, *_: object) -> tuple[str, int]:
            count = _numbers(data[position : position + 4], 1, is_swapped)[0]
            end = position + 4 + 4 * count
            units = _numbers(data[position + 4 : end], count, is_swapped)
            if any(unit > 0xFFFF for unit in units):
                raise ValueError("a wstring has a unit of more than 16 bits")
            return array("H", units).tobytes().decode(_UTF_16), end

        return read

    swapped = sys.byteorder != "little"
    little, big = (writer(swapped), writer(not swapped)), (reader(swapped), reader(not swapped))
    codec: Any = Msgdef
    return codec(_WIDE, _UNITS, str, 0, size, *little, *big, 0, *[None] * 7)


_UTF_16: Final = "utf-16-le" if array("H", [1]).tobytes()[0] else "utf-16-be"


def _units(text: str) -> array[int]:
    """Return the UTF-16 code units of a text."""
    return array("H", text.encode(_UTF_16))


def _numbers(data: bytes | memoryview, count: int, is_swapped: bool) -> array[int]:
    """Return 32-bit numbers out of CDR.

    Raises:
        ValueError: the data is too short.
    """
    if len(data) != 4 * count:
        raise ValueError(f"a wstring has {counted(len(data), 'byte')}; expected {4 * count}")
    codes = array("I", bytes(data))
    if is_swapped:
        codes.byteswap()
    return codes
