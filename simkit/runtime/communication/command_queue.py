"""Commands that wait for the next step, in the order of arrival and at most so many of a topic."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable
from typing import Any, Final

QUEUE_DEPTH: Final = 1000
"""So many messages of a topic wait for one step at most; of more, the newest do, as with ROS's `KEEP_LAST`."""

QueuedContent = Any
"""A message, or a call where there is no topic."""

QueuedCommand = tuple[str, QueuedContent]


class CommandQueue(dict[int, QueuedCommand]):
    """What waits, by order of arrival; true where anything does.

    Of each topic the newest `depth` messages are kept; an older one that has to go is counted. Entries without a topic
    are calls, which are never dropped.

    Args:
        on_full: called with a topic and its depth when the first of its messages is dropped.

    Attributes:
        dropped: how many messages were dropped, by topic.
        depths: how many are kept, by topic, where that is another number than `QUEUE_DEPTH`.
        generation: another number after everything in it was replaced (a reset or a restore).
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
        """Lets a message, or a call where `topic` is empty, wait for the next step."""
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
        """Takes out all that waits, in the order of arrival."""
        entries = list(self.values())
        self._empty()
        return entries

    def refill(self, entries: Iterable[QueuedCommand]) -> None:
        """Puts this in place of all that waits."""
        self.generation += 1
        self._fill(entries)

    def put_back(self, entries: Iterable[QueuedCommand]) -> None:
        """Puts what was drained and not dealt with before all that has come since."""
        self._fill([*entries, *self.values()])

    def _fill(self, entries: Iterable[QueuedCommand]) -> None:
        entries = list(entries)
        self._empty()
        for topic, content in entries:
            self.put(topic, content)

    def _empty(self) -> None:
        self.clear()
        self._of.clear()
