"""Handling of topic callbacks that raise, and of too many messages."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from simkit.errors import (
    InputError,
    PluginError,
    SimkitError,
    SimulationDiverged,
    SubscriberError,
    callback_name,
    cause_text,
)
from simkit.runtime.communication.subscription import MAX_KEPT_MESSAGES
from simkit.runtime.engine.plugin_faults import is_guarded

if TYPE_CHECKING:
    from simkit.diagnostics import Diagnostics
    from simkit.runtime.communication.publisher import Listener
    from simkit.runtime.communication.subscription import Subscription


class TopicFailures:
    """Errors and warnings of the topics of a simulation.

    Args:
        reports: collection for the warnings.
        now: function that returns the simulated time [s].

    Attributes:
        now: function that returns the simulated time [s].
    """

    def __init__(self, reports: Diagnostics, now: Callable[[], float]) -> None:
        self._reports, self.now = reports, now

    def subscriber_failed(self, subscription: Subscription, error: Exception) -> None:
        """Stop the run or close the subscription, as its policy requires. Call this inside the `except` block."""
        if isinstance(error, (PluginError, SimulationDiverged)) or is_guarded(subscription.callback):
            raise error
        topic, name = subscription.topic, callback_name(subscription.callback)
        if subscription.on_error == "stop":
            if isinstance(error, SimkitError) and not isinstance(error, InputError):
                raise error  # unchanged, so that the publishing plugin is not blamed
            raise SubscriberError(topic, name, self.now(), cause_text(error)) from error
        subscription.close()
        message = f"subscriber {name} of {topic!r} raised at t={self.now():.6g} s and is closed: {error!r}"
        self._reports.warning("SK-TOPIC-003", message)

    def input_error(self, listener: Listener, error: Exception) -> SimkitError:
        """Return the error for a command input whose callback raised."""
        owner, hook = listener.owner, f"its callback for {listener.topic!r}"
        if hasattr(owner, "where"):
            name = str(getattr(owner, "name", owner))
            return PluginError(name, hook, self.now(), str(owner.where), cause_text(error))
        return SubscriberError(listener.topic, callback_name(listener.callback), self.now(), cause_text(error))

    def report_full(self, topic: str) -> None:
        """Warn that a subscription without `keep` has received more messages than it can keep."""
        message = f"a subscription to {topic!r} is full: only the newest {MAX_KEPT_MESSAGES} messages are kept"
        self._reports.warning("SK-TOPIC-005", message, hint="subscribe with keep=, or close the subscription after use")

    def report_dropped(self, topic: str, depth: int) -> None:
        """Warn that a plugin's input received more messages for one step than its queue can keep."""
        message = f"more than {depth} messages on {topic!r} came for one step: the oldest are dropped from now on"
        hint = "send less often; sim.communication.bus.dropped counts them"
        self._reports.warning("SK-TOPIC-004", message, hint=hint)
