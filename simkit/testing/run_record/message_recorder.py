"""Recorders for the messages of one topic: all fields, small pictures, thinned point clouds, or noise statistics."""

from __future__ import annotations

import zlib
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Final, Literal
from zlib import crc32

import numpy as np
import numpy.typing as npt

from simkit.msgs import Message
from simkit.run_spec import RunSpec
from simkit.testing.run_record.message_columns import MessageRows, join_arrays, message_fields
from simkit.testing.run_record.noise_statistics import noise_statistics
from simkit.testing.run_record.record import Array, Pictures, Stream

if TYPE_CHECKING:
    from simkit.runtime import Simulation


TILE: Final = 32
"""Side length of a tile [px]."""


def tile_hashes(image: Array, tile: int = TILE) -> npt.NDArray[np.uint32]:
    """Return a hash of each tile of a picture, shape (rows, columns); the last tiles may be smaller.

    Args:
        image: Picture of any type, shape (height, width) or (height, width, channels).
        tile: Side length of a tile [px].
    """
    rows, columns = -(-image.shape[0] // tile), -(-image.shape[1] // tile)
    found = np.empty((rows, columns), np.uint32)
    for row in range(rows):
        for column in range(columns):
            part = image[row * tile : (row + 1) * tile, column * tile : (column + 1) * tile]
            found[row, column] = zlib.crc32(np.ascontiguousarray(part).tobytes())
    return found


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
        kept = np.arange(0, len(self._hashes), self._every)
        stream.pictures = Pictures(
            np.stack(self._small),
            self._shape,
            self._encoding,
            np.stack(self._tiles).astype(np.uint32),
            None if self._every == 1 else kept,
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


def pixels_of_image(message: Message) -> Any:
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


def points_of_cloud(message: Message) -> Any:
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

    def __init__(self, sensor: Any, type_name: str, paths: Sequence[str]) -> None:
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
