"""Transforms of frames as ROS's tf2 stores and finds them, with tf2's texts of errors.

`simkit.msgs.transform_tree` is simkit's own table for `sim.tf`. Programs need this one, because they depend on details
of tf2: what a lookup at an old time says, which parent counts after a frame has moved, and the sign of a quaternion.
Quaternions are (x, y, z, w), lengths are in metres, and times are in nanoseconds; the time 0 means the latest one.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from typing import Final

DEFAULT_CACHE_NS: Final = 10_000_000_000
"""Length of the history of a frame [ns]."""

Vector = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]
Sample = tuple[str, Vector, Quaternion]
"""Name of the parent, position and rotation in it."""

_MAX_DEPTH: Final = 1000
_NORM_TOLERANCE: Final = 10e-3
_NO_TIME: Final = 1 << 62
_IDENTITY: Final = ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))


class TransformException(Exception):
    """Error of a lookup of a transform."""

    __module__ = "tf2"


class ConnectivityException(TransformException):
    """The frames are in trees that are not connected."""

    __module__ = "tf2"


class LookupException(TransformException):
    """A frame is unknown."""

    __module__ = "tf2"


class ExtrapolationException(TransformException):
    """A transform is not known at the requested time."""

    __module__ = "tf2"


class InvalidArgumentException(TransformException):
    """The name of a frame is invalid."""

    __module__ = "tf2"


class TimeoutException(TransformException):
    """A transform did not arrive in time."""

    __module__ = "tf2"


class _Frame:
    """Transforms of one frame in its parent.

    Attributes:
        is_static: True if the only transform is valid at all times.
        stamps: times of the transforms [ns], in increasing order.
        samples: transforms at these times.
        authority: name of the sender of the newest transform.
    """

    __slots__ = ("authority", "is_static", "samples", "stamps")

    def __init__(self, is_static: bool) -> None:
        self.is_static = is_static
        self.stamps: list[int] = []
        self.samples: list[Sample] = []
        self.authority = "no recorded authority"

    @property
    def latest_ns(self) -> int:
        return 0 if self.is_static or not self.stamps else self.stamps[-1]

    @property
    def oldest_ns(self) -> int:
        return 0 if self.is_static or not self.stamps else self.stamps[0]

    def add(self, stamp: int, sample: Sample, cache_ns: int) -> bool:
        """Insert a transform; return False if it is older than the history."""
        stamps, samples = self.stamps, self.samples
        if self.is_static:
            stamps[:], samples[:] = [stamp], [sample]
            return True
        if stamps:
            oldest = stamps[-1] - cache_ns
            if stamps[0] < oldest:
                expired = bisect_right(stamps, oldest - 1)
                del stamps[:expired], samples[:expired]
            if stamp < oldest:
                return False
        at = bisect_right(stamps, stamp)
        before = at - 1
        while before >= 0 and stamps[before] == stamp:
            if samples[before] == sample:
                return True
            before -= 1
        stamps.insert(at, stamp)
        samples.insert(at, sample)
        return True

    def sample(self, stamp: int) -> Sample:
        """Return the transform at a time.

        Raises:
            ExtrapolationException: it is not known at this time.
        """
        stamps, samples = self.stamps, self.samples
        if self.is_static:
            return samples[0]
        if not stamps:
            raise ExtrapolationException
        latest = stamps[-1]
        if stamp in (0, latest):
            return samples[-1]
        if stamp == stamps[0]:
            return samples[0]
        if len(stamps) == 1:
            raise ExtrapolationException(
                f"Lookup would require extrapolation at time {_seconds(stamp)}, "
                f"but only time {_seconds(latest)} is in the buffer"
            )
        if stamp > latest:
            raise ExtrapolationException(
                f"Lookup would require extrapolation into the future.  Requested time {_seconds(stamp)} "
                f"but the latest data is at time {_seconds(latest)}"
            )
        if stamp < stamps[0]:
            raise ExtrapolationException(
                f"Lookup would require extrapolation into the past.  Requested time {_seconds(stamp)} "
                f"but the earliest data is at time {_seconds(stamps[0])}"
            )
        at = bisect_right(stamps, stamp) - 1
        before, after = samples[at], samples[at + 1]
        if before[0] != after[0] or stamps[at] == stamp:  # a frame never moves between two parents
            return before
        ratio = (stamp - stamps[at]) / (stamps[at + 1] - stamps[at])
        (x, y, z), (to_x, to_y, to_z), rest = before[1], after[1], 1.0 - ratio
        position = rest * x + ratio * to_x, rest * y + ratio * to_y, rest * z + ratio * to_z
        return before[0], position, slerp(before[2], after[2], ratio)


class FrameBuffer:
    """Transforms of all frames over the last seconds.

    Args:
        cache_ns: length of the history of each frame [ns].
    """

    def __init__(self, cache_ns: int = DEFAULT_CACHE_NS) -> None:
        self.cache_ns = cache_ns
        self._frames: dict[str, _Frame] = {}
        self._names: dict[str, None] = {}  # of all frames, also of roots, in the order of their arrival

    # ------------------------------------------------------------------ transforms

    def add(
        self,
        parent: str,
        child: str,
        stamp: int,
        position: Vector,
        rotation: Quaternion,
        *,
        is_static: bool = False,
        authority: str = "default_authority",
    ) -> str:
        """Store the pose of the frame `child` in the frame `parent`.

        Args:
            parent: frame in which the pose is given.
            child: frame with this pose.
            stamp: time [ns].
            position: position [m].
            rotation: unit quaternion (x, y, z, w).
            is_static: True if the pose is valid at all times.
            authority: name of the sender.

        Returns:
            Text of tf2 that says why the transform is ignored; empty if it is stored.
        """
        child, parent = child.removeprefix("/"), parent.removeprefix("/")
        x, y, z, w = rotation
        is_unit = abs(x * x + y * y + z * z + w * w - 1.0) < _NORM_TOLERANCE
        if (
            child == parent
            or not child
            or not parent
            or not is_unit
            or math.isnan(position[0] + position[1] + position[2])
        ):
            return _problem(parent, child, position, rotation, authority)
        frame = self._frames.get(child)
        if frame is None or frame.is_static is not is_static:
            frame = self._frames[child] = _Frame(is_static)
            self._names[child] = None
        self._names[parent] = None
        if not frame.add(stamp, (parent, position, rotation), self.cache_ns):
            return (
                f"TF_OLD_DATA ignoring data from the past for frame {child} at time {_seconds(stamp)} according to "
                f"authority {authority}\nPossible reasons are listed at http://wiki.ros.org/tf/Errors%20explained"
            )
        frame.authority = authority
        return ""

    def clear(self) -> None:
        """Forget all transforms that are not valid at all times."""
        for frame in self._frames.values():
            if not frame.is_static:
                frame.stamps.clear()
                frame.samples.clear()

    # ------------------------------------------------------------------ lookups

    def lookup(self, target: str, source: str, stamp: int) -> tuple[Vector, Quaternion, int]:
        """Return position and rotation of the frame `source` in the frame `target`, and their time [ns].

        Args:
            target: frame in which the pose is given.
            source: frame whose pose is returned.
            stamp: time [ns]; 0 for the latest time at which all transforms between the frames are known.

        Raises:
            InvalidArgumentException: a name is empty or begins with a slash.
            LookupException: a frame is unknown.
            ConnectivityException: the frames are not connected.
            ExtrapolationException: a transform is not known at this time.
        """
        if target == source:
            frame = self._frames.get(target)
            return *_IDENTITY, frame.latest_ns if frame is not None and stamp == 0 else stamp
        self._check_name(target, "target_frame")
        self._check_name(source, "source_frame")
        to_source, to_target, stamp = self._walk(target, source, stamp)
        position, rotation = _chain(to_source)
        if to_target:
            base, turn = _chain(to_target)
            inverse = _inverse(turn)
            x, y, z = position
            position = rotate(inverse, (x - base[0], y - base[1], z - base[2]))
            rotation = multiply(inverse, rotation)
        return position, _with_sign(rotation), stamp

    def lookup_full(
        self, target: str, target_stamp: int, source: str, source_stamp: int, fixed: str
    ) -> tuple[Vector, Quaternion, int]:
        """Return the pose of `source` at one time in `target` at another; `fixed` does not move between them."""
        for name, argument in ((target, "target_frame"), (source, "source_frame"), (fixed, "fixed_frame")):
            self._check_name(name, argument)
        position, rotation, _ = self.lookup(fixed, source, source_stamp)
        base, turn, stamp = self.lookup(target, fixed, target_stamp)
        x, y, z = rotate(turn, position)
        return (x + base[0], y + base[1], z + base[2]), _with_sign(multiply(turn, rotation)), stamp

    def problem(self, target: str, source: str, stamp: int) -> str:
        """Return tf2's text that says why a lookup would fail; empty if it would succeed."""
        if target == source:
            return ""
        for name, which in ((target, "target_frame"), (source, "source_frame")):
            text = self._name_problem(name, which)
            if text:
                return text
        return self._walk_problem(target, source, stamp)

    def problem_full(self, target: str, target_stamp: int, source: str, source_stamp: int, fixed: str) -> str:
        """Return tf2's text that says why a lookup with a fixed frame would fail; empty if it would succeed."""
        for name, which in ((target, "target_frame"), (source, "source_frame"), (fixed, "fixed_frame")):
            text = self._name_problem(name, which)
            if text:
                return text
        return self._walk_problem(target, fixed, target_stamp) or self._walk_problem(fixed, source, source_stamp)

    def latest_common_time(self, target: str, source: str) -> int:
        """Return the latest time [ns] at which all transforms between two frames are known; 0 for all times.

        Raises:
            TransformException: as `lookup`.
        """
        self._check_name(target, "", "get_latest_common_time")
        self._check_name(source, "", "get_latest_common_time")
        return self._latest_common_time(target, source)

    def chain(self, target: str, target_stamp: int, source: str, source_stamp: int, fixed: str) -> list[str]:
        """Return the frames on the way from `source` over `fixed` to `target`."""
        names = self._way(fixed, source, source_stamp)
        rest = self._way(target, fixed, target_stamp)
        return [*names, *rest[1:]]

    # ------------------------------------------------------------------ frames

    def names(self) -> list[str]:
        """Return the names of all frames, in the order of their arrival."""
        return list(self._names)

    def has_frame(self, name: str) -> bool:
        """Check whether a frame is known."""
        return name in self._names

    def parent(self, name: str, stamp: int) -> str | None:
        """Return the parent of a frame at a time [ns]; None if it is not known."""
        frame = self._frames.get(name)
        try:
            return None if frame is None else frame.sample(stamp)[0]
        except ExtrapolationException:
            return None

    def as_text(self) -> str:
        """Return a sentence for each frame with its parent."""
        frames = ((name, self._frames[name]) for name in self._names if name in self._frames)
        parents = ((name, frame.samples[-1][0] if frame.samples else "NO_PARENT") for name, frame in frames)
        return "".join(f"Frame {name} exists with parent {parent}.\n" for name, parent in parents)

    def as_yaml(self) -> str:
        """Return a YAML document with parent, sender, rate and times of each frame."""
        if not self._names:
            return "[]"
        lines = []
        for name in self._names:
            frame = self._frames.get(name)
            if frame is None or not frame.samples:
                continue
            length = frame.latest_ns - frame.oldest_ns
            rate = len(frame.samples) * 1e9 / max(length, 100_000)
            lines += [
                f"{name}: ",
                f"  parent: '{frame.samples[-1][0]}'",
                f"  broadcaster: '{frame.authority}'",
                f"  rate: {rate:.3f}",
                f"  most_recent_transform: {_seconds(frame.latest_ns)}",
                f"  oldest_transform: {_seconds(frame.oldest_ns)}",
                f"  buffer_length: {length / 1e9:.3f}",
            ]
        return "".join(f"{line}\n" for line in lines)

    # ------------------------------------------------------------------ ways between frames

    def _walk(self, target: str, source: str, stamp: int) -> tuple[list[Sample], list[Sample], int]:
        """Return the transforms from `source` and from `target` up to a common frame, and their time.

        This is tf2's `walkToTopParent`: only the way down to the target may fail because of its time. A time that the
        way up from the source does not have counts only if the ways do not meet.
        """
        if stamp == 0:
            stamp = self._latest_common_time(target, source)
        frames, up, problem = self._frames, [], None
        name, passed = source, {source}
        while name != target and (frame := frames.get(name)) is not None:
            try:
                sample = frame.sample(stamp)
            except ExtrapolationException as error:
                problem = error
                break
            up.append(sample)
            name = sample[0]
            if len(up) > _MAX_DEPTH:
                raise LookupException(self._loop_text())
            passed.add(name)
        if name == target:
            return up, [], stamp
        name, down = target, []
        while name not in passed and (frame := frames.get(name)) is not None:
            try:
                sample = frame.sample(stamp)
            except ExtrapolationException as error:
                raise ExtrapolationException(f"{error}{_between(source, target)}") from None
            down.append(sample)
            name = sample[0]
            if len(down) > _MAX_DEPTH:
                raise LookupException(self._loop_text())
        if name not in passed:
            if problem is not None:
                raise ExtrapolationException(f"{problem}{_between(source, target)}")
            raise ConnectivityException(_connectivity_text(source, target))
        return up[: self._steps_to(name, source, up)], down, stamp

    @staticmethod
    def _steps_to(name: str, source: str, up: list[Sample]) -> int:
        """Return the number of transforms from `source` to one of its ancestors."""
        if name == source:
            return 0
        return next(number for number, sample in enumerate(up, 1) if sample[0] == name)

    def _walk_problem(self, target: str, source: str, stamp: int) -> str:
        if target != source:
            try:
                self._walk(target, source, stamp)
            except TransformException as error:
                return str(error) or "Lookup would require extrapolation: there is no transform in the buffer"
        return ""

    def _latest_common_time(self, target: str, source: str) -> int:
        if target == source:
            frame = self._frames.get(source)
            return 0 if frame is None else frame.latest_ns
        common, times = _NO_TIME, {source: _NO_TIME}  # name of each ancestor of the source -> latest time up to it
        name = source
        while (frame := self._frames.get(name)) is not None and frame.samples:
            common = min(common, frame.latest_ns or _NO_TIME)
            name = frame.samples[-1][0]
            if name in times:
                raise LookupException(self._loop_text())
            times[name] = common
            if name == target:
                return 0 if common == _NO_TIME else common
        common, name, passed = _NO_TIME, target, {target}
        while name not in times:
            frame = self._frames.get(name)
            if frame is None or not frame.samples:
                raise ConnectivityException(_connectivity_text(source, target))
            common = min(common, frame.latest_ns or _NO_TIME)
            name = frame.samples[-1][0]
            if name in passed:
                raise LookupException(self._loop_text())
            passed.add(name)
        common = min(common, times[name])
        return 0 if common == _NO_TIME else common

    def _way(self, target: str, source: str, stamp: int) -> list[str]:
        """Return the names of the frames from `source` to `target`."""
        if target == source:
            return [source]
        up, down, _ = self._walk(target, source, stamp)
        first = [source, *(sample[0] for sample in up)]
        second = [target, *(sample[0] for sample in down)]
        return [*first, *reversed(second[:-1])] if down else first

    def _check_name(self, name: str, argument: str, function: str = "lookupTransform") -> None:
        place = f"{function} argument {argument}" if argument else function
        if not name or name[0] == "/":
            reason = "cannot start with a '/'" if name else "cannot be empty"
            raise InvalidArgumentException(f'Invalid argument "{name}" passed to {place} - in tf2 frame_ids {reason}')
        if name not in self._names:
            raise LookupException(f'"{name}" passed to {place} does not exist. ')

    def _name_problem(self, name: str, argument: str) -> str:
        if not name or name[0] == "/":
            reason = f"in tf2 frame_ids {'cannot start with a ' + repr('/') if name else 'cannot be empty'}"
        elif name not in self._names:
            reason = "frame does not exist"
        else:
            return ""
        return f'Invalid frame ID "{name}" passed to canTransform argument {argument} - {reason}'

    def _loop_text(self) -> str:
        return f"The tf tree is invalid because it contains a loop.\n{self.as_text()}\n"


def _problem(parent: str, child: str, position: Vector, rotation: Quaternion, authority: str) -> str:
    """Return tf2's text for a transform that is not valid."""
    if child == parent:
        return (
            f'TF_SELF_TRANSFORM: Ignoring transform from authority "{authority}" with frame_id and  child_frame_id '
            f'"{child}" because they are the same'
        )
    if not child:
        return f'TF_NO_CHILD_FRAME_ID: Ignoring transform from authority "{authority}" because child_frame_id not set '
    if not parent:
        return (
            f'TF_NO_FRAME_ID: Ignoring transform with child_frame_id "{child}"  from authority "{authority}" '
            "because frame_id not set"
        )
    first, second = (" ".join(f"{number:f}" for number in numbers) for numbers in (position, rotation))
    if any(map(math.isnan, (*position, *rotation))):
        return (
            f'TF_NAN_INPUT: Ignoring transform for child_frame_id "{child}" from authority "{authority}" because of a '
            f"nan value in the transform ({first}) ({second})"
        )
    return (
        f'TF_DENORMALIZED_QUATERNION: Ignoring transform for child_frame_id "{child}" from authority "{authority}" '
        f"because of an invalid quaternion in the transform ({second})"
    )


def _between(source: str, target: str) -> str:
    return f", when looking up transform from frame [{source}] to frame [{target}]"


def _connectivity_text(source: str, target: str) -> str:
    return (
        f"Could not find a connection between '{target}' and '{source}' because they are not part of the same tree."
        "Tf has two or more unconnected trees."
    )


def _seconds(stamp: int) -> str:
    """Return a time [ns] as tf2 shows it."""
    return f"{stamp // 1_000_000_000 + 1e-9 * (stamp % 1_000_000_000):.6f}"


# ---------------------------------------------------------------------- quaternions (x, y, z, w)


def multiply(a: Quaternion, b: Quaternion) -> Quaternion:
    """Return the Hamilton product of two quaternions."""
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by + ay * bw + az * bx - ax * bz,
        aw * bz + az * bw + ax * by - ay * bx,
        aw * bw - ax * bx - ay * by - az * bz,
    )


def rotate(rotation: Quaternion, vector: Vector) -> Vector:
    """Rotate a vector by a unit quaternion."""
    x, y, z, w = rotation
    vx, vy, vz = vector
    tx, ty, tz = 2 * (y * vz - z * vy), 2 * (z * vx - x * vz), 2 * (x * vy - y * vx)
    return vx + w * tx + y * tz - z * ty, vy + w * ty + z * tx - x * tz, vz + w * tz + x * ty - y * tx


def slerp(first: Quaternion, second: Quaternion, ratio: float) -> Quaternion:
    """Return the rotation between two others, along the shortest arc."""
    (ax, ay, az, aw), (bx, by, bz, bw) = first, second
    cosine = ax * bx + ay * by + az * bz + aw * bw
    norms = math.sqrt((ax * ax + ay * ay + az * az + aw * aw) * (bx * bx + by * by + bz * bz + bw * bw))
    angle = math.acos(min(1.0, abs(cosine) / norms))
    if angle == 0.0:
        return first
    scale = 1.0 / math.sin(angle)
    rest, part = math.sin((1.0 - ratio) * angle) * scale, math.sin(ratio * angle) * scale
    if cosine < 0:  # q and -q are the same rotation
        part = -part
    return rest * ax + part * bx, rest * ay + part * by, rest * az + part * bz, rest * aw + part * bw


def _inverse(rotation: Quaternion) -> Quaternion:
    return -rotation[0], -rotation[1], -rotation[2], rotation[3]


def _chain(samples: list[Sample]) -> tuple[Vector, Quaternion]:
    """Return the pose of the first frame in the parent of the last one."""
    if not samples:
        return _IDENTITY
    _, position, rotation = samples[0]
    for _, base, turn in samples[1:]:
        x, y, z = rotate(turn, position)
        position = x + base[0], y + base[1], z + base[2]
        rotation = multiply(turn, rotation)
    return position, rotation


def _with_sign(rotation: Quaternion) -> Quaternion:
    """Return the unit quaternion with the sign that tf2 gives it.

    tf2 returns a rotation by way of a matrix: w is positive if the trace of the matrix is positive; otherwise the
    largest of x, y and z is.
    """
    x, y, z, w = rotation
    norm = math.sqrt(x * x + y * y + z * z + w * w)
    if 4 * w * w > norm * norm:
        leader = w
    else:
        leader = max((x, y, z), key=abs)
    scale = math.copysign(norm, leader)
    return x / scale, y / scale, z / scale, w / scale
