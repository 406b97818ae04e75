"""Lift, drag and pitching moment of a wing: `gz::sim::systems::LiftDrag` and Gazebo Classic's `libLiftDragPlugin.so`.

The coefficients are linear in the angle of attack α, with a different slope beyond the stall:

    c(α) = slope · α                                   for |α| <= stall
    c(α) = ±slope · stall + slope_stall · (α ∓ stall)  for |α| > stall

Beyond the stall, lift and moment are zero where the formula would change their sign. Each coefficient is multiplied by
cos²(sweep); the sweep is the angle between the stream and the plane normal to the span. The angle of a control surface
increases the coefficients of lift and moment. The force is c · q · area: v is the speed of the stream normal to the
span and q = ½ρv² its dynamic pressure.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar, Final

from simkit import Params
from simkit.extend import JointAxis, Options, OptionsOf, boolean, find_named_link, number, text, vector3
from simkit.plugins.find_entities import find_axis_joint
from simkit_water_and_air.plugins.fluids.tuple_vectors import ZERO, Triple, cross, dot, perpendicular, scaled, unit
from simkit_water_and_air.plugins.fluids.wing import WingBase

if TYPE_CHECKING:
    from simkit import Model
    from simkit.extend import SceneModel, SpecBuilder

SLOWEST: Final = 0.01
"""Speed of the stream [m/s] up to which no force acts."""
_STRAIGHT: Final = 1e-9  # sine of the largest angle to the axis of revolution at which a stream counts as parallel


@dataclass(frozen=True, slots=True)
class CoefficientLine:
    """Aerodynamic coefficient as a function of the angle of attack, with one slope up to the stall and one beyond it.

    Attributes:
        slope: Slope up to the stall [1/rad].
        beyond: Slope beyond the stall [1/rad].
    """

    slope: float
    beyond: float

    def at(self, alpha: float, stall: float) -> float:
        """Return the coefficient at an angle of attack `alpha` [rad]; `stall` is the angle of the stall [rad]."""
        if alpha > stall:
            return self.slope * stall + self.beyond * (alpha - stall)
        if alpha < -stall:
            return -self.slope * stall + self.beyond * (alpha + stall)
        return self.slope * alpha

    def one_sided(self, alpha: float, stall: float) -> float:
        """Return the coefficient as `at` does, but zero where its sign would change beyond the stall."""
        coefficient = self.at(alpha, stall)
        if alpha > stall:
            return max(0.0, coefficient)
        return min(0.0, coefficient) if alpha < -stall else coefficient


@dataclass(frozen=True, slots=True)
class Aerofoil:
    """Wing; all directions and points are in the link's frame.

    Attributes:
        lift, drag, moment: Coefficients of lift, drag and pitching moment.
        stall: Angle of attack at the stall [rad].
        zero: Angle of attack [rad] at zero angle between the stream and `forward`.
        density: Density of the air or water [kg/m³].
        area: Reference area [m²].
        centre: Centre of pressure [m].
        forward, upward: Unit vectors; the wing usually moves along `forward`, and lift acts along `upward`.
        is_radial: True for a body of revolution around `forward`; its upward direction depends on the stream.
        is_reversible: True if a stream from behind also causes forces.
        lift_by_joint, moment_by_joint: Increase of the coefficients for each radian of the control surface [1/rad].
    """

    lift: CoefficientLine
    drag: CoefficientLine
    moment: CoefficientLine
    stall: float
    zero: float
    density: float
    area: float
    centre: Triple
    forward: Triple
    upward: Triple
    is_radial: bool
    is_reversible: bool
    lift_by_joint: float
    moment_by_joint: float

    def load(self, velocity: Triple, angle: float = 0.0) -> tuple[Triple, Triple]:
        """Return the force at the centre of pressure [N] and the moment [N·m], in the link's frame.

        Args:
            velocity: Velocity of the centre of pressure relative to the air [m/s], in the link's frame.
            angle: Angle of the control surface [rad].
        """
        speed = math.sqrt(dot(velocity, velocity))
        if speed <= SLOWEST or not (self.is_reversible or dot(self.forward, velocity) > 0.0):
            return ZERO, ZERO
        up = self._up(velocity, speed)
        span = unit(cross(self.forward, up))
        across = dot(velocity, span)
        plane = tuple(v - across * s for v, s in zip(velocity, span, strict=True))
        in_plane = math.sqrt(dot(plane, plane))
        if in_plane < 1e-12 * speed:
            return ZERO, ZERO
        lift_way = unit(cross(span, plane))
        alpha = self._angle_of_attack(lift_way, up)
        facing = 1.0 - (across / speed) ** 2
        lift = self.lift.one_sided(alpha, self.stall) * facing + self.lift_by_joint * angle
        drag = abs(self.drag.at(alpha, self.stall) * facing)
        moment = self.moment.one_sided(alpha, self.stall) * facing + self.moment_by_joint * angle
        pressed = 0.5 * self.density * in_plane * in_plane * self.area
        along = drag * pressed / in_plane
        force = tuple(lift * pressed * way - along * p for way, p in zip(lift_way, plane, strict=True))
        return (force[0], force[1], force[2]), scaled(span, moment * pressed)

    def _up(self, velocity: Triple, speed: float) -> Triple:
        if not self.is_radial:
            return self.upward
        aside = cross(self.forward, velocity)
        if dot(aside, aside) < (_STRAIGHT * speed) ** 2:
            # for a parallel stream, the angle of attack is zero with any upward direction
            return perpendicular(self.forward)
        return unit(cross(self.forward, aside))

    def _angle_of_attack(self, lift_way: Triple, up: Triple) -> float:
        """Return the angle of attack, from -90° to 90°: a stream from behind counts as a stream from the front."""
        aside = cross(up, lift_way)
        angle = math.atan2(math.sqrt(dot(aside, aside)), dot(up, lift_way))
        alpha = self.zero + (angle if dot(lift_way, self.forward) >= 0.0 else -angle)
        return math.remainder(alpha, math.pi) if abs(alpha) > math.pi / 2 else alpha


_MOST = 1e9


class AerofoilOptions(Options):
    """Options of a wing."""

    link_name: str = text(None, required=True)
    forward: tuple[float, float, float] = vector3((1.0, 0.0, 0.0))
    upward: tuple[float, float, float] = vector3((0.0, 0.0, 1.0))
    radial_symmetry: bool = boolean()
    cma: float = number(0.0, minimum=-_MOST, maximum=_MOST)
    cma_stall: float = number(0.0, minimum=-_MOST, maximum=_MOST)
    cla: float = number(1.0, minimum=-_MOST, maximum=_MOST)
    cla_stall: float = number(0.0, minimum=-_MOST, maximum=_MOST)
    cda: float = number(0.01, minimum=-_MOST, maximum=_MOST)
    cda_stall: float = number(1.0, minimum=-_MOST, maximum=_MOST)
    alpha_stall: float = number(math.pi / 2, "rad", minimum=0)
    a0: float = number(0.0, "rad", minimum=-_MOST, maximum=_MOST)
    air_density: float = number(1.2041, "kg/m³", minimum=0, maximum=_MOST)
    area: float = number(1.0, "m²", minimum=0, maximum=_MOST)
    cp: tuple[float, float, float] = vector3(unit="m")
    control_joint_rad_to_cl: float = number(4.0, minimum=-_MOST, maximum=_MOST)
    control_joint_name: str = text()


class MomentAerofoilOptions(AerofoilOptions):
    """Options of a wing with a pitching moment."""

    reversible: bool = boolean()
    cm_delta: float = number(0.0, minimum=-_MOST, maximum=_MOST)


def read_aerofoil(options: AerofoilOptions) -> Aerofoil:
    """Return the aerofoil that the options describe; invalid directions are reported as errors."""
    params, with_moment = options.params, options if isinstance(options, MomentAerofoilOptions) else None
    is_radial = options.radial_symmetry
    forward, upward = read_directions(params, options.forward, options.upward, may_be_parallel=is_radial)
    moment = CoefficientLine(options.cma, options.cma_stall)
    if not with_moment and (moment.slope or moment.beyond):
        message = "<cma> and <cma_stall> have no effect: Gazebo Classic's plugin applies no pitching moment"
        params.diagnostics.warning("SK-PLUGIN-111", message, params.where)
    return Aerofoil(
        lift=CoefficientLine(options.cla, options.cla_stall),
        drag=CoefficientLine(options.cda, options.cda_stall),
        moment=moment if with_moment else CoefficientLine(0.0, 0.0),
        stall=options.alpha_stall,
        zero=options.a0,
        density=options.air_density,
        area=options.area,
        centre=options.cp,
        forward=forward,
        upward=upward,
        is_radial=is_radial,
        is_reversible=with_moment.reversible if with_moment else True,
        lift_by_joint=options.control_joint_rad_to_cl,
        moment_by_joint=with_moment.cm_delta if with_moment else 0.0,
    )


def read_directions(
    params: Params, forward: Triple, upward: Triple, *, may_be_parallel: bool = False
) -> tuple[Triple, Triple]:
    """Return the unit vectors of `<forward>` and `<upward>`; invalid directions are reported as errors."""
    forward = _direction(params, "forward", forward, AerofoilOptions.forward)
    upward = _direction(params, "upward", upward, AerofoilOptions.upward)
    across = cross(forward, upward)
    if not may_be_parallel and dot(across, across) < 1e-12:
        params.error("SK-PLUGIN-110", "<forward> and <upward> are parallel, so lift has no direction")
        upward = perpendicular(forward)
    return forward, upward


def _direction(params: Params, name: str, found: Triple, default: Any) -> Triple:
    if not any(found):
        params.error("SK-PARAM-002", f"found <{name}>0 0 0</{name}>; expected a direction")
        fallback: Triple = default.default
        return fallback
    return unit(found)


class LiftDragBase(WingBase):
    """Applies lift, drag and moment to one link.

    They depend on the link's velocity relative to the air and on the angle of a joint, which turns a control surface.

    Attributes:
        is_about_mass: True if `<cp>` is relative to the centre of mass, false if it is relative to the link's origin.
    """

    reads_at_load = ("inertial",)  # the centre of mass is the default reference point

    options = OptionsOf(AerofoilOptions)
    is_about_mass: ClassVar[bool] = False

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        self._scoped = find_named_link(scene, "link_name", params)
        self._aerofoil = read_aerofoil(self.options)
        self._centre = self._aerofoil.centre
        if self.is_about_mass:
            link = next((link for link in scene.all_links() if link.scoped == self._scoped), None)
            mass_centre = link.inertial.com if link is not None else (0.0, 0.0, 0.0)
            x, y, z = (float(a + b) for a, b in zip(self._centre, mass_centre, strict=True))
            self._centre = (x, y, z)
        self._joint_name = ""
        if params.has("control_joint_name"):
            joint = find_axis_joint(scene, self.options.control_joint_name, params.block("control_joint_name"))
            self._joint_name = "" if joint is None else joint.scoped

    def load(self, parent: Model, params: Params) -> None:
        self._joint = JointAxis(self.sim.joint(self._joint_name)) if self._joint_name else None

    def find_load(self, velocity: Triple, spin: Triple) -> tuple[Triple, Triple]:
        """Return force and moment at the centre of pressure."""
        return self._aerofoil.load(velocity, self._joint.position if self._joint is not None else 0.0)


class LiftDrag(LiftDragBase):
    """Applies lift, drag and pitching moment to a wing, fin or blade, with coefficients that are linear up to a stall.

    `<cp>` is in the link's frame. The air moves with the world's wind. Without `<reversible>`, a stream from behind has
    no effect.
    """

    options = OptionsOf(MomentAerofoilOptions)
    filenames = ("gz-sim-lift-drag-system",)
    names = ("gz::sim::systems::LiftDrag",)


class LiftDragPlugin(LiftDragBase):
    """Applies lift and drag to a wing, fin or blade, for a stream from any side; it applies no pitching moment.

    `<cp>` is relative to the link's centre of mass.
    """

    filenames = ("libLiftDragPlugin.so",)
    is_about_mass = True
