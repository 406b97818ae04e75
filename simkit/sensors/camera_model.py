"""The pinhole camera of a file: intrinsics, frustum, lens distortion."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from simkit.params import Params
from simkit.pose import Vector
from simkit.sensors.rendering.view import View

MOST_PIXELS = 4096
_MOST_PIXELS = 1e9  # of focal lengths and principal points
_MOST_BENT = 1e3  # of coefficients of a distortion
_WIDEST = 3.1
_FARTHEST = 1e30  # [m] of a clip plane; the reciprocal of it is still a number of 32 bits


@dataclass(frozen=True, slots=True)
class Distortion:
    """Brown's model, as `plumb_bob`."""

    k1: float = 0.0
    k2: float = 0.0
    k3: float = 0.0
    p1: float = 0.0
    p2: float = 0.0

    @property
    def coefficients(self) -> Vector:
        """k1, k2, p1, p2, k3: the order of `CameraInfo` and of OpenCV."""
        return np.array((self.k1, self.k2, self.p1, self.p2, self.k3))

    def __bool__(self) -> bool:
        return bool(self.coefficients.any())


@dataclass(frozen=True, slots=True)
class CameraModel:
    """Image size [px], focal lengths and principal point [px], clip planes [m].

    A pixel (u, v), u to the right and v downwards, covers u to u+1: its middle is at u + 0.5.

    Attributes:
        hfov: horizontal opening angle [rad].
        tx, ty: last column of the projection matrix [px·m].
    """

    width: int
    height: int
    fx: float
    fy: float
    cx: float
    cy: float
    hfov: float
    near: float
    far: float
    distortion: Distortion = Distortion()
    tx: float = 0.0
    ty: float = 0.0

    def view(self, near: float | None = None, margin: int = 0) -> View:
        """The frustum, with another near plane [m] and some pixels more on every side where asked for."""
        return View(
            self.width + 2 * margin,
            self.height + 2 * margin,
            -(self.cx + margin) / self.fx,
            (self.width + margin - self.cx) / self.fx,
            -(self.height + margin - self.cy) / self.fy,
            (self.cy + margin) / self.fy,
            self.near if near is None else near,
            self.far,
        )

    @property
    def matrix(self) -> Vector:
        """K, row by row, shape (9,)."""
        return np.array((self.fx, 0.0, self.cx, 0.0, self.fy, self.cy, 0.0, 0.0, 1.0))

    @property
    def projection(self) -> Vector:
        """P, row by row, shape (12,)."""
        return np.array((self.fx, 0.0, self.cx, self.tx, 0.0, self.fy, self.cy, self.ty, 0.0, 0.0, 1.0, 0.0))

    def rays(self) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.float32]]:
        """y/x of each column, shape (width,), and z/x of each row, shape (height,): x forward, y left, z up."""
        y = -(np.arange(self.width) + 0.5 - self.cx) / self.fx
        z = -(np.arange(self.height) + 0.5 - self.cy) / self.fy
        return y.astype(np.float32), z.astype(np.float32)


def read_camera_model(params: Params, width: int, height: int) -> CameraModel:
    """The `<camera>` block's optics for an image of `width` by `height` [px]."""
    hfov = params.number("horizontal_fov", 1.047, minimum=0.01, maximum=_WIDEST)
    clip = params.block("clip")
    near, far = clip.number("near", 0.1, minimum=1e-6), clip.number("far", 100.0, minimum=1e-6, maximum=_FARTHEST)
    if not far > near:
        clip.error("SK-PARAM-002", f"found clip planes from {near:g} to {far:g} m, allowed is a <far> beyond <near>")
        near, far = 0.1, 100.0
    focal = width / (2 * math.tan(hfov / 2))
    fx, fy, cx, cy, tx, ty = focal, focal, width / 2, height / 2, 0.0, 0.0
    lens = params.child("lens")
    if lens is not None:
        intrinsics, projection = lens.child("intrinsics"), lens.child("projection")
        if intrinsics is not None:
            fx, fy = (intrinsics.number(name, 277.0, minimum=1e-3, maximum=_MOST_PIXELS) for name in ("fx", "fy"))
            cx = intrinsics.number("cx", 160.0, minimum=-_MOST_PIXELS, maximum=_MOST_PIXELS)
            cy = intrinsics.number("cy", 120.0, minimum=-_MOST_PIXELS, maximum=_MOST_PIXELS)
            hfov = math.atan(cx / fx) + math.atan((width - cx) / fx)
            if intrinsics.number("s", 0.0) != 0.0:
                message = "a skew <s> is not used: pixels are rectangular"
                intrinsics.diagnostics.warning("SK-SENSOR-005", message, intrinsics.where)
        if projection is not None:
            tx, ty = projection.number("tx", 0.0), projection.number("ty", 0.0)
            for name, value in (("p_fx", fx), ("p_fy", fy), ("p_cx", cx), ("p_cy", cy)):
                if abs(projection.number(name, value) - value) > 1e-6 * max(1.0, abs(value)):
                    message = f"<{name}> differs from the intrinsics and is not used: pictures are not rectified"
                    projection.diagnostics.warning("SK-SENSOR-006", message, projection.where)
    return CameraModel(width, height, fx, fy, cx, cy, hfov, near, far, _read_distortion(params), tx, ty)


def _read_distortion(params: Params) -> Distortion:
    block = params.child("distortion")
    if block is None:
        return Distortion()
    names = ("k1", "k2", "k3", "p1", "p2")
    distortion = Distortion(*(block.number(name, 0.0, minimum=-_MOST_BENT, maximum=_MOST_BENT) for name in names))
    if distortion and block.vector("center", 2, (0.5, 0.5)) != (0.5, 0.5):
        message = "a <center> of the distortion is not used: it is about the principal point"
        block.diagnostics.warning("SK-SENSOR-007", message, block.where)
    else:
        block.child("center")
    return distortion


class Distorter:
    """Bends a pinhole picture as a lens does: pixels of the result look up where they came from.

    Where the lens sees more than the pinhole, the picture is drawn with a margin.

    Attributes:
        margin: pixels to be drawn beyond each edge.
    """

    def __init__(self, model: CameraModel) -> None:
        columns, rows = np.meshgrid(np.arange(float(model.width)), np.arange(float(model.height)))
        bent_x: Vector = (columns + 0.5 - model.cx) / model.fx
        bent_y: Vector = (rows + 0.5 - model.cy) / model.fy
        x, y = straighten(bent_x, bent_y, model.distortion)
        u, v = x * model.fx + model.cx, y * model.fy + model.cy
        beyond = max(-u.min(), -v.min(), u.max() - model.width, v.max() - model.height, 0.0)
        self.margin = int(min(math.ceil(beyond), max(model.width, model.height) // 2))
        self._maps = (u + (self.margin - 0.5)).astype(np.float32), (v + (self.margin - 0.5)).astype(np.float32)

    def bend(self, picture: npt.NDArray[np.uint8]) -> npt.NDArray[np.uint8]:
        """The picture through the lens; black where nothing was drawn."""
        import cv2

        return np.asarray(cv2.remap(np.ascontiguousarray(picture), *self._maps, cv2.INTER_LINEAR), dtype=np.uint8)


def straighten(bent_x: Vector, bent_y: Vector, lens: Distortion) -> tuple[Vector, Vector]:
    """Where points of the bent picture lie in the straight one, both at distance 1; the inverse of Brown's model."""
    x, y = bent_x.copy(), bent_y.copy()
    for _ in range(60):
        r2 = x * x + y * y
        # beyond the radius where the model folds back there is no answer; the bound keeps the search finite
        radial = np.maximum(1 + r2 * (lens.k1 + r2 * (lens.k2 + r2 * lens.k3)), 0.1)
        next_x = (bent_x - 2 * lens.p1 * x * y - lens.p2 * (r2 + 2 * x * x)) / radial
        next_y = (bent_y - lens.p1 * (r2 + 2 * y * y) - 2 * lens.p2 * x * y) / radial
        moved = max(np.abs(next_x - x).max(), np.abs(next_y - y).max())
        x, y = np.clip(next_x, -10, 10), np.clip(next_y, -10, 10)
        if moved < 1e-6:
            break
    return x, y
