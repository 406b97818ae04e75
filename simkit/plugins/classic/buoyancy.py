"""The buoyancy of Gazebo Classic: `libBuoyancyPlugin.so`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit.params import Params
from simkit.plugins.base import ModelPlugin
from simkit.plugins.find_entities import find_link
from simkit.plugins.fluids.buoyant_force import Fluid
from simkit.plugins.fluids.collision_volumes import Hull
from simkit.plugins.fluids.floating_links import BuoyancyBase
from simkit.plugins.options import Options, OptionsOf, blocks, number, text, vector3

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.runtime import Model
    from simkit.scene import SceneModel

WATER: Final = 999.1026
"""[kg/m³], at 15 °C."""


class BuoyancyPluginLinkOptions(Options):
    """The `<link>` block."""

    name: str = text(element="@name")
    volume: float = number(minimum=1e-15, maximum=1000000000000000.0, required=True)
    center_of_volume: tuple[float, float, float] = vector3(required=True)


class BuoyancyPluginOptions(Options):
    """Options of `BuoyancyPlugin`."""

    fluid_density: float = number(WATER, minimum=0, maximum=1e9)
    link: tuple[BuoyancyPluginLinkOptions, ...] = blocks(BuoyancyPluginLinkOptions)


class BuoyancyPlugin(BuoyancyBase, ModelPlugin):
    """The links of the model float, wholly under water, by the volume of their collisions or by numbers of the file.

    `<link name="…">` with `<center_of_volume>` (link frame) and `<volume>` says what the shapes do not.
    """

    options = OptionsOf(BuoyancyPluginOptions)
    filenames = ("libBuoyancyPlugin.so",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        self._fluid = Fluid((self.options.fluid_density,))
        self._links = [link.scoped for link in scene.all_links()]
        self._given: dict[str, Hull] = {}
        for given in self.options.link:
            element = given.params
            link = find_link(scene, given.name, element) if given.name else None
            if not given.name:
                element.error("SK-PARAM-001", '<link> needs name="…": the link whose volume it is')
            hull = Hull(given.volume, np.array(given.center_of_volume))
            if link is not None:
                self._given.setdefault(link.scoped, hull)

    def load(self, parent: Model, params: Params) -> None:
        self.start()

    def find_hulls(self) -> Mapping[str, Sequence[Hull]]:
        """Of the model's links; numbers of the file before shapes."""
        links = self.sim.engine.names.links
        given = self._given
        return {n: [given[n]] if n in given else self._yard.hulls(links[n].scene) for n in self._links if n in links}
