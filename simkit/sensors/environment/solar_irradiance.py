"""Light at a solar sensor or a solar panel: direction, validity, shadow, irradiance and power."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import mujoco
import numpy as np

from simkit.compiler import Compiled
from simkit.in_process import InProcess
from simkit.linear_algebra import matmul
from simkit.number_text import number_or_nan
from simkit.params import LARGEST, Params
from simkit.pose import Vector, quat_from_rpy, quat_multiply
from simkit.runtime.handles.light import Light, LightState
from simkit.scene.geometry import Vec3
from simkit.sensors.environment.illumination import Lamp, ShadowRay, falloff_factor

STANDARD_IRRADIANCE: Final = 1000.0
"""Irradiance of a light whose state has no irradiance [W/m²], from the standard test conditions (IEC 60904-3)."""

_UP: Final = (0.0, 0.0, 1.0)
_FULL_CIRCLE: Final = 2 * math.pi
FALLOFFS: Final = ("none", "inverse_square", "attenuation")


@dataclass(frozen=True, slots=True)
class Panel:
    """Flat solar panel.

    Attributes:
        area: area [m²].
        efficiency: ratio of the electrical power to the power of the light on the area, from 0 to 1.
        normal: unit vector out of the panel's face, sensor frame.
    """

    area: float
    efficiency: float
    normal: Vec3


@dataclass(frozen=True, slots=True)
class SolarOptions:
    """Options of the measurement of light.

    Attributes:
        shadow: True if an object between sensor and light makes a reading invalid.
        towards: direction from the sensor to the light: `direction` is opposite to the rays of a directional light,
            `position` is from the sensor to the pose of the light.
        irradiance: irradiance of a surface that faces the light [W/m²], for a lamp at 1 m; None uses the light's value.
        falloff: rule by which a lamp fades with the distance; see `illumination.falloff_factor`.
        normal: unit vector out of the sensor's face, sensor frame.
        field_of_view: full angle of the cone about the normal in which a light is visible [rad].
        panel: solar panel, or None.
        measures_irradiance: True if the file requests the irradiance.
    """

    shadow: bool = False
    towards: str = "direction"
    irradiance: float | None = None
    falloff: str = "none"
    normal: Vec3 = _UP
    field_of_view: float = _FULL_CIRCLE
    panel: Panel | None = None
    measures_irradiance: bool = False


@dataclass(frozen=True, slots=True)
class SolarReading:
    """Light at one time, without noise.

    Attributes:
        orientation: rotation (w, x, y, z) in the sensor frame; its x axis points at the light, its y axis is level.
        is_valid: True if the light is on, reaches the sensor, is in the field of view, and is not hidden.
        shadow: scoped name of the visual or collision that casts its shadow on the sensor, or empty.
        incidence: angle between the sensor's normal and the direction to the light [rad].
        irradiance: irradiance of the sensor's face [W/m²].
        power: power of the panel [W]; 0 without a panel.
    """

    orientation: Vector
    is_valid: bool
    shadow: str
    incidence: float
    irradiance: float
    power: float


NO_LIGHT: Final = SolarReading(np.array((1.0, 0.0, 0.0, 0.0)), False, "", math.pi, 0.0, 0.0)


def read_solar_options(params: Params, towards: str) -> SolarOptions:
    """Read the elements that the `solar` sensor and the plugin `libsolar_sensor.so` have in common.

    Args:
        params: block that contains the elements.
        towards: default of `<towards>`.
    """
    normal = _normal(params, _UP)
    measures_irradiance = params.has("irradiance") or params.has("panel")
    return SolarOptions(
        shadow=params.boolean("shadow", False),
        towards=params.choice("towards", ("direction", "position"), towards),
        irradiance=read_irradiance(params, params.text("irradiance", "") or "light", "light"),
        falloff=params.choice("falloff", FALLOFFS, "none"),
        normal=normal,
        field_of_view=params.number("field_of_view", _FULL_CIRCLE, minimum=0, maximum=_FULL_CIRCLE + 1e-9),
        panel=_panel(params, normal),
        measures_irradiance=measures_irradiance,
    )


def read_irradiance(params: Params, text: str, keyword: str) -> float | None:
    """Return the number in `<irradiance>` [W/m²]; None for the keyword that stands for no number, or after an error."""
    value = number_or_nan(text)
    if text == keyword or 0 <= value <= LARGEST:
        return None if text == keyword else value
    allowed = f"{keyword}, or a number from 0 to {LARGEST:g} [W/m²]"
    params.block("irradiance").error("SK-PARAM-002", f"found <irradiance>{text}</irradiance>; expected {allowed}")
    return None


def _panel(params: Params, normal: Vec3) -> Panel | None:
    block = params.child("panel")
    if block is None:
        return None
    area = block.number("area", required=True, minimum=0, maximum=LARGEST)
    return Panel(area, block.number("efficiency", required=True, minimum=0, maximum=1), _normal(block, normal))


def _normal(params: Params, default: Vec3) -> Vec3:
    x, y, z = params.vector3("normal", default)
    length = math.sqrt(x * x + y * y + z * z)
    if length < 1e-12:
        params.block("normal").error("SK-PARAM-002", "found a <normal> of length zero; expected any other vector")
        return default
    return (x / length, y / length, z / length)


def report_unused_options(params: Params, options: SolarOptions, light: Light) -> None:
    """Report options that have no effect on a light of this type."""
    is_directional = light.scene.type == "directional"
    unused = {
        "falloff": is_directional and options.falloff != "none",
        "towards": not is_directional and params.has("towards"),
    }
    for name in (name for name, is_unused in unused.items() if is_unused):
        message = f"<{name}> has no effect, because {light.scoped!r} is a {light.scene.type} light"
        params.diagnostics.warning("SK-SENSOR-083", message, params.block(name).where)


class SolarView(InProcess):
    """View of a light from a point on a link.

    Args:
        options: options of the sensor.
        light: handle of the light.
    """

    def __init__(self, options: SolarOptions, light: Light) -> None:
        self.options, self.light = options, light
        self.lamp = Lamp(light, options.towards == "position")
        self._ray = ShadowRay() if options.shadow else None
        self._half = options.field_of_view / 2 + 1e-12

    def bind(self, compiled: Compiled, link: str) -> None:
        """Find the light, and the geoms that cast shadows on `link`, in a compiled model."""
        self.lamp.bind(compiled.names)
        if self._ray is not None:
            self._ray.bind(compiled, link, self.light.scene.link)

    def measure(
        self, model: mujoco.MjModel, data: mujoco.MjData, state: LightState, origin: Vector, rotation: Vector
    ) -> SolarReading:
        """Return the reading.

        Args:
            model: compiled model.
            data: data of the model with everything computed.
            state: state of the light.
            origin: position of the sensor in the world [m], shape (3,).
            rotation: rotation matrix of the sensor's frame in the world, shape (3, 3).
        """
        options = self.options
        beam = self.lamp.at(state, data, origin)
        if beam.distance <= 0.0:
            return NO_LIGHT
        direction = matmul(beam.direction, rotation)
        incidence = angle_between(direction, options.normal)
        shadow = self._ray.find(model, data, origin, beam) if self._ray is not None and beam.fraction > 0 else ""
        orientation = orientation_towards(direction)
        if shadow or beam.fraction <= 0.0:
            return SolarReading(orientation, False, shadow, incidence, 0.0, 0.0)
        facing = self._facing(state) * beam.fraction
        if not self.lamp.is_parallel and self.light.scene.type != "directional":
            facing *= falloff_factor(self.light.scene, beam.distance, options.falloff)
        panel, power = options.panel, 0.0
        if panel is not None:
            power = facing * max(0.0, float(matmul(direction, panel.normal))) * panel.area * panel.efficiency
        irradiance = facing * max(0.0, math.cos(incidence)) if incidence < math.pi / 2 else 0.0
        return SolarReading(orientation, incidence <= self._half, "", incidence, irradiance, power)

    def _facing(self, state: LightState) -> float:
        """Return the irradiance [W/m²] of a surface that faces the light."""
        if self.options.irradiance is not None:
            return self.options.irradiance
        return STANDARD_IRRADIANCE if state.irradiance is None else state.irradiance


# ---------------------------------------------------------------------- directions


def orientation_towards(direction: Vector) -> Vector:
    """Return the rotation (w, x, y, z) whose x axis is a unit vector and whose y axis is level.

    Its pitch is asin(-z), and its yaw is atan2(y, x).
    """
    x, y, z = direction.tolist()
    return quat_from_rpy(0.0, math.asin(-max(-1.0, min(1.0, z))), math.atan2(y, x))


def angle_between(first: Vector, second: Vec3) -> float:
    """Return the angle between two unit vectors [rad], exact for small angles too."""
    (ax, ay, az), (bx, by, bz) = first.tolist(), second
    across = math.hypot(ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx)
    return math.atan2(across, ax * bx + ay * by + az * bz)


def deflect_orientation(orientation: Vector, errors: Vector) -> Vector:
    """Return an orientation with an error of its x axis: one rotation by a vector about its own y and z axes [rad].

    With independent normal angles of standard deviation σ, the x axis turns about a random axis perpendicular to it.
    The angle of that turn has Rayleigh's distribution of scale σ.
    """
    about_y, about_z = errors.tolist()
    angle = math.hypot(about_y, about_z)
    if angle <= 0.0:
        return orientation
    scale = math.sin(angle / 2) / angle
    return quat_multiply(orientation, (math.cos(angle / 2), 0.0, scale * about_y, scale * about_z))


def covariance_across(axis: Vector, variance: float) -> Vector:
    """Return the row-major covariance [rad²], shape (9,), of a rotation about all axes perpendicular to `axis`."""
    x, y, z = axis.tolist()
    xx, yy, zz, xy, xz, yz = 1.0 - x * x, 1.0 - y * y, 1.0 - z * z, -x * y, -x * z, -y * z
    covariance: Vector = variance * np.array((xx, xy, xz, xy, yy, yz, xz, yz, zz))
    return covariance
