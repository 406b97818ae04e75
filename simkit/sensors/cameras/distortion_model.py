"""Lens distortion of a pinhole camera: Brown's model and its inverse."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from simkit.elementary_functions import sinh
from simkit.pose import Vector

_WIDEST = 30.0  # tangent of the largest angle off the axis (88 degrees) that is drawn
_ROWS = 64  # rows at once, so that the data fits into a processor's cache


@dataclass(frozen=True, slots=True)
class Distortion:
    """Brown's distortion model, as in OpenCV and `plumb_bob`.

    A point at (x, y) on the plane at distance 1, x to the right and y downwards from the centre, is moved to

        x·(1 + k1·r² + k2·r⁴ + k3·r⁶) + 2·p1·x·y + p2·(r² + 2x²),
        y·(1 + k1·r² + k2·r⁴ + k3·r⁶) + p1·(r² + 2y²) + 2·p2·x·y.

    Attributes:
        centre: centre of the distortion as a fraction of the image's width and height; None is the principal point.
    """

    k1: float = 0.0
    k2: float = 0.0
    k3: float = 0.0
    p1: float = 0.0
    p2: float = 0.0
    centre: tuple[float, float] | None = None

    @property
    def coefficients(self) -> Vector:
        """Coefficients k1, k2, p1, p2, k3, in the order of `CameraInfo` and of OpenCV."""
        return np.array((self.k1, self.k2, self.p1, self.p2, self.k3))

    def __bool__(self) -> bool:
        return bool(self.coefficients.any())


NO_DISTORTION: Final = Distortion()
"""Model without distortion."""


def distort(x: Vector, y: Vector, lens: Distortion) -> tuple[Vector, Vector]:
    """Map points of the undistorted image to the distorted one, both on the plane at distance 1."""
    r2 = x * x + y * y
    radial = 1 + r2 * (lens.k1 + r2 * (lens.k2 + r2 * lens.k3))
    bent_x = x * radial + 2 * lens.p1 * x * y + lens.p2 * (r2 + 2 * x * x)
    return bent_x, y * radial + lens.p1 * (r2 + 2 * y * y) + 2 * lens.p2 * x * y


def undistort(bent_x: Vector, bent_y: Vector, lens: Distortion) -> tuple[Vector, Vector]:
    """Map points of the distorted image to the undistorted one, both on the plane at distance 1.

    Points beyond the radius where the model folds back, and farther than 88 degrees off the axis, are NaN.
    """
    out_x, out_y = np.empty_like(bent_x), np.empty_like(bent_y)
    distorted_radii, radii = _radial_table(lens)
    for first in range(0, len(bent_x), _ROWS):
        rows = slice(first, first + _ROWS)
        out_x[rows], out_y[rows] = _solve(bent_x[rows], bent_y[rows], lens, distorted_radii, radii)
    return out_x, out_y


def _radial_table(lens: Distortion) -> tuple[Vector, Vector]:
    """Return distorted radii in ascending order, and the undistorted radius of each."""
    radii = sinh(np.linspace(0, math.asinh(_WIDEST * 100), 8192)) / 100  # dense at the radii of common images
    r2 = radii * radii
    slope = 1 + r2 * (3 * lens.k1 + r2 * (5 * lens.k2 + r2 * 7 * lens.k3))
    folds = np.flatnonzero(slope <= 0)
    radii = radii[: folds[0]] if len(folds) else radii
    r2 = radii * radii
    return radii * (1 + r2 * (lens.k1 + r2 * (lens.k2 + r2 * lens.k3))), radii


def _solve(
    bent_x: Vector, bent_y: Vector, lens: Distortion, distorted_radii: Vector, radii: Vector
) -> tuple[Vector, Vector]:
    """Invert the distortion by Newton's method in two dimensions, starting from the radial solution of the table."""
    radius = np.hypot(bent_x, bent_y)
    ratio = np.interp(radius, distorted_radii, radii) / np.maximum(radius, 1e-300)
    x, y = bent_x * ratio, bent_y * ratio
    limit = radii[-1]
    with np.errstate(all="ignore"):
        for _ in range(12):
            r2 = x * x + y * y
            radial = 1 + r2 * (lens.k1 + r2 * (lens.k2 + r2 * lens.k3))
            rise = 2 * (lens.k1 + r2 * (2 * lens.k2 + r2 * 3 * lens.k3))
            trial_x, trial_y = distort(x, y, lens)
            error_x, error_y = trial_x - bent_x, trial_y - bent_y
            xx = radial + rise * x * x + 2 * lens.p1 * y + 6 * lens.p2 * x
            yy = radial + rise * y * y + 6 * lens.p1 * y + 2 * lens.p2 * x
            xy = rise * x * y + 2 * lens.p1 * x + 2 * lens.p2 * y
            determinant = xx * yy - xy * xy
            x = np.clip(x - (yy * error_x - xy * error_y) / determinant, -2 * limit, 2 * limit)
            y = np.clip(y - (xx * error_y - xy * error_x) / determinant, -2 * limit, 2 * limit)
            if not np.nanmax(np.maximum(np.abs(error_x), np.abs(error_y)), initial=0.0) > 1e-10:
                break
        is_solved = (np.abs(error_x) + np.abs(error_y) < 1e-7) & (determinant > 0)
        is_solved &= x * x + y * y <= (1.01 * limit) ** 2
    x[~is_solved] = y[~is_solved] = np.nan
    return x, y
