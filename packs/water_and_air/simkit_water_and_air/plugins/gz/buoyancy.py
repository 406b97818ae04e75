"""Buoyancy of Gazebo: `gz::sim::systems::Buoyancy`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Final

from simkit import Params, WorldPlugin
from simkit.extend import Options, OptionsOf, block, blocks, did_you_mean, number, texts
from simkit_water_and_air.plugins.fluids.buoyant_force import Fluid
from simkit_water_and_air.plugins.fluids.collision_volumes import Hull
from simkit_water_and_air.plugins.fluids.floating_links import BuoyancyBase

if TYPE_CHECKING:
    from simkit import Simulation

WATER: Final = 1000.0
"""Density of water [kg/m³], the default."""


class DensityChangeOptions(Options):
    """Options of a `<density_change>` block."""

    above_depth: float = number(minimum=-1e9, maximum=1e9, required=True)
    density: float = number(minimum=0.0, maximum=1e9, required=True)


class GradedBuoyancyOptions(Options):
    """Options of the `<graded_buoyancy>` block."""

    density_change: tuple[DensityChangeOptions, ...] = blocks(DensityChangeOptions)
    default_density: float = number(WATER, "kg/m³", minimum=0.0, maximum=1e9)


class BuoyancyOptions(Options):
    """Options of `Buoyancy`."""

    graded_buoyancy: GradedBuoyancyOptions = block(GradedBuoyancyOptions)
    uniform_fluid_density: float = number(WATER, "kg/m³", minimum=0.0, maximum=1e9)
    enable: tuple[str, ...] = texts()


class Buoyancy(BuoyancyBase, WorldPlugin):
    """Fills the world with one fluid or with horizontal layers of fluids, and lifts links by their collisions' volume.

    If the file has `<enable>` elements, only the models and links that they name are lifted.
    """

    options = OptionsOf(BuoyancyOptions)
    filenames = ("gz-sim-buoyancy-system",)
    names = ("gz::sim::systems::Buoyancy",)

    def load(self, parent: Simulation, params: Params) -> None:
        self._fluid = self._read(params)
        enabled = [(element.value, element) for element in params.all("enable")]
        self._enabled = frozenset(name for name, _ in enabled)
        names = {scope for link in parent.engine.names.links for scope in _scopes(link)}
        for name, element in enabled:
            if name not in names:
                message = f"plugin {self.name!r}: there is no model or link {name!r} to float yet"
                params.diagnostics.warning("SK-PLUGIN-113", message, element.where, did_you_mean(name, names))
        self.start()

    def find_hulls(self) -> Mapping[str, Sequence[Hull]]:
        """Return the hulls of all movable and enabled links."""
        return {
            name: self._factory.hulls(binding.scene)
            for name, binding in self.sim.engine.names.links.items()
            if binding.body > 0 and (not self._enabled or not self._enabled.isdisjoint(_scopes(name)))
        }

    def _read(self, params: Params) -> Fluid:
        graded = self.options.graded_buoyancy
        if params.has("uniform_fluid_density"):
            if graded.is_given:
                graded.params.mark_all_read()
                fault = "found both <uniform_fluid_density> and <graded_buoyancy>"
                graded.params.warning("SK-PLUGIN-111", f"{fault}: <uniform_fluid_density> is used, as in Gazebo")
            return Fluid((self.options.uniform_fluid_density,))
        if not graded.is_given:
            message = f"plugin {self.name!r} defines no fluid: the whole world is filled with water of {WATER:g} kg/m³"
            params.warning("SK-PLUGIN-114", message, "add <uniform_fluid_density> or <graded_buoyancy>")
            return Fluid((WATER,))
        layers: dict[float, float] = {}
        for change in graded.density_change:
            layers[change.above_depth] = change.density
        heights = tuple(sorted(layers))
        return Fluid((graded.default_density, *(layers[h] for h in heights)), heights)


def _scopes(link: str) -> list[str]:
    """Return the scoped names of a link and of all models that contain it."""
    parts = link.split("::")
    return ["::".join(parts[:count]) for count in range(1, len(parts) + 1)]
