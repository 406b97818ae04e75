"""Lens distortion of a pinhole camera: Brown's model, its inverse, and pictures drawn through it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import numpy.typing as npt

from simkit.pose import Vector
from simkit.sensors.cameras.rendering.view import View

if TYPE_CHECKING:
    from simkit.sensors.cameras.camera_model import CameraModel

_WIDEST = 30.0  # tangent of the angle off the axis; what a lens sees beyond (88 degrees) is not drawn
_MOST_DRAWN = 4096  # pixels along an edge of what is drawn
_MOST_TIMES = 4.0  # as many pixels as the picture has
_FINEST = 1.5  # as fine as the picture in its middle
_ROWS = 64  # at once, so that what is worked on fits into a processor's cache
_DENSE = 1.5  # drawn pixels per pixel of the picture from which they are averaged first
_EDGE = 0.01  # of a raw depth: neighbours that differ by more than a plane's do belong to two surfaces


@dataclass(frozen=True, slots=True)
class Distortion:
    """Brown's model, as OpenCV and `plumb_bob` have it.

    A point at (x, y) on the plane at distance 1, x to the right and y downwards from the centre, is seen at

        x·(1 + k1·r² + k2·r⁴ + k3·r⁶) + 2·p1·x·y + p2·(r² + 2x²),
        y·(1 + k1·r² + k2·r⁴ + k3·r⁶) + p1·(r² + 2y²) + 2·p2·x·y.

    Attributes:
        centre: what it is about, as a part of the image's width and height; None is the principal point.
    """

    k1: float = 0.0
    k2: float = 0.0
    k3: float = 0.0
    p1: float = 0.0
    p2: float = 0.0
    centre: tuple[float, float] | None = None

    @property
    def coefficients(self) -> Vector:
        """k1, k2, p1, p2, k3: the order of `CameraInfo` and of OpenCV."""
        return np.array((self.k1, self.k2, self.p1, self.p2, self.k3))

    def __bool__(self) -> bool:
        return bool(self.coefficients.any())


NO_DISTORTION: Final = Distortion()
"""A straight picture."""


def distort(x: Vector, y: Vector, lens: Distortion) -> tuple[Vector, Vector]:
    """Where points of the straight picture are seen in the bent one, both on the plane at distance 1."""
    r2 = x * x + y * y
    radial = 1 + r2 * (lens.k1 + r2 * (lens.k2 + r2 * lens.k3))
    bent_x = x * radial + 2 * lens.p1 * x * y + lens.p2 * (r2 + 2 * x * x)
    return bent_x, y * radial + lens.p1 * (r2 + 2 * y * y) + 2 * lens.p2 * x * y


def undistort(bent_x: Vector, bent_y: Vector, lens: Distortion) -> tuple[Vector, Vector]:
    """Return where points of the distorted picture lie in the undistorted one, on the plane at distance 1.

    Beyond the radius where the model folds back, and farther than 88 degrees off the axis, there is no answer: NaN.
    """
    out_x, out_y = np.empty_like(bent_x), np.empty_like(bent_y)
    seen, straight = _radial_table(lens)
    for first in range(0, len(bent_x), _ROWS):
        rows = slice(first, first + _ROWS)
        out_x[rows], out_y[rows] = _solve(bent_x[rows], bent_y[rows], lens, seen, straight)
    return out_x, out_y


def _radial_table(lens: Distortion) -> tuple[Vector, Vector]:
    """Radii as they are seen, rising, and the straight ones that they belong to."""
    straight = np.sinh(np.linspace(0, math.asinh(_WIDEST * 100), 8192)) / 100  # dense where pictures are
    r2 = straight * straight
    slope = 1 + r2 * (3 * lens.k1 + r2 * (5 * lens.k2 + r2 * 7 * lens.k3))
    folds = np.flatnonzero(slope <= 0)
    straight = straight[: folds[0]] if len(folds) else straight
    r2 = straight * straight
    return straight * (1 + r2 * (lens.k1 + r2 * (lens.k2 + r2 * lens.k3))), straight


def _solve(bent_x: Vector, bent_y: Vector, lens: Distortion, seen: Vector, straight: Vector) -> tuple[Vector, Vector]:
    """By Newton's method in two dimensions, from the radial answer."""
    radius = np.hypot(bent_x, bent_y)
    ratio = np.interp(radius, seen, straight) / np.maximum(radius, 1e-300)
    x, y = bent_x * ratio, bent_y * ratio
    limit = straight[-1]
    with np.errstate(all="ignore"):
        for _ in range(12):
            r2 = x * x + y * y
            radial = 1 + r2 * (lens.k1 + r2 * (lens.k2 + r2 * lens.k3))
            rise = 2 * (lens.k1 + r2 * (2 * lens.k2 + r2 * 3 * lens.k3))
            found_x, found_y = distort(x, y, lens)
            miss_x, miss_y = found_x - bent_x, found_y - bent_y
            xx = radial + rise * x * x + 2 * lens.p1 * y + 6 * lens.p2 * x
            yy = radial + rise * y * y + 6 * lens.p1 * y + 2 * lens.p2 * x
            xy = rise * x * y + 2 * lens.p1 * x + 2 * lens.p2 * y
            determinant = xx * yy - xy * xy
            x = np.clip(x - (yy * miss_x - xy * miss_y) / determinant, -2 * limit, 2 * limit)
            y = np.clip(y - (xx * miss_y - xy * miss_x) / determinant, -2 * limit, 2 * limit)
            if not np.nanmax(np.maximum(np.abs(miss_x), np.abs(miss_y)), initial=0.0) > 1e-10:
                break
        lost = ~((np.abs(miss_x) + np.abs(miss_y) < 1e-7) & (determinant > 0) & (x * x + y * y <= (1.01 * limit) ** 2))
    x[lost] = y[lost] = np.nan
    return x, y


class ImageDistorter:
    """Draws what a pinhole sees wide enough and bends it: each pixel of the result looks up where it came from.

    Works for skewed pixels as well, which no rasteriser draws.
    """

    def __init__(self, model: CameraModel) -> None:
        x, y = model.directions()
        known = np.isfinite(x)
        self._is_full = bool(known.all())
        if not known.any():
            x, y, known = np.zeros_like(x), np.zeros_like(y), np.ones_like(known)
        scale_x, scale_y = _pixel_density(x, y, known, model)
        # edges of what is drawn lie on edges of pixels, so that rows that are not bent stay as they are
        left, right = _pixel_bounds(x[known], scale_x, model.cx * scale_x / model.fx)
        top, bottom = _pixel_bounds(y[known], scale_y, model.cy * scale_y / model.fy)
        self._frustum = left / scale_x, right / scale_x, -bottom / scale_y, -top / scale_y
        self._size = round(right - left), round(bottom - top)
        column, row = (scale_x * x - left - 0.5).astype(np.float32), (scale_y * y - top - 0.5).astype(np.float32)
        column[~known] = row[~known] = -100.0
        self._near, self._far = model.near, model.far
        self._make_maps(column, row)

    def _make_maps(self, column: npt.NDArray[np.float32], row: npt.NDArray[np.float32]) -> None:
        import cv2

        self._maps = cv2.convertMaps(column, row, cv2.CV_16SC2)
        width, height = self._size
        places = np.clip(np.rint(row), 0, height - 1).astype(np.int32) * np.int32(width)
        self._nearest = places + np.clip(np.rint(column), 0, width - 1).astype(np.int32)
        self._empty = None if self._is_full else row < -50
        self._coarse: tuple[Any, Any, Any] | None = None
        if min(row.shape) > 1:
            step = np.maximum(*(np.hypot(np.gradient(column, axis=a), np.gradient(row, axis=a)) for a in (0, 1)))
            if np.count_nonzero(step > _DENSE) > 0.01 * step.size:
                share = np.clip(2 * (step - 1), 0.0, 1.0).astype(np.float32)
                # the smaller picture's pixels are on every second one of the larger
                self._coarse = cv2.convertMaps(column / 2, row / 2, cv2.CV_16SC2), 1 - share, share

    def view(self) -> View:
        """What is to be drawn; it sees what the lens sees."""
        return View(*self._size, *self._frustum, self._near, self._far)

    def bend(self, picture: npt.NDArray[np.uint8], out: npt.NDArray[np.uint8] | None = None) -> npt.NDArray[np.uint8]:
        """Colours (h, w, 3) through the lens, black where it shows nothing.

        Where a strong lens crowds what is drawn, it is averaged, so that fine patterns do not flicker.

        Args:
            picture: drawn through `view`.
            out: contiguous, of the camera's size, to be written to.
        """
        import cv2

        bent = self._remapped(picture, self._maps, out)
        if self._coarse is not None:
            maps, share, coarse_share = self._coarse
            coarse = self._remapped(cv2.pyrDown(np.ascontiguousarray(picture)), maps)
            bent = cv2.blendLinear(bent, coarse, share, coarse_share, dst=out)
        return np.asarray(bent, dtype=np.uint8)

    def bend_depths(self, raw: npt.NDArray[np.float32]) -> npt.NDArray[np.float32]:
        """Raw depths through the lens, 0 (nothing) where it shows nothing.

        They change as 1/z does, linearly on planes, so between neighbours of one surface they are interpolated, which
        is exact on a plane. Where two surfaces meet, the nearest is taken: no point hangs in the air between them.
        """
        import cv2

        raw = np.ascontiguousarray(raw)
        bent: npt.NDArray[np.float32] = self._remapped(raw, self._maps)
        uneven = cv2.Laplacian(raw, cv2.CV_32F, ksize=1, borderType=cv2.BORDER_REPLICATE)
        edges = cv2.compare(np.abs(uneven), raw * np.float32(_EDGE), cv2.CMP_GT)
        edges[[0, -1]] = edges[:, [0, -1]] = 0  # of what is drawn; a slope shows there as an edge
        if edges.any():
            edges = cv2.dilate(edges, np.ones((3, 3), np.uint8))
            near_edges = self._taken(edges)
            np.copyto(bent, self._taken(raw), where=near_edges.view(np.bool_))
        if self._empty is not None:
            bent[self._empty] = 0
        return bent

    def bend_ids(self, ids: npt.NDArray[np.int32]) -> npt.NDArray[np.int32]:
        """The geom at each pixel through the lens, -1 where it shows nothing; names are not blended."""
        bent: npt.NDArray[np.int32] = self._taken(ids)
        if self._empty is not None:
            bent[self._empty] = -1
        return bent

    def _taken(self, what: npt.NDArray[Any]) -> npt.NDArray[Any]:
        return np.ascontiguousarray(what).ravel().take(self._nearest)

    def _remapped(self, what: npt.NDArray[Any], maps: Any, out: npt.NDArray[Any] | None = None) -> Any:
        import cv2

        border = cv2.BORDER_REPLICATE if self._is_full else cv2.BORDER_CONSTANT
        places, parts = maps
        return cv2.remap(np.ascontiguousarray(what), places, parts, cv2.INTER_LINEAR, dst=out, borderMode=border)


def _pixel_density(x: Vector, y: Vector, known: npt.NDArray[np.bool_], model: CameraModel) -> tuple[float, float]:
    """Pixels to be drawn per unit of x and y on the plane at distance 1.

    As fine as the picture in most of it, so that nothing that the lens magnifies is blurred, within bounds.
    """
    step = np.abs(np.diff(x, axis=1)) * model.fx if x.shape[1] > 1 else np.ones(1)
    step = step[np.isfinite(step) & (step > 1e-9)]
    finest = float(np.clip(1 / np.quantile(step, 0.1), 1.0, _FINEST)) if len(step) else 1.0
    finest = 1.0 if finest < 1.02 else finest
    wide, high = np.ptp(x[known]) * model.fx + 2, np.ptp(y[known]) * model.fy + 2
    most = (_MOST_DRAWN - 4) / max(wide, high), math.sqrt(_MOST_TIMES * x.size / (wide * high))
    scale = max(min(finest, *most), min(1.0, 8 / min(wide, high)))
    return scale * model.fx, scale * model.fy


def _pixel_bounds(values: Vector, scale: float, centre: float) -> tuple[float, float]:
    """First and last pixel edge around all values, one pixel more on each side, counted from the axis."""
    low, high = float(values.min()) * scale + centre, float(values.max()) * scale + centre
    return math.floor(low) - 1 - centre, math.ceil(high) + 1 - centre
