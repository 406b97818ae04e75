"""Reader of messages into streams: all numeric fields, and arrays of scans, clouds and images."""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from simkit import msgs
from simkit.errors import ArgumentValueError
from simkit.msgs.field_units import unit_of
from simkit.msgs.message_columns import TEXT, Column, columns_of
from simkit.pose import rpy_of_quaternions
from simkit_identification.measures.recording import ArrayOverTime, Floats, Signal, Stream, measurement_times

if TYPE_CHECKING:
    from rosbags.typesys.store import Typestore

Message = Any
Arrays = dict[str, tuple[np.ndarray, tuple[int, ...], str]]
"""Values, shape in the message and unit of each array of a message."""

_SETTING: Final = re.compile(r"(^|\.)(\w*covariance(_type)?|k|d|r|p|width|height|step|point_step|row_step)(\[|$)")
_NAMES: Final = ("child_frame_id", "name", "names", "joint_names", "id")
_MOST_ITEMS: Final = 40  # items of a list that become signals of their own
_MOST_CELLS: Final = 4000  # rays or pixels of a message that are kept; of more, every n-th
_MOST_NUMBERS: Final = 40_000_000  # numbers of an array over time that are kept: 160 MB
_EARTH: Final = 6_378_137.0  # [m] equatorial radius of WGS 84
_NS: Final = 1e-9


class StreamReader:
    """Collector of the messages of one topic.

    Args:
        topic: name of the topic.
        type_name: type of the messages.
        store: type store of the messages.
    """

    def __init__(self, topic: str, type_name: str, store: Typestore) -> None:
        self._topic, self._type_name = topic, type_name
        special = SPECIAL_TYPES.get(type_name)
        self._read_special = None if special is None else special[0]
        left_out = frozenset(special[1] if special else ())
        columns = columns_of(type_name, store, left_out)
        self._stamp = next((c for c in columns if c.path in ("header.stamp.sec", "stamp.sec")), None)
        self._stamp_ns = next((c for c in columns if c.path in ("header.stamp.nanosec", "stamp.nanosec")), None)
        if self._stamp is None:  # a list of stamped messages, such as /tf
            self._stamp = next((c for c in columns if c.path.endswith("header.stamp.sec")), None)
            self._stamp_ns = next((c for c in columns if c.path.endswith("header.stamp.nanosec")), None)
        self._columns = columns
        self._received: list[float] = []
        self._scalars: dict[str, tuple[str, list[int], list[float]]] = {}
        self._arrays: dict[str, tuple[str, tuple[int, ...], list[int], list[np.ndarray]]] = {}
        self._notes: dict[str, None] = {}

    def take(self, time: float, message: Message) -> None:
        """Add a message that was recorded at a time [s]."""
        number = len(self._received)
        self._received.append(time)
        for column in self._columns:
            column.take(message)
        if self._read_special is None:
            return
        try:
            numbers, arrays = self._read_special(message)
        except ArgumentValueError as error:
            self._notes[f"a message could not be read: {error}"] = None
            return
        for name, (value, unit) in numbers.items():
            _, rows, values = self._scalars.setdefault(name, (unit, [], []))
            rows.append(number)
            values.append(value)
        for name, (cells, shape, unit) in arrays.items():
            self._take_array(number, name, cells, shape, unit)

    def _take_array(self, number: int, name: str, cells: np.ndarray, shape: tuple[int, ...], unit: str) -> None:
        _, first_shape, rows, kept = self._arrays.setdefault(name, (unit, shape, [], []))
        if shape != first_shape:
            self._notes[f"{name} has several sizes; only {first_shape} is compared"] = None
            return
        if cells.size * len(kept) > _MOST_NUMBERS:
            self._notes[f"{name}: only the first {len(kept)} messages are compared item by item"] = None
            return
        rows.append(number)
        kept.append(cells)

    def stream(self, origin_ns: int) -> Stream:
        """Return the messages as a stream.

        Args:
            origin_ns: time of the clock of the stamps at the beginning of the recording [ns].
        """
        received = np.array(self._received)
        stamps = self._stamps(origin_ns)
        times = measurement_times(received, stamps)
        stream = Stream(self._topic, self._type_name, received, stamps, notes=list(self._notes))
        for signal in self._signals(times):
            stream.signals[signal.name] = signal
        for name, (unit, rows, values) in self._scalars.items():
            stream.signals[name] = Signal(name, unit, times[rows], np.array(values, np.float64))
        if "east" in stream.signals:
            stream.signals["east"] = _scaled_east(stream.signals["east"], stream.signals["north"])
        for name, (unit, shape, rows, cells) in self._arrays.items():
            stream.arrays[name] = ArrayOverTime(name, unit, times[rows], np.array(cells, np.float32), shape)
        return stream

    def _stamps(self, origin_ns: int) -> Floats:
        """Return the stamps [s]. A stamp of 0 in a recording with calendar times is none."""
        if self._stamp is None or self._stamp_ns is None:
            return np.full(len(self._received), np.nan)
        pairs = zip(self._stamp.rows(), self._stamp_ns.rows(), strict=True)
        stamps = [_first(sec) * 1_000_000_000 + _first(nanosec) for sec, nanosec in pairs]
        values = [(stamp - origin_ns) * _NS if stamp or not origin_ns else math.nan for stamp in stamps]
        return np.array(values, np.float64)

    def _signals(self, times: Floats) -> Iterable[Signal]:
        """Yield the signals of all numeric fields, and for each that is NaN or infinite the share of these values."""
        texts = {c.path: c for c in self._columns if c.kind == TEXT}
        numbers: dict[str, tuple[Floats, Floats]] = {}
        for column in self._columns:
            if column.kind == TEXT or re.search(r"(^|\.|\])(stamp)\.(sec|nanosec)$", column.path):
                continue
            numbers.update(_numbers_of(column, texts, times))
        angles = _angles_of(numbers)
        for path, (at, values) in {**numbers, **angles}.items():
            is_angle = path in angles
            unit = "rad" if is_angle else unit_of(self._type_name, path)
            is_missing = ~np.isfinite(values)
            known = np.where(is_missing, np.nan, values)
            yield Signal(path, unit, at, known, is_angle, bool(_SETTING.search(path)))
            if is_missing.any():
                yield Signal(f"missing share of {path}", "share", at, is_missing.astype(np.float64), is_setting=True)


def _first(value: Any) -> int:
    """Return a number, or the first item of a list; 0 for an empty list."""
    if isinstance(value, int):
        return value
    return int(value[0]) if len(value) else 0


def _numbers_of(column: Column, texts: dict[str, Column], times: Floats) -> dict[str, tuple[Floats, Floats]]:
    """Return the numbers of a column by name: of the field, or of each item of a list."""
    if not column.is_list:
        return {column.path: (times, column.numbers().astype(np.float64))}
    names = _names_of(column, texts)
    if names is not None:
        return _named_items(column, names, times)
    width = column.width
    if width is None or width > _MOST_ITEMS:
        rows = [np.asarray(row, np.float64) for row in column.rows()]
        means = [float(row[np.isfinite(row)].mean()) if np.isfinite(row).any() else math.nan for row in rows]
        lengths = np.array([len(row) for row in rows], np.float64)
        listed = column.path.partition("[]")[0]  # one length for all fields of a list of messages
        return {f"{listed} length": (times, lengths), f"{column.path} mean": (times, np.array(means))}
    table = column.numbers().astype(np.float64).reshape(-1, width) if width else np.empty((len(times), 0))
    return {f"{column.path}[{k}]": (times, table[:, k]) for k in range(width)}


def _names_of(column: Column, texts: dict[str, Column]) -> Column | None:
    """Return the column with the names of the items of a list; None if they have no names."""
    head, bracket, _ = column.path.rpartition("[]")
    beside = f"{head}[]." if bracket else column.path.rpartition(".")[0]
    prefix = beside if bracket or not beside else f"{beside}."
    for name in _NAMES:
        found = texts.get(f"{prefix}{name}")
        if found is not None and found.is_list:
            return found
    return None


def _named_items(column: Column, names: Column, times: Floats) -> dict[str, tuple[Floats, Floats]]:
    head, bracket, tail = column.path.rpartition("[]")
    found: dict[str, tuple[list[float], list[float]]] = {}
    for time, keys, values in zip(times.tolist(), names.rows(), column.rows(), strict=True):
        seen: Counter[str] = Counter()
        for name, value in zip(keys, values, strict=False):
            seen[name] += 1
            key = name if seen[name] == 1 else f"{name} #{seen[name]}"
            path = f"{head}[{key}]{tail}" if bracket else f"{column.path}[{key}]"
            at, kept = found.setdefault(path, ([], []))
            at.append(time)
            kept.append(float(value))
    return {path: (np.array(at), np.array(kept)) for path, (at, kept) in found.items()}


def _angles_of(numbers: dict[str, tuple[Floats, Floats]]) -> dict[str, tuple[Floats, Floats]]:
    """Take quaternions out of the numbers and return their roll, pitch and yaw [rad]."""
    angles: dict[str, tuple[Floats, Floats]] = {}
    for path in [p for p in numbers if p.endswith(".w")]:
        base = path.removesuffix(".w")
        parts = [f"{base}.{axis}" for axis in "wxyz"]
        if not all(part in numbers for part in parts):
            continue
        times = numbers[path][0]
        quaternions = np.column_stack([numbers[part][1] for part in parts])
        for part in parts:
            del numbers[part]
        lengths = np.sqrt((quaternions**2).sum(axis=1))
        if not (lengths > 0.5).any():  # no orientation is given
            continue
        quaternions = np.where((lengths > 0.5)[:, None], quaternions, np.array([1.0, 0.0, 0.0, 0.0]))
        rpy = rpy_of_quaternions(quaternions / np.sqrt((quaternions**2).sum(axis=1))[:, None])
        owner = base.removesuffix("orientation").removesuffix("rotation").rstrip(".") or ""
        prefix = f"{owner}." if owner else ""
        for k, name in enumerate(("roll", "pitch", "yaw")):
            angles[f"{prefix}{name}"] = (times, np.asarray(rpy[:, k], np.float64))
    return angles


# ---------------------------------------------------------------------- types with arrays

Numbers = dict[str, tuple[float, str]]
"""Value and unit of each number of a message."""


def _thin(values: np.ndarray) -> np.ndarray:
    return np.asarray(values[:: max(1, -(-len(values) // _MOST_CELLS))], np.float32)


def _share(valid: np.ndarray) -> float:
    return float(np.count_nonzero(valid)) / valid.size if valid.size else math.nan


def _scan(message: Message) -> tuple[Numbers, Arrays]:
    ranges = np.asarray(message.ranges, np.float64)
    valid = np.isfinite(ranges) & (ranges >= message.range_min) & (ranges <= message.range_max)
    numbers: Numbers = {"valid share": (_share(valid), "share")}
    intensities = np.asarray(message.intensities, np.float64)
    if intensities.size:
        numbers["intensity mean"] = (float(intensities.mean()), "")
    return numbers, {"ranges": (np.where(valid, ranges, np.nan).astype(np.float32), ranges.shape, "m")}


def _cloud(message: Message) -> tuple[Numbers, Arrays]:
    points = msgs.points(message)
    names = points.dtype.names or ()
    numbers: Numbers = {"points": (float(len(points)), "")}
    arrays: Arrays = {}
    if {"x", "y", "z"} <= set(names):
        ranges = np.sqrt(sum((points[axis].astype(np.float64) ** 2 for axis in "xyz"), np.zeros(len(points))))
        valid = np.isfinite(ranges) & (ranges > 0.0)
        numbers["valid share"] = (_share(valid), "share")
        numbers["valid points"] = (float(np.count_nonzero(valid)), "")
        if valid.any():
            numbers["range median"] = (float(np.median(ranges[valid])), "m")
            numbers["range smallest"] = (float(ranges[valid].min()), "m")
        shape = (int(message.height), int(message.width))
        arrays["ranges"] = (_thin(np.where(valid, ranges, np.nan)), shape, "m")
    for name in names:
        if name not in "xyz" and points.dtype[name].kind in "fiu" and len(points):
            values = points[name].astype(np.float64)
            finite = values[np.isfinite(values)]
            if finite.size:
                numbers[f"{name} mean"] = (float(finite.mean()), "")
                numbers[f"{name} span"] = (float(np.ptp(finite)), "")
    return numbers, arrays


def _image(message: Message) -> tuple[Numbers, Arrays]:
    pixels = msgs.image(message)
    encoding = str(getattr(message, "encoding", ""))
    if pixels.ndim == 2 and (pixels.dtype.kind == "f" or (encoding == "16UC1" and pixels.dtype == np.uint16)):
        return _depth_image(pixels)
    return _colour_image(pixels)


def _depth_image(pixels: np.ndarray) -> tuple[Numbers, Arrays]:
    depths = pixels.astype(np.float64) * (0.001 if pixels.dtype.kind == "u" else 1.0)
    valid = np.isfinite(depths) & (depths > 0.0)
    numbers: Numbers = {"valid share": (_share(valid), "share")}
    if valid.any():
        numbers["depth median"] = (float(np.median(depths[valid])), "m")
        numbers["depth smallest"] = (float(depths[valid].min()), "m")
    step = max(1, math.ceil(math.sqrt(depths.size / _MOST_CELLS)))
    cells = np.where(valid, depths, np.nan)[::step, ::step].ravel().astype(np.float32)
    return numbers, {"depths": (cells, depths.shape, "m")}


def _colour_image(pixels: np.ndarray) -> tuple[Numbers, Arrays]:
    largest = 255.0 if pixels.dtype.itemsize == 1 else float(pixels.max(initial=1))
    scaled = pixels[..., :3].astype(np.float64) * (255.0 / largest) if pixels.ndim == 3 else pixels * (255.0 / largest)
    grey = scaled.mean(axis=2) if scaled.ndim == 3 else scaled
    second = grey[1:-1, 1:-1] * 4.0 - grey[:-2, 1:-1] - grey[2:, 1:-1] - grey[1:-1, :-2] - grey[1:-1, 2:]
    saturated = np.asarray((scaled >= 254.5).any(axis=2) if scaled.ndim == 3 else scaled >= 254.5)
    numbers: Numbers = {
        "brightness": (float(grey.mean()), "of 255"),
        "contrast": (float(grey.std()), "of 255"),
        "sharpness": (float(second.std()) if second.size else 0.0, "of 255"),
        "saturated share": (_share(saturated), "share"),
    }
    if scaled.ndim == 3:
        for channel, name in enumerate(("red", "green", "blue")[: scaled.shape[2]]):
            numbers[f"brightness {name}"] = (float(scaled[:, :, channel].mean()), "of 255")
    step = max(1, math.ceil(math.sqrt(grey.size / _MOST_CELLS)))
    return numbers, {"pixels": (grey[::step, ::step].ravel().astype(np.float32), grey.shape, "of 255")}


def _position(message: Message) -> tuple[Numbers, Arrays]:
    latitude, longitude = math.radians(float(message.latitude)), math.radians(float(message.longitude))
    return {
        "north": (latitude * _EARTH, "m"),
        "east": (longitude * _EARTH, "m"),  # on the equator; `_scaled_east` completes it
        "fix share": (float(message.status.status >= 0), "share"),
    }, {}


def _scaled_east(east: Signal, north: Signal) -> Signal:
    """Return the way to the east with the length of a degree at the first latitude."""
    finite = north.values[np.isfinite(north.values)]
    scale = math.cos(float(finite[0]) / _EARTH) if len(finite) else 1.0
    return Signal(east.name, east.unit, east.times, east.values * scale)


SPECIAL_TYPES: Final[dict[str, tuple[Callable[[Message], tuple[Numbers, Arrays]], tuple[str, ...]]]] = {
    "sensor_msgs/msg/LaserScan": (_scan, ("ranges", "intensities")),
    "sensor_msgs/msg/PointCloud2": (_cloud, ("data", "fields", "is_bigendian", "is_dense")),
    "sensor_msgs/msg/Image": (_image, ("data", "is_bigendian")),
    "sensor_msgs/msg/CompressedImage": (_image, ("data",)),
    "sensor_msgs/msg/NavSatFix": (_position, ("latitude", "longitude")),
}
"""Reader of the numbers and arrays of a type, and the fields that it replaces."""
