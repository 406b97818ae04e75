"""Recorders for the messages of one topic: all fields, small pictures, thinned point clouds, or noise statistics.

The fields become columns of numbers and texts, one for each field.
"""

from __future__ import annotations

import zlib
from collections.abc import Callable, Sequence
from functools import cache
from itertools import pairwise
from operator import attrgetter
from typing import TYPE_CHECKING, Any, Final, Literal, NamedTuple
from zlib import crc32

import numpy as np
import numpy.typing as npt

from simkit import msgs
from simkit.msgs import Message
from simkit.run_spec import RunSpec
from simkit.testing.run_record.noise_statistics import noise_statistics
from simkit.testing.run_record.record import Array, Column, Pictures, Stream

if TYPE_CHECKING:
    from simkit.msgs.definition_parser import FieldNode
    from simkit.runtime import Simulation
    from simkit.runtime.engine.entity_structure import AttachedSensor


_STAMPS: Final = ("builtin_interfaces/msg/Time", "builtin_interfaces/msg/Duration")
_BASE, _NAME = 1, 2  # kinds of fields in the type store of rosbags; other kinds are lists
_NS: Final = 1_000_000_000


class MessageFields(NamedTuple):
    """Fields of a message type as flat paths; a time is one field.

    Attributes:
        numbers, texts, stamps: Paths of single values; numbers with their type.
        arrays: Paths of number lists with their type.
        lists: Paths of text lists.
        parts: Paths of message lists with their type.
    """

    numbers: dict[str, str]
    texts: list[str]
    stamps: list[str]
    arrays: dict[str, str]
    lists: list[str]
    parts: dict[str, str]


@cache
def message_fields(type_name: str) -> MessageFields:
    """Return the fields of a message type."""
    described = MessageFields({}, [], [], {}, [], {})
    _add_fields(described, type_name, "")
    return described


def _add_fields(described: MessageFields, type_name: str, prefix: str) -> None:
    definition: Sequence[tuple[str, FieldNode]] = msgs.type_store().fielddefs[msgs.full_name(type_name)][1]
    for field, (kind, of) in definition:
        path = prefix + field
        is_list = int(kind) not in (_BASE, _NAME)
        inner_kind, inner = of[0] if is_list else (kind, of)
        if int(inner_kind) == _NAME:
            if is_list:
                described.parts[path] = str(inner)
            elif inner in _STAMPS:
                described.stamps.append(path)
            else:
                _add_fields(described, str(inner), path + ".")
        elif str(inner[0]) in ("string", "wstring"):
            (described.lists if is_list else described.texts).append(path)
        else:
            (described.arrays if is_list else described.numbers)[path] = _dtype(str(inner[0]))


def _dtype(base: str) -> str:
    return {"byte": "uint8", "octet": "uint8", "char": "uint8"}.get(base, base)


class MessageRows:
    """Collector of the fields of messages.

    Args:
        type_name: Type of all messages.
        skip: Paths that are not collected.
    """

    def __init__(self, type_name: str, skip: frozenset[str] = frozenset()) -> None:
        self._fields = message_fields(type_name)
        fields = self._fields
        self._numbers = [path for path in fields.numbers if path not in skip]
        single = [*self._numbers, *fields.texts, *(f"{p}.{q}" for p in fields.stamps for q in ("sec", "nanosec"))]
        self._single = _getter(single)
        self._rows: list[tuple[object, ...]] = []
        self._arrays = {path: attrgetter(path) for path in fields.arrays if path not in skip}
        self._lists = {path: attrgetter(path) for path in fields.lists if path not in skip}
        self._kept: dict[str, list[Any]] = {path: [] for path in (*self._arrays, *self._lists)}
        self._parts = {
            path: (attrgetter(path), MessageRows(kind, _nested_path(skip, path)))
            for path, kind in fields.parts.items()
            if path not in skip
        }
        self._counts: dict[str, list[int]] = {path: [] for path in self._parts}

    def __len__(self) -> int:
        return len(self._rows)

    def take(self, message: object) -> None:
        """Add a message; the values of the message are copied."""
        self._rows.append(self._single(message))
        for path, get in self._arrays.items():
            self._kept[path].append(np.array(get(message)))
        for path, get in self._lists.items():
            self._kept[path].append([str(text) for text in get(message)])
        for path, (get, rows) in self._parts.items():
            items = get(message)
            self._counts[path].append(len(items))
            for item in items:
                rows.take(item)

    def columns(self) -> tuple[dict[str, Column], dict[str, list[str]]]:
        """Return all numbers as columns and all texts as lists, by path of the field."""
        fields = self._fields
        columns: dict[str, Column] = {}
        words: dict[str, list[str]] = {}
        turned = zip(*self._rows, strict=True)
        for path in self._numbers:
            columns[path] = Column(np.array(next(turned, ()), dtype=fields.numbers[path]))
        for path in fields.texts:
            words[path] = [str(text) for text in next(turned, ())]
        for path in fields.stamps:
            sec, nanosec = (np.array(next(turned, ()), dtype=np.int64) for _ in range(2))
            columns[path] = Column(sec * _NS + nanosec)
        for path in self._arrays:
            columns[path] = join_arrays([np.atleast_1d(a) for a in self._kept[path]], fields.arrays[path])
        for path in self._lists:
            words[path] = [", ".join(texts) for texts in self._kept[path]]
        for path, (_, rows) in self._parts.items():
            _add_nested_fields(columns, words, path, rows, self._counts[path])
        return columns, words


def join_arrays(arrays: list[Array], dtype: str) -> Column:
    """Join the arrays of all messages: as a table if all have the same length, else one after another."""
    lengths = np.array([len(a) for a in arrays], dtype=np.int64)
    if not len(arrays):
        return Column(np.zeros((0, 0), dtype=dtype))
    if (lengths == lengths[0]).all():
        return Column(np.stack(arrays).astype(dtype, copy=False))
    return Column(np.concatenate(arrays).astype(dtype, copy=False), lengths)


def _add_nested_fields(
    columns: dict[str, Column], words: dict[str, list[str]], path: str, rows: MessageRows, counts: list[int]
) -> None:
    """Add the fields of nested messages; all values of one outer message become one entry."""
    inner, texts = rows.columns()
    starts = np.concatenate([[0], np.cumsum(counts)]).astype(np.int64)
    is_even = len(set(counts)) == 1 and counts[0] > 0
    for name, column in inner.items():
        if column.lengths is None and is_even and column.values.ndim == 1:
            columns[f"{path}.{name}"] = Column(column.values.reshape(len(counts), counts[0]))
            continue
        width = column.lengths
        if width is None:
            each = int(np.prod(column.values.shape[1:], dtype=np.int64)) if column.values.ndim > 1 else 1
            width = np.full(len(rows), each, dtype=np.int64)
        ends = np.concatenate([[0], np.cumsum(width)])
        lengths = ends[starts[1:]] - ends[starts[:-1]]
        columns[f"{path}.{name}"] = Column(column.values.reshape(-1), lengths)
    for name, values in texts.items():
        words[f"{path}.{name}"] = [", ".join(values[start:stop]) for start, stop in pairwise(starts)]


def _nested_path(skip: frozenset[str], path: str) -> frozenset[str]:
    return frozenset(p.removeprefix(path + ".") for p in skip if p.startswith(path + "."))


def _getter(paths: list[str]) -> Callable[[object], tuple[object, ...]]:
    """Return a function that returns the values at all paths as a tuple."""
    if not paths:
        return lambda _: ()
    if len(paths) == 1:
        get_value = attrgetter(paths[0])
        return lambda message: (get_value(message),)
    return attrgetter(*paths)


TILE: Final = 32
"""Side length of a tile [px]."""


def tile_hashes(image: Array, tile: int = TILE) -> npt.NDArray[np.uint32]:
    """Return a hash of each tile of a picture, shape (rows, columns); the last tiles may be smaller.

    Args:
        image: Picture of any type, shape (height, width) or (height, width, channels).
        tile: Side length of a tile [px].
    """
    rows, columns = -(-image.shape[0] // tile), -(-image.shape[1] // tile)
    hashes = np.empty((rows, columns), np.uint32)
    for row in range(rows):
        for column in range(columns):
            part = image[row * tile : (row + 1) * tile, column * tile : (column + 1) * tile]
            hashes[row, column] = zlib.crc32(np.ascontiguousarray(part).tobytes())
    return hashes


def shrink(image: Array, longest: int) -> Array:
    """Reduce a picture: each new pixel is the mean of the original pixels in its area, with the same type.

    The mean of depths includes only finite values. If an area has none, its first value is used (infinite or NaN).

    Args:
        image: Picture of type uint8, uint16 or float32, shape (height, width) or (height, width, channels).
        longest: Maximum side length [px]; a smaller picture is returned unchanged.
    """
    height, width = image.shape[:2]
    factor = longest / max(height, width, 1)
    if factor >= 1.0:
        return image
    rows = np.arange(max(1, round(height * factor))) * height // max(1, round(height * factor))
    columns = np.arange(max(1, round(width * factor))) * width // max(1, round(width * factor))
    if np.issubdtype(image.dtype, np.integer):
        total = _block_sum(image.astype(np.int64), rows, columns)
        count = np.outer(np.diff([*rows, height]), np.diff([*columns, width]))
        count = count.reshape(count.shape + (1,) * (image.ndim - 2))
        return np.asarray(((2 * total + count) // (2 * count)).astype(image.dtype))
    finite = np.isfinite(image)
    total = _block_sum(np.where(finite, image, 0).astype(np.float64), rows, columns)
    hits = _block_sum(finite.astype(np.int64), rows, columns)
    first = image[np.ix_(rows, columns)]
    return np.asarray(np.where(hits > 0, total / np.maximum(hits, 1), first).astype(image.dtype))


def _block_sum(values: Array, rows: Array, columns: Array) -> Array:
    """Return the sums of blocks that begin at the given rows and columns."""
    return np.asarray(np.add.reduceat(np.add.reduceat(values, rows, axis=0), columns, axis=1))


_IMAGE: Final = "sensor_msgs/msg/Image"
_CLOUD: Final = "sensor_msgs/msg/PointCloud2"
_BINARY_FIELDS: Final = {
    _IMAGE: frozenset(("data",)),
    _CLOUD: frozenset(("data", "fields")),
    "sensor_msgs/msg/CompressedImage": frozenset(("data",)),
}
_POINTS_KEPT: Final = 64  # maximum number of stored points in a cloud message
_PICTURES_KEPT: Final = 32  # maximum number of stored pictures in a run
_CHANNELS: Final = {
    **dict.fromkeys(("mono8", "8UC1", "bayer_rggb8", "bayer_bggr8", "bayer_gbrg8", "bayer_grbg8"), ("uint8", 1)),
    **dict.fromkeys(("rgb8", "bgr8", "8UC3"), ("uint8", 3)),
    **dict.fromkeys(("rgba8", "bgra8"), ("uint8", 4)),
    **dict.fromkeys(("mono16", "16UC1"), ("uint16", 1)),
    "32FC1": ("float32", 1),
    "32FC3": ("float32", 3),
}
_CLOUD_TYPES: Final = {
    1: "int8", 2: "uint8", 3: "int16", 4: "uint16", 5: "int32", 6: "uint32", 7: "float32", 8: "float64"
}  # fmt: skip


class MessageRecorder:
    """Recorder of one topic that stores all fields unchanged.

    Args:
        type_name: Type of the messages.
    """

    def __init__(self, type_name: str) -> None:
        self._rows = MessageRows(type_name, _BINARY_FIELDS.get(type_name, frozenset()))

    def take(self, message: Message) -> None:
        """Add a message; the stored data are copies."""
        self._rows.take(message)

    def fill(self, stream: Stream) -> None:
        """Store the recorded data in a stream."""
        stream.columns, stream.words = self._rows.columns()


def message_recorder_for(scenario: RunSpec, sim: Simulation, topic: str, type_name: str) -> MessageRecorder:
    """Return the recorder for a topic."""
    if type_name == _IMAGE:
        return _ImageRecorder(scenario.picture)
    if type_name == _CLOUD:
        return _CloudRecorder()
    fields = message_fields(type_name)
    of_noise = [
        path
        for path in (*fields.numbers, *fields.arrays)
        if any(t.statistics for t in scenario.tolerance(topic, path)[:1])
    ]
    sensor = next((s for s in sim.engine.structure.all_sensors() if s.topic == topic), None)
    if not of_noise or sensor is None:
        return MessageRecorder(type_name)
    return _NoiseRecorder(sensor, type_name, of_noise)


class _ImageRecorder(MessageRecorder):
    """Recorder of reduced pictures."""

    def __init__(self, longest: int) -> None:
        super().__init__(_IMAGE)
        self._longest = longest
        self._small: list[Array] = []
        self._tiles: list[Array] = []
        self._hashes: list[int] = []
        self._every = 1
        self._shape: tuple[int, int] | None = None
        self._encoding, self._is_odd = "", False

    def take(self, message: Message) -> None:
        number = len(self._hashes)
        super().take(message)
        self._hashes.append(crc32(message.data))
        shape = (int(message.height), int(message.width))
        if self._shape is None:
            self._shape, self._encoding = shape, str(message.encoding)
        if number % self._every:
            return
        image = pixels_of_image(message)
        if image is None or shape != self._shape:  # another size cannot be stored, but the digest includes the picture
            self._is_odd = True
            return
        small = shrink(image, self._longest)
        self._small.append(small if small.dtype != np.uint16 else small.astype(np.float32))
        self._tiles.append(tile_hashes(image))
        if len(self._small) > _PICTURES_KEPT:  # keep every second, so that two runs store pictures of the same messages
            self._every *= 2
            del self._small[1::2], self._tiles[1::2]

    def fill(self, stream: Stream) -> None:
        super().fill(stream)
        if self._shape is None or not self._small or self._is_odd:
            return
        message_numbers = np.arange(0, len(self._hashes), self._every)
        stream.pictures = Pictures(
            np.stack(self._small),
            self._shape,
            self._encoding,
            np.stack(self._tiles).astype(np.uint32),
            None if self._every == 1 else message_numbers,
            np.array(self._hashes, np.uint32),
        )


class _CloudRecorder(MessageRecorder):
    """Recorder of thinned point clouds; the digest covers all points."""

    def __init__(self) -> None:
        super().__init__(_CLOUD)
        self._values: dict[str, list[Array]] = {}
        self._names: list[str] = []

    def take(self, message: Message) -> None:
        super().take(message)
        points = points_of_cloud(message)
        self._names.append(", ".join(points.dtype.names or ()))
        step = max(1, -(-len(points) // _POINTS_KEPT))
        thin = points[::step]
        for name in thin.dtype.names or ():
            if thin.dtype[name].kind in "iuf" and not thin.dtype[name].shape:
                self._values.setdefault(name, []).append(np.array(thin[name]))

    def fill(self, stream: Stream) -> None:
        super().fill(stream)
        stream.words["fields"] = list(self._names)
        for name, arrays in self._values.items():
            if len(arrays) == len(stream.times_ns):
                stream.columns[f"points.{name}"] = join_arrays(arrays, str(arrays[0].dtype))


def pixels_of_image(message: Message) -> Array | None:
    """Return the pixels of an Image message, shape (height, width, channels); None for an unknown encoding."""
    kind = _CHANNELS.get(str(message.encoding))
    if kind is None:
        return None
    dtype, channels = np.dtype(kind[0]), kind[1]
    data = np.asarray(message.data, dtype=np.uint8)
    height, width, step = int(message.height), int(message.width), int(message.step)
    wide = width * channels * dtype.itemsize
    if height * step > data.size or wide > step:
        return None
    rows = np.ascontiguousarray(data[: height * step].reshape(height, step)[:, :wide])
    pixels = rows.view(dtype.newbyteorder(">" if message.is_bigendian else "<")).reshape(height, width, channels)
    return pixels.astype(dtype, copy=False)


def points_of_cloud(message: Message) -> Array:
    """Return the points of a PointCloud2 message as a structured array."""
    order: Literal[">", "<"] = ">" if message.is_bigendian else "<"
    kinds: list[object] = []
    names: list[str] = []
    offsets: list[int] = []
    for field in message.fields:
        if int(field.datatype) in _CLOUD_TYPES and field.name not in names:
            kind = np.dtype(_CLOUD_TYPES[int(field.datatype)]).newbyteorder(order)
            kinds.append(kind if int(field.count) <= 1 else (kind, (int(field.count),)))
            names.append(str(field.name))
            offsets.append(int(field.offset))
    step = int(message.point_step)
    dtype = np.dtype({"names": names, "formats": kinds, "offsets": offsets, "itemsize": step})
    data = np.ascontiguousarray(np.asarray(message.data, dtype=np.uint8))
    count = len(data) // step if step else 0
    return np.frombuffer(data[: count * step].tobytes(), dtype=dtype)


class _NoiseRecorder(MessageRecorder):
    """Recorder that replaces some fields by noise statistics of reading minus ground truth.

    Args:
        sensor: Publishing sensor.
        type_name: Type of the messages.
        paths: Fields to replace by statistics.
    """

    def __init__(self, sensor: AttachedSensor, type_name: str, paths: Sequence[str]) -> None:
        super().__init__(type_name)
        self._sensor, self._paths = sensor, paths
        self._read, self._true = MessageRows(type_name), MessageRows(type_name)

    def take(self, message: Message) -> None:
        super().take(message)
        self._read.take(message)
        self._true.take(self._sensor.truth)

    def fill(self, stream: Stream) -> None:
        super().fill(stream)
        read, true = self._read.columns()[0], self._true.columns()[0]
        times = stream.times_ns * 1e-9
        period = float(np.median(np.diff(times))) if len(times) > 1 else 0.0
        for path in sorted(self._paths):
            column, truth = read[path], true[path]
            if column.lengths is not None or column.values.shape != truth.values.shape or not len(column.values):
                continue
            with np.errstate(invalid="ignore"):  # a ray without a hit gives inf - inf
                residual = _table(column.values) - _table(truth.values)
            if not np.nan_to_num(residual).any():
                continue  # without noise, the samples themselves are compared
            stream.statistics[path] = noise_statistics(residual, period)
            del stream.columns[path]


def _table(values: Array) -> Array:
    """Return an array with one row for each message."""
    return values.reshape(len(values), -1).astype(np.float64)
