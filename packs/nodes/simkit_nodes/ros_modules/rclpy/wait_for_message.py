"""Wait for one message."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from simkit_nodes.host import current_host
from simkit_nodes.ros_modules.rclpy.utilities import timeout_sec_to_nsec

if TYPE_CHECKING:
    from simkit_nodes.ros_modules.rclpy.node import Node
    from simkit_nodes.ros_modules.rclpy.qos import QoSProfile

__all__ = ["wait_for_message"]


def wait_for_message(
    msg_type: object, node: Node, topic: str, *, qos_profile: QoSProfile | int = 1, time_to_wait: float = -1
) -> tuple[bool, Any]:
    """Wait for the next message of a topic, without spinning.

    Args:
        msg_type: class of the message.
        node: node that subscribes.
        topic: name of the topic.
        qos_profile: quality of service, or the depth of the queue.
        time_to_wait: longest wait [s]; a negative number for no limit.

    Returns:
        True and the message, or False and None.
    """
    host, context = current_host(), node.context
    timeout_ns = timeout_sec_to_nsec(time_to_wait)
    end_ns = None if timeout_ns < 0 else host.now_ns() + timeout_ns
    subscription = node.create_subscription(msg_type, topic, lambda _: None, qos_profile)
    source = subscription._graph_subscription
    source.wake_always()
    try:
        while context.is_valid and not source.has_message and (end_ns is None or host.now_ns() < end_ns):
            host.wait(end_ns, lambda: source.has_message or not context.is_valid)
        taken = subscription.take_message()
    finally:
        node.destroy_subscription(subscription)
    return (False, None) if taken is None else (True, taken[0])
