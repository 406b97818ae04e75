"""Images of ROS as arrays of OpenCV, as the package `cv_bridge`."""

from __future__ import annotations

from simkit_nodes.ros_modules.cv_bridge.boost.cv_bridge_boost import getCvType
from simkit_nodes.ros_modules.cv_bridge.core import CvBridge, CvBridgeError

__all__ = ["CvBridge", "CvBridgeError", "getCvType"]
