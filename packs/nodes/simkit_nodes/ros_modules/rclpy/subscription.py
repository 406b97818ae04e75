"""Subscriptions."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from enum import Enum
from typing import TYPE_CHECKING, Any

from simkit import msgs
from simkit_nodes.interfaces import ROS2
from simkit_nodes.ros_modules.rclpy.executors import await_or_execute
from simkit_nodes.ros_modules.rclpy.impl.implementation_singleton import Handle
from simkit_nodes.ros_modules.rclpy.waitable import ExecutorEntity

if TYPE_CHECKING:
    from simkit_nodes.graph_topics import GraphSubscription
    from simkit_nodes.ros_modules.rclpy.callback_groups import CallbackGroup
    from simkit_nodes.ros_modules.rclpy.event_handler import EventHandler
    from simkit_nodes.ros_modules.rclpy.qos import QoSProfile

__all__ = ["Subscription"]


class Subscription(ExecutorEntity):
    """Subscription of a topic; see `Node.create_subscription`.

    Attributes:
        msg_type: class of the messages.
        topic: name of the topic as the program has written it.
        qos_profile: quality of service.
        raw: True if the callback receives the bytes of each message.
        event_handlers: callbacks for events.
    """

    class CallbackType(Enum):
        """Arguments of the callback."""

        MessageOnly = 0
        WithMessageInfo = 1

    def __init__(
        self,
        subscription_impl: GraphSubscription,
        msg_type: object,
        topic: str,
        callback: Callable[..., object],
        callback_group: CallbackGroup,
        qos_profile: QoSProfile,
        raw: bool,
        event_handlers: list[EventHandler],
        logger_name: str = "",
    ) -> None:
        self._graph_subscription, self.msg_type, self.topic = subscription_impl, msg_type, topic
        self.callback_group, self.qos_profile, self.raw = callback_group, qos_profile, raw
        self.callback = callback
        self.event_handlers, self._logger_name = event_handlers, logger_name
        self._handle = Handle()
        self._to_program = ROS2.to_program(subscription_impl.type_name)

    @property
    def handle(self) -> Handle:
        """State of the subscription."""
        return self._handle

    @property
    def topic_name(self) -> str:
        """Absolute name of the topic."""
        with self._handle:
            return self._graph_subscription.topic

    @property
    def logger_name(self) -> str:
        """Name of the node's logger."""
        with self._handle:
            return self._logger_name

    def get_publisher_count(self) -> int:
        """Return the number of connected publishers."""
        with self._handle:
            return self._graph_subscription.matched

    @property
    def callback(self) -> Callable[..., object]:
        """Function or coroutine function that receives a message, or a message and what is known about it."""
        return self._callback

    @callback.setter
    def callback(self, value: Callable[..., object]) -> None:
        self._callback, self._callback_type = value, callback_type_of(value)

    def destroy(self) -> None:
        """Destroy the subscription; see `Node.destroy_subscription`."""
        self._handle.destroy()
        for handler in self.event_handlers:
            handler.destroy()
        self._graph_subscription.close()

    def __enter__(self) -> Subscription:
        return self

    def __exit__(self, *_: object) -> None:
        self.destroy()

    def take_message(self) -> tuple[Any, dict[str, int | None]] | None:
        """Return the oldest message that waits, and what is known about it; None without a message."""
        taken = self._graph_subscription.take()
        if taken is None:
            return None
        message, received = taken
        info = {
            "source_timestamp": received.source_ns,
            "received_timestamp": received.received_ns,
            "publication_sequence_number": received.number,
            "reception_sequence_number": None,
        }
        return msgs.serialize(message) if self.raw else self._to_program(message), info

    def _is_ready(self) -> bool:
        return bool(self._handle) and self._graph_subscription.has_message

    def _take(self) -> Any:
        taken = self.take_message() if self._handle else None
        if taken is None or self._callback_type is Subscription.CallbackType.WithMessageInfo:
            return taken
        return taken[:1]

    async def _execute(self, data: Any) -> None:
        await await_or_execute(self._callback, *data)


def callback_type_of(callback: Callable[..., object]) -> Subscription.CallbackType:
    """Return what a callback receives.

    Raises:
        RuntimeError: the callback takes neither one nor two arguments.
    """
    for kind, arguments in zip(Subscription.CallbackType, ((None,), (None, None)), strict=True):
        try:
            inspect.signature(callback).bind(*arguments)
        except TypeError:
            continue
        return kind
    raise RuntimeError(
        "Subscription.__init__(): callback should be either be callable with one argument"
        "(to get only the message) or two (to get message and message info)"
    )
