"""Viewpoint of a picture: eye and target from which all given points are in the image."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from simkit.linear_algebra import matmul, norm

Points = NDArray[np.float64]

VERTICAL_FOV: Final = 0.6
"""Opening angle of a picture [rad]: small, so that parallel edges stay nearly parallel."""
MARGIN: Final = 0.075
"""Part of the image's height that is left free at each edge, for the title and the legend."""
_NEAREST: Final = 0.002  # [m] least distance of the eye


@dataclass(frozen=True)
class Camera:
    """Camera of a picture.

    Attributes:
        eye, target: position of the camera and of the point in the middle of the image [m], shape (3,).
        width, height: size of the image [px].
        ceiling: height above which static shapes are not drawn, so that a roof does not hide what is below it [m].
    """

    eye: Points
    target: Points
    width: int
    height: int
    ceiling: float = math.inf

    @property
    def distance(self) -> float:
        """Distance between eye and target [m]."""
        return norm(self.target - self.eye)

    @property
    def pixels_per_metre(self) -> float:
        """Size of a metre at the target [px]."""
        return self.height / (2.0 * math.tan(VERTICAL_FOV / 2) * self.distance)

    def project(self, points: Points) -> tuple[Points, Points]:
        """Return the pixels (x right, y down), shape (n, 2), and the distances along the view [m] of points (n, 3)."""
        axes = view_axes(self.target - self.eye)
        across, up, depth = matmul(axes, (np.atleast_2d(points) - self.eye).T)
        ahead = np.maximum(depth, 1e-9)
        scale = self.height / (2.0 * math.tan(VERTICAL_FOV / 2)) / ahead
        pixels = np.stack((self.width / 2 + across * scale, self.height / 2 - up * scale), axis=1)
        return pixels, depth

    def moved(self, offset: Points) -> Camera:
        """Return the camera, moved by an offset [m]."""
        return replace(self, eye=self.eye + offset, target=self.target + offset)

    def resized(self, width: int, height: int) -> Camera:
        """Return the camera with another image size [px]."""
        return replace(self, width=width, height=height)


def view_axes(view: Points) -> Points:
    """Return the axes of an upright image for a line of sight: right, up and forward, shape (3, 3)."""
    forward = view / max(norm(view), 1e-12)
    right = np.cross(forward, (0.0, 0.0, 1.0))
    if norm(right) < 1e-3:
        right = np.array((0.0, -1.0, 0.0))
    right = right / norm(right)
    return np.array((right, np.cross(right, forward), forward))


def line_of_sight(azimuth: float, elevation: float) -> Points:
    """Return the line of sight of an eye at a direction from the target: `azimuth` and `elevation` [rad]."""
    flat = math.cos(elevation)
    return -np.array((flat * math.cos(azimuth), flat * math.sin(azimuth), math.sin(elevation)))


def frame_points(points: Points, view: Points, width: int, height: int) -> Camera:
    """Return the nearest camera along a line of sight that has all points in the middle part of its image.

    A point at (across, up, depth) from the target is in the image if |across| and |up| are at most the tangents of half
    the opening angles times its distance along the view. So each point gives a least distance of the eye. The target is
    shifted until the least distances of opposite edges are equal.

    Args:
        points: points that must be visible [m], shape (n, 3).
        view: line of sight, shape (3,).
        width: width of the image [px].
        height: height of the image [px].
    """
    axes = view_axes(view)
    target = (points.min(axis=0) + points.max(axis=0)) / 2
    tangent = math.tan(VERTICAL_FOV / 2) / height
    margin = 2.0 * MARGIN * height
    distance = 0.0
    for axis, size in ((0, max(width - margin, 0.5 * width)), (1, height - margin)):
        half = tangent * size
        position, depth = matmul(points - target, axes[axis]), matmul(points - target, axes[2])
        high, low = float((position / half - depth).max()), float((-position / half - depth).max())
        target = target + axes[axis] * half * (high - low) / 2
        distance = max(distance, (high + low) / 2)
    return Camera(target - max(distance, _NEAREST) * axes[2], target, width, height)
