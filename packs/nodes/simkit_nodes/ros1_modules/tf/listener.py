"""Lookups of transforms, and messages in other frames."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
import yaml

from simkit.linear_algebra import matmul
from simkit_nodes import transformations
from simkit_nodes.interfaces import ROS1, ProgramMessage
from simkit_nodes.ros1_modules import tf2_ros
from simkit_nodes.ros1_modules.rospy.rostime import Duration, Time

__all__ = ["TransformListener", "Transformer", "TransformerROS"]

_Pose = tuple[list[float], list[float]]
"""Position x, y, z [m] and quaternion x, y, z, w."""

_NO_THREAD: Final = "cannot wait for transform without a dedicated thread that listens to incoming TF messages"


def _plain(frame: str) -> str:
    """Return the name of a frame without a slash at its start, which tf2 refuses."""
    return frame.removeprefix("/")


class Transformer:
    """Buffer of transforms that gives poses as lists.

    Args:
        interpolate: accepted as in ROS.
        cache_time: length of the history (`rospy.Duration`); 10 s by default.
    """

    def __init__(self, interpolate: bool = True, cache_time: Duration | None = None) -> None:
        self._buffer = tf2_ros.Buffer(cache_time, debug=False)
        self._using_dedicated_thread = False

    # ------------------------------------------------------------------ transforms

    def setTransform(self, transform: ProgramMessage, authority: str = "default_authority") -> None:
        """Store a `geometry_msgs.msg.TransformStamped`."""
        self._buffer.set_transform(transform, authority)

    def lookupTransform(self, target_frame: str, source_frame: str, time: Any) -> _Pose:
        """Return position and quaternion of a frame in another one.

        Args:
            target_frame: frame in which the pose is given.
            source_frame: frame whose pose is returned.
            time: time; 0 for the latest one.

        Raises:
            tf.Exception: the pose is not known.
        """
        return _pose(self._buffer.lookup_transform(_plain(target_frame), _plain(source_frame), time))

    def lookupTransformFull(
        self, target_frame: str, target_time: Any, source_frame: str, source_time: Any, fixed_frame: str
    ) -> _Pose:
        """Return the pose of a frame at one time in another frame at another time; see `lookupTransform`."""
        return _pose(
            self._buffer.lookup_transform_full(
                _plain(target_frame), target_time, _plain(source_frame), source_time, _plain(fixed_frame)
            )
        )

    def canTransform(self, target_frame: str, source_frame: str, time: Any) -> bool:
        """Check whether a transform is known."""
        return bool(self._buffer.can_transform(_plain(target_frame), _plain(source_frame), time))

    def canTransformFull(
        self, target_frame: str, target_time: Any, source_frame: str, source_time: Any, fixed_frame: str
    ) -> bool:
        """Check whether a transform between two times is known."""
        return bool(
            self._buffer.can_transform_full(
                _plain(target_frame), target_time, _plain(source_frame), source_time, _plain(fixed_frame)
            )
        )

    def waitForTransform(
        self, target_frame: str, source_frame: str, time: Any, timeout: Any, polling_sleep_duration: Any = None
    ) -> None:
        """Wait until a transform is known.

        Raises:
            tf.Exception: it is not known in time.
        """
        self._check_listens()
        _check(
            self._buffer.can_transform(
                _plain(target_frame), _plain(source_frame), time, timeout, return_debug_tuple=True
            ),
            source_frame,
            target_frame,
        )

    def waitForTransformFull(
        self,
        target_frame: str,
        target_time: Any,
        source_frame: str,
        source_time: Any,
        fixed_frame: str,
        timeout: Any,
        polling_sleep_duration: Any = None,
    ) -> None:
        """Wait until a transform between two times is known; see `waitForTransform`."""
        self._check_listens()
        frames = _plain(target_frame), target_time, _plain(source_frame), source_time, _plain(fixed_frame)
        answer = self._buffer.can_transform_full(*frames, timeout, return_debug_tuple=True)
        _check(answer, source_frame, target_frame)

    def _check_listens(self) -> None:
        if not self._using_dedicated_thread:
            raise tf2_ros.TransformException(_NO_THREAD)

    def getLatestCommonTime(self, source_frame: str, dest_frame: str) -> Any:
        """Return the latest time at which the pose of a frame in another one is known."""
        return self._buffer.get_latest_common_time(_plain(source_frame), _plain(dest_frame))

    def lookupTwist(
        self, tracking_frame: str, observation_frame: str, time: Any, averaging_interval: Any
    ) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Return the linear [m/s] and angular velocity [rad/s] of a frame in another one.

        Args:
            tracking_frame: frame that moves.
            observation_frame: frame in which the velocities are given.
            time: time in the middle of the interval; 0 for the latest one.
            averaging_interval: duration over which the velocities are averaged.
        """
        latest = self.getLatestCommonTime(observation_frame, tracking_frame)
        end = min((time or latest) + Duration(0.5 * averaging_interval.to_sec()), latest)
        start = max(Time(0.0001) + averaging_interval, end) - averaging_interval
        seconds = (end - start).to_sec()
        first, first_turn = self.lookupTransform(observation_frame, tracking_frame, start)
        last, last_turn = self.lookupTransform(observation_frame, tracking_frame, end)
        turn = matmul(transformations.quaternion_matrix(last_turn), transformations.quaternion_matrix(first_turn).T)
        angle, axis, _ = transformations.rotation_from_matrix(turn)
        linear = tuple((b - a) / seconds for a, b in zip(first, last, strict=True))
        return linear, tuple(float(part) * angle / seconds for part in axis)

    # ------------------------------------------------------------------ frames

    def chain(
        self, target_frame: str, target_time: Any, source_frame: str, source_time: Any, fixed_frame: str
    ) -> list[str]:
        """Return the frames between two frames."""
        return self._buffer._chain(target_frame, target_time, source_frame, source_time, fixed_frame)

    def frameExists(self, frame_id: str) -> bool:
        """Check whether a frame is known."""
        return frame_id in self.getFrameStrings()

    def getFrameStrings(self) -> list[str]:
        """Return the names of all frames with a parent."""
        return list(yaml.safe_load(self._buffer.all_frames_as_yaml()) or {})

    def allFramesAsString(self) -> str:
        """Return a sentence for each frame with its parent."""
        return self._buffer.all_frames_as_string()

    def clear(self) -> None:
        """Forget all transforms that are not valid at all times."""
        self._buffer.clear()

    def setUsingDedicatedThread(self, value: bool) -> None:
        """Store whether a thread listens to transforms."""
        self._using_dedicated_thread = value

    def getTFPrefix(self) -> str:
        """Return the prefix of frames; tf2 has none."""
        return ""


def _pose(message: ProgramMessage) -> _Pose:
    base, turn = message.transform.translation, message.transform.rotation
    return [base.x, base.y, base.z], [turn.x, turn.y, turn.z, turn.w]


def _check(answer: tuple[bool, str], source: str, target: str) -> None:
    if not answer[0]:
        raise tf2_ros.TransformException(answer[1] or f'no such transformation: "{source}" -> "{target}"')


def xyz_to_mat44(pos: Any) -> Any:
    """Return the matrix of a position message."""
    return transformations.translation_matrix((pos.x, pos.y, pos.z))


def xyzw_to_mat44(ori: Any) -> Any:
    """Return the matrix of a quaternion message."""
    return transformations.quaternion_matrix((ori.x, ori.y, ori.z, ori.w))


class TransformerROS(Transformer):
    """Buffer of transforms that also converts messages."""

    def asMatrix(self, target_frame: str, hdr: Any) -> Any:
        """Return the 4 × 4 matrix from the frame and the time of a header to a frame."""
        return self.fromTranslationRotation(*self.lookupTransform(target_frame, hdr.frame_id, hdr.stamp))

    def fromTranslationRotation(self, translation: Any, rotation: Any) -> Any:
        """Return the 4 × 4 matrix of a position and a quaternion."""
        return matmul(transformations.translation_matrix(translation), transformations.quaternion_matrix(rotation))

    def transformPoint(self, target_frame: str, ps: Any) -> Any:
        """Return a `geometry_msgs.msg.PointStamped` in another frame."""
        result = _stamped("geometry_msgs/msg/PointStamped", target_frame, ps)
        result.point = _moved(self.asMatrix(target_frame, ps.header), ps.point, 1.0)
        return result

    def transformVector3(self, target_frame: str, v3s: Any) -> Any:
        """Return a `geometry_msgs.msg.Vector3Stamped` in another frame; it turns and does not move."""
        result = _stamped("geometry_msgs/msg/Vector3Stamped", target_frame, v3s)
        result.vector = _moved(self.asMatrix(target_frame, v3s.header), v3s.vector, 0.0)
        return result

    def transformQuaternion(self, target_frame: str, ps: Any) -> Any:
        """Return a `geometry_msgs.msg.QuaternionStamped` in another frame."""
        result = _stamped("geometry_msgs/msg/QuaternionStamped", target_frame, ps)
        matrix = matmul(self.asMatrix(target_frame, ps.header), xyzw_to_mat44(ps.quaternion))
        _set_quaternion(result.quaternion, matrix)
        return result

    def transformPose(self, target_frame: str, ps: Any) -> Any:
        """Return a `geometry_msgs.msg.PoseStamped` in another frame."""
        result = _stamped("geometry_msgs/msg/PoseStamped", target_frame, ps)
        pose = matmul(xyz_to_mat44(ps.pose.position), xyzw_to_mat44(ps.pose.orientation))
        matrix = matmul(self.asMatrix(target_frame, ps.header), pose)
        position = result.pose.position
        position.x, position.y, position.z = (float(number) for number in matrix[:3, 3])
        _set_quaternion(result.pose.orientation, matrix)
        return result

    def transformPointCloud(self, target_frame: str, point_cloud: Any) -> Any:
        """Return a `sensor_msgs.msg.PointCloud` in another frame."""
        result = _stamped("sensor_msgs/msg/PointCloud", target_frame, point_cloud)
        matrix = self.asMatrix(target_frame, point_cloud.header)
        result.channels = point_cloud.channels
        result.points = [_moved(matrix, point, 1.0) for point in point_cloud.points]
        return result


def _stamped(type_name: str, frame: str, message: ProgramMessage) -> Any:
    result = ROS1.message_class(type_name)()
    result.header.stamp, result.header.frame_id = message.header.stamp, frame
    return result


def _moved(matrix: Any, point: Any, factor: float) -> Any:
    """Return a point (factor 1) or a vector (factor 0) of the same class after a transform."""
    x, y, z = matmul(matrix, np.array([[point.x], [point.y], [point.z], [factor]]))[:3, 0]
    return type(point)(float(x), float(y), float(z))


def _set_quaternion(message: ProgramMessage, matrix: Any) -> None:
    message.x, message.y, message.z, message.w = (float(n) for n in transformations.quaternion_from_matrix(matrix))


class TransformListener(TransformerROS):
    """Buffer of transforms that listens to `/tf` and `/tf_static`."""

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self._listener = tf2_ros.TransformListener(self._buffer)
        self.setUsingDedicatedThread(True)
