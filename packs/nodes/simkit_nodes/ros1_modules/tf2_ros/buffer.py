"""Buffer of transforms that waits for them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

from simkit_nodes.ros1_modules.rospy.ros_node import ros_node
from simkit_nodes.ros1_modules.rospy.rostime import Duration, limit_ns
from simkit_nodes.ros1_modules.tf2_py import BufferCore
from simkit_nodes.ros_modules.tf2_ros.buffer_interface import BufferInterface
from simkit_nodes.transform_availability import Availability, TransformAvailability

__all__ = ["Buffer"]

_NO_WAIT: Final = Duration()


class Buffer(BufferCore, TransformAvailability, BufferInterface):
    """Transforms of all frames over the last seconds.

    Args:
        cache_time: length of the history; 10 s by default.
        debug: accepted as in ROS.
    """

    def __init__(self, cache_time: Duration | None = None, debug: bool = True) -> None:
        BufferCore.__init__(self, cache_time)
        BufferInterface.__init__(self)

    def set_transform(self, transform: object, authority: str = "default_authority") -> None:
        """Store a `geometry_msgs.msg.TransformStamped`."""
        super().set_transform(transform, authority)
        ros_node().host.wake()

    def set_transform_static(self, transform: object, authority: str = "default_authority") -> None:
        """Store a `geometry_msgs.msg.TransformStamped` that is valid at all times."""
        super().set_transform_static(transform, authority)
        ros_node().host.wake()

    def lookup_transform(self, target_frame: str, source_frame: str, time: object, timeout: object = _NO_WAIT) -> Any:
        """Return the pose of a frame in another one as a `geometry_msgs.msg.TransformStamped`.

        Args:
            target_frame: frame in which the pose is given.
            source_frame: frame whose pose is returned.
            time: time; 0 for the latest one.
            timeout: longest wait for the transform.

        Raises:
            TransformException: the pose is not known.
        """
        self.can_transform(target_frame, source_frame, time, timeout)
        return self.lookup_transform_core(target_frame, source_frame, time)

    def lookup_transform_full(
        self,
        target_frame: str,
        target_time: object,
        source_frame: str,
        source_time: object,
        fixed_frame: str,
        timeout: object = _NO_WAIT,
    ) -> Any:
        """Return the pose of a frame at one time in another frame at another time; see `lookup_transform`."""
        arguments = target_frame, target_time, source_frame, source_time, fixed_frame
        self.can_transform_full(*arguments, timeout)
        return self.lookup_transform_full_core(*arguments)

    def _wait_for(self, check: Callable[[], Availability], timeout: object) -> Availability:
        """Wait until the transform is known or the time is over."""
        node = ros_node()
        node.poll()
        result, limit = check(), limit_ns(timeout)
        if not result[0] and limit is not None and limit > node.host.now_ns():
            node.wait(limit, lambda: check()[0])
            result = check()
        return result
