"""Motion: speeds of poses, drift, speed at each command, and the delay from a command to the reaction."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from simkit_identification.measures.context import Context
from simkit_identification.measures.measure import Measure
from simkit_identification.measures.recording import Floats, Signal, SignalRecording, Stream
from simkit_identification.measures.signals import is_constant

_STEP: Final = 1.0  # [s] time over which the motion of a pose is measured
_SETTLING: Final = 1.0  # [s] after a change of a command, in which the speed is not steady
_LEAST_STEADY: Final = 1.0  # [s] steady motion for a speed at a command
_MOST_LEVELS: Final = 6
_SMALLEST_CHANGE: Final = 0.02  # [m/s or rad/s] change of a command whose reaction is timed
_LONGEST_DELAY: Final = 1.5  # [s]
_GRID: Final = 0.01  # [s]
_BEST_CORRELATION: Final = 0.8  # below which a reaction does not follow the command


@dataclass(frozen=True)
class PosePath:
    """Pose in the plane over time: signals of a position and of a yaw."""

    name: str
    x: Signal
    y: Signal
    yaw: Signal

    def in_start_frame(self) -> tuple[Floats, Floats, Floats, Floats]:
        """Return times [s], x and y [m] and yaw [rad] relative to the first pose."""
        x, y = self.x.values - self.x.values[0], self.y.values - self.y.values[0]
        yaw = np.unwrap(self.yaw.values)
        c, s = math.cos(float(yaw[0])), math.sin(float(yaw[0]))
        return self.x.times, c * x + s * y, c * y - s * x, yaw - yaw[0]


def pose_paths(stream: Stream) -> Iterator[PosePath]:
    """Yield the poses that move in a stream."""
    for name, x in stream.signals.items():
        for part in ("position.x", "translation.x"):
            if not name.endswith(part):
                continue
            base = name.removesuffix(part).rstrip(".")
            y = stream.signals.get(name.removesuffix("x") + "y")
            yaw = stream.signals.get(f"{base}.yaw" if base else "yaw")
            if y is None or yaw is None or not len(x.times) == len(y.times) == len(yaw.times) > 2:
                continue
            if not (is_constant(x) and is_constant(y) and is_constant(yaw)):
                yield PosePath(base, x, y, yaw)


def paths(stream: Stream, _: Context) -> Iterator[Measure]:
    """Yield the motion of each pose in one second, in the frame of the pose, and the length of the path."""
    for path in pose_paths(stream):
        times, x, y, yaw = path.in_start_frame()
        if not np.all(np.diff(times) > 0.0) or times[-1] - times[0] < 3.0 * _STEP:
            continue
        grid = np.arange(math.ceil(times[0] / _STEP), math.floor(times[-1] / _STEP) + 1) * _STEP
        gx, gy, gyaw = (np.interp(grid, times, v) for v in (x, y, yaw))
        dx, dy = np.diff(gx), np.diff(gy)
        heading = gyaw[:-1]
        forward = np.cos(heading) * dx + np.sin(heading) * dy
        left = np.cos(heading) * dy - np.sin(heading) * dx
        label = f" of {path.name}" if path.name else ""
        yield Measure(f"forward speed{label}", "m/s", "paired", forward / _STEP, grid[:-1])
        yield Measure(f"sideways speed{label}", "m/s", "paired", left / _STEP, grid[:-1])
        yield Measure(f"yaw rate{label}", "rad/s", "paired", np.diff(gyaw) / _STEP, grid[:-1])
        length = float(np.sqrt(np.diff(x) ** 2 + np.diff(y) ** 2).sum())
        yield Measure(f"path length{label}", "m", "value", np.array([length]))


# ---------------------------------------------------------------------- commands


@dataclass(frozen=True)
class Command:
    """Commanded speed over time: forward or angular."""

    topic: str
    is_angular: bool
    times: Floats
    values: Floats


def commands_of(recording: SignalRecording) -> Iterator[Command]:
    """Yield the commanded speeds of a recording that change or are not zero."""
    for topic in recording.commands:
        stream = recording.streams.get(topic)
        if stream is None or stream.count < 1 or not stream.type_name.endswith(("/Twist", "/TwistStamped")):
            continue
        prefix = "twist." if stream.type_name.endswith("Stamped") else ""
        for axis, is_angular in (("linear.x", False), ("angular.z", True)):
            signal = stream.signals.get(prefix + axis)
            if signal is not None and np.any(signal.values != 0.0):
                yield Command(topic, is_angular, stream.received, signal.values)


def speeds_of(stream: Stream, *, is_angular: bool) -> Signal | None:
    """Return the signal of a stream that tells the speed of a robot."""
    if not stream.type_name.endswith(("/Odometry", "/TwistWithCovarianceStamped")):
        return None
    return stream.signals.get("twist.twist.angular.z" if is_angular else "twist.twist.linear.x")


def changes_of(command: Command) -> tuple[Floats, Floats]:
    """Return the times at which a command changes, and the values from then on."""
    changed = np.flatnonzero(np.diff(command.values)) + 1
    kept = np.concatenate(([0], changed))
    return command.times[kept], command.values[kept]


def speed_at_commands(stream: Stream, context: Context) -> Iterator[Measure]:
    """Yield the steady speed at each commanded speed."""
    for command in commands_of(context.recording):
        signal = speeds_of(stream, is_angular=command.is_angular)
        if signal is None or len(signal.times) < 5:
            continue
        starts, levels = changes_of(command)
        ends = np.append(starts[1:], context.recording.duration)
        unit = "rad/s" if command.is_angular else "m/s"
        steady: dict[float, npt.NDArray[np.bool_]] = {}
        lengths: Counter[float] = Counter()
        for start, end, level in zip(starts.tolist(), ends.tolist(), levels.tolist(), strict=True):
            inside = (signal.times >= start + _SETTLING) & (signal.times < end)
            key = round(level, 3)
            if key and inside.any():
                lengths[key] += end - start - _SETTLING
                steady[key] = steady.get(key, np.zeros(len(signal.times), bool)) | inside
        for level, length in lengths.most_common(_MOST_LEVELS):
            if length >= _LEAST_STEADY:
                name = f"speed at {command.topic} {level:g} {unit}"
                yield Measure(name, unit, "mean", signal.values[steady[level]])


def delays(stream: Stream, context: Context) -> Iterator[Measure]:
    """Yield the delay from each change of a command to the reaction of the speed."""
    for command in commands_of(context.recording):
        signal = speeds_of(stream, is_angular=command.is_angular)
        if signal is None or len(signal.times) < 5:
            continue
        found = command_delays(command, signal, context.recording.duration)
        if len(found):
            axis = "angular" if command.is_angular else "linear"
            yield Measure(f"delay after {command.topic} {axis}", "s", "mean", found)


def command_delays(command: Command, signal: Signal, end: float) -> Floats:
    """Return the delay of the reaction to each change of a command [s].

    A delay is the shift of the command at which its correlation with the speed is largest, from the previous change to
    the next one.
    """
    starts, levels = changes_of(command)
    found: list[float] = []
    for k in range(len(starts)):
        before = float(levels[k - 1]) if k else 0.0
        at = float(starts[k])
        low = max(float(signal.times[0]), float(starts[k - 1]) if k else at - 1.0, at - 1.0)
        high = min(
            float(signal.times[-1]), float(starts[k + 1]) if k + 1 < len(starts) else end, at + 2.0 * _LONGEST_DELAY
        )
        if abs(float(levels[k]) - before) < _SMALLEST_CHANGE or high - at < 0.5 or at - low < 0.2:
            continue
        delay = _step_delay(signal, at, low, high)
        if delay is not None:
            found.append(delay)
    return np.array(found)


def _step_delay(signal: Signal, at: float, low: float, high: float) -> float | None:
    """Return the delay of a step in a signal: the shift of a step with the largest correlation."""
    grid = np.arange(low, high, _GRID)
    speed = np.interp(grid, signal.times, signal.values)
    speed = speed - speed.mean()
    power = float((speed**2).sum())
    if power <= 0.0:
        return None
    # sums of the signal after each possible step give the correlation with all steps at once
    after = np.cumsum(speed[::-1])[::-1]
    count = len(grid)
    left = np.arange(count, 0, -1)
    spread = np.sqrt(left * (count - left) / count)
    shifts = grid - at
    usable = (shifts >= 0.0) & (shifts <= _LONGEST_DELAY) & (spread > 0.0)
    if not usable.any():
        return None
    correlation = np.abs(after[usable]) / (spread[usable] * math.sqrt(power))
    best = int(np.argmax(correlation))
    return float(shifts[usable][best]) if correlation[best] >= _BEST_CORRELATION else None
