"""The pinhole camera of a file: intrinsics, frustum, lens distortion."""

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
_MAX_FOCAL_PIXELS = 1e9  # of focal lengths and principal points
_MAX_DISTORTION = 1e3  # of coefficients of a distortion
_NARROWEST, _WIDEST = 0.001, 3.1415  # a pinhole sees less than half a turn
_STEEPEST = 10.0  # a skew, as a multiple of the focal length
_FARTHEST = 1e30  # [m] of a clip plane; the reciprocal of it is still a number of 32 bits
_MIDDLE = (0.5, 0.5)


@dataclass(frozen=True, slots=True)
class CameraModel:
    """Image size [px], focal lengths, principal point and skew [px], clip planes [m].

    A pixel (u, v), u to the right and v downwards, covers u to u+1: its middle is at u + 0.5. A point at (x, y, 1), x
    to the right and y downwards, is seen at u = fx·x + skew·y + cx, v = fy·y + cy.

    Attributes:
        hfov: horizontal opening angle [rad].
        tx, ty: last column of the projection matrix [px·m].
        rectified: focal lengths and principal point [px] of the projection matrix; None has those of the intrinsics.
        info_model: what `CameraInfo` says, where that is not what is drawn.
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
        """Whether a picture needs more than a rasteriser draws: lens distortion, or skewed pixels."""
        return bool(self.distortion) or self.skew != 0

    def view(self) -> View:
        """The frustum without distortion and skew."""
        left, right = -self.cx / self.fx, (self.width - self.cx) / self.fx
        bottom, top = -(self.height - self.cy) / self.fy, self.cy / self.fy
        return View(self.width, self.height, left, right, bottom, top, self.near, self.far)

    @property
    def matrix(self) -> Vector:
        """K, row by row, shape (9,)."""
        return np.array((self.fx, self.skew, self.cx, 0.0, self.fy, self.cy, 0.0, 0.0, 1.0))

    @property
    def projection(self) -> Vector:
        """P, row by row, shape (12,): of the rectified picture, which has K's skew unless `rectified` is given."""
        fx, fy, cx, cy = self.rectified or (self.fx, self.fy, self.cx, self.cy)
        skew = 0.0 if self.rectified else self.skew
        return np.array((fx, skew, cx, self.tx, 0.0, fy, cy, self.ty, 0.0, 0.0, 1.0, 0.0))

    @property
    def distortion_model(self) -> str:
        """As `CameraInfo` names it."""
        return "plumb_bob"

    @property
    def coefficients(self) -> Vector:
        """D."""
        return self.distortion.coefficients

    def rays(self) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.float32]]:
        """y/x and z/x of what each pixel sees, x forward, y left, z up.

        Returns:
            Of each column, shape (width,), and of each row, shape (height,); both of each pixel, shape (height, width),
            where `is_bent`. NaN where the lens shows nothing.
        """
        if self.is_distorted:
            x, y = self.directions()
            return -x.astype(np.float32), -y.astype(np.float32)
        left = -(np.arange(self.width) + 0.5 - self.cx) / self.fx
        up = -(np.arange(self.height) + 0.5 - self.cy) / self.fy
        return left.astype(np.float32), up.astype(np.float32)

    def directions(self) -> tuple[Vector, Vector]:
        """Where each pixel's middle looks: x to the right and y downwards at distance 1, shape (height, width) both.

        NaN where the lens shows nothing.
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

    def seen_at(self, x: Vector, y: Vector) -> tuple[Vector, Vector]:
        """Where points of the plane at distance 1 are seen [px]: x to the right and y downwards."""
        lens = self.distortion
        if lens:
            off_x, off_y = _centre(self)
            bent_x, bent_y = distort(x - off_x, y - off_y, lens)
            x, y = bent_x + off_x, bent_y + off_y
        return self.fx * x + self.skew * y + self.cx, self.fy * y + self.cy

    def as_gazebo(self) -> CameraModel:
        """What Gazebo draws for the same file, which is not what its `CameraInfo` says.

        It draws with `<projection>` in place of `<intrinsics>` where there is one (gz-sensors, CameraSensor.cc), leans
        skewed pixels the other way and leaves the skew out of K, and bends nothing: Ogre 2 has no such pass.
        """
        info_model = replace(self, skew=0.0)
        fx, fy, cx, cy = self.rectified or (self.fx, self.fy, self.cx, self.cy)
        skew = 0.0 if self.rectified else -self.skew
        return replace(self, fx=fx, fy=fy, cx=cx, cy=cy, skew=skew, distortion=NO_DISTORTION, info_model=info_model)


def _centre(model: CameraModel) -> tuple[float, float]:
    """What the distortion is about, on the plane at distance 1."""
    if model.distortion.centre is None:
        return 0.0, 0.0
    across, down = model.distortion.centre
    y = (down * model.height - model.cy) / model.fy
    return (across * model.width - model.cx - model.skew * y) / model.fx, y


def read_camera_model(params: Params, width: int, height: int) -> CameraModel:
    """The `<camera>` block's optics for an image of `width` by `height` [px]."""
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
    """Near and far clip plane [m]."""
    clip = params.block("clip")
    near, far = clip.number("near", 0.1, minimum=1e-6), clip.number("far", 100.0, minimum=1e-6, maximum=_FARTHEST)
    if far > near:
        return near, far
    clip.error("SK-PARAM-002", f"found clip planes from {near:g} to {far:g} m, allowed is a <far> beyond <near>")
    return 0.1, 100.0


def _read_field_of_view(params: Params) -> float:
    """`<horizontal_fov>` [rad] of a pinhole."""
    hfov = params.number("horizontal_fov", 1.047, minimum=_NARROWEST)
    if hfov <= _WIDEST:
        return hfov
    found = params.block("horizontal_fov")
    allowed = f"allowed is a number from {_NARROWEST:g} to {_WIDEST:g} rad: a pinhole sees less than half a turn"
    hint = "degrees are written as radians; a sensor of type wide_angle_camera sees up to 6.28 rad"
    found.error("SK-PARAM-002", f"found <horizontal_fov>{hfov:g}</horizontal_fov>, {allowed}", hint)
    return _WIDEST


def _read_projection(projection: Params, model: CameraModel) -> CameraModel:
    """Read P as it is given; the picture is drawn by the intrinsics, which K tells."""
    intrinsics = model.fx, model.fy, model.cx, model.cy
    names = ("p_fx", "p_fy", "p_cx", "p_cy")
    least = (1e-3, 1e-3, -_MAX_FOCAL_PIXELS, -_MAX_FOCAL_PIXELS)
    given = [
        projection.number(name, value, minimum=low, maximum=_MAX_FOCAL_PIXELS)
        for name, value, low in zip(names, intrinsics, least, strict=True)
    ]
    tx, ty = (
        projection.number(name, 0.0, minimum=-_MAX_FOCAL_PIXELS, maximum=_MAX_FOCAL_PIXELS) for name in ("tx", "ty")
    )
    rectified = given[0], given[1], given[2], given[3]
    for name, value, own in zip(names, given, intrinsics, strict=True):
        if abs(value - own) > 1e-6 * max(1.0, abs(own)):
            message = f"<{name}>{value:g}</{name}> differs from the intrinsics' {own:g}"
            says = "it is told in P, the picture is drawn by the intrinsics; Gazebo draws it by <projection>"
            where = (projection.child(name) or projection).where
            projection.diagnostics.note("SK-SENSOR-006", f"{message}: {says}", where)
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
        message = "the distortion's <center> is off the principal point: it is drawn so, and CameraInfo cannot say it"
        hint = "move the principal point with <intrinsics>; a <center> of 0.5 0.5 is the principal point"
        block.diagnostics.warning("SK-SENSOR-100", message, block.block("center").where, hint)
    _check_fold(block, replace(model, distortion=lens))
    return lens


def _check_fold(block: Params, model: CameraModel) -> None:
    """Says that a lens shows nothing in a part of the picture."""
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
    lost = np.count_nonzero(np.isnan(x)) / x.size
    if lost > 0:
        message = f"the distortion folds back within the picture: {lost:.0%} of it has no ray and stays black"
        hint = "Brown's model holds up to the radius where 1 + 3·k1·r² + 5·k2·r⁴ + 7·k3·r⁶ is 0"
        block.diagnostics.warning("SK-SENSOR-101", message, block.where, hint)
