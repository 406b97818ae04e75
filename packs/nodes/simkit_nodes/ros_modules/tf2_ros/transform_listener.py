"""Listener that stores the transforms of `/tf` and `/tf_static` in a buffer."""

from __future__ import annotations

from typing import Any, Final

from simkit_nodes.host import current_host
from simkit_nodes.interfaces import ROS2
from simkit_nodes.ros_modules.rclpy.callback_groups import ReentrantCallbackGroup
from simkit_nodes.ros_modules.rclpy.executors import SingleThreadedExecutor
from simkit_nodes.ros_modules.rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile
from simkit_nodes.ros_modules.tf2_ros.buffer import Buffer

__all__ = ["DEFAULT_STATIC_TF_TOPIC", "DEFAULT_TF_TOPIC", "TransformListener"]

DEFAULT_TF_TOPIC: Final = "/tf"
DEFAULT_STATIC_TF_TOPIC: Final = "/tf_static"

_TFMessage = ROS2.message_class("tf2_msgs/msg/TFMessage")


class TransformListener:
    """Listener of transforms.

    Args:
        buffer: buffer that stores the transforms.
        node: node that subscribes.
        spin_thread: execute the node's callbacks in a thread of the listener.
        qos: quality of service for `tf_topic`.
        static_qos: quality of service for `tf_static_topic`.
        tf_topic: topic of transforms that change.
        tf_static_topic: topic of transforms that do not change.
    """

    def __init__(
        self,
        buffer: Buffer,
        node: Any,
        *,
        spin_thread: bool = False,
        qos: Any = None,
        static_qos: Any = None,
        tf_topic: str = DEFAULT_TF_TOPIC,
        tf_static_topic: str = DEFAULT_STATIC_TF_TOPIC,
    ) -> None:
        if qos is None:
            qos = QoSProfile(depth=100, durability=DurabilityPolicy.VOLATILE, history=HistoryPolicy.KEEP_LAST)
        if static_qos is None:
            static_qos = QoSProfile(
                depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL, history=HistoryPolicy.KEEP_LAST
            )
        self.buffer, self.node = buffer, node
        self.group = ReentrantCallbackGroup()  # other callbacks of the node may wait for a transform
        self.tf_sub = node.create_subscription(_TFMessage, tf_topic, self.callback, qos, callback_group=self.group)
        self.tf_static_sub = node.create_subscription(
            _TFMessage, tf_static_topic, self.static_callback, static_qos, callback_group=self.group
        )
        if spin_thread:
            self.executor = SingleThreadedExecutor()
            self.dedicated_listener_thread = current_host().start_thread(self._spin, "tf2_ros listener")

    def _spin(self) -> None:
        self.executor.add_node(self.node)
        self.executor.spin()
        self.executor.remove_node(self.node)

    def unregister(self) -> None:
        """End both subscriptions."""
        self.node.destroy_subscription(self.tf_sub)
        self.node.destroy_subscription(self.tf_static_sub)

    def callback(self, data: Any) -> None:
        """Store transforms of `/tf`."""
        for transform in data.transforms:
            self.buffer.set_transform(transform, "default_authority")

    def static_callback(self, data: Any) -> None:
        """Store transforms of `/tf_static`."""
        for transform in data.transforms:
            self.buffer.set_transform_static(transform, "default_authority")
