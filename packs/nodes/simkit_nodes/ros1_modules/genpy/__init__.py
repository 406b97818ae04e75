"""Package `genpy` of ROS 1: base classes of messages, times and durations."""

from __future__ import annotations

from simkit_nodes.interfaces.ros1_message import (
    DeserializationError,
    Message,
    MessageException,
    SerializationError,
)
from simkit_nodes.interfaces.ros1_time import Duration, Time, TVal

__all__ = ["DeserializationError", "Duration", "Message", "MessageException", "SerializationError", "TVal", "Time"]
