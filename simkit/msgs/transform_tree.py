"""Transforms of `/tf` and `/tf_static` over the last seconds, and the pose of one frame in another, as in ROS's tf2."""

from __future__ import annotations

import math
from bisect import bisect_left, bisect_right
from collections.abc import Collection, Iterator
from typing import Final, NamedTuple

from simkit.argument_checks import check_text, checked_number, wrong_type
from simkit.diagnostics import did_you_mean
from simkit.errors import TransformError
from simkit.float_sum import float_sum
from simkit.msgs.message_types import FieldValue, Message
from simkit.number_text import counted
from simkit.pose import Pose

UNKNOWN_FRAME: Final = "SK-TF-001"
NOT_CONNECTED: Final = "SK-TF-002"
OUTSIDE_HISTORY: Final = "SK-TF-003"
DEFAULT_LENGTH: Final = 10.0
"""Length of the history [s], as in tf2."""
_NS: Final = 1_000_000_000
_MOST_SHOWN = 10  # frames in a message

_Sample = tuple[str, float, float, float, float, float, float, float]  # parent, x, y, z, qw, qx, qy, qz
TreeState = tuple[tuple[str, bool, tuple[int, ...], tuple[_Sample, ...]], ...]
"""Copy of a tree: name, static or not, times and transforms of each frame."""


class _Frame:
    """Transforms of one frame in its parent.

    Attributes:
        is_static: True if the newest transform is valid at all times.
        stamps: times of the transforms [ns], in increasing order.
        samples: parent, position and rotation at these times.
    """

    __slots__ = ("is_static", "samples", "stamps")

    def __init__(self, is_static: bool = False) -> None:
        self.is_static = is_static
        self.stamps: list[int] = []
        self.samples: list[_Sample] = []

    def add(self, stamp: int, sample: _Sample, length_ns: int) -> None:
        """Insert a transform, and drop those that are older than the history."""
        stamps, samples = self.stamps, self.samples
        if not stamps or stamp > stamps[-1]:
            stamps.append(stamp)
            samples.append(sample)
        elif stamp >= stamps[-1] - length_ns:
            at = bisect_left(stamps, stamp)
            if stamps[at] == stamp:
                samples[at] = sample
            else:
                stamps.insert(at, stamp)
                samples.insert(at, sample)
        expired = bisect_left(stamps, stamps[-1] - length_ns)
        del stamps[:expired], samples[:expired]

    def covers(self, stamp: int) -> bool:
        """Check whether the transform is known at a time, without extrapolation."""
        return self.is_static or self.stamps[0] <= stamp <= self.stamps[-1]

    def parent(self, stamp: int | None) -> str:
        """Return the parent at a time; the nearest known one outside the history; None for the newest."""
        if stamp is None or self.is_static:
            return self.samples[-1][0]
        return self.samples[max(0, bisect_right(self.stamps, stamp) - 1)][0]

    def pose(self, stamp: int) -> Pose:
        """Return the pose in the parent; outside the history, the nearest one.

        Positions are interpolated linearly, rotations along the shortest arc.
        """
        if self.is_static or stamp >= self.stamps[-1]:
            return _pose_of(self.samples[-1])
        if stamp <= self.stamps[0]:
            return _pose_of(self.samples[0])
        at = bisect_right(self.stamps, stamp) - 1
        before = self.samples[at]
        if self.stamps[at] == stamp or self.samples[at + 1][0] != before[0]:  # a frame never moves between parents
            return _pose_of(before)
        part = (stamp - self.stamps[at]) / (self.stamps[at + 1] - self.stamps[at])
        return _interpolated(before, self.samples[at + 1], part)


def _pose_of(sample: _Sample) -> Pose:
    return Pose(sample[1:4], sample[4:])


def _interpolated(before: _Sample, after: _Sample, part: float) -> Pose:
    first, second = before[4:], after[4:]
    norms = math.hypot(*first) * math.hypot(*second)
    cosine = float_sum(a * b for a, b in zip(first, second, strict=True)) / norms
    sign = -1.0 if cosine < 0 else 1.0  # q and -q are the same rotation
    angle = math.acos(min(1.0, abs(cosine)))
    if angle < 1e-9:
        weights = 1.0 - part, sign * part
    else:
        weights = math.sin((1.0 - part) * angle) / math.sin(angle), sign * math.sin(part * angle) / math.sin(angle)
    position = [a + (b - a) * part for a, b in zip(before[1:4], after[1:4], strict=True)]
    unit = math.hypot(*first), math.hypot(*second)
    rotation = [weights[0] * a / unit[0] + weights[1] * b / unit[1] for a, b in zip(first, second, strict=True)]
    return Pose(position, rotation)


class _Step(NamedTuple):
    """Frame on the way to the root, and its transforms."""

    name: str
    frame: _Frame


class TransformTree:
    """Transforms of all frames.

    Attributes:
        since_ns: time from which on transforms are received [ns]; None if it is not known.
        ignored: number of transforms that are not valid: with NaN, without names, or of a frame in itself.
    """

    def __init__(self, length: float = DEFAULT_LENGTH) -> None:
        self.length = length
        self.since_ns: int | None = None
        self.ignored = 0
        self._frames: dict[str, _Frame] = {}
        self._received_ns: dict[str, int] = {}
        self._found: dict[tuple[str, str], tuple[Pose, int]] = {}  # results of `latest` until the next change

    @property
    def length(self) -> float:
        """Length of the history of each frame [s]; settable."""
        return self._length_ns / _NS

    @length.setter
    def length(self, seconds: float) -> None:
        self._length_ns = round(checked_number(seconds, "the length of the history", 0.0, unit="s") * _NS)

    def take(self, message: Message, *, is_static: bool) -> None:
        """Store the transforms of a `tf2_msgs/msg/TFMessage`; others are ignored, because any process may send them."""
        self._found.clear()
        for stamped in getattr(message, "transforms", ()):
            position, rotation, stamp = stamped.transform.translation, stamped.transform.rotation, stamped.header.stamp
            child, parent = stamped.child_frame_id.lstrip("/"), stamped.header.frame_id.lstrip("/")
            numbers = position.x, position.y, position.z, rotation.w, rotation.x, rotation.y, rotation.z
            norm = math.hypot(*numbers[3:])
            is_finite = math.isfinite(float_sum(numbers[:3]))
            if not (child and parent and child != parent and 1e-6 < norm < 1e6 and is_finite):
                self.ignored += 1
                continue
            frame = self._frames.get(child)
            if frame is None or frame.is_static is not is_static:
                frame = self._frames[child] = _Frame(is_static)
            if is_static:
                frame.stamps, frame.samples = [0], [(parent, *numbers)]
            else:
                frame.add(stamp.sec * _NS + stamp.nanosec, (parent, *numbers), self._length_ns)

    def advance(self, topic: str, now_ns: int) -> None:
        """Forget the transforms of a future that a reset or a restore has undone, as tf2 does.

        Args:
            topic: topic of the next transforms.
            now_ns: simulated time of their publication [ns].
        """
        if now_ns < self._received_ns.get(topic, now_ns):
            self._frames = {name: frame for name, frame in self._frames.items() if frame.is_static}
            self._found.clear()
            self.since_ns = now_ns
        self._received_ns[topic] = now_ns

    def is_static(self, name: str) -> bool:
        """Check whether the transform of a frame is valid at all times."""
        return name in self._frames and self._frames[name].is_static

    def newest(self, name: str) -> int:
        """Return the time of the newest transform of a frame [ns]; 0 if it is valid at all times."""
        return self._frames[name].stamps[-1]

    def frames(self) -> dict[str, str]:
        """Return the parent of each frame, sorted by name; an empty text for a root."""
        parents = {name: frame.parent(None) for name, frame in self._frames.items()}
        return dict(sorted((dict.fromkeys(parents.values(), "") | parents).items()))

    def lookup(self, target: str, source: str, time: FieldValue = None) -> Pose:
        """Return the pose of the frame `source` in the frame `target`.

        Args:
            target: frame in which the pose is given.
            source: frame whose pose is returned.
            time: simulated time [s], or the stamp of a message; None for the latest time at which all transforms
                between the frames are known. With None, a transform that is first known later has its first pose.

        Raises:
            TransformError: SK-TF-001 a frame is unknown; SK-TF-002 the frames are not connected; SK-TF-003 a transform
                between them is not known at that time.
        """
        stamp = _nanoseconds(time)
        if stamp is None:
            return self.latest(target, source)[0]
        up, down = self._path(*self._known_names(target, source), stamp)
        for step in (*up, *down):
            if not step.frame.covers(stamp):
                raise self._outside(step, stamp)
        return self._chain(up, stamp).inverse() @ self._chain(down, stamp)

    def latest(self, target: str, source: str) -> tuple[Pose, int]:
        """Return the pose at the latest time at which all transforms are known, and this time [ns]; see `lookup`."""
        names = self._checked_names(target, source)
        found = self._found.get(names)
        if found is None:
            self._check_known(names)
            found = self._found[names] = self._latest(*names)
        return found

    def _latest(self, target: str, source: str) -> tuple[Pose, int]:
        up, down = self._path(target, source, None)
        stamp = min((step.frame.stamps[-1] for step in (*up, *down) if not step.frame.is_static), default=0)
        up, down = self._path(target, source, stamp)
        return self._chain(up, stamp).inverse() @ self._chain(down, stamp), stamp

    def _chain(self, steps: list[_Step], stamp: int) -> Pose:
        """Return the pose of the first frame in the parent of the last frame."""
        pose = Pose()
        for step in steps:
            pose = step.frame.pose(stamp) @ pose
        return pose

    def _path(self, target: str, source: str, stamp: int | None) -> tuple[list[_Step], list[_Step]]:
        """Return the steps from `target` and from `source` to their first common ancestor."""
        up, down = list(self._ancestors(target, stamp)), list(self._ancestors(source, stamp))
        names = [step.name for step in down] + [self._end(source, down, stamp)]
        for count, name in enumerate([step.name for step in up] + [self._end(target, up, stamp)]):
            if name in names:
                return up[:count], down[: names.index(name)]
        ways = " and ".join(
            " → ".join([*(f"{step.name!r}" for step in steps), f"{self._end(name, steps, stamp)!r}"])
            + (" has no parent" if not steps else " ends there")
            for name, steps in ((source, down), (target, up))
        )
        when = "" if stamp is None else f" at t={stamp / _NS:g} s"
        missing = f"no transform connects {self._end(source, down, stamp)!r} with {self._end(target, up, stamp)!r}"
        raise TransformError(
            NOT_CONNECTED, f"the frames {source!r} and {target!r} are not connected{when}: {ways}; {missing}"
        )

    def _end(self, name: str, steps: list[_Step], stamp: int | None) -> str:
        return steps[-1].frame.parent(stamp) if steps else name

    def _ancestors(self, name: str, stamp: int | None) -> Iterator[_Step]:
        """Yield a frame and its ancestors, except the root.

        Raises:
            TransformError: the frames form a circle.
        """
        seen: list[str] = []
        while name in self._frames:
            if name in seen:
                circle = " → ".join(repr(n) for n in (*seen[seen.index(name) :], name))
                raise TransformError(NOT_CONNECTED, f"the frames form a circle: {circle}")
            seen.append(name)
            yield _Step(name, self._frames[name])
            name = self._frames[name].parent(stamp)

    def _known_names(self, target: str, source: str) -> tuple[str, str]:
        """Return the names of two frames without leading slashes; raise TransformError for an unknown frame."""
        names = self._checked_names(target, source)
        self._check_known(names)
        return names

    def _checked_names(self, target: str, source: str) -> tuple[str, str]:
        for frame, name in ((target, "the target frame"), (source, "the source frame")):
            check_text(frame, name)
        return target.lstrip("/"), source.lstrip("/")

    def _check_known(self, names: Collection[str]) -> None:
        known: Collection[str] = self._frames.keys() | {frame.parent(None) for frame in self._frames.values()}
        missing = list(dict.fromkeys(name for name in names if name not in known))
        if not missing:
            return
        known = sorted(known)
        hints = []
        for name in missing:
            near = did_you_mean(name, known)
            hints.append(f"{name!r}" + (f" ({near})" if near else ""))
        shown = ", ".join(known[:_MOST_SHOWN]) + (" …" if len(known) > _MOST_SHOWN else "")
        rest = f"the known frames are {shown}" if known else "no frame is known yet"
        since = "" if self.since_ns is None else f"; transforms are received since t={self.since_ns / _NS:g} s"
        what = "frame" if len(missing) == 1 else "frames"
        text = f"unknown {what} {' and '.join(hints)}; {rest}{since}"
        raise TransformError(UNKNOWN_FRAME, text)

    def _outside(self, step: _Step, stamp: int) -> TransformError:
        first, last = step.frame.stamps[0], step.frame.stamps[-1]
        where = f"{step.frame.parent(stamp)!r} → {step.name!r}"
        known = f"from t={first / _NS:.9g} s to t={last / _NS:.9g} s" if first < last else f"at t={first / _NS:.9g} s"
        text = f"the transform {where} is known {known}, not at t={stamp / _NS:.9g} s"
        if stamp > last:
            hint = "use time=None for the latest transform, or run the simulation further"
        elif self.since_ns is not None and self.since_ns > stamp:
            hint = f"transforms are received since t={self.since_ns / _NS:.9g} s; use `tf` before the time of interest"
        else:
            hint = f"the history has {self.length:g} s; set `tf.length` to a longer one"
        return TransformError(OUTSIDE_HISTORY, text, help=hint)

    # ------------------------------------------------------------------ state

    def copied(self) -> TreeState:
        """Return a copy of all transforms."""
        return tuple((n, f.is_static, tuple(f.stamps), tuple(f.samples)) for n, f in self._frames.items())

    def replace(self, state: TreeState) -> None:
        """Replace all transforms."""
        self._frames.clear()
        self._found.clear()
        for name, is_static, stamps, samples in state:
            frame = self._frames[name] = _Frame(is_static)
            frame.stamps, frame.samples = list(stamps), list(samples)

    def __repr__(self) -> str:
        return f"<{type(self).__name__} of {counted(len(self.frames()), 'frame')}>"


def _nanoseconds(time: FieldValue) -> int | None:
    """Return a time in seconds, or a stamp of a message, in nanoseconds."""
    if time is None:
        return None
    if hasattr(time, "nanosec"):
        return int(time.sec) * _NS + int(time.nanosec)
    if isinstance(time, bool) or hasattr(time, "__msgtype__"):
        raise wrong_type("the time", "seconds, a stamp of a message, or None", time)
    return round(checked_number(time, "the time", unit="s") * _NS)
