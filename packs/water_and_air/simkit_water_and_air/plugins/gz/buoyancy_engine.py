"""Bladder that changes the buoyancy of a submarine or glider: `gz::sim::systems::BuoyancyEngine`.

The volume V follows its command with a limited rate. The force is -g · (ρ·V - ρ₀·V₀), with the density ρ₀ of the fluid,
the density ρ at the link (zero above the surface) and the volume V₀ at which the vehicle floats without force.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from simkit import ModelPlugin, Params, msgs
from simkit.extend import Options, OptionsOf, find_named_link, listens, number, publishes, text
from simkit.msgs import valid_topic
from simkit.plugins.joints.joint_commands import DOUBLE
from simkit_water_and_air.plugins.fluids.link_forces import PushedLinks, cross, moving_data

if TYPE_CHECKING:
    from simkit import Model
    from simkit.extend import SceneModel, SpecBuilder
    from simkit.msgs import Float64


class BuoyancyEngineOptions(Options):
    """Options of `BuoyancyEngine`."""

    link_name: str = text(None, required=True)
    namespace: str = text()
    min_volume: float = number(3e-5, "m³", minimum=0)
    max_volume: float = number(9.9e-4, "m³", minimum=0)
    default_volume: float = number(None, "m³", minimum=0, instead="min_volume")
    neutral_volume: float = number(3e-4, "m³", minimum=0)
    max_inflation_rate: float = number(3e-6, "m³/s", minimum=0)
    fluid_density: float = number(1000.0, "kg/m³", minimum=0, maximum=1e9)
    surface: float = number(math.inf, "m", finite=False, description="height of the surface; none by default")


class BuoyancyEngine(ModelPlugin):
    """Pushes a link up or down by the volume of a bladder, which follows commands.

    The command is a `Float64` [m³] on `/model/<namespace>/buoyancy_engine`, or on `/buoyancy_engine` without
    `<namespace>`; it stays within `<min_volume>` and `<max_volume>`. The volume is published on `…/current_volume`.
    """

    endpoints = (listens("/buoyancy_engine", DOUBLE), publishes("/buoyancy_engine/current_volume", DOUBLE))
    options = OptionsOf(BuoyancyEngineOptions)
    filenames = ("gz-sim-buoyancy-engine-system",)
    names = ("gz::sim::systems::BuoyancyEngine",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        options = self.options.read_all()
        self._link = find_named_link(scene, "link_name", params)
        if options.max_volume < options.min_volume:
            text = f"<max_volume>{options.max_volume:g}</max_volume> is below <min_volume>"
            params.error("SK-PARAM-002", f"{text}; expected at least {options.min_volume:g}")

    def load(self, parent: Model, params: Params) -> None:
        options = self.options
        self._links = PushedLinks(self.sim, (self._link,))
        self._volume = self._command = options.default_volume
        base = f"/model/{options.namespace}/buoyancy_engine" if options.namespace else "/buoyancy_engine"
        self.listen(valid_topic(base), DOUBLE, self._on_command)
        self._state = self.advertise(valid_topic(f"{base}/current_volume"), DOUBLE)

    def _on_command(self, message: Float64) -> None:
        volume = float(message.data)
        if math.isnan(volume):
            self._once.not_finite()
            return
        self._command = max(self.options.min_volume, min(self.options.max_volume, volume))

    def before_step(self) -> None:
        """Change the volume, and apply the force for the next step."""
        if not self._links.is_current:
            self._links = PushedLinks(self.sim, (self._link,))
        options = self.options
        most = self.period * options.max_inflation_rate
        self._volume += max(-most, min(most, self._command - self._volume))
        if self._state.wanted:
            self._state.publish(msgs.make(DOUBLE, data=self._volume))
        if not len(self._links):
            return
        data = moving_data(self.sim)
        bodies = self._links.bodies
        origin = data.xpos[bodies]
        density = options.fluid_density if origin[0, 2] < options.surface else 0.0
        mass = density * self._volume - options.fluid_density * options.neutral_volume
        force = -mass * self.sim.mj_model.opt.gravity[None]
        self._links.push(data, force, cross(origin - data.xipos[bodies], force))
