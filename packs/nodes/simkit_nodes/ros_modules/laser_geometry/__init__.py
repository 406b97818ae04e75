"""Point clouds of laser scans, as the package `laser_geometry`."""

from __future__ import annotations

from simkit_nodes.ros_modules.laser_geometry.laser_geometry import LaserProjection

__all__ = ["LaserProjection"]
