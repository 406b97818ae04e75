"""Aerodynamics of an airship's hull: `gz::sim::systems::LighterThanAirDynamics`.

The nose of the hull points along the x axis of its link. With the velocity v_e of the point (-eps_v, 0, 0) through the
air, its angle γ to the x axis and its dynamic pressure q_e = ½ρ|v_e|², the force across the hull and its moment are

    F = q_e · (-force_inviscid_coeff · sin 2γ + force_viscous_coeff · sin²γ)
    N = q_e · (-moment_inviscid_coeff · sin 2γ + moment_viscous_coeff · sin²γ)

F acts against the component of v_e across the hull. The axial drag is axial_drag_coeff · ½ρ|v|² · cos²α against the
motion along x, with α = atan2(w, u). The added mass M of the link's `<fluid_added_mass>` causes -M·dν/dt and its
Coriolis forces, without the Munk moment of M₁₁, which the inviscid moment contains. Source: S. B. V. Gomes, "An
investigation of the flight dynamics of airships with application to the YEZ-2A", 1990.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit import ModelPlugin, Params
from simkit.extend import Options, OptionsOf, Vector, find_named_link, number, text
from simkit.linear_algebra import matmul
from simkit_water_and_air.plugins.fluids.added_mass import SmoothedAcceleration, own_inertia
from simkit_water_and_air.plugins.fluids.link_forces import PushedLinks, cross, moving_data

if TYPE_CHECKING:
    from simkit import Model
    from simkit.extend import SceneModel, SpecBuilder

_MOST: Final = 1e12


class LighterThanAirOptions(Options):
    """Options of `LighterThanAirDynamics`."""

    link_name: str = text(None, required=True)
    air_density: float = number(1.225, "kg/m³", minimum=0, maximum=1e9)
    moment_inviscid: float = number(
        None, "m³", element="moment_inviscid_coeff", minimum=-_MOST, maximum=_MOST, required=True
    )
    moment_viscous: float = number(
        None, "m³", element="moment_viscous_coeff", minimum=-_MOST, maximum=_MOST, required=True
    )
    force_inviscid: float = number(
        None, "m²", element="force_inviscid_coeff", minimum=-_MOST, maximum=_MOST, required=True
    )
    force_viscous: float = number(
        None, "m²", element="force_viscous_coeff", minimum=-_MOST, maximum=_MOST, required=True
    )
    eps_v: float = number(None, "m", minimum=-1e6, maximum=1e6, required=True)
    axial_drag: float = number(None, "m²", element="axial_drag_coeff", minimum=-_MOST, maximum=_MOST, required=True)


class LighterThanAirDynamics(ModelPlugin):
    """Applies the forces of the air on the hull of an airship; use `Buoyancy` for its lift.

    The air moves with the world's wind. The added mass is that of the link's `<fluid_added_mass>`.
    """

    options = OptionsOf(LighterThanAirOptions)
    filenames = ("gz-sim-lighter_than_air_dynamics-system",)
    names = ("gz::sim::systems::LighterThanAirDynamics",)
    reads_at_load = ("inertial",)  # the smoothing follows from the mass

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        self.options.read_all()
        self._link = find_named_link(scene, "link_name", params)
        link = next((link for link in scene.all_links() if link.scoped == self._link), None)
        self._added = np.zeros((6, 6))
        if link is not None and link.fluid_added_mass:
            self._added[np.triu_indices(6)] = link.fluid_added_mass
            self._added += np.triu(self._added, 1).T
        self._acceleration = SmoothedAcceleration(own_inertia(link), np.diag(self._added))

    def load(self, parent: Model, params: Params) -> None:
        self._links = PushedLinks(self.sim, (self._link,))

    def before_step(self) -> None:
        """Apply the forces of the air for the next step."""
        if not self._links.is_current:
            self._links = PushedLinks(self.sim, (self._link,))
        if not len(self._links):
            return
        data, bodies = moving_data(self.sim), self._links.bodies
        axes: Vector = data.xmat[bodies[0]].reshape(3, 3)
        through = self._links.velocities(data)[0] - np.array(self.sim.engine.wind.at(self.sim.tick))
        velocity = np.concatenate((matmul(through, axes), matmul(data.cvel[bodies[0], :3], axes)))
        wrench = self._wrench(velocity)
        force, torque = matmul(axes, wrench[:3])[None], matmul(axes, wrench[3:])[None]
        self._links.push(data, force, torque + cross(data.xpos[bodies] - data.xipos[bodies], force))

    def _wrench(self, velocity: Vector) -> Vector:
        """Return force [N] and torque [N·m] at the link's origin, in its axes."""
        o = self.options
        linear, angular = velocity[:3], velocity[3:]
        u, v, w = linear.tolist()
        y, z = v - o.eps_v * float(angular[2]), w + o.eps_v * float(angular[1])  # of v_e
        across = math.hypot(y, z)
        pressed = 0.5 * o.air_density * (u * u + across * across)
        angle = math.atan2(across, u)
        double, square = math.sin(2 * angle), math.sin(angle) ** 2
        force = pressed * (-o.force_inviscid * double + o.force_viscous * square)
        moment = pressed * (-o.moment_inviscid * double + o.moment_viscous * square)
        if across > 0:
            y, z = y / across, z / across
        slope = math.cos(math.atan2(w, u)) ** 2
        drag = math.copysign(o.axial_drag * 0.5 * o.air_density * (u * u + v * v + w * w) * slope, -u)
        momentum = matmul(self._added, velocity)
        wrench: Vector = np.array((drag, -force * y, -force * z, 0.0, moment * z, -moment * y))
        wrench -= matmul(self._added, self._acceleration.update(velocity, self.period))
        wrench[:3] -= np.cross(angular, momentum[:3])
        wrench[3:] -= np.cross(linear, matmul(self._added[:3, 3:], angular)) + np.cross(angular, momentum[3:])
        return wrench
