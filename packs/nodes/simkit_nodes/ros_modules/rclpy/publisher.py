"""Publishers."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from simkit import msgs
from simkit_nodes.host import current_host
from simkit_nodes.interfaces import ROS2, ProgramMessage
from simkit_nodes.ros_modules.rclpy.duration import Duration
from simkit_nodes.ros_modules.rclpy.impl.implementation_singleton import Handle, RCLError

if TYPE_CHECKING:
    from simkit_nodes.graph_topics import GraphPublisher
    from simkit_nodes.ros_modules.rclpy.context import Context
    from simkit_nodes.ros_modules.rclpy.event_handler import EventHandler
    from simkit_nodes.ros_modules.rclpy.qos import QoSProfile

__all__ = ["Publisher"]


class Publisher:
    """Publisher of a topic; see `Node.create_publisher`.

    Attributes:
        msg_type: class of the messages.
        topic: name of the topic as the program has written it.
        qos_profile: quality of service.
        event_handlers: callbacks for events.
    """

    def __init__(
        self,
        publisher_impl: GraphPublisher,
        msg_type: Any,
        topic: str,
        qos_profile: QoSProfile,
        event_handlers: list[EventHandler],
        context: Context,
        logger_name: str = "",
    ) -> None:
        self._graph_publisher, self.msg_type, self.topic, self.qos_profile = (
            publisher_impl,
            msg_type,
            topic,
            qos_profile,
        )
        self.event_handlers, self._context, self._logger_name = event_handlers, context, logger_name
        self._handle, self._host = Handle(), current_host()
        self._to_simkit = ROS2.to_simkit(publisher_impl.type_name)

    @property
    def handle(self) -> Handle:
        """State of the publisher."""
        return self._handle

    @property
    def topic_name(self) -> str:
        """Absolute name of the topic."""
        with self._handle:
            return self._graph_publisher.topic

    @property
    def logger_name(self) -> str:
        """Name of the node's logger."""
        with self._handle:
            return self._logger_name

    def publish(self, msg: ProgramMessage) -> None:
        """Publish a message, or the bytes of a serialised message.

        Raises:
            TypeError: the message has another type.
            InvalidHandle: the publisher is destroyed.
            RCLError: the context has ended.
        """
        with self._handle:
            if isinstance(msg, self.msg_type):
                message = self._to_simkit(msg)
            elif isinstance(msg, bytes):
                message = msgs.deserialize(msg, self._graph_publisher.type_name)
            else:
                raise TypeError(f"Expected {self.msg_type}, got {type(msg)}")
            if not self._context.is_valid:
                raise RCLError("Failed to publish: publisher's context is invalid, at ./src/rcl/publisher.c:423")
            self._host.poll()
            self._graph_publisher.publish(message)

    def get_subscription_count(self) -> int:
        """Return the number of connected subscriptions."""
        with self._handle:
            self._host.poll()
            return self._graph_publisher.matched

    def assert_liveliness(self) -> None:
        """Show that the publisher is alive."""
        with self._handle:
            pass

    def wait_for_all_acked(self, timeout: Duration | None = None) -> bool:
        """Return True: subscriptions receive messages at once."""
        with self._handle:
            return True

    def destroy(self) -> None:
        """Destroy the publisher; see `Node.destroy_publisher`."""
        self._handle.destroy()
        for handler in self.event_handlers:
            handler.destroy()
        self._graph_publisher.close()

    def __enter__(self) -> Publisher:
        return self

    def __exit__(self, *_: object) -> None:
        self.destroy()
