"""Publishers and subscribers of rospy.

Each subscriber has a thread for its callbacks, as rospy has one for each connection.
"""

from __future__ import annotations

import traceback
import warnings
from collections import deque
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any, Final

from simkit_nodes.interfaces import ROS1, ProgramMessage, type_name_of
from simkit_nodes.interfaces.ros1_bytes import message_bytes
from simkit_nodes.interfaces.ros1_message import Message, SerializationError
from simkit_nodes.interfaces.ros1_messages import ros1_name
from simkit_nodes.qos import Qos
from simkit_nodes.ros1_modules.rospy.exceptions import ROSException, ROSSerializationException
from simkit_nodes.ros1_modules.rospy.log import logerr
from simkit_nodes.ros1_modules.rospy.msg import AnyMsg, args_kwds_to_message
from simkit_nodes.ros1_modules.rospy.ros_node import RosNode, ros_node

if TYPE_CHECKING:
    from simkit_nodes.graph_topics import GraphPublisher, GraphSubscription

__all__ = ["Message", "Publisher", "SubscribeListener", "Subscriber", "Topic"]

DEFAULT_BUFF_SIZE: Final = 65536


class SubscribeListener:
    """Base of objects that hear of new subscribers of a publisher."""

    def peer_subscribe(
        self, topic_name: str, topic_publish: Callable[[Any], object], peer_publish: Callable[[Any], object]
    ) -> None:
        """Receive a new subscriber.

        Args:
            topic_name: global name of the topic.
            topic_publish: function that publishes a message to all subscribers.
            peer_publish: function that publishes a message for the new subscriber.
        """

    def peer_unsubscribe(self, topic_name: str, num_peers: int) -> None:
        """Receive the end of a subscriber, and the number of those that remain."""


class Topic:
    """Base of publishers and subscribers.

    Attributes:
        name: name of the topic as the program has written it.
        resolved_name: global name of the topic.
        data_class: class of the messages.
        type: type of the messages, such as `geometry_msgs/Twist`.
        md5sum: sum of the definition; simkit does not compute it.
    """

    def __init__(self, name: str, data_class: type[Any]) -> None:
        if not name or not isinstance(name, str):
            raise ValueError("topic name is not a non-empty string")
        if data_class is None:
            raise ValueError("topic parameter 'data_class' is not initialized")
        if not isinstance(data_class, type):
            raise ValueError(f"data_class [{data_class}] is not a class")
        if not issubclass(data_class, Message):
            raise ValueError(f"data_class [{data_class.__class__.__name__}] is not a message data class")
        self._node: RosNode = ros_node()
        self.name, self.resolved_name = name, self._node.resolve_endpoint(name)
        self.data_class, self.type, self.md5sum = data_class, data_class._type, "*"
        self._end: GraphPublisher | GraphSubscription | None = None
        self._is_closed = False

    def get_num_connections(self) -> int:
        """Return the number of connections to the other side of the topic."""
        self._node.poll()
        return self._end.matched if self._end is not None else 0

    def unregister(self) -> None:
        """Close this side of the topic."""
        self._is_closed = True
        if self._end is not None:
            self._end.close()
            self._end = None


class Publisher(Topic):
    """Publisher of a topic.

    Args:
        name: name of the topic.
        data_class: class of the messages.
        subscriber_listener: object that hears of new subscribers.
        tcp_nodelay: accepted as in rospy.
        latch: True if a new subscriber gets the last message.
        headers: accepted as in rospy.
        queue_size: accepted as in rospy; a message is sent at once.
    """

    def __init__(
        self,
        name: str,
        data_class: type[Any],
        subscriber_listener: SubscribeListener | None = None,
        tcp_nodelay: bool = False,
        latch: bool = False,
        headers: dict[str, str] | None = None,
        queue_size: int | None = None,
    ) -> None:
        super().__init__(name, data_class)
        if queue_size is None:
            text = (
                "The publisher should be created with an explicit keyword argument 'queue_size'. Please see "
                "http://wiki.ros.org/rospy/Overview/Publishers%20and%20Subscribers for more information."
            )
            warnings.warn(text, SyntaxWarning, stacklevel=2)
        self._listener, self._is_latched, self._seq = subscriber_listener, latch, 0
        self._to_simkit = None if data_class is AnyMsg else ROS1.to_simkit(type_name_of(data_class))
        self._node.at_init(self._open)

    def _open(self) -> None:
        if self._is_closed or self._to_simkit is None:
            return
        qos = Qos(is_transient_local=self._is_latched, depth=1 if self._is_latched else None)
        kind = type_name_of(self.data_class)
        if self._listener is None:
            self._end = self._node.graph_node.advertise(self.resolved_name, kind, qos)
        else:
            events: deque[str] = deque()
            on_event = partial(self._store_event, events)
            self._end = self._node.graph_node.advertise(self.resolved_name, kind, qos, on_event)
            self._node.start_thread(partial(self._tell, self._listener, events), f"listener {self.resolved_name}")

    def _store_event(self, events: deque[str], kind: str, policy: object) -> None:
        if kind in ("matched", "unmatched"):
            events.append(kind)
            self._node.host.wake()

    def _tell(self, listener: SubscribeListener, events: deque[str]) -> None:
        """Tell the listener of each new subscriber; the function of a thread."""
        while not self._node.is_shutdown and not self._is_closed:
            if not events:
                self._node.wait(None, lambda: self._is_closed or bool(events))
            elif events.popleft() == "matched":
                listener.peer_subscribe(self.resolved_name, self.publish, self.publish)
            else:
                listener.peer_unsubscribe(self.resolved_name, self.get_num_connections())

    def publish(self, *args: object, **kwds: object) -> None:
        """Publish a message, or a new one of the arguments.

        Raises:
            ROSException: the node has no name yet, or the publisher is closed.
            ROSSerializationException: a field has a value that its type does not have.
        """
        node = self._node
        node.poll()
        if node.is_shutdown:
            return
        if self._is_closed:
            raise ROSException("publish() to an unregistered() handle")
        if not node.is_initialized:
            raise ROSException("ROS node has not been initialized yet. Please call init_node() first")
        message = args_kwds_to_message(self.data_class, args, kwds)
        if self._to_simkit is None or self._end is None:
            raise ROSException("a message of any type can be received, but not published")
        if message._has_header:
            self._seq += 1
            message.header.seq = self._seq
        try:
            self._end.publish(self._to_simkit(message))  # type: ignore[union-attr]
        except SerializationError as error:
            raise ROSSerializationException(str(error)) from None


class Subscriber(Topic):
    """Subscriber of a topic.

    Args:
        name: name of the topic.
        data_class: class of the messages.
        callback: function of each message.
        callback_args: second argument of the function; None for a function without one.
        queue_size: largest number of messages that wait for the function; None for all.
        buff_size: accepted as in rospy.
        tcp_nodelay: accepted as in rospy.

    Attributes:
        callback: function of each message.
        callback_args: its second argument.
    """

    def __init__(
        self,
        name: str,
        data_class: type[Any],
        callback: Callable[..., object] | None = None,
        callback_args: object = None,
        queue_size: int | None = None,
        buff_size: int = DEFAULT_BUFF_SIZE,
        tcp_nodelay: bool = False,
    ) -> None:
        super().__init__(name, data_class)
        if queue_size == 0:
            raise ROSException("queue size may not be set to zero")
        if queue_size is not None and type(queue_size) is not int:
            raise ROSException("queue size must be an integer")
        self.callback, self.callback_args, self._seq = callback, callback_args, 0
        self._depth = queue_size if queue_size and queue_size > 0 else None
        self._node.at_init(self._open)

    def _open(self) -> None:
        if self._is_closed:
            return
        # ROS 1 has no policies of quality: a subscriber gets what there is, also the last message of a latched topic.
        qos = Qos(is_reliable=False, is_transient_local=True, accepts_volatile=True, depth=self._depth)
        kind = self._type_name()
        if kind is None:
            self._node.start_thread(self._open_when_typed, f"subscriber {self.resolved_name}")
            return
        self._end = self._node.graph_node.subscribe(self.resolved_name, kind, qos)
        self._node.start_thread(self._call_back, f"subscriber {self.resolved_name}")

    def _type_name(self) -> str | None:
        """Return the type of the topic; None for a message of any type on a topic that has no type yet."""
        if self.data_class is not AnyMsg:
            return type_name_of(self.data_class)
        types = self._node.host.graph.topics().get(self.resolved_name)
        return types[0] if types else None

    def _open_when_typed(self) -> None:
        self._node.wait(None, lambda: self._is_closed or self._type_name() is not None)
        self._open()

    def _call_back(self) -> None:
        """Call the function with each message; the function of the thread."""
        node, end = self._node, self._end
        if end is None:
            return
        subscription: Any = end
        while not node.is_shutdown and not self._is_closed:
            taken = subscription.take()
            if taken is None:
                node.wait(None, lambda: self._is_closed or subscription.has_message)
                continue
            callback = self.callback
            if callback is not None:
                self._call(callback, self._message(subscription, *taken))

    def _message(self, subscription: Any, simkit_message: Any, received: Any) -> Any:
        """Return the message of the program."""
        kind = subscription.type_name
        if self.data_class is AnyMsg:
            message: ProgramMessage = AnyMsg().deserialize(message_bytes(ROS1.to_program(kind)(simkit_message)))
        else:
            message = ROS1.to_program(kind)(simkit_message)
            if message._has_header:
                self._seq += 1
                message.header.seq = received.number or self._seq
            if type(message) is not self.data_class:  # a class that `numpy_msg` has made
                numpy_class: Any = self.data_class
                message = numpy_class.of_message(message)
        publisher = received.publisher
        message._connection_header = {
            "callerid": "/gazebo" if publisher is None else publisher.node.name,
            "latching": "1" if publisher is not None and publisher.qos.is_transient_local else "0",
            "md5sum": "*",
            "message_definition": "",
            "topic": self.resolved_name,
            "type": ros1_name(kind),
        }
        return message

    def _call(self, callback: Callable[..., object], message: object) -> None:
        try:
            if self.callback_args is None:
                callback(message)
            else:
                callback(message, self.callback_args)
        except Exception:  # noqa: BLE001 - as in rospy, the subscriber goes on
            if not self._node.is_shutdown:
                # the name without the address of the object, which differs from run to run
                name = getattr(callback, "__qualname__", type(callback).__name__)
                logerr("bad callback: <function %s>\n%s", name, traceback.format_exc())

    def unregister(self) -> None:
        """Close the subscriber."""
        self.callback = self.callback_args = None
        super().unregister()
        self._node.host.wake()
