"""Draw pictures through a distorted lens: wide enough without distortion, then remapped pixel by pixel."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt

from simkit.pose import Vector
from simkit.sensors.cameras.array_pool import AnyArray
from simkit.sensors.cameras.camera_model import CameraModel
from simkit.sensors.cameras.rendering.view import View

_MOST_DRAWN = 4096  # pixels along an edge of what is drawn
_MOST_TIMES = 4.0  # as many pixels as the picture has
_FINEST = 1.5  # as fine as the picture in its middle
_DENSE = 1.5  # drawn pixels per pixel of the picture from which they are averaged first
_EDGE = 0.01  # of a raw depth: neighbours that differ by more than a plane's do belong to two surfaces


_Maps = tuple[AnyArray, AnyArray]  # the place and the fraction of each pixel, as OpenCV keeps them


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
        self._coarse: tuple[_Maps, npt.NDArray[np.float32], npt.NDArray[np.float32]] | None = None
        if min(row.shape) > 1:
            step = np.maximum(*(np.hypot(np.gradient(column, axis=a), np.gradient(row, axis=a)) for a in (0, 1)))
            if np.count_nonzero(step > _DENSE) > 0.01 * step.size:
                share = np.clip(2 * (step - 1), 0.0, 1.0).astype(np.float32)
                # the smaller picture's pixels are on every second one of the larger
                self._coarse = cv2.convertMaps(column / 2, row / 2, cv2.CV_16SC2), 1 - share, share

    def view(self) -> View:
        """What is to be drawn; it sees what the lens sees."""
        return View(*self._size, *self._frustum, self._near, self._far)

    def distort(
        self, picture: npt.NDArray[np.uint8], out: npt.NDArray[np.uint8] | None = None
    ) -> npt.NDArray[np.uint8]:
        """Colours (h, w, 3) through the lens, black where it shows nothing.

        Where a strong lens crowds what is drawn, it is averaged, so that fine patterns do not flicker.

        Args:
            picture: drawn through `view`.
            out: contiguous, of the camera's size, to be written to.
        """
        import cv2

        bent = self._remap(picture, self._maps, out)
        if self._coarse is not None:
            maps, share, coarse_share = self._coarse
            coarse = self._remap(cv2.pyrDown(np.ascontiguousarray(picture)), maps)
            bent = cv2.blendLinear(bent, coarse, share, coarse_share, dst=out)
        return np.asarray(bent, dtype=np.uint8)

    def distort_depths(self, raw: npt.NDArray[np.float32]) -> npt.NDArray[np.float32]:
        """Raw depths through the lens, 0 (nothing) where it shows nothing.

        They change as 1/z does, linearly on planes, so between neighbours of one surface they are interpolated, which
        is exact on a plane. Where two surfaces meet, the nearest is taken: no point hangs in the air between them.
        """
        import cv2

        raw = np.ascontiguousarray(raw)
        bent: npt.NDArray[np.float32] = self._remap(raw, self._maps)
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

    def distort_ids(self, ids: npt.NDArray[np.int32]) -> npt.NDArray[np.int32]:
        """The geom at each pixel through the lens, -1 where it shows nothing; names are not blended."""
        bent: npt.NDArray[np.int32] = self._taken(ids)
        if self._empty is not None:
            bent[self._empty] = -1
        return bent

    def _taken(self, what: AnyArray) -> AnyArray:
        return np.ascontiguousarray(what).ravel().take(self._nearest)

    def _remap(self, what: AnyArray, maps: _Maps, out: AnyArray | None = None) -> Any:
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
