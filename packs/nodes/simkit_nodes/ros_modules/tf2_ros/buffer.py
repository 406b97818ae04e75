"""Buffer of transforms that waits for them in simulated time."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

from simkit_nodes.host import current_host
from simkit_nodes.interfaces import ROS2, ProgramMessage, interface_module
from simkit_nodes.ros_modules.rclpy.clock import Clock, JumpThreshold
from simkit_nodes.ros_modules.rclpy.duration import Duration
from simkit_nodes.ros_modules.rclpy.logging import get_logger
from simkit_nodes.ros_modules.rclpy.task import Future
from simkit_nodes.ros_modules.tf2_py import BufferCore
from simkit_nodes.ros_modules.tf2_ros.buffer_interface import BufferInterface
from simkit_nodes.transform_availability import Availability, TransformAvailability

__all__ = ["Buffer"]

_services: Any = interface_module("tf2_msgs.srv", ROS2)
_NO_WAIT: Final = Duration()
_POLL_NS: Final = 20_000_000  # tf2_ros asks again every 20 ms


class Buffer(BufferCore, TransformAvailability, BufferInterface):
    """Transforms of all frames over the last seconds.

    Args:
        cache_time: length of the history (`rclpy.duration.Duration`); 10 s by default.
        node: node that offers the service `tf2_frames`, and whose clock tells jumps back in time.
    """

    def __init__(self, cache_time: Duration | None = None, node: Any = None) -> None:
        BufferCore.__init__(self, cache_time)
        BufferInterface.__init__(self)
        self._new_data_callbacks: list[Callable[[], None]] = []
        if node is not None:
            self.srv = node.create_service(_services.FrameGraph, "tf2_frames", self._answer_frames)
        self.clock = Clock() if node is None else node.get_clock()
        threshold = JumpThreshold(min_forward=None, min_backward=Duration(seconds=-1), on_clock_change=True)
        self.jump_handle = self.clock.create_jump_callback(threshold, post_callback=self.time_jump_callback)

    def _answer_frames(self, request: ProgramMessage, response: ProgramMessage) -> Any:
        del request
        response.frame_yaml = self.all_frames_as_yaml()
        return response

    def time_jump_callback(self, time_jump: Any) -> None:
        """Forget all transforms after a jump back in time."""
        del time_jump
        get_logger("tf2_buffer").warning("Detected jump back in time. Clearing tf buffer.")
        self.clear()

    def set_transform(self, transform: ProgramMessage, authority: str) -> None:
        """Store a `geometry_msgs.msg.TransformStamped`."""
        super().set_transform(transform, authority)
        self._tell_new_data()

    def set_transform_static(self, transform: ProgramMessage, authority: str) -> None:
        """Store a `geometry_msgs.msg.TransformStamped` that is valid at all times."""
        super().set_transform_static(transform, authority)
        self._tell_new_data()

    def _tell_new_data(self) -> None:
        for callback in tuple(self._new_data_callbacks):
            callback()

    # ------------------------------------------------------------------ lookups that wait

    def lookup_transform(self, target_frame: str, source_frame: str, time: Any, timeout: Duration = _NO_WAIT) -> Any:
        """Return the pose of a frame in another one as a `geometry_msgs.msg.TransformStamped`.

        Args:
            target_frame: frame in which the pose is given.
            source_frame: frame whose pose is returned.
            time: `rclpy.time.Time` or stamp of a message; 0 for the latest time.
            timeout: longest wait for the transform. The wait lets no callback of this thread run, as in ROS: in a
                callback of a single-threaded executor it always takes the full time.

        Raises:
            TransformException: the pose is not known.
        """
        if timeout != _NO_WAIT:
            self.can_transform(target_frame, source_frame, time, timeout)
        return self.lookup_transform_core(target_frame, source_frame, time)

    def lookup_transform_full(
        self,
        target_frame: str,
        target_time: Any,
        source_frame: str,
        source_time: Any,
        fixed_frame: str,
        timeout: Duration = _NO_WAIT,
    ) -> Any:
        """Return the pose of a frame at one time in another frame at another time; see `lookup_transform`."""
        self.can_transform_full(target_frame, target_time, source_frame, source_time, fixed_frame, timeout)
        return self.lookup_transform_full_core(target_frame, target_time, source_frame, source_time, fixed_frame)

    def _wait_for(self, check: Callable[[], Availability], timeout: Any) -> Availability:
        """Check every 20 ms until the transform is known or the time is over."""
        result = check()
        if not result[0] and timeout is not None and timeout != _NO_WAIT:
            host = current_host()
            end = host.now_ns() + timeout.nanoseconds
            while host.now_ns() < end and not result[0]:
                host.wait(min(end, host.now_ns() + _POLL_NS))
                result = check()
        return result

    # ------------------------------------------------------------------ lookups for coroutines

    async def lookup_transform_async(self, target_frame: str, source_frame: str, time: Any) -> Any:
        """Return a transform as soon as it is known; see `lookup_transform`."""
        await self.wait_for_transform_async(target_frame, source_frame, time)
        return self.lookup_transform_core(target_frame, source_frame, time)

    async def lookup_transform_full_async(
        self, target_frame: str, target_time: Any, source_frame: str, source_time: Any, fixed_frame: str
    ) -> Any:
        """Return a transform between two times as soon as it is known; see `lookup_transform_full`."""
        arguments = target_frame, target_time, source_frame, source_time, fixed_frame
        await self.wait_for_transform_full_async(*arguments)
        return self.lookup_transform_full_core(*arguments)

    def wait_for_transform_async(self, target_frame: str, source_frame: str, time: Any) -> Future:
        """Return a future with the transform."""
        return self._future(
            lambda: self.can_transform_core(target_frame, source_frame, time)[0],
            lambda: self.lookup_transform_core(target_frame, source_frame, time),
        )

    def wait_for_transform_full_async(
        self, target_frame: str, target_time: Any, source_frame: str, source_time: Any, fixed_frame: str
    ) -> Future:
        """Return a future with the transform between two times."""
        arguments = target_frame, target_time, source_frame, source_time, fixed_frame
        return self._future(
            lambda: self.can_transform_full_core(*arguments)[0], lambda: self.lookup_transform_full_core(*arguments)
        )

    def _future(self, is_known: Callable[[], bool], lookup: Callable[[], object]) -> Future:
        future = Future()

        def look() -> None:
            if not future.done() and is_known():
                future.set_result(lookup())

        look()
        if not future.done():
            self._new_data_callbacks.append(look)
            future.add_done_callback(lambda _: self._new_data_callbacks.remove(look))
        return future
