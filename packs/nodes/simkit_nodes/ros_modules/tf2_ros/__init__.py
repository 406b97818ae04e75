"""Transforms between frames, as the ROS 2 package `tf2_ros`."""

from __future__ import annotations

from simkit_nodes.interfaces import ROS2
from simkit_nodes.ros_modules.rclpy.duration import Duration
from simkit_nodes.ros_modules.rclpy.time import Time
from simkit_nodes.ros_modules.tf2_py import (
    BufferCore,
    ConnectivityException,
    ExtrapolationException,
    InvalidArgumentException,
    LookupException,
    TimeoutException,
    TransformException,
)
from simkit_nodes.ros_modules.tf2_ros.buffer import Buffer
from simkit_nodes.ros_modules.tf2_ros.buffer_interface import (
    BufferInterface,
    ConvertRegistration,
    NotImplementedException,
    Stamped,
    TransformRegistration,
    TypeException,
    convert,
)
from simkit_nodes.ros_modules.tf2_ros.static_transform_broadcaster import StaticTransformBroadcaster
from simkit_nodes.ros_modules.tf2_ros.transform_broadcaster import TransformBroadcaster
from simkit_nodes.ros_modules.tf2_ros.transform_listener import TransformListener

__all__ = [
    "Buffer",
    "BufferCore",
    "BufferInterface",
    "ConnectivityException",
    "ConvertRegistration",
    "Duration",
    "ExtrapolationException",
    "InvalidArgumentException",
    "LookupException",
    "NotImplementedException",
    "Stamped",
    "StaticTransformBroadcaster",
    "TFMessage",
    "Time",
    "TimeoutException",
    "TransformBroadcaster",
    "TransformException",
    "TransformListener",
    "TransformRegistration",
    "TransformStamped",
    "TypeException",
    "convert",
]

TransformStamped = ROS2.message_class("geometry_msgs/msg/TransformStamped")
TFMessage = ROS2.message_class("tf2_msgs/msg/TFMessage")
