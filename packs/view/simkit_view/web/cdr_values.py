"""Values of a message's CDR in the form of rosbridge, without a message object: one generated function for each type.

Bytes become base64, and NaN and infinite numbers None. For CBOR, arrays of numbers become bytes with a tag. A generated
function reads all neighbouring numbers in one call of `struct`. This is the function of `std_msgs/msg/Header`:

    def read(d, p):
        unpack, size = layouts0[p & 7]
        v1 = unpack(d, p)
        p += size
        t2 = str(d[p : p + v1[2] - 1], "utf-8")
        p += v1[2]
        return {"stamp": {"sec": v1[0], "nanosec": v1[1]}, "frame_id": t2}, p
"""

from __future__ import annotations

import binascii
import math
import struct
from collections.abc import Callable
from functools import cache
from typing import Any, Final

import numpy as np

from simkit import msgs
from simkit.errors import MessageError
from simkit.extend import counted
from simkit.msgs import type_store
from simkit.msgs.definition_parser import ARRAY, BASE, NAME, FieldNode
from simkit.msgs.message_text import NUMBER_CODES, field_nodes
from simkit.msgs.message_types import FieldValue

_Reader = Callable[[bytes, int], tuple[dict[str, FieldValue], int]]
_CODES: Final = {**NUMBER_CODES, "bool": "?", "byte": "b"}  # `byte` is signed, as in rosbags
_CBOR_TAGS: Final = {"H": 69, "I": 70, "Q": 71, "b": 72, "h": 77, "i": 78, "q": 79, "f": 85, "d": 86}
"""Tags of arrays of little-endian numbers (RFC 8746), by the code of the number."""
_HEAD: Final = b"\0\1"  # little-endian CDR
_HEAD_SIZE: Final = 4
_MOST_PADDING: Final = 3  # bytes after the last field


def read_values(data: bytes, type_name: str, *, is_binary: bool = False) -> dict[str, FieldValue]:
    """Convert a message to dicts, lists, numbers and texts.

    Args:
        data: message as CDR.
        type_name: full name of its type.
        is_binary: True for CBOR: arrays of numbers become bytes with a tag, and NaN stays.

    Raises:
        MessageError: the data are not a message of the type.
    """
    if not data.startswith(_HEAD):
        data = msgs.serialize(msgs.deserialize(data, type_name))
    try:
        values, end = _reader(type_name, is_binary)(data, _HEAD_SIZE)
    except (struct.error, UnicodeDecodeError, ValueError) as error:
        raise MessageError(f"{type_name}: the data are damaged: {error}") from None
    if not 0 <= len(data) - end <= _MOST_PADDING:
        raise MessageError(f"{type_name}: found {counted(len(data), 'byte')}; expected {end}")
    return values


@cache
def _reader(type_name: str, is_binary: bool) -> _Reader:
    return _Generator(type_name, is_binary).function()


class _Layouts(dict[int, tuple[Callable[[bytes, int], tuple[Any, ...]], int]]):
    """Functions that read a sequence of numbers, and its size [bytes], by the position of the first number modulo 8."""

    def __init__(self, items: list[tuple[int, str]]) -> None:
        super().__init__()
        self._items = items

    def __missing__(self, start: int) -> tuple[Callable[[bytes, int], tuple[Any, ...]], int]:
        formats, position = ["<"], start
        for count, code in self._items:
            width = struct.calcsize(f"<{code}")
            gap = (_HEAD_SIZE - position) % width
            formats.append(f"{gap}x{count}{code}" if gap else f"{count}{code}")
            position += gap + count * width
        layout = self[start] = struct.Struct("".join(formats)).unpack_from, position - start
        return layout


class _Generator:
    """Generator of the function that reads one type."""

    def __init__(self, type_name: str, is_binary: bool) -> None:
        self._is_binary = is_binary
        self._globals: dict[str, object] = {
            "isfinite": math.isfinite, "base64": binascii.b2a_base64, "finite": _finite, "tagged": _tagged,
            "numbers": _numbers, "wide_text": _wide_text, "all": all, "map": map
        }  # fmt: skip
        self._lines: list[str] = []
        self._indent, self._names = " ", 0
        self._begin_run()
        values = self._message(type_name)
        self._end_run()
        self._emit(f"return {values}, p")

    def function(self) -> _Reader:
        """Return the compiled function."""
        exec("\n".join(["def read(d, p):", *self._lines]), self._globals)  # the parser has checked the fields' names
        reader: _Reader = self._globals["read"]  # type: ignore[assignment]
        return reader

    # ------------------------------------------------------------------ fields

    def _message(self, type_name: str) -> str:
        """Return the expression of a message's values."""
        shown = {name for name, _ in field_nodes(type_name)}
        fields = [(name, self._field(node)) for name, node in type_store().fielddefs[type_name][1]]
        return "{" + ", ".join(f"{name!r}: {value}" for name, value in fields if name in shown) + "}"

    def _field(self, node: FieldNode) -> str:
        kind, content = int(node[0]), node[1]
        if kind == NAME:
            return self._message(content)
        if kind == BASE and content[0] in _CODES:
            return self._put(_CODES[content[0]])
        if kind == BASE:
            return self._text(content[0])
        item, length = content[0], content[1] if kind == ARRAY else None
        if int(item[0]) == BASE and item[1][0] in _CODES:
            return self._numbers(_CODES[item[1][0]], length)
        return self._list(item, length)

    def _text(self, kind: str) -> str:
        count = self._count()
        name = self._name("t")
        if kind == "wstring":
            self._emit(f"{name} = wide_text(d, p, {count})")
            self._emit(f"p += 4 * {count}")
        else:
            self._emit(f'{name} = str(d[p : p + {count} - 1], "utf-8") if {count} else ""')
            self._emit(f"p += {count}")
        return name

    def _numbers(self, code: str, length: int | None) -> str:
        tag, is_bytes = _CBOR_TAGS.get(code) if self._is_binary else None, code == "B"
        if length is not None and (tag is None and not is_bytes):
            return f"[*{self._put(code, length)}]"
        count = self._count() if length is None else self._constant(length)
        width, name = struct.calcsize(f"<{code}"), self._name("a")
        if width > 1:
            self._emit(f"if {count}: p += (4 - p) & {width - 1}")
        if is_bytes or tag is not None:
            content = f"d[p : p + {width} * {count}]"
            is_text = is_bytes and not self._is_binary
            content = f"base64({content}, newline=False).decode()" if is_text else content
            self._emit(f"{name} = {content}" if is_bytes else f"{name} = tagged({tag}, {content})")
        else:
            self._emit(f"{name} = numbers(d, p, {count}, '<{code}')")
        self._emit(f"p += {width} * {count}")
        return name

    def _list(self, item: FieldNode, length: int | None) -> str:
        """Read a list of texts or messages."""
        count = self._count() if length is None else self._constant(length)
        name = self._name("l")
        self._emit(f"{name} = []")
        self._emit(f"for _ in range({count}):")
        self._indent += " "
        value = self._field(item)
        self._end_run()
        self._emit(f"{name}.append({value})")
        self._indent = self._indent[:-1]
        return name

    # ------------------------------------------------------------------ runs of numbers that are read in one call

    def _begin_run(self) -> None:
        self._items: list[tuple[int, str]] = []
        self._run, self._length = self._name("v"), 0

    def _put(self, code: str, count: int | None = None) -> str:
        """Add a number, or an array of `count` numbers, to the run; return its expression."""
        self._items.append((1 if count is None else count, code))
        first, self._length = self._length, self._length + (1 if count is None else count)
        return f"{self._run}[{first}]" if count is None else f"{self._run}[{first}:{self._length}]"

    def _count(self) -> str:
        """End the run with a number of elements; return its expression."""
        count = self._put("I")
        self._end_run()
        return count

    def _constant(self, number: int) -> str:
        self._end_run()
        return str(number)

    def _end_run(self) -> None:
        if self._items:
            layouts = self._name("layouts")
            self._globals[layouts] = _Layouts(self._items)
            self._emit(f"unpack, size = {layouts}[p & 7]")
            self._emit(f"{self._run} = unpack(d, p)")
            self._emit("p += size")
            if not self._is_binary and any(code in "fd" for _, code in self._items):
                self._emit(f"if not all(map(isfinite, {self._run})): {self._run} = finite({self._run})")
        self._begin_run()

    # ------------------------------------------------------------------ lines

    def _emit(self, line: str) -> None:
        self._lines.append(self._indent + line)

    def _name(self, prefix: str) -> str:
        self._names += 1
        return f"{prefix}{self._names}"


def _finite(values: tuple[float, ...]) -> list[float | None]:
    """Replace NaN and infinite numbers by None."""
    return [value if math.isfinite(value) else None for value in values]


def _tagged(tag: int, content: bytes) -> object:
    import cbor2

    return cbor2.CBORTag(tag, content)


def _numbers(data: bytes, position: int, count: int, code: str) -> list[float | None]:
    """Return an array of numbers as a list."""
    array = np.frombuffer(data, np.dtype(code), count, position)
    values: list[float | None] = array.tolist()
    if array.dtype.kind == "f" and not np.isfinite(array).all():
        return [value if value is not None and math.isfinite(value) else None for value in values]
    return values


def _wide_text(data: bytes, position: int, count: int) -> str:
    """Return a `wstring` of so many UTF-16 code units, each in 32 bits."""
    return np.frombuffer(data, "<u4", count, position).astype("<u2").tobytes().decode("utf-16-le")
