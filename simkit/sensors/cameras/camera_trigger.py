"""Trigger of a camera that takes pictures only when messages call for them."""

from __future__ import annotations

from collections.abc import Sequence

from simkit.runtime.communication.topic_bus import TopicBus

TRIGGER_TYPES = ("std_msgs/msg/Bool", "std_msgs/msg/Empty")


class Trigger:
    """Messages that each call for a picture at the next due time.

    Attributes:
        pending: pictures that are called for.
        counts: whether messages that come in before a due time give a picture each, at that and the next ones; else
            they give one.
    """

    def __init__(self) -> None:
        self.pending = 0
        self.counts = False

    def listen(self, bus: TopicBus, topic: str, types: Sequence[str]) -> None:
        """Hears one more topic.

        Args:
            topic: absolute.
            types: of the messages, whatever they say; the first is the listed one.
        """
        bus.listen(topic, types, self._on_message)

    def _on_message(self, _: object) -> None:
        self.pending = self.pending + 1 if self.counts else 1

    def take(self) -> bool:
        """Whether a picture is called for now, which is one less then."""
        if self.pending == 0:
            return False
        self.pending -= 1
        return True
