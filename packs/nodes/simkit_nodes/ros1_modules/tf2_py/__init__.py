"""Transforms of frames without a node, as the ROS 1 package `tf2_py`."""

from __future__ import annotations

from typing import Any

from simkit_nodes.frame_buffer import (
    DEFAULT_CACHE_NS,
    ConnectivityException,
    ExtrapolationException,
    FrameBuffer,
    InvalidArgumentException,
    LookupException,
    Quaternion,
    TimeoutException,
    TransformException,
    Vector,
)
from simkit_nodes.interfaces import ROS1, ProgramMessage
from simkit_nodes.ros1_modules.rospy.rostime import Time

__all__ = [
    "BufferCore",
    "ConnectivityException",
    "ExtrapolationException",
    "InvalidArgumentException",
    "LookupException",
    "TimeoutException",
    "TransformException",
]


class BufferCore:
    """Transforms of all frames over the last seconds.

    Args:
        cache_time: length of the history (`rospy.Duration`); 10 s by default.
    """

    def __init__(self, cache_time: Any = None) -> None:
        self._frames = FrameBuffer(DEFAULT_CACHE_NS if cache_time is None else cache_time.to_nsec())

    def set_transform(self, transform: ProgramMessage, authority: str = "default_authority") -> None:
        """Store a `geometry_msgs.msg.TransformStamped`."""
        self._add(transform, authority, is_static=False)

    def set_transform_static(self, transform: ProgramMessage, authority: str = "default_authority") -> None:
        """Store a `geometry_msgs.msg.TransformStamped` that is valid at all times."""
        self._add(transform, authority, is_static=True)

    def _add(self, transform: ProgramMessage, authority: str, *, is_static: bool) -> None:
        header, base, turn = transform.header, transform.transform.translation, transform.transform.rotation
        position = float(base.x), float(base.y), float(base.z)
        rotation = float(turn.x), float(turn.y), float(turn.z), float(turn.w)
        stamp, child = header.stamp.to_nsec(), transform.child_frame_id
        self._frames.add(header.frame_id, child, stamp, position, rotation, is_static=is_static, authority=authority)

    def clear(self) -> None:
        """Forget all transforms that are not valid at all times."""
        self._frames.clear()

    # ------------------------------------------------------------------ lookups

    def lookup_transform_core(self, target_frame: str, source_frame: str, time: Any) -> Any:
        """Return the pose of a frame in another one as a `geometry_msgs.msg.TransformStamped`.

        Args:
            target_frame: frame in which the pose is given.
            source_frame: frame whose pose is returned.
            time: `rospy.Time`; 0 for the latest time.

        Raises:
            TransformException: the pose is not known.
        """
        pose = self._frames.lookup(target_frame, source_frame, time.to_nsec())
        return _transform(target_frame, source_frame, *pose)

    def lookup_transform_full_core(
        self, target_frame: str, target_time: Any, source_frame: str, source_time: Any, fixed_frame: str
    ) -> Any:
        """Return the pose of a frame at one time in another frame at another time; see `lookup_transform_core`."""
        times = target_time.to_nsec(), source_time.to_nsec()
        pose = self._frames.lookup_full(target_frame, times[0], source_frame, times[1], fixed_frame)
        return _transform(target_frame, source_frame, *pose)

    def can_transform_core(self, target_frame: str, source_frame: str, time: Any) -> tuple[bool, str]:
        """Return whether a transform is known, and the reason why not."""
        problem = self._frames.problem(target_frame, source_frame, time.to_nsec())
        return not problem, problem

    def can_transform_full_core(
        self, target_frame: str, target_time: Any, source_frame: str, source_time: Any, fixed_frame: str
    ) -> tuple[bool, str]:
        """Return whether a transform between two times is known, and the reason why not."""
        times = target_time.to_nsec(), source_time.to_nsec()
        problem = self._frames.problem_full(target_frame, times[0], source_frame, times[1], fixed_frame)
        return not problem, problem

    def get_latest_common_time(self, source_frame: str, dest_frame: str) -> Any:
        """Return the latest time at which the pose of a frame in another one is known."""
        return Time(0, self._frames.latest_common_time(dest_frame, source_frame))

    # ------------------------------------------------------------------ frames

    def all_frames_as_yaml(self) -> str:
        """Return a YAML document with parent, sender, rate and times of each frame."""
        return self._frames.as_yaml()

    def all_frames_as_string(self) -> str:
        """Return a sentence for each frame with its parent."""
        return self._frames.as_text()

    def _chain(
        self, target_frame: str, target_time: Any, source_frame: str, source_time: Any, fixed_frame: str
    ) -> list[str]:
        """Return the frames between two frames."""
        times = target_time.to_nsec(), source_time.to_nsec()
        return self._frames.chain(target_frame, times[0], source_frame, times[1], fixed_frame)


def _transform(target: str, source: str, position: Vector, rotation: Quaternion, stamp: int) -> Any:
    message: ProgramMessage = ROS1.message_class("geometry_msgs/msg/TransformStamped")()
    message.header.frame_id, message.child_frame_id = target, source
    message.header.stamp.set(*divmod(stamp, 1_000_000_000))
    base, turn = message.transform.translation, message.transform.rotation
    base.x, base.y, base.z = position
    turn.x, turn.y, turn.z, turn.w = rotation
    return message
