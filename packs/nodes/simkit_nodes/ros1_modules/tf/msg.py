"""Messages of the package `tf`; `tfMessage` is the type of `/tf`."""

from __future__ import annotations

from simkit_nodes.interfaces import ROS1

__all__ = ["tfMessage"]

tfMessage = ROS1.message_class("tf2_msgs/msg/TFMessage")
