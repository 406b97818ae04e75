"""Models of cameras, as the package `image_geometry`."""

from __future__ import annotations

from simkit_nodes.ros_modules.image_geometry.cameramodels import PinholeCameraModel, StereoCameraModel

__all__ = ["PinholeCameraModel", "StereoCameraModel"]
