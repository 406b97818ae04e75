"""Pinhole camera of a file: intrinsics, frustum and lens distortion."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from simkit.params import Params
from simkit.pose import Vector
from simkit.sensors.cameras.distortion_model import NO_DISTORTION, Distortion, distort, undistort
from simkit.sensors.cameras.rendering.view import View

MAX_PIXELS = 4096
_MAX_FOCAL_PIXELS = 1e9  # upper limit of focal lengths and principal points
_MAX_DISTORTION = 1e3  # upper limit of distortion coefficients
_NARROWEST, _WIDEST = 0.001, 3.1415  # [rad] a pinhole camera cannot reach half a turn
_STEEPEST = 10.0  # upper limit of the skew, as a multiple of the focal length
_FARTHEST = 1e30  # [m] limit of a clip plane; its reciprocal is still a normal 32-bit float
_MIDDLE = (0.5, 0.5)


@dataclass(frozen=True, slots=True)
class CameraModel:
    """Pinhole camera: image size [px], focal lengths, principal point and skew [px], clip planes [m].

    A pixel (u, v), u to the right and v downwards, covers u to u+1, so its middle is at u + 0.5. A point at (x, y, 1),
    x to the right and y downwards, is projected to u = fx·x + skew·y + cx, v = fy·y + cy.

    Attributes:
        hfov: horizontal opening angle [rad].
        tx, ty: last column of the projection matrix [px·m].
        rectified: focal lengths and principal point [px] of the projection matrix; None uses the intrinsics.
        info_model: model that `CameraInfo` describes, if it differs from the model of the drawn image.
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
    distortion: Distortion = NO_DISTORTION
    tx: float = 0.0
    ty: float = 0.0
    skew: float = 0.0
    rectified: tuple[float, float, float, float] | None = None
    info_model: CameraModel | None = None

    @property
    def is_distorted(self) -> bool:
        """True if the image has lens distortion or skewed pixels, which a rasteriser cannot draw."""
        return bool(self.distortion) or self.skew != 0

    def view(self) -> View:
        """Return the frustum without distortion and skew."""
        left, right = -self.cx / self.fx, (self.width - self.cx) / self.fx
        bottom, top = -(self.height - self.cy) / self.fy, self.cy / self.fy
        return View(self.width, self.height, left, right, bottom, top, self.near, self.far)

    @property
    def matrix(self) -> Vector:
        """Matrix K, row by row, shape (9,)."""
        return np.array((self.fx, self.skew, self.cx, 0.0, self.fy, self.cy, 0.0, 0.0, 1.0))

    @property
    def projection(self) -> Vector:
        """Matrix P of the rectified image, row by row, shape (12,).

        Without `rectified`, P has the skew of K; with `rectified`, P has no skew.
        """
        fx, fy, cx, cy = self.rectified or (self.fx, self.fy, self.cx, self.cy)
        skew = 0.0 if self.rectified else self.skew
        return np.array((fx, skew, cx, self.tx, 0.0, fy, cy, self.ty, 0.0, 0.0, 1.0, 0.0))

    @property
    def distortion_model(self) -> str:
        """Name of the distortion model in `CameraInfo`."""
        return "plumb_bob"

    @property
    def coefficients(self) -> Vector:
        """Distortion coefficients D."""
        return self.distortion.coefficients

    def rays(self) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.float32]]:
        """Return y/x and z/x of the direction of each pixel, x forward, y left, z up.

        Returns:
            y/x of each column, shape (width,), and z/x of each row, shape (height,). If `is_distorted`, both have the
            shape (height, width). Pixels where the lens shows nothing are NaN.
        """
        if self.is_distorted:
            x, y = self.directions()
            return -x.astype(np.float32), -y.astype(np.float32)
        left = -(np.arange(self.width) + 0.5 - self.cx) / self.fx
        up = -(np.arange(self.height) + 0.5 - self.cy) / self.fy
        return left.astype(np.float32), up.astype(np.float32)

    def directions(self) -> tuple[Vector, Vector]:
        """Return each pixel's direction: x to the right and y downwards at distance 1, shape (height, width).

        Pixels where the lens shows nothing are NaN.
        """
        y, x = np.meshgrid(
            (np.arange(self.height) + 0.5 - self.cy) / self.fy,
            (np.arange(self.width) + 0.5 - self.cx) / self.fx,
            indexing="ij",
        )
        x = x - self.skew / self.fx * y
        lens = self.distortion
        if lens:
            off_x, off_y = _centre(self)
            x, y = undistort(x - off_x, y - off_y, lens)
            x, y = x + off_x, y + off_y
        return x, y

    def project(self, x: Vector, y: Vector) -> tuple[Vector, Vector]:
        """Project points of the plane at distance 1, x to the right and y downwards, to pixels."""
        lens = self.distortion
        if lens:
            off_x, off_y = _centre(self)
            bent_x, bent_y = distort(x - off_x, y - off_y, lens)
            x, y = bent_x + off_x, bent_y + off_y
        return self.fx * x + self.skew * y + self.cx, self.fy * y + self.cy

    def zoomed(self, factor: float) -> CameraModel:
        """Return the model with focal lengths that are `factor` times as long.

        The principal point and the coefficients of the distortion stay the same.
        """
        rectified = self.rectified
        if rectified is not None:
            rectified = rectified[0] * factor, rectified[1] * factor, rectified[2], rectified[3]
        return replace(
            self,
            fx=self.fx * factor,
            fy=self.fy * factor,
            skew=self.skew * factor,
            tx=self.tx * factor,
            ty=self.ty * factor,
            hfov=2 * math.atan(math.tan(self.hfov / 2) / factor),
            rectified=rectified,
            info_model=self.info_model and self.info_model.zoomed(factor),
        )

    def as_gazebo(self) -> CameraModel:
        """Return the model that Gazebo draws for the same file, which differs from its `CameraInfo`.

        Gazebo draws with `<projection>` instead of `<intrinsics>` if the file has both (gz-sensors, CameraSensor.cc).
        It skews pixels in the opposite direction and omits the skew from K. It draws no distortion, because Ogre 2 has
        no such pass.
        """
        info_model = replace(self, skew=0.0)
        fx, fy, cx, cy = self.rectified or (self.fx, self.fy, self.cx, self.cy)
        skew = 0.0 if self.rectified else -self.skew
        return replace(self, fx=fx, fy=fy, cx=cx, cy=cy, skew=skew, distortion=NO_DISTORTION, info_model=info_model)


def _centre(model: CameraModel) -> tuple[float, float]:
    """Return the centre of the distortion on the plane at distance 1."""
    if model.distortion.centre is None:
        return 0.0, 0.0
    across, down = model.distortion.centre
    y = (down * model.height - model.cy) / model.fy
    return (across * model.width - model.cx - model.skew * y) / model.fx, y


def read_camera_model(params: Params, width: int, height: int) -> CameraModel:
    """Read the optics of the `<camera>` block.

    Args:
        params: the `<camera>` block.
        width: width of the image [px].
        height: height of the image [px].
    """
    hfov = _read_field_of_view(params)
    near, far = read_clip(params)
    focal = width / (2 * math.tan(hfov / 2))
    fx, fy, cx, cy, skew = focal, focal, width / 2, height / 2, 0.0
    lens = params.child("lens")
    intrinsics = lens.child("intrinsics") if lens is not None else None
    if intrinsics is not None:
        fx, fy = (intrinsics.number(name, 277.0, minimum=1e-3, maximum=_MAX_FOCAL_PIXELS) for name in ("fx", "fy"))
        cx = intrinsics.number("cx", 160.0, minimum=-_MAX_FOCAL_PIXELS, maximum=_MAX_FOCAL_PIXELS)
        cy = intrinsics.number("cy", 120.0, minimum=-_MAX_FOCAL_PIXELS, maximum=_MAX_FOCAL_PIXELS)
        skew = intrinsics.number("s", 0.0, minimum=-_STEEPEST * fx, maximum=_STEEPEST * fx)
        hfov = math.atan(cx / fx) + math.atan((width - cx) / fx)
    model = CameraModel(width, height, fx, fy, cx, cy, hfov, near, far, skew=skew)
    projection = lens.child("projection") if lens is not None else None
    if projection is not None:
        model = _read_projection(projection, model)
    return replace(model, distortion=_read_distortion(params, model))


def read_clip(params: Params) -> tuple[float, float]:
    """Read the near and far clip plane [m]."""
    clip = params.block("clip")
    near, far = clip.number("near", 0.1, minimum=1e-6), clip.number("far", 100.0, minimum=1e-6, maximum=_FARTHEST)
    if far > near:
        return near, far
    clip.error("SK-PARAM-002", f"found clip planes from {near:g} to {far:g} m; expected a <far> beyond <near>")
    return 0.1, 100.0


def _read_field_of_view(params: Params) -> float:
    """Read `<horizontal_fov>` [rad] of a pinhole camera."""
    hfov = params.number("horizontal_fov", 1.047, minimum=_NARROWEST)
    if hfov <= _WIDEST:
        return hfov
    element = params.block("horizontal_fov")
    allowed = f"expected a number from {_NARROWEST:g} to {_WIDEST:g} rad for a pinhole camera"
    hint = "give the angle in radians; the sensor type wide_angle_camera allows up to 6.28 rad"
    element.error("SK-PARAM-002", f"found <horizontal_fov>{hfov:g}</horizontal_fov>, {allowed}", hint)
    return _WIDEST


def _read_projection(projection: Params, model: CameraModel) -> CameraModel:
    """Read the matrix P of `<projection>`. The image is drawn with the intrinsics, which the matrix K contains."""
    intrinsics = model.fx, model.fy, model.cx, model.cy
    names = ("p_fx", "p_fy", "p_cx", "p_cy")
    least = (1e-3, 1e-3, -_MAX_FOCAL_PIXELS, -_MAX_FOCAL_PIXELS)
    values = [
        projection.number(name, value, minimum=low, maximum=_MAX_FOCAL_PIXELS)
        for name, value, low in zip(names, intrinsics, least, strict=True)
    ]
    tx, ty = (
        projection.number(name, 0.0, minimum=-_MAX_FOCAL_PIXELS, maximum=_MAX_FOCAL_PIXELS) for name in ("tx", "ty")
    )
    rectified = values[0], values[1], values[2], values[3]
    for name, value, intrinsic in zip(names, values, intrinsics, strict=True):
        if abs(value - intrinsic) > 1e-6 * max(1.0, abs(intrinsic)):
            message = f"<{name}>{value:g}</{name}> differs from {intrinsic:g} in <intrinsics>"
            effect = "P contains this value, but the image is drawn with <intrinsics>; Gazebo draws with <projection>"
            where = (projection.child(name) or projection).where
            projection.diagnostics.note("SK-SENSOR-006", f"{message}: {effect}", where)
    return replace(model, tx=tx, ty=ty, rectified=rectified if rectified != intrinsics else None)


def _read_distortion(params: Params, model: CameraModel) -> Distortion:
    block = params.child("distortion")
    if block is None:
        return NO_DISTORTION
    names = ("k1", "k2", "k3", "p1", "p2")
    k1, k2, k3, p1, p2 = (block.number(name, 0.0, minimum=-_MAX_DISTORTION, maximum=_MAX_DISTORTION) for name in names)
    across, down = block.vector("center", 2, _MIDDLE)
    centre = None if (across, down) == _MIDDLE else (across, down)
    lens = Distortion(k1, k2, k3, p1, p2, centre)
    if not lens:
        return NO_DISTORTION
    off = math.hypot(*_centre(replace(model, distortion=lens)))
    if off > 1e-6:
        message = "the distortion's <center> is not the principal point: CameraInfo cannot describe the image"
        hint = "use <center>0.5 0.5</center>, and move the principal point with <intrinsics>"
        block.diagnostics.warning("SK-SENSOR-100", message, block.block("center").where, hint)
    _check_fold(block, replace(model, distortion=lens))
    return lens


def _check_fold(block: Params, model: CameraModel) -> None:
    """Report a distortion that folds back within the image, because the lens then shows nothing in some pixels."""
    coarse = max(1, max(model.width, model.height) // 64)
    steps = replace(
        model,
        width=-(-model.width // coarse),
        height=-(-model.height // coarse),
        fx=model.fx / coarse,
        fy=model.fy / coarse,
        cx=model.cx / coarse,
        cy=model.cy / coarse,
        skew=model.skew / coarse,
    )
    x, _ = steps.directions()
    black_fraction = np.count_nonzero(np.isnan(x)) / x.size
    if black_fraction > 0:
        message = f"the distortion folds back within the image: {black_fraction:.0%} of the pixels stay black"
        hint = "reduce k1, k2, k3: Brown's model is valid up to the radius where 1 + 3·k1·r² + 5·k2·r⁴ + 7·k3·r⁶ is 0"
        block.diagnostics.warning("SK-SENSOR-101", message, block.where, hint)
