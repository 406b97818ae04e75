"""Callbacks for messages that belong together, as the ROS 1 package `message_filters`."""

from __future__ import annotations

from typing import Any

from simkit_nodes.interfaces import ProgramMessage
from simkit_nodes.ros1_modules import rospy
from simkit_nodes.ros_modules.message_filters import (
    ApproximateTimeSynchronizer,
    Cache,
    SimpleFilter,
    TimeSynchronizer,
)

__all__ = ["ApproximateTimeSynchronizer", "Cache", "SimpleFilter", "Subscriber", "TimeSynchronizer"]


class Subscriber(SimpleFilter):
    """Subscriber as a source of messages.

    Args:
        args: arguments of `rospy.Subscriber` before the callback.
        kwargs: further arguments of `rospy.Subscriber`.
    """

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__()
        self.topic = args[0]
        self.sub = rospy.Subscriber(*args, **{**kwargs, "callback": self.callback})

    def callback(self, msg: ProgramMessage) -> None:
        """Hand a message on."""
        self.signalMessage(msg)

    def getTopic(self) -> str:
        """Return the topic."""
        return str(self.topic)

    def unregister(self) -> None:
        """Stop listening."""
        self.sub.unregister()

    def __getattr__(self, key: str) -> Any:
        if key == "sub":
            raise AttributeError(key)
        return getattr(self.sub, key)
