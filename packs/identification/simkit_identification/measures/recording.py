"""Recordings as numbers over time: each topic is a stream of signals, and of arrays for scans, clouds and images."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Final

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]

STILL_SPEED: Final = 0.005
"""Speed [m/s], and half of the angular speed [rad/s], below which a robot counts as still."""
_STILL_MARGIN: Final = 0.5  # [s] after a motion, in which a robot still swings
_LATCHED: Final = 2  # messages of a latched topic at most, which are kept whole
_LARGEST_LATENCY: Final = 10.0  # [s] beyond which the stamps of a topic are those of another clock


@dataclass(frozen=True)
class Signal:
    """Number in the messages of a topic.

    Attributes:
        name: path of the field: `angular_velocity.x`, `position[wheel_left_joint]`.
        unit: SI unit; empty for none.
        times: time of each value since the beginning of the recording [s], shape (n,).
        values: values, shape (n,); NaN for no value.
        is_angle: True for an angle, whose differences wrap around after a full turn.
        is_setting: True for a number of the whole message that usually does not change, such as a covariance.
    """

    name: str
    unit: str
    times: Floats
    values: Floats
    is_angle: bool = False
    is_setting: bool = False


@dataclass(frozen=True)
class ArrayOverTime:
    """Array with one row for each message: the ranges of a scan, or the depths of an image.

    Attributes:
        name: path of the field.
        unit: SI unit.
        times: time of each row since the beginning of the recording [s], shape (n,).
        values: values, shape (n, items); NaN for an item without a return.
        shape: shape of the array in a message; rows of different recordings are only compared if it is equal.
    """

    name: str
    unit: str
    times: Floats
    values: npt.NDArray[np.float32]
    shape: tuple[int, ...]


@dataclass
class Stream:
    """Messages of one topic.

    Attributes:
        topic: name of the topic.
        type_name: ROS type.
        received: time at which each message was recorded, since the beginning of the recording [s], shape (n,).
        stamps: time in the header of each message on the same clock [s], shape (n,); NaN for none.
        signals: numbers by name.
        arrays: arrays by name.
        notes: remarks about what was left out.
    """

    topic: str
    type_name: str
    received: Floats
    stamps: Floats
    signals: dict[str, Signal] = field(default_factory=dict)
    arrays: dict[str, ArrayOverTime] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)

    @property
    def count(self) -> int:
        """Number of messages."""
        return len(self.received)

    @property
    def period(self) -> float:
        """Median time between two messages [s]; NaN for less than three messages."""
        return float(np.median(np.diff(self.received))) if self.count > 2 else float("nan")

    @property
    def is_periodic(self) -> bool:
        """True if most intervals between messages are similar, so that a missing message can be recognised."""
        if self.count < 10 or not self.period > 0.0:
            return False
        intervals = np.diff(self.received)
        return float(np.mean(np.abs(intervals - self.period) < 0.3 * self.period)) > 0.6

    @property
    def times(self) -> Floats:
        """Times of the measurements [s]: the stamps, or the times of receipt for a clock of its own or no stamps."""
        return measurement_times(self.received, self.stamps)


def measurement_times(received: Floats, stamps: Floats) -> Floats:
    """Return the stamps of messages, or their times of receipt if the stamps belong to another clock."""
    if not len(received) or not np.isfinite(stamps).all():
        return received
    return stamps if abs(float(np.median(received - stamps))) < _LARGEST_LATENCY else received


@dataclass
class SignalRecording:
    """Recorded messages as numbers.

    Attributes:
        name: name of the source, for tables.
        duration: time from the beginning to the last message [s].
        streams: streams by topic.
        commands: topics of commands: those that a world hears, or those with types of commands.
        notes: remarks.
        offset: time [s] that was added to all times to align the recording.
    """

    name: str
    duration: float
    streams: dict[str, Stream]
    commands: tuple[str, ...] = ()
    notes: list[str] = field(default_factory=list)
    offset: float = 0.0

    def shifted(self, offset: float) -> SignalRecording:
        """Return the recording with later times.

        Args:
            offset: time to add [s].
        """
        if not offset:
            return self
        streams = {name: _shifted_stream(stream, offset) for name, stream in self.streams.items()}
        return SignalRecording(
            self.name, self.duration + offset, streams, self.commands, list(self.notes), self.offset + offset
        )

    def between(self, start: float, end: float) -> SignalRecording:
        """Return the part between two times [s]."""
        streams = {name: _cut_stream(stream, start, end) for name, stream in self.streams.items()}
        return replace(self, duration=min(self.duration, end), streams=streams, notes=list(self.notes))

    def renamed(self, names: Mapping[str, str]) -> SignalRecording:
        """Return the recording with other names of topics."""
        streams = {}
        for name, stream in self.streams.items():
            new = names.get(name, name)
            streams[new] = Stream(
                new, stream.type_name, stream.received, stream.stamps, stream.signals, stream.arrays, stream.notes
            )
        commands = tuple(names.get(name, name) for name in self.commands)
        return SignalRecording(self.name, self.duration, streams, commands, self.notes, self.offset)

    def still_intervals(self) -> list[tuple[float, float]] | None:
        """Return the intervals [s] in which the robot is still; None if no topic tells its motion."""
        moving: list[tuple[float, float]] = []
        known = False
        for stream in self.streams.values():
            for signal in stream.signals.values():
                limit = _still_limit(stream, signal)
                if limit is not None and len(signal.values) > 2:
                    known = True
                    moving += _intervals(signal.times, np.abs(signal.values) > limit)
        if not known:
            return None
        return _gaps_between(moving, self._start(), self.duration)

    def _start(self) -> float:
        return min((float(s.received[0]) for s in self.streams.values() if s.count), default=0.0)


def _shifted_stream(stream: Stream, offset: float) -> Stream:
    signals = {
        name: Signal(s.name, s.unit, s.times + offset, s.values, s.is_angle, s.is_setting)
        for name, s in stream.signals.items()
    }
    arrays = {
        name: ArrayOverTime(a.name, a.unit, a.times + offset, a.values, a.shape) for name, a in stream.arrays.items()
    }
    return Stream(
        stream.topic, stream.type_name, stream.received + offset, stream.stamps + offset, signals, arrays, stream.notes
    )


def _cut_stream(stream: Stream, start: float, end: float) -> Stream:
    """Return the messages of a stream that were received between two times [s], and the values of these times."""

    def inside(times: Floats) -> npt.NDArray[np.bool_]:
        return (times >= start - 1e-9) & (times <= end + 1e-9)

    kept = inside(stream.received)
    if stream.count <= _LATCHED:
        return stream
    if kept.all() and all(inside(s.times).all() for s in stream.signals.values()):
        return stream
    signals = {
        name: Signal(s.name, s.unit, s.times[now], s.values[now], s.is_angle, s.is_setting)
        for name, s in stream.signals.items()
        if (now := inside(s.times)).any()
    }
    arrays = {
        name: ArrayOverTime(a.name, a.unit, a.times[now], a.values[now], a.shape)
        for name, a in stream.arrays.items()
        if (now := inside(a.times)).any()
    }
    return Stream(
        stream.topic, stream.type_name, stream.received[kept], stream.stamps[kept], signals, arrays, list(stream.notes)
    )


_ANGULAR: Final = ("angular.z", "angular.x", "angular.y")
_LINEAR: Final = ("linear.x", "linear.y")


def _still_limit(stream: Stream, signal: Signal) -> float | None:
    """Return the value above which a signal tells that the robot moves; None for a signal that does not tell."""
    package, _, name = stream.type_name.rpartition("/")
    if name == "Odometry" or name in ("Twist", "TwistStamped", "TwistWithCovarianceStamped"):
        if signal.name.endswith(_LINEAR):
            return STILL_SPEED
        if signal.name.endswith(_ANGULAR):
            return 2.0 * STILL_SPEED
    if name == "JointState" and package == "sensor_msgs/msg" and signal.name.startswith("velocity["):
        return 10.0 * STILL_SPEED
    return None


def _intervals(times: Floats, flags: npt.NDArray[np.bool_]) -> list[tuple[float, float]]:
    """Return the intervals in which flags are set; each flag holds until the next one."""
    if not flags.any():
        return []
    edges = np.flatnonzero(np.diff(np.concatenate(([False], flags, [False])).astype(np.int8)))
    starts, ends = edges[::2], edges[1::2]
    last = len(times) - 1
    return [(float(times[s]), float(times[min(e, last)])) for s, e in zip(starts.tolist(), ends.tolist(), strict=True)]


def _gaps_between(busy: Sequence[tuple[float, float]], start: float, end: float) -> list[tuple[float, float]]:
    """Return the intervals between others, without a margin after each of them."""
    free: list[tuple[float, float]] = []
    at = start + _STILL_MARGIN  # a robot of a simulation first settles
    for begin, stop in sorted(busy):
        if begin > at:
            free.append((at, begin))
        at = max(at, stop + _STILL_MARGIN)
    if end > at:
        free.append((at, end))
    return free
