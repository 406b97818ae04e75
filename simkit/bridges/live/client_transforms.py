"""Transforms of a simulation in another process: `client.tf`."""

from __future__ import annotations

import time as wall_time
from collections.abc import Sequence

from simkit.bridges.live.client_handles import LiveSubscription
from simkit.bridges.live.server_link import ServerLink
from simkit.errors import TransformError
from simkit.msgs.message_types import FieldValue
from simkit.msgs.transform_tree import TransformTree
from simkit.pose import Pose

TOPICS = ("/tf_static", "/tf")
"""Topics of transforms; those of the first are valid at all times."""
_MOST_PIECES = 100  # pieces of received data that one call reads at most, if a simulation sends without end
DEFAULT_TIMEOUT = 1.0
"""Default of the longest wait for transforms [s], wall time."""


class LiveTransforms(TransformTree):
    """Transforms that a client has received. They arrive while a method of the client or of this object runs.

    Args:
        link: connection to the simulation.
        subscriptions: subscriptions to `TOPICS`.
        since_ns: simulated time of the subscriptions [ns].
    """

    def __init__(self, link: ServerLink, subscriptions: Sequence[LiveSubscription], since_ns: int) -> None:
        super().__init__()
        self._link, self._subscriptions, self.since_ns = link, subscriptions, since_ns

    def lookup(self, target: str, source: str, time: FieldValue = None, timeout: float = DEFAULT_TIMEOUT) -> Pose:
        """Return the pose of the frame `source` in the frame `target`; see `TransformTree.lookup`.

        Args:
            target: frame in which the pose is given.
            source: frame whose pose is returned.
            time: simulated time [s], or the stamp of a message; None for the latest time.
            timeout: longest wait until the pose is known [s], wall time.

        Raises:
            TransformError: the pose is not known after the timeout.
            LiveClosed: the simulation has ended.
        """
        end = wall_time.monotonic() + timeout
        while True:
            self._receive()
            try:
                return super().lookup(target, source, time)
            except TransformError:
                left = end - wall_time.monotonic()
                if left <= 0 or not self._link.wait(self._has_new, left):
                    raise

    def frames(self, timeout: float = DEFAULT_TIMEOUT) -> dict[str, str]:
        """Return the parent of each frame, sorted by name; an empty text for a root.

        Args:
            timeout: longest wait for the first transforms [s], wall time.
        """
        self._receive()
        if not super().frames():
            self._link.wait(self._has_new, timeout)
            self._receive()
        return super().frames()

    def _has_new(self) -> bool:
        return any(subscription.waiting for subscription in self._subscriptions)

    def _receive(self) -> None:
        for _ in range(_MOST_PIECES):
            if not self._link.receive(0.0):
                break
        for subscription in self._subscriptions:
            while subscription.waiting:
                received = subscription.waiting.popleft()
                self.advance(subscription.topic, received.time_ns)
                self.take(received.message, is_static=subscription.topic == TOPICS[0])
