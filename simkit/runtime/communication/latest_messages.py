"""Newest messages of the subscriptions, as part of snapshots."""

from __future__ import annotations

from typing import TYPE_CHECKING

from simkit.runtime.communication.publisher import Publisher
from simkit.runtime.communication.subscription import Message, Subscription

if TYPE_CHECKING:
    from simkit.runtime.communication.topic_bus import TopicBus


class MessagesBySubscription(dict[Subscription, Message]):
    """Newest message of each subscription. A pickled snapshot contains none, because it has no subscriptions."""

    def __reduce__(self) -> tuple[type[MessagesBySubscription], tuple[()]]:
        return MessagesBySubscription, ()


class LatestMessages:
    """Newest messages of all subscriptions of a bus, so that `Subscription.latest` belongs to the restored state.

    Args:
        bus: topic bus.
    """

    def __init__(self, bus: TopicBus) -> None:
        self._bus = bus

    def _subscriptions(self) -> list[Subscription]:
        return [one for one in self._bus.subscriptions() if one.keeps]

    def get_state(self) -> MessagesBySubscription:
        """Return the newest messages for a snapshot."""
        return MessagesBySubscription((one, one.latest) for one in self._subscriptions())

    def set_state(self, state: MessagesBySubscription) -> None:
        """Restore the newest messages.

        A subscription that is newer than the snapshot gets what a new subscription would get: the message that a
        latched topic keeps, or none.
        """
        for one in self._subscriptions():
            self._bus.gather(one.topic)  # deferred messages belong to the state of before
            one.restore_latest(state[one] if one in state else self._kept(one.topic))

    def _kept(self, topic: str) -> Message:
        """Return the message that a latched topic keeps for a new subscription, or None."""
        kept: list[Message] = [None]
        for _, end, _, _ in self._bus.endpoints(topic):
            if isinstance(end, Publisher) and end.active and end.latched:
                end.send_kept(kept.append)
        return kept[-1]
