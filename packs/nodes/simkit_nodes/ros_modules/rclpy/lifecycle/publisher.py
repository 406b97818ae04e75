"""Publishers of lifecycle nodes."""

from __future__ import annotations

from typing import Any

from simkit_nodes.interfaces import ProgramMessage
from simkit_nodes.ros_modules.rclpy.lifecycle.managed_entity import SimpleManagedEntity
from simkit_nodes.ros_modules.rclpy.publisher import Publisher

__all__ = ["LifecyclePublisher"]


class LifecyclePublisher(SimpleManagedEntity, Publisher):
    """Publisher that publishes only while its node is active."""

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        SimpleManagedEntity.__init__(self)
        Publisher.__init__(self, *args, **kwargs)

    def publish(self, msg: ProgramMessage) -> None:
        """Publish a message if the node is active."""
        if self.is_activated:
            Publisher.publish(self, msg)
