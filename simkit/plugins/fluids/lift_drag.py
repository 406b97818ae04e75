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

from simkit.params import Params
from simkit.plugins.base import ModelPlugin
from simkit.plugins.find_entities import find_axis_joint, find_named_link
from simkit.plugins.fluids.link_forces import moving_data
from simkit.plugins.joints.joint_axis import JointAxis
from simkit.plugins.options import Options, OptionsOf, boolean, number, text, vector3
from simkit.runtime.engine.physics_step import CONTROL

if TYPE_CHECKING:
    import mujoco

    from simkit.compiler import SpecBuilder
    from simkit.runtime import Model
    from simkit.scene import SceneModel

Triple = tuple[float, float, float]
SLOWEST: Final = 0.01
"""Speed of the stream [m/s] up to which no force acts."""
_ZERO: Final[Triple] = (0.0, 0.0, 0.0)
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
        found = self.at(alpha, stall)
        if alpha > stall:
            return max(0.0, found)
        return min(0.0, found) if alpha < -stall else found


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
        speed = math.sqrt(_dot(velocity, velocity))
        if speed <= SLOWEST or not (self.is_reversible or _dot(self.forward, velocity) > 0.0):
            return _ZERO, _ZERO
        up = self._up(velocity, speed)
        span = unit(_cross(self.forward, up))
        across = _dot(velocity, span)
        plane = tuple(v - across * s for v, s in zip(velocity, span, strict=True))
        in_plane = math.sqrt(_dot(plane, plane))
        if in_plane < 1e-12 * speed:
            return _ZERO, _ZERO
        lift_way = unit(_cross(span, plane))
        alpha = self._angle_of_attack(lift_way, up)
        facing = 1.0 - (across / speed) ** 2
        lift = self.lift.one_sided(alpha, self.stall) * facing + self.lift_by_joint * angle
        drag = abs(self.drag.at(alpha, self.stall) * facing)
        moment = self.moment.one_sided(alpha, self.stall) * facing + self.moment_by_joint * angle
        pressed = 0.5 * self.density * in_plane * in_plane * self.area
        along = drag * pressed / in_plane
        force = tuple(lift * pressed * way - along * p for way, p in zip(lift_way, plane, strict=True))
        return (force[0], force[1], force[2]), _scaled(span, moment * pressed)

    def _up(self, velocity: Triple, speed: float) -> Triple:
        if not self.is_radial:
            return self.upward
        aside = _cross(self.forward, velocity)
        if _dot(aside, aside) < (_STRAIGHT * speed) ** 2:
            # for a parallel stream, the angle of attack is zero with any upward direction
            return _any_across(self.forward)
        return unit(_cross(self.forward, aside))

    def _angle_of_attack(self, lift_way: Triple, up: Triple) -> float:
        """Return the angle of attack, from -90° to 90°: a stream from behind counts as a stream from the front."""
        aside = _cross(up, lift_way)
        angle = math.atan2(math.sqrt(_dot(aside, aside)), _dot(up, lift_way))
        alpha = self.zero + (angle if _dot(lift_way, self.forward) >= 0.0 else -angle)
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
    forward = _direction(params, "forward", options.forward, AerofoilOptions.forward)
    upward = _direction(params, "upward", options.upward, AerofoilOptions.upward)
    is_radial = options.radial_symmetry
    across = _cross(forward, upward)
    if not is_radial and _dot(across, across) < 1e-12:
        params.error("SK-PLUGIN-110", "<forward> and <upward> are parallel, so lift has no direction")
        upward = _any_across(forward)
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


def _direction(params: Params, name: str, found: Triple, default: Any) -> Triple:
    if not any(found):
        params.error("SK-PARAM-002", f"found <{name}>0 0 0</{name}>; expected a direction")
        fallback: Triple = default.default
        return fallback
    return unit(found)


def unit(v: Triple) -> Triple:
    """Return the vector scaled to length 1; a zero vector stays zero."""
    largest = max(abs(v[0]), abs(v[1]), abs(v[2]))
    if largest == 0.0:
        return _ZERO
    scaled = (v[0] / largest, v[1] / largest, v[2] / largest)
    length = math.sqrt(_dot(scaled, scaled))
    return scaled[0] / length, scaled[1] / length, scaled[2] / length


def _any_across(v: Triple) -> Triple:
    axis = min(range(3), key=lambda i: abs(v[i]))
    return unit(_cross(v, (float(axis == 0), float(axis == 1), float(axis == 2))))


def _dot(a: tuple[float, ...], b: tuple[float, ...]) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _cross(a: tuple[float, ...], b: tuple[float, ...]) -> Triple:
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def _scaled(v: Triple, by: float) -> Triple:
    return v[0] * by, v[1] * by, v[2] * by


class LiftDragBase(ModelPlugin):
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

    def before_step(self) -> None:
        """Apply lift, drag and moment to the link for the next step."""
        sim = self.sim
        body = sim.engine.names.links[self._scoped].body
        if body <= 0:
            return
        data = moving_data(sim)
        arm, velocity, axes = self._motion(data, body)
        angle = self._joint.position if self._joint is not None else 0.0
        force, moment = self._aerofoil.load(_turned_back(axes, velocity), angle)
        if not (any(force) or any(moment)):
            return
        (fx, fy, fz), (mx, my, mz) = _in_world_axes(axes, force), _in_world_axes(axes, moment)
        x, y, z = arm
        row = data.xfrc_applied[body]
        row += (fx, fy, fz, mx + y * fz - z * fy, my + z * fx - x * fz, mz + x * fy - y * fx)
        sim.engine.physics.one_shot = True
        sim.engine.physics.changed_body(CONTROL, body)

    def _motion(self, data: mujoco.MjData, body: int) -> tuple[Triple, Triple, list[float]]:
        """Return the state of the centre of pressure.

        Returns:
            Position relative to the centre of mass [m], velocity relative to the air [m/s], and the link's axes.
        """
        model = self.sim.mj_model
        axes: list[float] = data.xmat[body].tolist()
        px, py, pz = _in_world_axes(axes, self._centre)
        ox, oy, oz = data.xpos[body].tolist()
        gx, gy, gz = data.subtree_com[model.body_rootid[body]].tolist()
        wx, wy, wz, vx, vy, vz = data.cvel[body].tolist()  # cvel refers to the centre of mass of the whole tree
        rx, ry, rz = ox + px - gx, oy + py - gy, oz + pz - gz
        ax, ay, az = self.sim.engine.wind.at(self.sim.tick)
        velocity = vx + wy * rz - wz * ry - ax, vy + wz * rx - wx * rz - ay, vz + wx * ry - wy * rx - az
        mx, my, mz = data.xipos[body].tolist()
        return (ox + px - mx, oy + py - my, oz + pz - mz), velocity, axes


def _in_world_axes(axes: list[float], v: Triple) -> Triple:
    """Rotate a vector from the link's frame into the world; the matrix is row-major."""
    x, y, z = v
    return (
        axes[0] * x + axes[1] * y + axes[2] * z,
        axes[3] * x + axes[4] * y + axes[5] * z,
        axes[6] * x + axes[7] * y + axes[8] * z,
    )


def _turned_back(axes: list[float], v: Triple) -> Triple:
    x, y, z = v
    return (
        axes[0] * x + axes[3] * y + axes[6] * z,
        axes[1] * x + axes[4] * y + axes[7] * z,
        axes[2] * x + axes[5] * y + axes[8] * z,
    )


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
