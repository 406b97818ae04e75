"""Events of publishers and subscriptions, such as an incompatible quality of service."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from enum import IntEnum
from typing import TYPE_CHECKING, Any, Final

from simkit_nodes.ros_modules.rclpy.executors import await_or_execute
from simkit_nodes.ros_modules.rclpy.impl.implementation_singleton import Handle, UnsupportedEventTypeError
from simkit_nodes.ros_modules.rclpy.logging import get_logger
from simkit_nodes.ros_modules.rclpy.qos import QoSPolicyKind, qos_policy_name_from_kind
from simkit_nodes.ros_modules.rclpy.waitable import Waitable

if TYPE_CHECKING:
    from simkit_nodes.graph_topics import EventKind
    from simkit_nodes.qos import Policy
    from simkit_nodes.ros_modules.rclpy.callback_groups import CallbackGroup

__all__ = [
    "EventHandler",
    "IncompatibleTypeInfo",
    "PublisherEventCallbacks",
    "QoSEventHandler",
    "QoSLivelinessChangedInfo",
    "QoSLivelinessLostInfo",
    "QoSMessageLostInfo",
    "QoSOfferedDeadlineMissedInfo",
    "QoSOfferedIncompatibleQoSInfo",
    "QoSPublisherEventType",
    "QoSPublisherMatchedInfo",
    "QoSRequestedDeadlineMissedInfo",
    "QoSRequestedIncompatibleQoSInfo",
    "QoSSubscriptionEventType",
    "QoSSubscriptionMatchedInfo",
    "SubscriptionEventCallbacks",
    "UnsupportedEventTypeError",
]


class QoSPublisherEventType(IntEnum):
    """Kinds of events of a publisher."""

    RCL_PUBLISHER_OFFERED_DEADLINE_MISSED = 0
    RCL_PUBLISHER_LIVELINESS_LOST = 1
    RCL_PUBLISHER_OFFERED_INCOMPATIBLE_QOS = 2
    RCL_PUBLISHER_INCOMPATIBLE_TYPE = 3
    RCL_PUBLISHER_MATCHED = 4


class QoSSubscriptionEventType(IntEnum):
    """Kinds of events of a subscription."""

    RCL_SUBSCRIPTION_REQUESTED_DEADLINE_MISSED = 0
    RCL_SUBSCRIPTION_LIVELINESS_CHANGED = 1
    RCL_SUBSCRIPTION_REQUESTED_INCOMPATIBLE_QOS = 2
    RCL_SUBSCRIPTION_MESSAGE_LOST = 3
    RCL_SUBSCRIPTION_INCOMPATIBLE_TYPE = 4
    RCL_SUBSCRIPTION_MATCHED = 5


@dataclass(frozen=True)
class _CountInfo:
    """Number of events, and how many of them are new.

    Attributes:
        total_count: number of events since the beginning.
        total_count_change: number of events since the last callback.
    """

    total_count: int = 0
    total_count_change: int = 0


class QoSRequestedDeadlineMissedInfo(_CountInfo):
    """Missed deadlines of a subscription."""


class QoSOfferedDeadlineMissedInfo(_CountInfo):
    """Missed deadlines of a publisher."""


class QoSLivelinessLostInfo(_CountInfo):
    """Losses of the liveliness of a publisher."""


class QoSMessageLostInfo(_CountInfo):
    """Lost messages."""


class IncompatibleTypeInfo(_CountInfo):
    """Publishers or subscriptions of another type."""


@dataclass(frozen=True)
class QoSRequestedIncompatibleQoSInfo(_CountInfo):
    """Publishers or subscriptions with an incompatible quality of service.

    Attributes:
        last_policy_kind: policy that did not fit last.
    """

    last_policy_kind: QoSPolicyKind = QoSPolicyKind.INVALID


QoSOfferedIncompatibleQoSInfo = QoSRequestedIncompatibleQoSInfo


@dataclass(frozen=True)
class _MatchedInfo(_CountInfo):
    """Connected publishers or subscriptions.

    Attributes:
        current_count: number of connections.
        current_count_change: change of the number since the last callback.
    """

    current_count: int = 0
    current_count_change: int = 0


class QoSSubscriptionMatchedInfo(_MatchedInfo):
    """Publishers that are connected with a subscription."""


class QoSPublisherMatchedInfo(_MatchedInfo):
    """Subscriptions that are connected with a publisher."""


@dataclass(frozen=True)
class QoSLivelinessChangedInfo:
    """Publishers of a subscription that are alive.

    Attributes:
        alive_count: number of publishers that are alive.
        not_alive_count: number of publishers that are not alive.
        alive_count_change: change of the first number since the last callback.
        not_alive_count_change: change of the second number since the last callback.
    """

    alive_count: int = 0
    not_alive_count: int = 0
    alive_count_change: int = 0
    not_alive_count_change: int = 0


_INFO_OF_EVENT: Final[dict[str, Any]] = {
    "RCL_PUBLISHER_OFFERED_DEADLINE_MISSED": QoSOfferedDeadlineMissedInfo,
    "RCL_PUBLISHER_LIVELINESS_LOST": QoSLivelinessLostInfo,
    "RCL_PUBLISHER_OFFERED_INCOMPATIBLE_QOS": QoSOfferedIncompatibleQoSInfo,
    "RCL_PUBLISHER_INCOMPATIBLE_TYPE": IncompatibleTypeInfo,
    "RCL_PUBLISHER_MATCHED": QoSPublisherMatchedInfo,
    "RCL_SUBSCRIPTION_REQUESTED_DEADLINE_MISSED": QoSRequestedDeadlineMissedInfo,
    "RCL_SUBSCRIPTION_LIVELINESS_CHANGED": QoSLivelinessChangedInfo,
    "RCL_SUBSCRIPTION_REQUESTED_INCOMPATIBLE_QOS": QoSRequestedIncompatibleQoSInfo,
    "RCL_SUBSCRIPTION_MESSAGE_LOST": QoSMessageLostInfo,
    "RCL_SUBSCRIPTION_INCOMPATIBLE_TYPE": IncompatibleTypeInfo,
    "RCL_SUBSCRIPTION_MATCHED": QoSSubscriptionMatchedInfo,
}


class EventSource:
    """Events of one publisher or subscription, which the graph reports."""

    def __init__(self) -> None:
        self._handlers: list[EventHandler] = []

    def add(self, handler: EventHandler) -> None:
        """Add a handler."""
        self._handlers.append(handler)

    def report(self, kind: EventKind, policy: Policy | None) -> None:
        """Pass an event to the handlers."""
        for handler in self._handlers:
            handler.report(kind, policy)


class EventHandler(Waitable):
    """Callback for one kind of events.

    Args:
        callback_group: callback group.
        callback: function or coroutine function that receives what has happened.
        event_type: kind of the events.
        parent_impl: events of the publisher or subscription.
    """

    def __init__(
        self,
        *,
        callback_group: CallbackGroup,
        callback: Callable[[Any], object],
        event_type: IntEnum,
        parent_impl: EventSource,
    ) -> None:
        super().__init__(callback_group)
        self.event_type, self.callback = event_type, callback
        self._info: Any = _INFO_OF_EVENT[event_type.name]()
        self._has_news = False
        self._handle = Handle()
        self._wake: Callable[[], None] = lambda: None
        parent_impl.add(self)

    def report(self, kind: EventKind, policy: Policy | None) -> None:
        """Count an event, if it is of the handler's kind."""
        info = self._info
        change = 1 if kind == "matched" else -1
        if isinstance(info, _MatchedInfo) and kind in ("matched", "unmatched"):
            new, count = max(0, change), info.current_count + change
            info = replace(info, current_count=count, current_count_change=info.current_count_change + change)
        elif isinstance(info, QoSLivelinessChangedInfo) and kind in ("matched", "unmatched"):
            count, changed = info.alive_count + change, info.alive_count_change + change
            self._set(replace(info, alive_count=count, alive_count_change=changed))
            return
        elif isinstance(info, QoSRequestedIncompatibleQoSInfo) and kind == "incompatible_qos" and policy is not None:
            new, info = 1, replace(info, last_policy_kind=QoSPolicyKind[policy])
        elif (isinstance(info, IncompatibleTypeInfo) and kind == "incompatible_type") or (
            isinstance(info, (QoSOfferedDeadlineMissedInfo, QoSRequestedDeadlineMissedInfo)) and kind == "deadline"
        ):
            new = 1
        else:
            return
        self._set(replace(info, total_count=info.total_count + new, total_count_change=info.total_count_change + new))

    def _set(self, info: object) -> None:
        self._info, self._has_news = info, True
        self._wake()

    def is_ready(self, wait_set: object) -> bool:
        """Check whether there are new events."""
        return self._has_news

    def _is_ready(self) -> bool:
        return self._has_news  # a node has three for each topic, and executors ask each one at each callback

    def take_data(self) -> Any:
        """Return what has happened since the last callback."""
        info, self._has_news = self._info, False
        changes = {name: 0 for name in info.__dataclass_fields__ if name.endswith("_change")}
        self._info = replace(info, **changes)
        return info

    async def execute(self, taken_data: object) -> None:
        """Call the callback."""
        await await_or_execute(self.callback, taken_data)

    def destroy(self) -> None:
        """Destroy the handler."""
        self._handle.is_destroyed = True
        self._has_news = False


class QoSEventHandler(EventHandler):
    """Name of `EventHandler` in early distributions."""


def _handlers(
    group: CallbackGroup, source: EventSource, callbacks: list[tuple[IntEnum, Callable[[Any], object] | None]]
) -> list[EventHandler]:
    return [
        EventHandler(callback_group=group, callback=callback, event_type=kind, parent_impl=source)
        for kind, callback in callbacks
        if callback is not None
    ]


class SubscriptionEventCallbacks:
    """Callbacks for the events of a subscription.

    Args:
        deadline: function for missed deadlines.
        incompatible_qos: function for publishers with an incompatible quality of service; the default logs a warning.
        liveliness: function for changes of the number of publishers that are alive.
        message_lost: function for lost messages; none are lost.
        incompatible_type: function for publishers of another type; the default logs a warning.
        matched: function for new and lost connections with publishers.
        use_default_callbacks: False for no warnings.
    """

    def __init__(
        self,
        *,
        deadline: Callable[[Any], object] | None = None,
        incompatible_qos: Callable[[Any], object] | None = None,
        liveliness: Callable[[Any], object] | None = None,
        message_lost: Callable[[Any], object] | None = None,
        incompatible_type: Callable[[Any], object] | None = None,
        matched: Callable[[Any], object] | None = None,
        use_default_callbacks: bool = True,
    ) -> None:
        self.deadline, self.incompatible_qos, self.liveliness = deadline, incompatible_qos, liveliness
        self.message_lost, self.incompatible_type, self.matched = message_lost, incompatible_type, matched
        self.use_default_callbacks = use_default_callbacks

    def create_event_handlers(
        self, callback_group: CallbackGroup, subscription: EventSource, topic_name: str, logger_name: str = "rclpy"
    ) -> list[EventHandler]:
        """Return the handlers of the callbacks."""

        def warn_of_qos(event: Any) -> None:
            get_logger(logger_name).warning(
                f"New publisher discovered on topic '{topic_name}', offering incompatible QoS. "
                "No messages will be received from it. "
                f"Last incompatible policy: {qos_policy_name_from_kind(event.last_policy_kind)}"
            )

        def warn_of_type(event: object) -> None:
            get_logger(logger_name).warning(
                f"Incompatible type on topic '{topic_name}', no messages will be sent to it."
            )

        has_defaults = self.use_default_callbacks
        kind = QoSSubscriptionEventType
        return _handlers(
            callback_group,
            subscription,
            [
                (kind.RCL_SUBSCRIPTION_REQUESTED_DEADLINE_MISSED, self.deadline),
                (
                    kind.RCL_SUBSCRIPTION_REQUESTED_INCOMPATIBLE_QOS,
                    self.incompatible_qos or (warn_of_qos if has_defaults else None),
                ),
                (kind.RCL_SUBSCRIPTION_LIVELINESS_CHANGED, self.liveliness),
                (kind.RCL_SUBSCRIPTION_MESSAGE_LOST, self.message_lost),
                (
                    kind.RCL_SUBSCRIPTION_INCOMPATIBLE_TYPE,
                    self.incompatible_type or (warn_of_type if has_defaults else None),
                ),
                (kind.RCL_SUBSCRIPTION_MATCHED, self.matched),
            ],
        )


class PublisherEventCallbacks:
    """Callbacks for the events of a publisher.

    Args:
        deadline: function for missed deadlines.
        liveliness: function for losses of the liveliness.
        incompatible_qos: function for subscriptions with an incompatible quality of service; the default logs a
            warning.
        incompatible_type: function for subscriptions of another type; the default logs a warning.
        matched: function for new and lost connections with subscriptions.
        use_default_callbacks: False for no warnings.
    """

    def __init__(
        self,
        *,
        deadline: Callable[[Any], object] | None = None,
        liveliness: Callable[[Any], object] | None = None,
        incompatible_qos: Callable[[Any], object] | None = None,
        incompatible_type: Callable[[Any], object] | None = None,
        matched: Callable[[Any], object] | None = None,
        use_default_callbacks: bool = True,
    ) -> None:
        self.deadline, self.liveliness, self.incompatible_qos = deadline, liveliness, incompatible_qos
        self.incompatible_type, self.matched = incompatible_type, matched
        self.use_default_callbacks = use_default_callbacks

    def create_event_handlers(
        self, callback_group: CallbackGroup, publisher: EventSource, topic_name: str, logger_name: str = "rclpy"
    ) -> list[EventHandler]:
        """Return the handlers of the callbacks."""

        def warn_of_qos(event: Any) -> None:
            get_logger(logger_name).warning(
                f"New subscription discovered on topic '{topic_name}', requesting incompatible QoS. "
                "No messages will be sent to it. "
                f"Last incompatible policy: {qos_policy_name_from_kind(event.last_policy_kind)}"
            )

        def warn_of_type(event: object) -> None:
            get_logger(logger_name).warning(
                f"Incompatible type on topic '{topic_name}', no messages will be sent to it."
            )

        has_defaults = self.use_default_callbacks
        kind = QoSPublisherEventType
        return _handlers(
            callback_group,
            publisher,
            [
                (kind.RCL_PUBLISHER_OFFERED_DEADLINE_MISSED, self.deadline),
                (kind.RCL_PUBLISHER_LIVELINESS_LOST, self.liveliness),
                (
                    kind.RCL_PUBLISHER_OFFERED_INCOMPATIBLE_QOS,
                    self.incompatible_qos or (warn_of_qos if has_defaults else None),
                ),
                (
                    kind.RCL_PUBLISHER_INCOMPATIBLE_TYPE,
                    self.incompatible_type or (warn_of_type if has_defaults else None),
                ),
                (kind.RCL_PUBLISHER_MATCHED, self.matched),
            ],
        )
