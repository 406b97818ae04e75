"""Quality of service of topics: the policies of ROS 2, and which publishers and subscriptions fit together."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

Policy = Literal["RELIABILITY", "LIVELINESS", "DEADLINE", "DURABILITY"]


@dataclass(frozen=True)
class Qos:
    """Quality of service of a publisher or a subscription.

    Attributes:
        is_reliable: True for reliable, False for best effort.
        is_transient_local: True if later subscriptions get the last messages of the publisher; False for volatile.
        depth: largest number of messages in the queue of a subscription, and for later subscriptions; None for all.
        deadline_ns: longest time between two messages [ns]; None for no deadline.
        lifespan_ns: age at which a message is dropped [ns]; None for no limit.
        is_manual: True if the publisher itself asserts its liveliness.
        lease_ns: time in which a publisher must show its liveliness [ns]; None for no limit.
        accepts_volatile: True for a transient local subscription that also takes volatile publishers, as in ROS 1.
    """

    is_reliable: bool = True
    is_transient_local: bool = False
    depth: int | None = 10
    deadline_ns: int | None = None
    lifespan_ns: int | None = None
    is_manual: bool = False
    lease_ns: int | None = None
    accepts_volatile: bool = False


def incompatible_policies(offered: Qos, requested: Qos) -> list[Policy]:
    """Return the policies for which a publisher offers less than a subscription requests.

    The first of them is the one that ROS reports as the last incompatible policy: the one with the highest number in
    DDS.
    """
    policies: list[Policy] = []
    if requested.is_reliable and not offered.is_reliable:
        policies.append("RELIABILITY")
    if (requested.is_manual and not offered.is_manual) or _is_longer(offered.lease_ns, requested.lease_ns):
        policies.append("LIVELINESS")
    if _is_longer(offered.deadline_ns, requested.deadline_ns):
        policies.append("DEADLINE")
    if requested.is_transient_local and not (offered.is_transient_local or requested.accepts_volatile):
        policies.append("DURABILITY")
    return policies


def _is_longer(offered_ns: int | None, requested_ns: int | None) -> bool:
    """Check whether an offered duration is longer than the requested one; None is infinite."""
    return requested_ns is not None and (offered_ns is None or offered_ns > requested_ns)
