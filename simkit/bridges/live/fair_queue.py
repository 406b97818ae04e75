"""Fair order of the messages for one client: in each round every subscription may send the same number of bytes."""

from __future__ import annotations

from collections import deque
from operator import itemgetter

from simkit.bridges.live.message_log import ClientSubscription, Entry

_SHARE = 1 << 16  # [bytes] that a subscription may send in one round
_OVERHEAD = 64  # [bytes] that each message counts besides its data
_LARGEST_ROUND = 1 << 20  # [bytes] above which the next round begins; other subscriptions then come first


Item = tuple[int, ClientSubscription, Entry]
"""Position in the order of publication, subscription and message."""


class FairQueue:
    """Queued messages of the subscriptions of a client (deficit round robin).

    A large message is sent when its subscription has saved enough bytes over several rounds, so small messages of other
    topics need not wait for it. Within a round, messages are in the order of their publication. A client that keeps up
    has one round for each poll and receives small messages in the order of their publication.
    """

    def __init__(self) -> None:
        self._active: dict[ClientSubscription, None] = {}
        self._round: deque[Item] = deque()

    def __bool__(self) -> bool:
        return bool(self._round or self._active)

    def activate(self, reader: ClientSubscription) -> None:
        """Add a subscription that has messages."""
        self._active[reader] = None

    def remove(self, reader: ClientSubscription) -> None:
        """Remove a subscription with its messages."""
        self._active.pop(reader, None)
        if any(waiting is reader for _, waiting, _ in self._round):
            self._round = deque(item for item in self._round if item[1] is not reader)

    def clear(self) -> None:
        """Remove all subscriptions with their messages."""
        self._active.clear()
        self._round.clear()

    def next(self) -> Item | None:
        """Remove the next message and return it with its position and subscription; None if there is none."""
        while not self._round:
            if not self._active:
                return None
            self._begin_round()
        return self._round.popleft()

    def _begin_round(self) -> None:
        """Take the messages of a round. If no subscription can pay for its message, skip the rounds until one can."""
        waiting: list[Item] = []
        missing: list[int] = []
        size = 0
        for reader in list(self._active):
            del self._active[reader]
            credit = reader.credit + _SHARE
            for entry in reader.take_entries():
                cost = len(entry[3]) + _OVERHEAD
                if cost > credit:
                    self._active[reader] = None
                    missing.append(cost - credit)
                    reader.credit = credit
                    break
                credit -= cost
                size += cost
                waiting.append((entry[0], reader, entry))
            else:
                reader.rest()
            if size > _LARGEST_ROUND:
                break
        if missing and not waiting:
            skipped = (min(missing) - 1) // _SHARE * _SHARE
            for reader in self._active:
                reader.credit += skipped
        waiting.sort(key=itemgetter(0))
        self._round.extend(waiting)
