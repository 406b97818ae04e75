"""Transforms between frames, as the ROS 1 package `tf2_ros`."""

from __future__ import annotations

from simkit_nodes.ros1_modules.tf2_py import (
    BufferCore,
    ConnectivityException,
    ExtrapolationException,
    InvalidArgumentException,
    LookupException,
    TimeoutException,
    TransformException,
)
from simkit_nodes.ros1_modules.tf2_ros.buffer import Buffer
from simkit_nodes.ros1_modules.tf2_ros.static_transform_broadcaster import StaticTransformBroadcaster
from simkit_nodes.ros1_modules.tf2_ros.transform_broadcaster import TransformBroadcaster
from simkit_nodes.ros1_modules.tf2_ros.transform_listener import TransformListener
from simkit_nodes.ros_modules.tf2_ros.buffer_interface import (
    BufferInterface,
    ConvertRegistration,
    NotImplementedException,
    TransformRegistration,
    TypeException,
    convert,
)

__all__ = [
    "Buffer",
    "BufferCore",
    "BufferInterface",
    "ConnectivityException",
    "ConvertRegistration",
    "ExtrapolationException",
    "InvalidArgumentException",
    "LookupException",
    "NotImplementedException",
    "StaticTransformBroadcaster",
    "TimeoutException",
    "TransformBroadcaster",
    "TransformException",
    "TransformListener",
    "TransformRegistration",
    "TypeException",
    "convert",
]
