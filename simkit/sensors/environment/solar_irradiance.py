"""Light at a solar sensor or a solar panel: direction, validity, shadow, irradiance, power."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import mujoco
import numpy as np

from simkit.compiler import Compiled
from simkit.params import LARGEST, Params
from simkit.pose import Vector, quat_from_rpy, quat_multiply
from simkit.runtime.handles.light import Light, LightState
from simkit.scene.geometry import Vec3
from simkit.sensors.environment.illumination import Lamp, ShadowRay, falloff_share

STANDARD_IRRADIANCE: Final = 1000.0
"""[W/m²] of a light of which nothing says it: that of standard test conditions (IEC 60904-3)."""

"""Of an irradiance [W/m²] and of an area [m²], whose product is a number then."""

_UP: Final = (0.0, 0.0, 1.0)
_FULL_CIRCLE: Final = 2 * math.pi
FALLOFFS: Final = ("none", "inverse_square", "attenuation")


@dataclass(frozen=True, slots=True)
class Panel:
    """A flat solar panel.

    Attributes:
        area: [m²].
        efficiency: electrical power by the light's on its area, from 0 to 1.
        normal: unit vector out of its face, sensor frame.
    """

    area: float
    efficiency: float
    normal: Vec3


@dataclass(frozen=True, slots=True)
class SolarOptions:
    """What a solar sensor measures, and how.

    Attributes:
        shadow: whether what stands in the way makes a reading invalid.
        towards: `direction`: a directional light is where its rays come from; `position`: where its pose is.
        irradiance: of a surface that faces the light [W/m²], of a lamp at 1 m; None for what the light says of itself.
        falloff: how a lamp fades with the distance; see `lighting.faded`.
        normal: unit vector out of the sensor's face, sensor frame.
        field_of_view: full angle of the cone about it in which a light is seen [rad].
        panel: None for none.
        measures_irradiance: whether the file asks for it.
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
    """What is there at one time, without noise.

    Attributes:
        orientation: (w, x, y, z) in the sensor frame; its x axis points at the light, its y axis is level there.
        is_valid: whether the sensor has the light: it shines there, is in the field of view, and nothing is between.
        shadow: scoped name of the visual or collision that casts its shadow on the sensor, or empty.
        incidence: angle between the sensor's normal and the direction to the light [rad].
        irradiance: of the sensor's face [W/m²].
        power: of the panel [W]; 0 without one.
    """

    orientation: Vector
    is_valid: bool
    shadow: str
    incidence: float
    irradiance: float
    power: float


NO_LIGHT: Final = SolarReading(np.array((1.0, 0.0, 0.0, 0.0)), False, "", math.pi, 0.0, 0.0)


def read_solar_options(params: Params, towards: str) -> SolarOptions:
    """Reads the elements that the sensor and the course's plugin have in common; `towards` is the default."""
    normal = _normal(params, _UP)
    given = params.text("irradiance", "")
    asks = params.has("irradiance") or params.has("panel")
    return SolarOptions(
        shadow=params.boolean("shadow", False),
        towards=params.choice("towards", ("direction", "position"), towards),
        irradiance=None if given in ("", "light") else _irradiance(params),
        falloff=params.choice("falloff", FALLOFFS, "none"),
        normal=normal,
        field_of_view=params.number("field_of_view", _FULL_CIRCLE, minimum=0, maximum=_FULL_CIRCLE + 1e-9),
        panel=_panel(params, normal),
        measures_irradiance=asks,
    )


def _irradiance(params: Params) -> float | None:
    found = params.block("irradiance")
    try:
        value = float(found.value)
    except ValueError:
        value = math.nan
    if 0 <= value <= LARGEST:
        return value
    allowed = f"light, or a number from 0 to {LARGEST:g} [W/m²]"
    found.error("SK-PARAM-002", f"found <irradiance>{found.value}</irradiance>, allowed is {allowed}")
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
        params.block("normal").error("SK-PARAM-002", "found a <normal> of length zero, allowed is any other vector")
        return default
    return (x / length, y / length, z / length)


def report_unused_options(params: Params, options: SolarOptions, light: Light) -> None:
    """Warns of an option that has no effect on a light of its type."""
    directional = light.scene.type == "directional"
    idle = {"falloff": directional and options.falloff != "none", "towards": not directional and params.has("towards")}
    for name in (name for name, has_none in idle.items() if has_none):
        message = f"<{name}> has no effect: {light.scoped!r} is a {light.scene.type} light"
        params.diagnostics.warning("SK-SENSOR-083", message, params.block(name).where)


class SolarView:
    """What a place on a link has of a light.

    Args:
        options: of the sensor.
        light: the light's handle.
    """

    def __init__(self, options: SolarOptions, light: Light) -> None:
        self.options, self.light = options, light
        self.lamp = Lamp(light, options.towards == "position")
        self._ray = ShadowRay() if options.shadow else None
        self._half = options.field_of_view / 2 + 1e-12

    def bind(self, compiled: Compiled, link: str) -> None:
        """Finds the light and what throws shadows on `link` in a compiled model."""
        self.lamp.bind(compiled.names)
        if self._ray is not None:
            self._ray.bind(compiled, link, self.light.scene.link)

    def measure(
        self, model: mujoco.MjModel, data: mujoco.MjData, state: LightState, origin: Vector, rotation: Vector
    ) -> SolarReading:
        """The reading.

        Args:
            model, data: with everything computed.
            state: of the light.
            origin: of the sensor in the world [m], shape (3,).
            rotation: of its frame, shape (3, 3).
        """
        options = self.options
        beam = self.lamp.at(state, data, origin)
        if beam.distance <= 0.0:
            return NO_LIGHT
        direction = beam.direction @ rotation
        incidence = angle_between(direction, options.normal)
        shadow = self._ray.find(model, data, origin, beam) if self._ray is not None and beam.share > 0 else ""
        orientation = orientation_towards(direction)
        if shadow or beam.share <= 0.0:
            return SolarReading(orientation, False, shadow, incidence, 0.0, 0.0)
        facing = self._facing(state) * beam.share
        if not self.lamp.is_parallel and self.light.scene.type != "directional":
            facing *= falloff_share(self.light.scene, beam.distance, options.falloff)
        panel, power = options.panel, 0.0
        if panel is not None:
            power = facing * max(0.0, float(direction @ panel.normal)) * panel.area * panel.efficiency
        irradiance = facing * max(0.0, math.cos(incidence)) if incidence < math.pi / 2 else 0.0
        return SolarReading(orientation, incidence <= self._half, "", incidence, irradiance, power)

    def _facing(self, state: LightState) -> float:
        """Irradiance [W/m²] of a surface that faces the light."""
        if self.options.irradiance is not None:
            return self.options.irradiance
        return STANDARD_IRRADIANCE if state.irradiance is None else state.irradiance

    def __deepcopy__(self, memo: dict[int, object]) -> SolarView:
        return self


# ---------------------------------------------------------------------- directions


def orientation_towards(direction: Vector) -> Vector:
    """(w, x, y, z) whose x axis is a unit vector and whose y axis is level: pitch = asin(-z), yaw = atan2(y, x)."""
    x, y, z = direction.tolist()
    return quat_from_rpy(0.0, math.asin(-max(-1.0, min(1.0, z))), math.atan2(y, x))


def angle_between(first: Vector, second: Vec3) -> float:
    """Angle between two unit vectors [rad], exact for small ones too."""
    (ax, ay, az), (bx, by, bz) = first.tolist(), second
    across = math.hypot(ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx)
    return math.atan2(across, ax * bx + ay * by + az * bz)


def deflect_orientation(orientation: Vector, errors: Vector) -> Vector:
    """An orientation turned about its own y and z axes together by two angles [rad]: its x axis errs.

    With independent normal angles of standard deviation σ the x axis is turned about a random axis at right angles to
    it by an angle that has Rayleigh's distribution of scale σ.
    """
    about_y, about_z = errors.tolist()
    angle = math.hypot(about_y, about_z)
    if angle <= 0.0:
        return orientation
    scale = math.sin(angle / 2) / angle
    return quat_multiply(orientation, (math.cos(angle / 2), 0.0, scale * about_y, scale * about_z))


def covariance_across(axis: Vector, variance: float) -> Vector:
    """Row-major covariance, shape (9,), of a turn about all axes at right angles to a unit vector [rad²]."""
    x, y, z = axis.tolist()
    xx, yy, zz, xy, xz, yz = 1.0 - x * x, 1.0 - y * y, 1.0 - z * z, -x * y, -x * z, -y * z
    covariance: Vector = variance * np.array((xx, xy, xz, xy, yy, yz, xz, yz, zz))
    return covariance
