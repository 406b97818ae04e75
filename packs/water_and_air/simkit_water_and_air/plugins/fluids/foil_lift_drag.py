"""Sails, keels and rudders: `FoilLiftDrag` and `SailLiftDrag` of asv_sim.

The coefficients are those of a flat, symmetric foil, for angles of attack α from 0° to 180°:

    c_l(α) = cla · (α - a0) up to the stall, then with the slope cla_stall; c_l(180° - α) = -c_l(α)
    c_d(α) = cda · α; c_d(180° - α) = c_d(α)

The defaults are those of a thin plate: cla = 2π, alpha_stall = 1/(2π), cla_stall = -2π/(π² - 1), cda = 2/π. Lift
changes its sign if the stream comes from the other side. Both forces are c · ½ρv² · area, with the speed v of the
stream at a right angle to the span.
"""

from __future__ import annotations

import math
from abc import abstractmethod
from typing import TYPE_CHECKING, Final

from simkit import Params
from simkit.extend import Options, OptionsOf, boolean, find_named_link, number, text, vector3
from simkit_water_and_air.plugins.fluids.lift_drag import SLOWEST, read_directions
from simkit_water_and_air.plugins.fluids.tuple_vectors import ZERO, Triple, cross, dot, unit
from simkit_water_and_air.plugins.fluids.wing import WingBase

if TYPE_CHECKING:
    from simkit import Model
    from simkit.extend import SceneModel, SpecBuilder

_MOST: Final = 1e9


class FoilShapeOptions(Options):
    """Options of all foils."""

    link_name: str = text(None, required=True)
    cp: tuple[float, float, float] = vector3((0.0, 0.0, 0.0), "m")
    fluid_density: float = number(1000.1, "kg/m³", minimum=0, maximum=_MOST)
    forward: tuple[float, float, float] = vector3((1.0, 0.0, 0.0))
    upward: tuple[float, float, float] = vector3((0.0, 0.0, 1.0))
    area: float = number(1.0, "m²", minimum=0, maximum=_MOST)


class FoilOptions(FoilShapeOptions):
    """Options of a foil of asv_sim."""

    cp: tuple[float, float, float] = vector3((0.0, 0.0, 0.0), "m", required=True)
    fluid_density: float = number(1.2, "kg/m³", minimum=0, maximum=_MOST)
    radial_symmetry: bool = boolean(True)
    a0: float = number(0.0, "rad", minimum=-_MOST, maximum=_MOST)
    alpha_stall: float = number(1 / (2 * math.pi), "rad", minimum=0)
    cla: float = number(2 * math.pi, "1/rad", minimum=-_MOST, maximum=_MOST)
    cla_stall: float = number(-2 * math.pi / (math.pi**2 - 1), "1/rad", minimum=-_MOST, maximum=_MOST)
    cda: float = number(2 / math.pi, "1/rad", minimum=-_MOST, maximum=_MOST)


class FoilBase(WingBase):
    """Base class of foils in air and water, whose lift changes its sign with the side of the stream."""

    def read_foil(self, scene: SceneModel, params: Params, options: FoilShapeOptions) -> None:
        """Read the options; called in `prepare`."""
        self._shape = options.read_all()
        self._scoped = find_named_link(scene, "link_name", params)
        self._centre = options.cp
        forward, upward = read_directions(params, options.forward, options.upward)
        self._forward, self._span = forward, unit(cross(forward, upward))

    @abstractmethod
    def coefficients(self, alpha: float) -> tuple[float, float]:
        """Return the coefficients of lift and drag at an angle of attack from 0 to π."""

    def find_load(self, velocity: Triple, spin: Triple) -> tuple[Triple, Triple]:
        """Return the force at the centre of pressure; there is no moment."""
        across = dot(velocity, self._span)
        stream = tuple(across * s - v for v, s in zip(velocity, self._span, strict=True))
        speed = math.sqrt(dot(stream, stream))
        if speed <= SLOWEST:
            return ZERO, ZERO
        shape = self._shape
        way: Triple = (stream[0] / speed, stream[1] / speed, stream[2] / speed)
        up = cross(way, self._span)
        alpha = math.acos(max(-1.0, min(1.0, -dot(self._forward, way))))
        lift, drag = self.coefficients(alpha)
        if dot(self._forward, up) < 0:
            lift = -lift
        pressed = 0.5 * shape.fluid_density * speed * speed * shape.area
        force = tuple(pressed * (lift * a + drag * b) for a, b in zip(up, way, strict=True))
        return (force[0], force[1], force[2]), ZERO


class AsvFoil(FoilBase):
    """Base class of the foils of asv_sim."""

    options = OptionsOf(FoilOptions)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        self.read_foil(scene, params, self.options)
        if not self.options.radial_symmetry:
            message = "found <radial_symmetry>false</radial_symmetry>; expected true: the foil is symmetric"
            params.error("SK-PARAM-002", message)

    def load(self, parent: Model, params: Params) -> None:
        """Do nothing; all parameters are known."""

    def coefficients(self, alpha: float) -> tuple[float, float]:
        """Return the coefficients of lift and drag at an angle of attack from 0 to π."""
        options = self.options
        is_from_behind = alpha >= math.pi / 2
        angle = math.pi - alpha if is_from_behind else alpha
        lift = options.cla * (min(angle, options.alpha_stall) - options.a0)
        lift += options.cla_stall * max(angle - options.alpha_stall, 0.0)
        return -lift if is_from_behind else lift, options.cda * angle


class FoilLiftDrag(AsvFoil):
    """Applies lift and drag to a keel, a rudder or another flat foil in water at rest."""

    is_in_wind = False
    filenames = ("libasv_sim2-foil-lift-drag-system.so", "libFoilLiftDragSystem.so", "libFoilPlugin.so")
    names = ("gz::sim::systems::FoilLiftDrag",)


class SailLiftDrag(AsvFoil):
    """Applies lift and drag of the wind to a sail."""

    filenames = ("libasv_sim2-sail-lift-drag-system.so", "libSailLiftDragSystem.so", "libSailPlugin.so")
    names = ("gz::sim::systems::SailLiftDrag",)
