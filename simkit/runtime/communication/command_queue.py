"""Queue of the commands for the next step, in the order of arrival and with a limit for each topic."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable
from typing import Any, Final

QUEUE_DEPTH: Final = 1000
"""Largest number of messages of a topic that wait for one step; the newest are kept, as with ROS's `KEEP_LAST`."""

QueuedContent = Any
"""Message of a topic. An entry without a topic contains a function to call instead."""

QueuedCommand = tuple[str, QueuedContent]


class CommandQueue(dict[int, QueuedCommand]):
    """Waiting commands in the order of arrival. The truth value of the queue is False if no command waits.

    The newest `depth` messages of each topic are kept; dropped older messages are counted. Entries without a topic are
    function calls, which are never dropped.

    Args:
        on_full: function that receives a topic and its depth when the first of its messages is dropped.

    Attributes:
        dropped: number of dropped messages by topic.
        depths: limits by topic, for topics whose limit differs from `QUEUE_DEPTH`.
        generation: counter that changes when a reset or a restore replaces all commands.
    """

    def __init__(self, on_full: Callable[[str, int], None]) -> None:
        super().__init__()
        self._on_full = on_full
        self._of: dict[str, deque[int]] = {}
        self._next = 0
        self.dropped: dict[str, int] = {}
        self.depths: dict[str, int] = {}
        self.generation = 0

    def put(self, topic: str, content: QueuedContent) -> None:
        """Queue a message, or a function call if `topic` is empty, for the next step."""
        key = self._next
        self._next = key + 1
        self[key] = topic, content
        if not topic:
            return
        keys = self._of.get(topic)
        if keys is None:
            keys = self._of[topic] = deque()
        keys.append(key)
        if len(keys) > self.depths.get(topic, QUEUE_DEPTH):
            del self[keys.popleft()]
            self._count(topic)

    def _count(self, topic: str) -> None:
        before = self.dropped.get(topic, 0)
        self.dropped[topic] = before + 1
        if not before:
            self._on_full(topic, self.depths.get(topic, QUEUE_DEPTH))

    def drain(self) -> list[QueuedCommand]:
        """Remove and return all entries, in the order of arrival."""
        entries = list(self.values())
        self._empty()
        return entries

    def refill(self, entries: Iterable[QueuedCommand]) -> None:
        """Replace all entries."""
        self.generation += 1
        self._fill(entries)

    def put_back(self, entries: Iterable[QueuedCommand]) -> None:
        """Insert drained, unprocessed entries before all later ones."""
        self._fill([*entries, *self.values()])

    def _fill(self, entries: Iterable[QueuedCommand]) -> None:
        entries = list(entries)
        self._empty()
        for topic, content in entries:
            self.put(topic, content)

    def _empty(self) -> None:
        self.clear()
        self._of.clear()
