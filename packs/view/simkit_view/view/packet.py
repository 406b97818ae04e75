"""Packets from the server to the page, a JSON head and arrays, and the streams that make them."""

from __future__ import annotations

import json
import math
import struct
from collections.abc import Mapping, Sequence
from typing import Protocol

import numpy as np
import numpy.typing as npt

from simkit.run_spec import JsonObject

Arrays = Mapping[str, npt.NDArray[np.generic]]
_ALIGNED = 4  # [bytes]; typed arrays of the page begin at multiples of their element size


class Stream(Protocol):
    """Source of the packets of one stream, made when the first page asks for it."""

    def packet(self, options: Sequence[object]) -> bytes | None:
        """Return a packet of the present state; None if nothing has changed since the last.

        Args:
            options: options that each page has sent for the stream.
        """
        ...

    def close(self) -> None:
        """End the stream, because no page shows it any more or the structure has changed."""
        ...


def make_packet(head: JsonObject, arrays: Arrays) -> bytes:
    """Return a packet.

    Args:
        head: values of the packet: `kind`, and what else JSON can express.
        arrays: arrays by name; 64-bit numbers become 32-bit numbers.
    """
    table, pieces, offset = {}, [], 0
    for name, values in arrays.items():
        packed = np.ascontiguousarray(values, _wire_type(values.dtype))
        raw = packed.tobytes()
        table[name] = [packed.dtype.str, offset, list(packed.shape)]
        padding = -len(raw) % _ALIGNED
        pieces += [raw, bytes(padding)]
        offset += len(raw) + padding
    text = json.dumps(_without_nan({**head, "arrays": table}), allow_nan=False, separators=(",", ":")).encode()
    text += b" " * (-len(text) % _ALIGNED)
    return b"".join((struct.pack("<I", len(text)), text, *pieces))


def read_packet(data: bytes) -> tuple[JsonObject, dict[str, npt.NDArray[np.generic]]]:
    """Return head and arrays of a packet."""
    (length,) = struct.unpack_from("<I", data)
    head = json.loads(data[4 : 4 + length])
    begin, arrays = 4 + length, {}
    for name, (kind, offset, shape) in head.pop("arrays").items():
        count = int(np.prod(shape))
        arrays[name] = np.frombuffer(data, kind, count, begin + offset).reshape(shape)
    return head, arrays


def _without_nan(value: object) -> object:
    """Return a value of JSON with null for NaN and infinity, which browsers do not read."""
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, dict):
        return {name: _without_nan(item) for name, item in value.items()}
    return [_without_nan(item) for item in value] if isinstance(value, (list, tuple)) else value


def _wire_type(dtype: np.dtype[np.generic]) -> np.dtype[np.generic]:
    """Return the type in the packet: bytes, 16-bit numbers, or little-endian 32-bit numbers."""
    if dtype.itemsize == 1:
        return np.dtype("u1")
    if dtype == np.uint16:
        return np.dtype("<u2")
    return np.dtype("<f4") if dtype.kind == "f" else np.dtype("<i4")
