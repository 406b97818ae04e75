"""Aerodynamics of a whole aircraft by stability derivatives: `gz::sim::systems::AdvancedLiftDrag` of gz-sim and PX4.

The body axes are x forward, y to the right and z down. V is the speed in the plane of x and z. The velocity (u, v, w)
of the centre of pressure gives the angle of attack α = atan2(w, u) and the sideslip β = atan2(v, u). The dynamic
pressure is ½ρV², S is the area, b = √(S·AR) the span and c the chord `<mac>`. With the dimensionless rates
p̂ = p·b/(2V), q̂ = q·c/(2V) and r̂ = r·b/(2V), every coefficient is the sum

    C = C(α) + Cβ·β + Cp·p̂ + Cq·q̂ + Cr·r̂ + Σ direction · C_ctrl · deflection in degrees

Lift, drag and pitching moment depend on α as follows; σ(α) rises from 0 to 1 at the stall within about 10°:

    CL(α)  = (1 - σ)·(CL0 + CLa·α) + σ·2·sign(α)·sin²α·cos α
    CD(α)  = (1 - σ)·(CD0 + CL²/(π·AR·eff)) + σ·CD_plate·sin²α,  CD_plate = 2/(1 + exp(-0.224 - 0.115·max(AR, 1/AR)))
    Cem(α) = Cem0 + Cema·α, with the slope Cema_stall beyond the stall

Lift acts at a right angle to the stream, drag along the stream, the side force along y; the moments act about x, y, z.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

from simkit import Params
from simkit.extend import (
    LARGEST,
    JointAxis,
    Options,
    OptionsOf,
    blocks,
    find_named_link,
    integer,
    number,
    text,
    vector3,
    without_effect,
)
from simkit.plugins.find_entities import find_axis_joint
from simkit_water_and_air.plugins.fluids.lift_drag import read_directions
from simkit_water_and_air.plugins.fluids.tuple_vectors import ZERO, Triple, cross, dot, unit
from simkit_water_and_air.plugins.fluids.wing import WingBase

if TYPE_CHECKING:
    from simkit import Model
    from simkit.extend import SceneModel, SpecBuilder

_SLOWEST: Final = 1e-9  # [m/s]
_SHARPNESS: Final = 15.0  # [1/rad], of the transition at the stall
_PLATE: Final = (-0.224, -0.115)  # constants of the drag of a flat plate
Six = tuple[float, float, float, float, float, float]


class ControlSurfaceOptions(Options):
    """Options of a `<control_surface>`: effects on the coefficients for each degree of deflection."""

    joint: str = text(element="name", required=True)
    index: bool = without_effect()
    direction: float = number(required=True)
    drag: float = number(element="CD_ctrl", unit="1/deg", required=True)
    side: float = number(element="CY_ctrl", unit="1/deg", required=True)
    lift: float = number(element="CL_ctrl", unit="1/deg", required=True)
    roll: float = number(element="Cell_ctrl", unit="1/deg", required=True)
    pitch: float = number(element="Cem_ctrl", unit="1/deg", required=True)
    yaw: float = number(element="Cen_ctrl", unit="1/deg", required=True)


class AdvancedLiftDragOptions(Options):
    """Options of `AdvancedLiftDrag`."""

    namespace: bool = without_effect(element="robotNamespace")
    wind_topic: bool = without_effect(element="windSubTopic")
    force_topic: bool = without_effect(element="topic_name")
    link_name: str = text(None, required=True)
    forward: tuple[float, float, float] = vector3((1.0, 0.0, 0.0))
    upward: tuple[float, float, float] = vector3((0.0, 0.0, 1.0))
    cp: tuple[float, float, float] = vector3(unit="m")
    air_density: float = number(1.2041, "kg/m³", minimum=0, maximum=LARGEST)
    area: float = number(1.0, "m²", minimum=1e-12, maximum=LARGEST)
    aspect_ratio: float = number(None, element="AR", minimum=1e-6, maximum=1e6, required=True)
    efficiency: float = number(None, element="eff", minimum=1e-6, maximum=1e6, required=True)
    chord: float = number(0.0, "m", element="mac", minimum=0)
    alpha_stall: float = number(math.pi / 2, "rad", minimum=0, maximum=2 * math.pi)
    lift_at_zero: float = number(0.0, element="CL0")
    drag_at_zero: float = number(0.0, element="CD0")
    pitch_at_zero: float = number(0.0, element="Cem0")
    pitch_beyond_stall: float = number(0.0, "1/rad", element="Cema_stall")
    cla: float = number(0.0, "1/rad", element="CLa")
    cya: float = number(0.0, "1/rad", element="CYa")
    cella: float = number(0.0, "1/rad", element="Cella")
    cema: float = number(0.0, "1/rad", element="Cema")
    cena: float = number(0.0, "1/rad", element="Cena")
    clb: float = number(0.0, "1/rad", element="CLb")
    cyb: float = number(0.0, "1/rad", element="CYb")
    cellb: float = number(0.0, "1/rad", element="Cellb")
    cemb: float = number(0.0, "1/rad", element="Cemb")
    cenb: float = number(0.0, "1/rad", element="Cenb")
    cdp: float = number(0.0, element="CDp")
    cyp: float = number(0.0, element="CYp")
    clp: float = number(0.0, element="CLp")
    cellp: float = number(0.0, element="Cellp")
    cemp: float = number(0.0, element="Cemp")
    cenp: float = number(0.0, element="Cenp")
    cdq: float = number(0.0, element="CDq")
    cyq: float = number(0.0, element="CYq")
    clq: float = number(0.0, element="CLq")
    cellq: float = number(0.0, element="Cellq")
    cemq: float = number(0.0, element="Cemq")
    cenq: float = number(0.0, element="Cenq")
    cdr: float = number(0.0, element="CDr")
    cyr: float = number(0.0, element="CYr")
    clr: float = number(0.0, element="CLr")
    cellr: float = number(0.0, element="Cellr")
    cemr: float = number(0.0, element="Cemr")
    cenr: float = number(0.0, element="Cenr")
    num_ctrl_surfaces: int = integer(0, minimum=0, maximum=1000)
    surfaces: tuple[ControlSurfaceOptions, ...] = blocks(ControlSurfaceOptions, element="control_surface")
    # elements in models of PX4 that Gazebo does not use either
    a0: bool = without_effect()
    lift_beyond_stall: bool = without_effect(element="CLa_stall")
    drag_beyond_stall: bool = without_effect(element="CDa_stall")
    control_joint_rad_to_cl: bool = without_effect()
    radial_symmetry: bool = without_effect()


class AdvancedLiftDrag(WingBase):
    """Applies the forces and moments of the air on an aircraft, by stability derivatives such as those of AVL.

    The air moves with the world's wind. The first `<num_ctrl_surfaces>` control surfaces have an effect.
    """

    options = OptionsOf(AdvancedLiftDragOptions)
    filenames = ("gz-sim-advanced-lift-drag-system", "libAdvancedLiftDragPlugin.so")
    names = ("gz::sim::systems::AdvancedLiftDrag",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        options = self.options.read_all()
        self._scoped = find_named_link(scene, "link_name", params)
        self._centre = options.cp
        forward, upward = read_directions(params, options.forward, options.upward)
        right = unit(cross(forward, upward))
        self._axes = forward, right, cross(forward, right)  # x, y and z of the body
        self._surfaces = self._read_surfaces(scene)
        self._span = math.sqrt(options.area * options.aspect_ratio)
        self._chord = options.chord or options.area / self._span
        self._drops_pitch = bool(builder.world.gazebo_quirks)
        o = options
        # derivatives of drag, side force, lift, roll, pitch and yaw with respect to the sideslip and the rates
        self._by_beta: Six = (0.0, o.cyb, o.clb, o.cellb, o.cemb, o.cenb)
        self._by_roll: Six = (o.cdp, o.cyp, o.clp, o.cellp, o.cemp, o.cenp)
        self._by_pitch: Six = (o.cdq, o.cyq, o.clq, o.cellq, o.cemq, o.cenq)
        self._by_yaw: Six = (o.cdr, o.cyr, o.clr, o.cellr, o.cemr, o.cenr)

    def _read_surfaces(self, scene: SceneModel) -> list[tuple[str, Six]]:
        """Return the joint of each control surface in use, and its effects for each radian."""
        options, surfaces = self.options, []
        count, listed = options.num_ctrl_surfaces, options.surfaces
        if count != len(listed):
            message = f"<num_ctrl_surfaces> is {count}, but the file has {len(listed)} <control_surface> elements"
            used = f"the first {count} have an effect, as in Gazebo" if count < len(listed) else "all of them are used"
            options.params.warning("SK-PLUGIN-119", f"{message}: {used}", "make the two numbers equal")
        for index, surface in enumerate(listed):
            surface.read_all()
            joint = find_axis_joint(scene, surface.joint, surface.params.block("name")) if surface.joint else None
            if joint is None or index >= count:
                continue
            factor = surface.direction * 180 / math.pi
            s = surface
            effects = (
                s.drag * factor,
                s.side * factor,
                s.lift * factor,
                s.roll * factor,
                s.pitch * factor,
                s.yaw * factor,
            )
            surfaces.append((joint.scoped, effects))
        return surfaces

    def load(self, parent: Model, params: Params) -> None:
        self._joints = [(JointAxis(self.sim.joint(name)), effects) for name, effects in self._surfaces]

    def find_load(self, velocity: Triple, spin: Triple) -> tuple[Triple, Triple]:
        """Return force and moment at the centre of pressure."""
        options = self.options
        x_axis, y_axis, z_axis = self._axes
        u, v, w = dot(velocity, x_axis), dot(velocity, y_axis), dot(velocity, z_axis)
        speed = math.hypot(u, w)
        if speed <= _SLOWEST:
            return ZERO, ZERO
        alpha, beta = math.atan2(w, u), math.atan2(v, u)
        pressed = 0.5 * options.air_density * speed * speed * options.area
        drag, side, lift, roll, pitch, yaw = self._coefficients(
            alpha,
            beta,
            dot(spin, x_axis) * self._span / (2 * speed),
            dot(spin, y_axis) * self._chord / (2 * speed),
            dot(spin, z_axis) * self._span / (2 * speed),
        )
        stream = tuple((u * a + w * c) / speed for a, c in zip(x_axis, z_axis, strict=True))
        up = cross(y_axis, stream)  # at a right angle to the stream, towards `<upward>`
        force = tuple(pressed * (lift * a - drag * b + side * c) for a, b, c in zip(up, stream, y_axis, strict=True))
        moment = tuple(
            pressed * (roll * self._span * a + pitch * self._chord * b + yaw * self._span * c)
            for a, b, c in zip(x_axis, y_axis, z_axis, strict=True)
        )
        return (force[0], force[1], force[2]), (moment[0], moment[1], moment[2])

    def _coefficients(self, alpha: float, beta: float, p: float, q: float, r: float) -> list[float]:
        """Return the coefficients of drag, side force, lift, roll, pitch and yaw.

        Args:
            alpha: Angle of attack [rad].
            beta: Sideslip [rad].
            p: Dimensionless roll rate.
            q: Dimensionless pitch rate.
            r: Dimensionless yaw rate.
        """
        o = self.options
        controls = [0.0] * 6
        for joint, effects in self._joints:
            angle = joint.position
            controls = [total + angle * effect for total, effect in zip(controls, effects, strict=True)]
        stalled, sine = _share_of_stall(alpha, o.alpha_stall), math.sin(alpha)
        lift = (1 - stalled) * (o.lift_at_zero + o.cla * alpha)
        lift += stalled * 2 * math.copysign(sine * sine, alpha) * math.cos(alpha)
        # drag follows from the whole lift of steady flight
        steady = lift + o.clb * beta + controls[2]
        ratio = o.aspect_ratio
        plate = 2 / (1 + math.exp(_PLATE[0] + _PLATE[1] * max(ratio, 1 / ratio)))
        drag = (1 - stalled) * (o.drag_at_zero + steady * steady / (math.pi * ratio * o.efficiency))
        drag += stalled * plate * sine * sine
        bounded = max(-o.alpha_stall, min(o.alpha_stall, alpha))
        pitch = o.pitch_at_zero + o.cema * bounded + o.pitch_beyond_stall * (alpha - bounded)
        by_alpha = drag, o.cya * alpha, lift, o.cella * alpha, 0.0 if self._drops_pitch else pitch, o.cena * alpha
        rows = zip(by_alpha, self._by_beta, self._by_roll, self._by_pitch, self._by_yaw, controls, strict=True)
        return [a + b * beta + c * p + d * q + e * r + control for a, b, c, d, e, control in rows]


def _share_of_stall(alpha: float, stall: float) -> float:
    """Return the share of separated flow at an angle of attack: 0 well below the stall, 1 well beyond it."""
    above, below = math.exp(-_SHARPNESS * (alpha - stall)), math.exp(_SHARPNESS * (alpha + stall))
    return (1 + above + below) / ((1 + above) * (1 + below))
