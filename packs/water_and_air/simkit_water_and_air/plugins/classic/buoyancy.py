"""Buoyancy of Gazebo Classic: `libBuoyancyPlugin.so`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit import ModelPlugin, Params
from simkit.extend import Options, OptionsOf, blocks, find_link, number, text, vector3
from simkit_water_and_air.plugins.fluids.buoyant_force import Fluid
from simkit_water_and_air.plugins.fluids.collision_volumes import Hull
from simkit_water_and_air.plugins.fluids.floating_links import BuoyancyBase

if TYPE_CHECKING:
    from simkit import Model
    from simkit.extend import SceneModel, SpecBuilder

WATER: Final = 999.1026
"""Density of water at 15 °C [kg/m³]."""


class BuoyancyPluginLinkOptions(Options):
    """Options in the `<link>` block."""

    name: str = text(element="@name")
    volume: float = number(minimum=1e-15, maximum=1000000000000000.0, required=True)
    center_of_volume: tuple[float, float, float] = vector3(required=True)


class BuoyancyPluginOptions(Options):
    """Options of `BuoyancyPlugin`."""

    fluid_density: float = number(WATER, minimum=0, maximum=1e9)
    link: tuple[BuoyancyPluginLinkOptions, ...] = blocks(BuoyancyPluginLinkOptions)


class BuoyancyPlugin(BuoyancyBase, ModelPlugin):
    """Applies the buoyancy of fully submerged links, by the volume of their collisions or by values in the file.

    `<link name="…">` sets the `<volume>` [m³] and the `<center_of_volume>` [m, link frame], in place of the values from
    the link's collisions.
    """

    options = OptionsOf(BuoyancyPluginOptions)
    filenames = ("libBuoyancyPlugin.so",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        self._fluid = Fluid((self.options.fluid_density,))
        self._links = [link.scoped for link in scene.all_links()]
        self._hulls_in_file: dict[str, Hull] = {}
        for block in self.options.link:
            element = block.params
            link = find_link(scene, block.name, element) if block.name else None
            if not block.name:
                element.error("SK-PARAM-001", '<link> needs name="…": the name of the link')
            hull = Hull(block.volume, np.array(block.center_of_volume))
            if link is not None:
                self._hulls_in_file.setdefault(link.scoped, hull)

    def load(self, parent: Model, params: Params) -> None:
        self.start()

    def find_hulls(self) -> Mapping[str, Sequence[Hull]]:
        """Return the hulls of the model's links, from values in the file or else from the collisions."""
        links = self.sim.engine.names.links
        hulls = self._hulls_in_file
        return {n: [hulls[n]] if n in hulls else self._factory.hulls(links[n].scene) for n in self._links if n in links}
