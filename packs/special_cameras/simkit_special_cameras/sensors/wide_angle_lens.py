"""Lens models of SDF: image radius as a function of the angle off the optical axis."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from simkit import Params
from simkit.elementary_functions import arcsin, arctan, power, tan
from simkit.extend import Vector
from simkit.linear_algebra import matmul
from simkit.matrix_decompositions import lstsq
from simkit.sensors.cameras.camera_model import MAX_PIXELS, CameraModel, read_clip

_NARROWEST = 0.001  # [rad]
_ALL_ROUND = 6.2832  # [rad] upper limit, slightly above a full turn so that a value rounded to four digits is valid
_ALMOST = 1e-3  # [rad] distance from a right angle, whose tangent is infinite
_LEAST, _MOST = 1e-6, 1e6  # limits of the numbers of a custom function
_INTRINSICS = 277.0, 277.0, 160.0, 120.0  # [px] defaults of SDF: fx, fy, cx, cy
_TERMS = 4  # number of coefficients of ROS's polynomial for wide lenses


@dataclass(frozen=True, slots=True)
class Lens:
    """Lens r = c1 · f · fun(θ / c2 + c3), which maps an angle θ off the axis to a radius r [half widths].

    Attributes:
        type: name of the lens in SDF.
        function: `sin`, `tan` or `id`.
        cutoff: angle off the axis beyond which the image is black [rad].
    """

    type: str
    c1: float
    c2: float
    c3: float
    f: float
    function: str
    cutoff: float = math.pi / 2

    @property
    def widest(self) -> float:
        """Angle off the axis up to which the radius increases [rad]."""
        if self.function == "id":
            return math.pi
        end = math.pi / 2 - (_ALMOST if self.function == "tan" else 0.0)
        return min(math.pi, self.c2 * (end - self.c3))

    def radius(self, angle: Vector) -> Vector:
        """Return the radius [half widths] of an angle off the axis [rad]."""
        argument = angle / self.c2 + self.c3
        if self.function == "id":
            return self.c1 * self.f * argument
        return self.c1 * self.f * (np.sin(argument) if self.function == "sin" else tan(argument))

    def angle(self, radius: Vector) -> Vector:
        """Return the angle off the axis [rad] of a radius [half widths]; NaN if no angle has this radius."""
        value = radius / (self.c1 * self.f)
        with np.errstate(invalid="ignore"):
            if self.function == "sin":
                value = arcsin(value)
            elif self.function == "tan":
                value = arctan(value)
            angle = self.c2 * (value - self.c3)
            return np.where((angle >= -1e-9) & (angle <= self.widest), np.maximum(angle, 0.0), np.nan)

    def scaled_to(self, hfov: float) -> Lens:
        """Return the lens with the `f` that maps half of `hfov` [rad] to the left and right edge."""
        unit = replace(self, f=1.0)
        return replace(self, f=1.0 / float(unit.radius(np.array(hfov / 2))))


LENSES: Final[Mapping[str, Lens]] = {
    name: Lens(name, c, c, 0.0, 1.0, function)
    for name, c, function in (
        ("gnomonical", 1.0, "tan"),
        ("stereographic", 2.0, "tan"),
        ("equidistant", 1.0, "id"),
        ("equisolid_angle", 2.0, "sin"),
        ("orthographic", 1.0, "sin"),
    )
}
"""Unscaled lenses by their names in SDF."""


@dataclass(frozen=True, slots=True)
class WideAngleModel(CameraModel):
    """Camera with any of SDF's lenses.

    The focal lengths are those near the axis, and the principal point is the middle of the image.

    Attributes:
        lens: scaled lens.
        face_size: edge of a face of the cube that the image is made of [px]; 0 uses the necessary size.
        polynomial: k1 to k4 of ROS's `equidistant` model, fitted to the lens.
        file_intrinsics: fx, fy, cx, cy of `<intrinsics>`, which do not affect the image, or SDF's defaults.
    """

    lens: Lens = LENSES["stereographic"]
    face_size: int = 0
    polynomial: tuple[float, ...] = (0.0,) * _TERMS
    file_intrinsics: tuple[float, float, float, float] = _INTRINSICS

    @property
    def distortion_model(self) -> str:
        """Distortion model: `plumb_bob` (without distortion) for a gnomonical lens (a pinhole), else `equidistant`."""
        return "plumb_bob" if self.lens.type == "gnomonical" else "equidistant"

    @property
    def coefficients(self) -> Vector:
        """Coefficients D: k1 to k4 of θ·(1 + k1·θ² + k2·θ⁴ + k3·θ⁶ + k4·θ⁸); five zeros for a gnomonical lens."""
        return np.zeros(5) if self.lens.type == "gnomonical" else np.array(self.polynomial)

    @property
    def is_distorted(self) -> bool:
        return True

    def offsets(self) -> tuple[Vector, Vector]:
        """Return each pixel's offset from the middle [half widths], right and downwards, shape (height, width)."""
        across = (np.arange(self.width) + 0.5 - self.cx) * (2 / self.width)
        down = (np.arange(self.height) + 0.5 - self.cy) * (2 / self.width)
        x, y = np.meshgrid(across, down)
        return x, y

    def as_gazebo(self) -> CameraModel:
        """Return the model that Gazebo uses for the same file.

        Gazebo ignores `<scale_to_hfov>` and `<cutoff_angle>`. Its `CameraInfo` contains the intrinsics of the file, or
        SDF's defaults, for every lens (gz-sensors, WideAngleCameraSensor.cc).
        """
        fx, fy, cx, cy = self.file_intrinsics
        info_model = CameraModel(self.width, self.height, fx, fy, cx, cy, self.hfov, self.near, self.far)
        lens = replace(self.lens, cutoff=math.pi / 2)
        return replace(
            self, lens=lens.scaled_to(self.hfov) if self.hfov / 2 <= lens.widest else lens, info_model=info_model
        )


def read_wide_angle_model(params: Params, width: int, height: int) -> WideAngleModel:
    """Read the optics of the `<camera>` block for an image of `width` by `height` [px]."""
    block = params.block("lens")
    lens, hfov = _read_lens(block), params.number("horizontal_fov", 1.047, minimum=_NARROWEST, maximum=_ALL_ROUND)
    near, far = read_clip(params)
    if block.boolean("scale_to_hfov", True):
        lens, hfov = _scale_to_view(params, lens, hfov)
    face_size = block.integer("env_texture_size", 0, minimum=8, maximum=MAX_PIXELS)
    focal, polynomial, error = _fit_equidistant(lens, width, height)
    if error > 0.5 and lens.type != "gnomonical":
        message = f"CameraInfo has an error of {error:.1f} px: ROS has only four coefficients for the lens"
        block.diagnostics.note("SK-SENSOR-102", message, block.where, "reduce <cutoff_angle> for a better fit")
    distortion = params.child("distortion")
    if distortion is not None:
        distortion.mark_all_read()
        message = "<distortion> has no effect on a wide_angle_camera, which uses its <lens>"
        hint = "remove <distortion>; Gazebo ignores it too"
        params.diagnostics.warning("SK-SENSOR-103", message, distortion.where, hint)
    return WideAngleModel(
        width, height, focal, focal, width / 2, height / 2, hfov, near, far,
        lens=lens, face_size=face_size, polynomial=polynomial, file_intrinsics=_read_intrinsics(block),
    )  # fmt: skip


def _read_lens(block: Params) -> Lens:
    """Read the lens without scaling it."""
    name = block.choice("type", (*LENSES, "custom", "gnomonic"), "stereographic")
    name = "gnomonical" if name == "gnomonic" else name  # gz accepts both names
    custom = block.child("custom_function")
    if name == "custom":
        source = custom or block.block("custom_function")
        c1, c2, f = (source.number(key, 1.0, minimum=_LEAST, maximum=_MOST) for key in ("c1", "c2", "f"))
        c3 = source.number("c3", 0.0, minimum=-_MOST, maximum=_MOST)
        lens = Lens(name, c1, c2, c3, f, source.choice("fun", ("sin", "tan", "id"), "tan"))
        if not (lens.widest > 0 and float(lens.radius(np.array(lens.widest))) > 0):
            expected = "expected values for which the lens has a positive image radius"
            source.error("SK-PARAM-002", f"found c2 {c2:g} and c3 {c3:g}; {expected}")
            lens = LENSES["stereographic"]
    else:
        lens = LENSES[name]
        if custom is not None:
            custom.mark_all_read()
            message = f"<custom_function> has no effect: the lens type is {name}"
            block.diagnostics.warning("SK-SENSOR-103", message, custom.where, "use <type>custom</type>")
    return replace(lens, cutoff=block.number("cutoff_angle", math.pi / 2, minimum=_NARROWEST, maximum=_ALL_ROUND))


def _scale_to_view(params: Params, lens: Lens, hfov: float) -> tuple[Lens, float]:
    """Return the lens that shows `hfov` [rad] across the image, and `hfov`; report and replace an invalid `hfov`."""
    if hfov / 2 > lens.widest + 1e-4 or not float(lens.radius(np.array(hfov / 2))) > 0:
        element, widest = params.block("horizontal_fov"), 2 * lens.widest
        least = max(_NARROWEST, -2 * lens.c2 * lens.c3)
        allowed = f"a number from {least:.4g} to {widest:.4g} for a lens of type {lens.type}"
        hint = "choose another <type> of <lens>"
        element.error("SK-PARAM-002", f"found <horizontal_fov>{hfov:g}</horizontal_fov>; expected {allowed}", hint)
        hfov = widest
    return lens.scaled_to(min(hfov, 2 * lens.widest)), hfov


def _read_intrinsics(block: Params) -> tuple[float, float, float, float]:
    intrinsics, projection = block.child("intrinsics"), block.child("projection")
    for element in (intrinsics, projection):
        if element is not None:
            message = f"<{element.name}> does not affect the image, which <lens><type> and <horizontal_fov> define"
            block.diagnostics.warning("SK-SENSOR-103", message, element.where, "Gazebo draws the same image")
            element.mark_all_read()
    if intrinsics is None:
        return _INTRINSICS
    values = [intrinsics.number(key, value) for key, value in zip(("fx", "fy", "cx", "cy"), _INTRINSICS, strict=True)]
    return values[0], values[1], values[2], values[3]


def _fit_equidistant(lens: Lens, width: int, height: int) -> tuple[float, tuple[float, ...], float]:
    """Fit ROS's `equidistant` model, which is OpenCV's `fisheye`, to a lens.

    The model maps an angle θ to the radius focal · θ·(1 + k1·θ² + k2·θ⁴ + k3·θ⁶ + k4·θ⁸). See J. Kannala and S. Brandt,
    IEEE Trans. Pattern Analysis and Machine Intelligence 28 (2006) 1335.

    Returns:
        Focal length [px], k1 to k4, and the largest error [px].
    """
    corner = float(lens.angle(np.array(math.hypot(width, height) / width)))
    end = min(lens.cutoff, lens.widest, corner if math.isfinite(corner) else math.pi)
    angles = np.linspace(0.0, end, 400)[1:]
    radii = lens.radius(angles) * width / 2
    if lens.function == "id" and lens.c3 == 0:
        return float(radii[0] / angles[0]), (0.0,) * _TERMS, 0.0
    tiny = end * 1e-4
    focal = float(lens.radius(np.array(tiny)) - lens.radius(np.array(0.0))) / tiny * width / 2
    powers = power(angles[:, None], np.arange(3, 3 + 2 * _TERMS, 2))
    scale = powers[-1]
    factors = lstsq(powers / scale, radii / focal - angles)
    error = np.abs(matmul(powers / scale, factors) + angles - radii / focal).max() * focal
    return focal, tuple(float(f) for f in factors / scale), float(error)
