"""Lens distortion of images: a wider image is drawn without distortion and then remapped pixel by pixel."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from simkit.pose import Vector
from simkit.sensors.cameras.array_pool import AnyArray
from simkit.sensors.cameras.camera_model import CameraModel
from simkit.sensors.cameras.rendering.view import View

_MOST_DRAWN = 4096  # largest edge of the drawn image [px]
_MOST_TIMES = 4.0  # largest ratio of drawn pixels to pixels of the result
_FINEST = 1.5  # largest ratio of the drawn resolution to the result's resolution in the middle
_DENSE = 1.5  # number of drawn pixels per pixel of the result, per axis, above which drawn pixels are averaged
# smallest relative deviation of a raw depth from its neighbours' mean that marks the edge of a surface; 0 on a plane
_EDGE = 0.01


_Maps = tuple[AnyArray, AnyArray]  # integer and fractional source position of each pixel, in OpenCV's format


class ImageDistorter:
    """Distorter of a wide undistorted image: each pixel of the result looks up its source position.

    Skewed pixels, which no rasteriser draws, are supported as well.
    """

    def __init__(self, model: CameraModel) -> None:
        x, y = model.directions()
        known = np.isfinite(x)
        self._is_full = bool(known.all())
        if not known.any():
            x, y, known = np.zeros_like(x), np.zeros_like(y), np.ones_like(known)
        scale_x, scale_y = _pixel_density(x, y, known, model)
        # the drawn edges lie on pixel edges, so that undistorted rows stay exact
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
        indices = np.clip(np.rint(row), 0, height - 1).astype(np.int32) * np.int32(width)
        self._nearest = indices + np.clip(np.rint(column), 0, width - 1).astype(np.int32)
        self._empty = None if self._is_full else row < -50
        self._coarse: tuple[_Maps, npt.NDArray[np.float32], npt.NDArray[np.float32]] | None = None
        if min(row.shape) > 1:
            step = np.maximum(*(np.hypot(np.gradient(column, axis=a), np.gradient(row, axis=a)) for a in (0, 1)))
            if np.count_nonzero(step > _DENSE) > 0.01 * step.size:
                weight = np.clip(2 * (step - 1), 0.0, 1.0).astype(np.float32)
                # the half-size image has its pixels at every second pixel of the full one
                self._coarse = cv2.convertMaps(column / 2, row / 2, cv2.CV_16SC2), 1 - weight, weight

    def view(self) -> View:
        """Return the view to draw, which contains everything that the lens shows."""
        return View(*self._size, *self._frustum, self._near, self._far)

    def distort(
        self, picture: npt.NDArray[np.uint8], out: npt.NDArray[np.uint8] | None = None
    ) -> npt.NDArray[np.uint8]:
        """Return colours (h, w, 3) through the lens, black where the lens shows nothing.

        Where a strong lens compresses the drawn image, pixels are averaged, so that fine patterns do not flicker.

        Args:
            picture: colours drawn through `view`.
            out: contiguous output array of the camera's size.
        """
        import cv2

        bent = self._remap(picture, self._maps, out)
        if self._coarse is not None:
            maps, share, coarse_share = self._coarse
            coarse = self._remap(cv2.pyrDown(np.ascontiguousarray(picture)), maps)
            bent = cv2.blendLinear(bent, coarse, share, coarse_share, dst=out)
        return np.asarray(bent, dtype=np.uint8)

    def distort_depths(self, raw: npt.NDArray[np.float32]) -> npt.NDArray[np.float32]:
        """Return raw depths through the lens, 0 (no object) where the lens shows nothing.

        On one surface, pixels are interpolated. This is exact on a plane, because raw depths are proportional to 1/z,
        which is linear in the image of a plane. Where two surfaces meet, the nearest pixel is used, so that no point
        lies between the surfaces.
        """
        import cv2

        raw = np.ascontiguousarray(raw)
        bent: npt.NDArray[np.float32] = self._remap(raw, self._maps)
        uneven = cv2.Laplacian(raw, cv2.CV_32F, ksize=1, borderType=cv2.BORDER_REPLICATE)
        edges = cv2.compare(np.abs(uneven), raw * np.float32(_EDGE), cv2.CMP_GT)
        # at the border of the drawn image, a neighbour is missing, and a slope would count as an edge
        edges[[0, -1]] = edges[:, [0, -1]] = 0
        if edges.any():
            edges = cv2.dilate(edges, np.ones((3, 3), np.uint8))
            near_edges = self._take_nearest(edges)
            np.copyto(bent, self._take_nearest(raw), where=near_edges.view(np.bool_))
        if self._empty is not None:
            bent[self._empty] = 0
        return bent

    def distort_ids(self, ids: npt.NDArray[np.int32]) -> npt.NDArray[np.int32]:
        """Return the geom at each pixel through the lens, -1 where the lens shows nothing; ids are not blended."""
        bent: npt.NDArray[np.int32] = self._take_nearest(ids)
        if self._empty is not None:
            bent[self._empty] = -1
        return bent

    def _take_nearest(self, image: AnyArray) -> AnyArray:
        return np.ascontiguousarray(image).ravel().take(self._nearest)

    def _remap(self, image: AnyArray, maps: _Maps, out: AnyArray | None = None) -> AnyArray:
        import cv2

        border = cv2.BORDER_REPLICATE if self._is_full else cv2.BORDER_CONSTANT
        positions, fractions = maps
        image = np.ascontiguousarray(image)
        bent: AnyArray = cv2.remap(image, positions, fractions, cv2.INTER_LINEAR, dst=out, borderMode=border)
        return bent


def _pixel_density(x: Vector, y: Vector, known: npt.NDArray[np.bool_], model: CameraModel) -> tuple[float, float]:
    """Return the pixels to draw per unit of x and y on the plane at distance 1.

    The density is high enough for 90 % of the result's pixels, so that the lens magnifies no blurred parts. The size
    of the drawn image limits the density.
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
    """Return the first and last pixel edge around all values, widened by one pixel, counted from the axis."""
    low, high = float(values.min()) * scale + centre, float(values.max()) * scale + centre
    return math.floor(low) - 1 - centre, math.ceil(high) + 1 - centre
