"""Transforms of a running simulation: `sim.tf`."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import Final

from simkit.completion import Completed
from simkit.msgs.message_types import FieldValue, Message
from simkit.msgs.transform_tree import TransformTree, TreeState
from simkit.pose import Pose
from simkit.runtime.communication.publisher import Publisher
from simkit.runtime.communication.subscription import LazyMessage, Subscription
from simkit.runtime.communication.topic_bus import TopicBus

_TOPICS: Final = {"/tf_static": True, "/tf": False}
"""Topics of transforms, and whether their transforms are valid at all times."""

BufferState = tuple[int | None, TreeState] | None
"""Time from which on transforms are received, and the transforms; None before the first use."""


def present_messages(bus: TopicBus, topic: str) -> Iterator[Message]:
    """Yield the newest message of each publisher of a topic, or its present one if the publisher can make it."""
    for _, end, _, _ in tuple(bus.endpoints(topic)):
        if isinstance(end, Publisher) and end.active:
            message = end.last if end.present is None else end.present()
            message = message.get() if type(message) is LazyMessage else message
            if message is not None:
                yield message


class TransformBuffer(TransformTree, Completed):
    """Transforms of a simulation. Nothing is received, and nothing is published for it, before its first use.

    Args:
        bus: topic bus.
        now_ns: function that returns the simulated time [ns].
    """

    _internal_names = frozenset(
        (
            *("advance", "close", "copied", "get_state", "is_static", "latest", "newest", "open", "replace"),
            *("set_state", "since_ns", "take"),
        )
    )

    def __init__(self, bus: TopicBus, now_ns: Callable[[], int]) -> None:
        super().__init__()
        self._bus, self._now_ns = bus, now_ns
        self._is_open = self._has_present = False
        self._taps: list[Subscription] = []

    def open(self) -> TransformBuffer:
        """Begin to receive transforms, if this has not begun; the present transforms are known at once."""
        if not self._is_open:
            self._is_open = True
            for topic, is_static in _TOPICS.items():
                name = self._bus.remapping.new_name(topic)
                self._taps.append(self._bus.tap(name, partial(self.take, is_static=is_static)))
        if not self._has_present:
            self._has_present, self.since_ns = True, self._now_ns()
            self._take_present()
        return self

    def close(self) -> None:
        """End the reception of transforms."""
        for tap in self._taps:
            tap.close()
        self._taps.clear()
        self._is_open = self._has_present = False

    def _take_present(self) -> None:
        """Store the present transforms, because the next message of a publisher may be far away."""
        for topic, is_static in _TOPICS.items():
            for message in present_messages(self._bus, self._bus.remapping.new_name(topic)):
                self.take(message, is_static=is_static)

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
        return super(TransformBuffer, self.open()).lookup(target, source, time)

    def frames(self) -> dict[str, str]:
        """Return the parent of each frame, sorted by name; an empty text for a root."""
        return super(TransformBuffer, self.open()).frames()

    # ------------------------------------------------------------------ state

    def get_state(self) -> BufferState:
        """Return the transforms for a snapshot; None before the first use."""
        return (self.since_ns, self.copied()) if self._has_present else None

    def set_state(self, state: BufferState) -> None:
        """Restore a state from `get_state`.

        The state before the first use has no transforms. They are read at the next use, because plugins have their
        restored state only then.
        """
        self._has_present = state is not None
        self.since_ns, frames = (None, ()) if state is None else state
        self.replace(frames)
