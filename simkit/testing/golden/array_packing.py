"""Compact storage of arrays and texts: numbers are rounded, predicted, split into byte planes and compressed.

A block consists of `SKGOLD` with a version, the length of a JSON text, the JSON text, and the bytes of all arrays in
order. The block is compressed with xz. A block may come from an untrusted source. Therefore all sizes are checked
before memory is allocated, number types come from a fixed list, and nothing is executed.
"""

from __future__ import annotations

import json
import lzma
import math
import struct
from typing import Final, NamedTuple

import numpy as np

from simkit.elementary_functions import log2
from simkit.json_reader import parse_json
from simkit.run_spec import JsonMapping, JsonObject
from simkit.testing.run_record.record import Array

_MAGIC: Final = b"SKGOLD\x01\n"
_PRESET: Final = 6 | lzma.PRESET_EXTREME
_FAST: Final = 3
_LONG_BLOCK_BYTES: Final = 2 << 20
_MAX_MEMORY: Final = 64 << 20  # memory of the decompressor without its output [bytes]
MAX_BLOCK_BYTES: Final = 1 << 30
"""Maximum size of an unpacked block and of all its arrays together [bytes]."""
_TYPES: Final = frozenset(
    ("bool", "int8", "uint8", "int16", "uint16", "int32", "uint32", "int64", "uint64", "float32", "float64")
)
_ORDERS: Final = ("plain", "time", "time2", "across")  # neighbour from which a number is predicted
_MAX_DIMENSIONS: Final = 5


class PackingError(ValueError):
    """Error of a data block that is damaged or has another format."""


class Packer:
    """Collector of arrays for one block."""

    def __init__(self) -> None:
        self._entries: list[dict[str, object]] = []
        self._parts: list[bytes] = []

    def add(self, values: Array, step: float = 0.0) -> int:
        """Add an array and return its number in the block.

        Args:
            values: Array whose first axis is time.
            step: Rounding step; 0 stores the values exactly.
        """
        entry: dict[str, object] = {"dtype": str(values.dtype), "shape": list(values.shape)}
        if entry["dtype"] not in _TYPES:
            raise TypeError(f"arrays of {values.dtype} cannot be stored")
        values = np.ascontiguousarray(values)
        if len(values) > 1 and values.size and _is_constant(values):
            entry["constant"] = True
            values = values[:1]
        integers = self._whole_numbers(values, step, entry)
        data = _byte_planes(values.reshape(-1))
        if integers is not None:
            prediction = _predict(integers)
            if "step" in entry or prediction.cost < 0.98 * _entropy_bits(data, values.size):
                entry |= {"order": prediction.order, "width": prediction.width}
                data = prediction.data
        entry["bytes"] = len(data)
        self._entries.append(entry)
        self._parts.append(data)
        return len(self._entries) - 1

    def block(self, about: object) -> bytes:
        """Return the compressed block.

        Args:
            about: JSON data to store with the arrays.
        """
        head = json.dumps({"arrays": self._entries, "about": about}, separators=(",", ":"), ensure_ascii=False)
        text = head.encode()
        content = b"".join((_MAGIC, struct.pack("<I", len(text)), text, *self._parts))
        # large blocks compress well with any preset, and the best preset takes minutes
        preset = _PRESET if len(content) <= _LONG_BLOCK_BYTES else _FAST
        return lzma.compress(content, format=lzma.FORMAT_XZ, check=lzma.CHECK_CRC64, preset=preset)

    def _whole_numbers(self, values: Array, step: float, entry: dict[str, object]) -> Array | None:
        """Convert the values to integer multiples of the step; None if they must be stored bit by bit."""
        if values.dtype.kind in "iub" and values.size:
            return values.astype(np.int64)
        if step <= 0 or not values.size:
            return None
        finite = np.isfinite(values)
        with np.errstate(over="ignore"):  # a tiny step: the values are stored bit by bit
            scaled = np.rint(np.where(finite, values, 0).astype(np.float64) / step)
        if np.abs(scaled).max(initial=0) >= 2**52:
            return None
        entry["step"] = step
        if not finite.all():
            kinds = np.select([np.isnan(values), values == np.inf, values == -np.inf], [1, 2, 3], 0).astype(np.uint8)
            entry["kinds"] = self.add(kinds)
        return np.asarray(scaled.astype(np.int64))


class Unpacker:
    """Reader of the arrays in a block.

    Args:
        data: Compressed block.

    Raises:
        PackingError: The block is damaged.
    """

    def __init__(self, data: bytes) -> None:
        content = _decompress(data)
        if not content.startswith(_MAGIC) or len(content) < len(_MAGIC) + 4:
            raise PackingError("the data do not start with the header of a block")
        start = len(_MAGIC) + 4
        (length,) = struct.unpack("<I", content[len(_MAGIC) : start])
        try:
            head = parse_json(content[start : start + length].decode())
            self.about: JsonObject = head["about"]
            self._entries = [_validate_entry(entry) for entry in head["arrays"]]
        except (ValueError, KeyError, TypeError, OverflowError) as error:
            raise PackingError(f"the table of the block cannot be read: {error}") from None
        if sum(_size(entry) for entry in self._entries) > MAX_BLOCK_BYTES:
            raise PackingError("the arrays of the block are too large")
        self._whole = memoryview(content)
        self._starts = np.cumsum([start + length, *(entry["bytes"] for entry in self._entries)]).tolist()
        if self._starts[-1] != len(content):
            raise PackingError("the block is truncated or has additional data at its end")

    def array(self, number: object) -> Array:
        """Return the array with a number that `Packer.add` returned.

        Raises:
            PackingError: The number is unknown, or the array is damaged.
        """
        if type(number) is not int or not 0 <= number < len(self._entries):
            raise PackingError(f"there is no array {number!r:.40}")
        entry = self._entries[number]
        data = bytes(self._whole[self._starts[number] : self._starts[number + 1]])
        try:
            return self._decode(entry, data)
        except (ValueError, TypeError, KeyError, OverflowError) as error:
            raise PackingError(f"array {number} is damaged: {error}") from None

    def _decode(self, entry: JsonObject, data: bytes) -> Array:
        shape, dtype = tuple(entry["shape"]), np.dtype(entry["dtype"])
        stored = (1, *shape[1:]) if entry["constant"] else shape
        kept_as = np.dtype(entry["width"]) if entry["order"] else dtype
        values = _join_byte_planes(data, kept_as, math.prod(stored))
        if entry["order"]:
            integers = _undo_prediction(_unzigzag(values).reshape(stored), entry["order"])
            values = integers.astype(dtype) if not entry["step"] else (integers * entry["step"]).astype(dtype)
            if entry["kinds"] is not None:
                values = self._with_kinds(values, entry)
        values = values.reshape(stored)
        return np.broadcast_to(values, shape).copy() if entry["constant"] else values

    def _with_kinds(self, values: Array, entry: JsonObject) -> Array:
        inner = self._entries[entry["kinds"]] if 0 <= entry["kinds"] < len(self._entries) else None
        if inner is None or inner["kinds"] is not None:
            raise PackingError("the table of non-finite values of an array is missing")
        kinds = self.array(entry["kinds"]).reshape(values.shape)
        for kind, value in ((1, np.nan), (2, np.inf), (3, -np.inf)):
            values[kinds == kind] = value
        return values


def _decompress(data: bytes) -> bytes:
    decompressor = lzma.LZMADecompressor(format=lzma.FORMAT_XZ, memlimit=_MAX_MEMORY)
    try:
        content = decompressor.decompress(data, max_length=MAX_BLOCK_BYTES)
    except (lzma.LZMAError, EOFError) as error:
        raise PackingError(f"the block cannot be decompressed: {error}") from None
    if not decompressor.eof or decompressor.unused_data:
        raise PackingError("the block is truncated, too large, or has additional data at its end")
    return content


def _validate_entry(entry: JsonObject) -> dict[str, object]:
    """Validate an entry of a block's table, which may come from an untrusted source."""
    shape, dtype, size = entry["shape"], entry["dtype"], entry["bytes"]
    if dtype not in _TYPES or type(shape) is not list or len(shape) > _MAX_DIMENSIONS:
        raise ValueError("an array has an unknown type")
    if not all(type(n) is int and 0 <= n <= MAX_BLOCK_BYTES for n in (*shape, size)):
        raise ValueError("an array has an invalid size")
    order, step, kinds = entry.get("order", ""), entry.get("step", 0.0), entry.get("kinds")
    width = entry.get("width", "uint8")
    if order not in ("", *_ORDERS) or width not in ("uint8", "uint16", "uint32", "uint64"):
        raise ValueError("an array has an unknown order")
    if type(step) not in (int, float) or not 0 <= step < math.inf or not (kinds is None or type(kinds) is int):
        raise ValueError("an array has an invalid step")
    return {
        "shape": shape, "dtype": dtype, "bytes": size, "order": order, "step": step, "kinds": kinds, "width": width,
        "constant": entry.get("constant") is True and bool(shape) and shape[0] > 0,
    }  # fmt: skip


def _size(entry: JsonObject) -> int:
    return int(math.prod(entry["shape"])) * 8


def _is_constant(values: Array) -> bool:
    bits = values.reshape(len(values), -1).view(np.uint8).reshape(len(values), -1)
    return bool((bits == bits[:1]).all())


# ---------------------------------------------------------------------- prediction of numbers


class _Prediction(NamedTuple):
    """Differences between numbers and their predictions, as bytes."""

    order: str
    width: str
    data: bytes
    cost: float


def _predict(integers: Array) -> _Prediction:
    """Encode an array with the kind of prediction that needs the fewest bytes."""
    best: _Prediction | None = None
    for order in _ORDERS:
        if (order == "across" and integers.ndim < 2) or (order in ("time", "time2") and len(integers) < 2):
            continue
        small = _smallest_type(_zigzag(integers if order == "plain" else _difference(integers, order)))
        data = _byte_planes(small)
        cost = _entropy_bits(data, small.size)
        if best is None or cost < best.cost * 0.98:
            best = _Prediction(order, str(small.dtype), data, cost)
    assert best is not None
    return best


def _entropy_bits(data: bytes, count: int) -> float:
    """Estimate the compressed size of byte planes by their entropy [bits]."""
    if not count:
        return 1.0
    planes = np.frombuffer(data, np.uint8).reshape(-1, count)
    bits = 1.0
    for plane in planes:
        shares = np.bincount(plane, minlength=256) / count
        shares = shares[shares > 0]
        bits -= count * float((shares * log2(shares)).sum())
    return bits


def _difference(integers: Array, order: str) -> Array:
    if order == "across":
        differences = np.diff(integers, axis=1, prepend=0)
        differences[:, 0] = np.diff(integers[:, 0], axis=0, prepend=0)
        return differences
    for _ in range(2 if order == "time2" else 1):
        integers = np.diff(integers, axis=0, prepend=0)
    return integers


def _undo_prediction(residual: Array, order: str) -> Array:
    if order == "across":
        sums = residual.copy()
        sums[:, 0] = np.cumsum(residual[:, 0], axis=0)
        return np.asarray(np.cumsum(sums, axis=1))
    for _ in range(("plain", "time", "time2").index(order)):
        residual = np.cumsum(residual, axis=0)
    return np.asarray(residual)


def _zigzag(numbers: Array) -> Array:
    """Map signed to unsigned numbers so that small magnitudes stay small: 0, -1, 1, -2 become 0, 1, 2, 3."""
    flat = numbers.reshape(-1)
    return ((flat << 1) ^ (flat >> 63)).view(np.uint64)


def _unzigzag(numbers: Array) -> Array:
    wide = numbers.astype(np.uint64)
    return np.asarray((wide >> np.uint64(1)).view(np.int64) ^ -(wide & np.uint64(1)).view(np.int64))


def _smallest_type(numbers: Array) -> Array:
    """Convert numbers to the smallest unsigned type without a loss."""
    largest = int(numbers.max(initial=0))
    return numbers.astype(next(w for w in ("uint8", "uint16", "uint32", "uint64") if largest <= np.iinfo(w).max))


def _byte_planes(values: Array) -> bytes:
    """Group the first bytes of all values, then the second bytes, and so on, because equal bytes compress better."""
    size = values.dtype.itemsize
    little = values.astype(values.dtype.newbyteorder("<"), copy=False)
    return np.ascontiguousarray(little.view(np.uint8).reshape(-1, size).T).tobytes()


def _join_byte_planes(data: bytes, dtype: np.dtype[np.generic], count: int) -> Array:
    if len(data) != count * dtype.itemsize:
        raise ValueError("the data do not have the declared length")
    planes = np.frombuffer(data, np.uint8).reshape(dtype.itemsize, count)
    little = np.ascontiguousarray(planes.T).view(dtype.newbyteorder("<")).reshape(-1)
    return little.astype(dtype)


def pack_words(packer: Packer, texts: list[str]) -> dict[str, object]:
    """Return texts as a list without repetitions, and the number of each text in this list."""
    known = {text: number for number, text in enumerate(dict.fromkeys(texts))}
    return {"texts": list(known), "which": packer.add(np.array([known[text] for text in texts], dtype=np.int64))}


def unpack_words(unpacker: Unpacker, stored: JsonMapping, count: int) -> list[str]:
    """Return the texts from `pack_words`.

    Raises:
        PackingError: The data are damaged.
    """
    texts = [str(text) for text in stored["texts"]]
    which = unpacker.array(stored["which"]).tolist()
    if len(which) != count or any(type(i) is not int or not 0 <= i < len(texts) for i in which):
        raise PackingError("the texts do not match the messages")
    return [texts[i] for i in which]
