"""Package `tf_conversions` of ROS 1: poses as frames of `PyKDL`."""

from __future__ import annotations

from simkit_nodes.ros1_modules.tf_conversions.posemath import (
    fromCameraParams,
    fromMatrix,
    fromMsg,
    fromTf,
    toMatrix,
    toMsg,
    toTf,
)

__all__ = ["fromCameraParams", "fromMatrix", "fromMsg", "fromTf", "toMatrix", "toMsg", "toTf"]
