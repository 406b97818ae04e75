"""Callbacks for messages that belong together, as the ROS 2 package `message_filters`.

Stamps are those of messages of both ROS versions.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence
from typing import Any

from simkit_nodes.host import current_host, current_program
from simkit_nodes.interfaces import ROS1, ProgramMessage, ros1_time
from simkit_nodes.ros_modules.rclpy.clock import ROSClock
from simkit_nodes.ros_modules.rclpy.duration import Duration
from simkit_nodes.ros_modules.rclpy.logging import get_logger
from simkit_nodes.ros_modules.rclpy.time import Time

__all__ = ["ApproximateTimeSynchronizer", "Cache", "SimpleFilter", "Subscriber", "TimeSynchronizer"]


class SimpleFilter:
    """Source of messages for callbacks and other filters."""

    def __init__(self) -> None:
        self.callbacks: dict[int, tuple[Callable[..., object], tuple[Any, ...]]] = {}

    def registerCallback(self, cb: Callable[..., object], *args: object) -> int:
        """Call a function with each result of the filter, then with further arguments; return its number."""
        number = len(self.callbacks)
        self.callbacks[number] = (cb, args)
        return number

    def signalMessage(self, *msg: object) -> None:
        """Call all functions."""
        for callback, args in self.callbacks.values():
            callback(*msg, *args)


class Subscriber(SimpleFilter):
    """Subscription as a source of messages.

    Args:
        args: node, type, topic, and further arguments of `Node.create_subscription` after the callback.
        kwargs: keyword arguments of `Node.create_subscription`; `qos_profile` is 10 by default.
    """

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__()
        self.node, self.topic = args[0], args[2]
        kwargs.setdefault("qos_profile", 10)
        self.sub = self.node.create_subscription(*args[1:], self.callback, **kwargs)

    def callback(self, msg: object) -> None:
        """Hand a message on."""
        self.signalMessage(msg)

    def getTopic(self) -> str:
        """Return the topic."""
        return str(self.topic)

    def __getattr__(self, key: str) -> Any:
        if key == "sub":
            raise AttributeError(key)
        return getattr(self.sub, key)


Stamp = Time | ros1_time.Time
"""Time of a message: of `rclpy` or of ROS 1."""


def _nanoseconds(stamp: Stamp) -> int:
    return stamp.to_nsec() if isinstance(stamp, ros1_time.Time) else int(stamp.nanoseconds)


def stamp_of(msg: object, allow_headerless: bool, logger_name: str) -> Any:
    """Return the stamp of a message; without a header the present time, or None with a warning if it is not allowed."""
    stamp = getattr(getattr(msg, "header", None), "stamp", None)
    if stamp is not None:
        return stamp if isinstance(stamp, (Time, ros1_time.Time)) else Time.from_msg(stamp)
    if allow_headerless:
        return ros1_time.Time(0, current_host().now_ns()) if current_program().flavour is ROS1 else ROSClock().now()
    get_logger(logger_name).warning(
        "can not use message filters messages without timestamp information when 'allow_headerless' is disabled. auto "
        "assign ROSTIME to headerless messages once enabling constructor option of 'allow_headerless'."
    )
    return None


class Cache(SimpleFilter):
    """Newest messages of a filter.

    Args:
        f: filter.
        cache_size: largest number of messages.
        allow_headerless: accept messages without a header, with the present time as their stamp.
    """

    def __init__(self, f: SimpleFilter, cache_size: int = 1, allow_headerless: bool = False) -> None:
        super().__init__()
        self.cache_size, self.allow_headerless = cache_size, allow_headerless
        self.cache_msgs: list[Any] = []
        self.cache_times: list[Any] = []
        self.connectInput(f)

    def connectInput(self, f: SimpleFilter) -> None:
        """Receive the messages of a filter."""
        self.incoming_connection = f.registerCallback(self.add)

    def add(self, msg: object) -> None:
        """Store a message and hand it on."""
        stamp = stamp_of(msg, self.allow_headerless, "message_filters_cache")
        if stamp is None:
            return
        self.cache_times.append(stamp)
        self.cache_msgs.append(msg)
        if len(self.cache_msgs) > self.cache_size:
            del self.cache_msgs[0], self.cache_times[0]
        self.signalMessage(msg)

    def getInterval(self, from_stamp: Any, to_stamp: Any) -> list[Any]:
        """Return the messages between two times."""
        if not from_stamp <= to_stamp:
            raise AssertionError
        pairs = zip(self.cache_msgs, self.cache_times, strict=True)
        return [msg for msg, time in pairs if from_stamp <= time <= to_stamp]

    def getElemAfterTime(self, stamp: object) -> Any:
        """Return the first message at or after a time; None without one."""
        pairs = zip(self.cache_msgs, self.cache_times, strict=True)
        return next((msg for msg, time in pairs if time >= stamp), None)

    def getElemBeforeTime(self, stamp: object) -> Any:
        """Return the last message at or before a time; None without one."""
        pairs = zip(reversed(self.cache_msgs), reversed(self.cache_times), strict=True)
        return next((msg for msg, time in pairs if time <= stamp), None)

    def getLastestTime(self) -> Any:
        """Return the stamp of the last message; None without one."""
        return self.cache_times[-1] if self.cache_times else None

    def getOldestTime(self) -> Any:
        """Return the stamp of the first message; None without one."""
        return self.cache_times[0] if self.cache_times else None

    def getLast(self) -> Any:
        """Return the last message; None without one."""
        last = self.getLastestTime()
        return None if last is None else self.getElemAfterTime(last)


class TimeSynchronizer(SimpleFilter):
    """Filter whose callback gets a message of each input, all with the same stamp.

    Args:
        fs: inputs.
        queue_size: largest number of messages of each input that wait for the others.
    """

    def __init__(self, fs: Sequence[SimpleFilter], queue_size: int) -> None:
        super().__init__()
        self.queue_size = queue_size
        self.connectInput(fs)

    def connectInput(self, fs: Sequence[SimpleFilter]) -> None:
        """Receive the messages of filters."""
        self.queues: list[dict[int, Any]] = [{} for _ in fs]
        inputs = enumerate(zip(fs, self.queues, strict=True))
        self.input_connections = [f.registerCallback(self.add, queue, index) for index, (f, queue) in inputs]

    def _store(self, msg: object, stamp: Stamp, queue: dict[int, Any]) -> None:
        queue[_nanoseconds(stamp)] = msg
        while len(queue) > self.queue_size:
            del queue[min(queue)]

    def add(self, msg: ProgramMessage, my_queue: dict[int, Any], my_queue_index: int | None = None) -> None:
        """Store a message of an input, and hand on all sets that are complete."""
        del my_queue_index
        stamp = msg.header.stamp
        self._store(msg, stamp if isinstance(stamp, ros1_time.Time) else Time.from_msg(stamp), my_queue)
        for time in sorted(set.intersection(*(set(queue) for queue in self.queues))):
            self.signalMessage(*(queue[time] for queue in self.queues))
            for queue in self.queues:
                del queue[time]


class ApproximateTimeSynchronizer(TimeSynchronizer):
    """Filter whose callback gets a message of each input, with stamps that differ little.

    Args:
        fs: inputs.
        queue_size: largest number of messages of each input that wait for the others.
        slop: largest difference of the stamps [s].
        allow_headerless: accept messages without a header, with the present time as their stamp.
    """

    def __init__(
        self, fs: Sequence[SimpleFilter], queue_size: int, slop: float, allow_headerless: bool = False
    ) -> None:
        super().__init__(fs, queue_size)
        self.slop, self.allow_headerless = Duration(seconds=slop), allow_headerless

    def add(self, msg: object, my_queue: dict[int, Any], my_queue_index: int | None = None) -> None:
        """Store a message of an input, and hand on the set of the closest messages if it is complete."""
        stamp = stamp_of(msg, self.allow_headerless, "message_filters_approx")
        if stamp is None:
            return
        self._store(msg, stamp, my_queue)
        now, slop = _nanoseconds(stamp), self.slop.nanoseconds
        choices: list[list[int]] = []
        for index, queue in enumerate(self.queues):
            if index == my_queue_index:
                choices.append([now])
                continue
            near = [time for time in queue if abs(time - now) <= slop]
            if not near:
                return
            choices.append(sorted(near, key=lambda time: abs(time - now)))
        for times in itertools.product(*choices):
            pairs = list(zip(self.queues, times, strict=True))
            if max(times) - min(times) < slop and all(time in queue for queue, time in pairs):
                self.signalMessage(*(queue[time] for queue, time in pairs))
                for queue, time in pairs:
                    del queue[time]
                break
