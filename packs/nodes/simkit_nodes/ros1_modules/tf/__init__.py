"""Transforms between frames, as the ROS 1 package `tf`."""

from __future__ import annotations

from simkit_nodes.ros1_modules.tf.broadcaster import TransformBroadcaster
from simkit_nodes.ros1_modules.tf.listener import Transformer, TransformerROS, TransformListener
from simkit_nodes.ros1_modules.tf2_py import ConnectivityException, ExtrapolationException, LookupException
from simkit_nodes.ros1_modules.tf2_py import TransformException as Exception

__all__ = [
    "ConnectivityException",
    "Exception",
    "ExtrapolationException",
    "LookupException",
    "TransformBroadcaster",
    "TransformListener",
    "Transformer",
    "TransformerROS",
]
