"""Table of transforms, as the ROS 2 package `tf2_py`."""

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
from simkit_nodes.interfaces import ROS2, ProgramMessage
from simkit_nodes.ros_modules.rclpy.logging import get_logger
from simkit_nodes.ros_modules.rclpy.time import Time

__all__ = [
    "BufferCore",
    "ConnectivityException",
    "ExtrapolationException",
    "InvalidArgumentException",
    "LookupException",
    "TimeoutException",
    "TransformException",
]

_Stamped = ROS2.message_class("geometry_msgs/msg/TransformStamped")


class BufferCore:
    """Transforms of all frames over the last seconds.

    Args:
        cache_time: length of the history (`rclpy.duration.Duration`); 10 s by default.
    """

    def __init__(self, cache_time: Any = None) -> None:
        self._frame_buffer = FrameBuffer(
            DEFAULT_CACHE_NS if cache_time is None else _nanoseconds(cache_time, "duration")
        )

    # ------------------------------------------------------------------ transforms

    def set_transform(self, transform: ProgramMessage, authority: str) -> None:
        """Store a `geometry_msgs.msg.TransformStamped`; invalid ones are logged."""
        self._set(transform, authority, is_static=False)

    def set_transform_static(self, transform: ProgramMessage, authority: str) -> None:
        """Store a `geometry_msgs.msg.TransformStamped` that is valid at all times."""
        self._set(transform, authority, is_static=True)

    def _set(self, transform: ProgramMessage, authority: str, *, is_static: bool) -> None:
        header, pose = transform.header, transform.transform
        position, rotation = pose.translation, pose.rotation
        text = self._frame_buffer.add(
            header.frame_id,
            transform.child_frame_id,
            _nanoseconds(header.stamp),
            (float(position.x), float(position.y), float(position.z)),
            (float(rotation.x), float(rotation.y), float(rotation.z), float(rotation.w)),
            is_static=is_static,
            authority=authority,
        )
        if text:
            logger = get_logger("tf2")
            (logger.warning if text.startswith("TF_OLD_DATA") else logger.error)(text)

    def clear(self) -> None:
        """Forget all transforms that are not valid at all times."""
        self._frame_buffer.clear()

    # ------------------------------------------------------------------ lookups

    def lookup_transform_core(self, target_frame: str, source_frame: str, time: Any) -> Any:
        """Return the pose of a frame in another one as a `geometry_msgs.msg.TransformStamped`.

        Args:
            target_frame: frame in which the pose is given.
            source_frame: frame whose pose is returned.
            time: `rclpy.time.Time` or stamp of a message; 0 for the latest time.

        Raises:
            TransformException: the pose is not known.
        """
        _check_names(target_frame, source_frame)
        pose = self._frame_buffer.lookup(target_frame, source_frame, _nanoseconds(time))
        return _message(target_frame, source_frame, *pose)

    def lookup_transform_full_core(
        self, target_frame: str, target_time: Any, source_frame: str, source_time: Any, fixed_frame: str
    ) -> Any:
        """Return the pose of a frame at one time in another frame at another time.

        Args:
            target_frame: frame in which the pose is given.
            target_time: time of this frame.
            source_frame: frame whose pose is returned.
            source_time: time of this frame.
            fixed_frame: frame that does not move between the times.

        Raises:
            TransformException: the pose is not known.
        """
        _check_names(target_frame, source_frame, fixed_frame)
        times = _nanoseconds(target_time), _nanoseconds(source_time)
        pose = self._frame_buffer.lookup_full(target_frame, times[0], source_frame, times[1], fixed_frame)
        return _message(target_frame, source_frame, *pose)

    def can_transform_core(self, target_frame: str, source_frame: str, time: Any) -> tuple[bool, str]:
        """Return whether a lookup would succeed, and the reason why not."""
        _check_names(target_frame, source_frame)
        text = self._frame_buffer.problem(target_frame, source_frame, _nanoseconds(time))
        return not text, text

    def can_transform_full_core(
        self, target_frame: str, target_time: Any, source_frame: str, source_time: Any, fixed_frame: str
    ) -> tuple[bool, str]:
        """Return whether a lookup with a fixed frame would succeed, and the reason why not."""
        _check_names(target_frame, source_frame, fixed_frame)
        times = _nanoseconds(target_time), _nanoseconds(source_time)
        text = self._frame_buffer.problem_full(target_frame, times[0], source_frame, times[1], fixed_frame)
        return not text, text

    def get_latest_common_time(self, target_frame: str, source_frame: str) -> Time:
        """Return the latest time at which all transforms between two frames are known.

        Raises:
            TransformException: the frames are not connected.
        """
        _check_names(target_frame, source_frame)
        return Time(nanoseconds=self._frame_buffer.latest_common_time(target_frame, source_frame))

    # ------------------------------------------------------------------ frames

    def all_frames_as_yaml(self) -> str:
        """Return a YAML document with parent, sender, rate and times of each frame."""
        return self._frame_buffer.as_yaml()

    def all_frames_as_string(self) -> str:
        """Return a sentence for each frame with its parent."""
        return self._frame_buffer.as_text()

    def _frameExists(self, frame_id: str) -> bool:
        return self._frame_buffer.has_frame(frame_id)

    def _getFrameStrings(self) -> list[str]:
        return self._frame_buffer.names()

    def _chain(
        self, target_frame: str, target_time: Any, source_frame: str, source_time: Any, fixed_frame: str
    ) -> list[str]:
        times = _nanoseconds(target_time), _nanoseconds(source_time)
        return self._frame_buffer.chain(target_frame, times[0], source_frame, times[1], fixed_frame)


def _nanoseconds(time: Any, kind: str = "time") -> int:
    """Return the nanoseconds of a `Time`, a `Duration` or a message of one."""
    try:
        return int(time.nanoseconds)
    except AttributeError:
        pass
    try:
        return int(time.sec) * 1_000_000_000 + int(time.nanosec)
    except AttributeError:
        raise TypeError(f"{kind} must have sec and nanosec, or nanoseconds.") from None


def _check_names(*names: object) -> None:
    for number, name in enumerate(names, 1):
        if not isinstance(name, str):
            raise TypeError(f"argument {number} must be str, not {type(name).__name__}")


def _message(target: str, source: str, position: Vector, rotation: Quaternion, stamp: int) -> Any:
    message = _Stamped()
    header, pose = message.header, message.transform
    header.stamp.sec, header.stamp.nanosec = divmod(stamp, 1_000_000_000)
    header.frame_id, message.child_frame_id = target, source
    pose.translation.x, pose.translation.y, pose.translation.z = position
    pose.rotation.x, pose.rotation.y, pose.rotation.z, pose.rotation.w = rotation
    return message
