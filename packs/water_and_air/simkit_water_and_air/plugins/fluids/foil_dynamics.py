"""Sails, keels and rudders of usv_sim_lsa: `libfoil_dynamics_plugin.so`.

The coefficients are those of `foil_dynamics_plugin.cpp`, for an angle of attack α:

    c_l = l · sin 2α        c_d = d · (1 - cos 2α)

l and d are 8 and 4 for a sail or a keel, and `<mult_lift>` and `<mult_drag>` for a rudder. Both forces are c · ½ρv² ·
area, with the speed v of the stream at a right angle to the span.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

from simkit import Params
from simkit.extend import OptionsOf, choice, listens, number, without_effect
from simkit_water_and_air.plugins.fluids.foil_lift_drag import FoilBase, FoilShapeOptions
from simkit_water_and_air.plugins.fluids.tuple_vectors import ZERO, Triple
from simkit_water_and_air.plugins.fluids.water_current import VECTOR, current_of

if TYPE_CHECKING:
    from simkit import Model
    from simkit.extend import SceneModel, SpecBuilder
    from simkit.msgs import Message

_MOST: Final = 1e9
_CURRENT: Final = "/gazebo/current"


class FoilDynamicsOptions(FoilShapeOptions):
    """Options of `FoilDynamics`."""

    kind: str = choice(("sail", "keel", "rudder"), element="link_type", required=True)
    lift: float = number(1.5, element="mult_lift", minimum=-_MOST, maximum=_MOST)
    drag: float = number(1.0, element="mult_drag", minimum=0, maximum=_MOST)
    fluid_velocity: str = choice(("global", "local", "none"), "none", element="fluidVelocity")
    joint: bool = without_effect(element="joint_name")
    a0: bool = without_effect()
    cla: bool = without_effect()
    cda: bool = without_effect()
    cma: bool = without_effect()
    alpha_stall: bool = without_effect()
    cla_stall: bool = without_effect()
    cda_stall: bool = without_effect()
    cma_stall: bool = without_effect()


class FoilDynamics(FoilBase):
    """Applies lift and drag to the sail, keel or rudder `<link_name>`; `<cp>` is relative to its centre of mass.

    A sail is in the world's wind, unless `<fluidVelocity>` is `none`. A keel and a rudder are in water that moves with
    the current on `/gazebo/current` [m/s, world axes].
    """

    endpoints = (listens(_CURRENT, VECTOR),)
    options = OptionsOf(FoilDynamicsOptions)
    filenames = ("libfoil_dynamics_plugin.so",)
    reads_at_load = ("inertial",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        options = self.options
        self.read_foil(scene, params, options)
        link = next((link for link in scene.all_links() if link.scoped == self._scoped), None)
        if link is not None:
            x, y, z = (float(a + b) for a, b in zip(options.cp, link.inertial.com, strict=True))
            self._centre = x, y, z
        self._is_sail = options.kind == "sail"
        self._is_in_wind = options.fluid_velocity != "none"
        self._factors = (options.lift, options.drag) if options.kind == "rudder" else (8.0, 4.0)
        self._current: Triple = ZERO

    def load(self, parent: Model, params: Params) -> None:
        if not self._is_sail:
            self.listen(_CURRENT, VECTOR, self._on_current)

    def _on_current(self, message: Message) -> None:
        current = current_of(message)
        if current is None:
            self._once.not_finite("a current")
        else:
            self._current = current

    def fluid_velocity(self) -> Triple:
        """Return the velocity of the wind or of the water [m/s]."""
        if not self._is_sail:
            return self._current
        x, y, z = self.sim.engine.wind.at(self.sim.tick) if self._is_in_wind else ZERO
        return x, y, z

    def coefficients(self, alpha: float) -> tuple[float, float]:
        """Return the coefficients of lift and drag at an angle of attack from 0 to π."""
        lift, drag = self._factors
        return lift * math.sin(2 * alpha), drag * (1 - math.cos(2 * alpha))
