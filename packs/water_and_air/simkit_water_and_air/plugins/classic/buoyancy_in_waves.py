"""Buoyancy of upright boxes in waves: `libbuoyancy_gazebo_plugin.so` of VRX for Gazebo Classic.

A link with the cross-section A and the height H, centred at its origin, is lifted at `<center_of_volume>` by the weight
of the water up to the surface. The drag is -fluid_drag · v·|v|, for the vertical velocity v relative to the water. The
sum of both is never negative.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from simkit import ModelPlugin, Params
from simkit.extend import Options, OptionsOf, Vector, blocks, find_named_link, number, text, vector3
from simkit_water_and_air.plugins.classic.ocean_waves import waves_of
from simkit_water_and_air.plugins.fluids.link_forces import PushedLinks, cross, moving_data

if TYPE_CHECKING:
    from simkit import Model
    from simkit.extend import SceneModel, SpecBuilder


class FloatingLinkOptions(Options):
    """Options of a `<link>` block."""

    link: str = text(element="name", required=True)
    centre: tuple[float, float, float] = vector3((0.0, 0.0, 0.0), "m", element="center_of_volume", required=True)
    area: float = number(None, "m²", minimum=1e-12, maximum=1e9, required=True)
    height: float = number(None, "m", minimum=1e-9, maximum=1e6, required=True)


class BuoyancyInWavesOptions(Options):
    """Options of `BuoyancyInWaves`."""

    wave_model: str = text()
    fluid_density: float = number(999.1026, "kg/m³", minimum=0, maximum=1e9)
    fluid_level: float = number(0.0, "m", minimum=-1e6, maximum=1e6)
    fluid_drag: float = number(0.0, "N·s²/m²", minimum=0, maximum=1e9)
    links: tuple[FloatingLinkOptions, ...] = blocks(FloatingLinkOptions, element="link")


class BuoyancyInWaves(ModelPlugin):
    """Lifts links as upright boxes in the waves of the model `<wave_model>`; without it, the water is calm."""

    options = OptionsOf(BuoyancyInWavesOptions)
    filenames = ("libbuoyancy_gazebo_plugin.so",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        self._boxes: dict[str, tuple[float, float, Vector]] = {}  # area, height and centre of volume
        self.options.read_all()
        for item in self.options.links:
            item.read_all()
            link = find_named_link(scene, "name", item.params)
            self._boxes.setdefault(link, (item.area, item.height, np.array(item.centre)))

    def load(self, parent: Model, params: Params) -> None:
        self._links = PushedLinks(self.sim, tuple(self._boxes))

    def before_step(self) -> None:
        """Apply buoyancy and drag for the next step."""
        if not self._links.is_current:
            self._links = PushedLinks(self.sim, tuple(self._boxes))
        links, options = self._links, self.options
        if not len(links):
            return
        data, time, waves = moving_data(self.sim), self.sim.time, waves_of(self, options.wave_model)
        weight = -options.fluid_density * float(self.sim.mj_model.opt.gravity[2])  # of a cubic metre of water [N]
        forces, velocities = np.zeros((len(links), 3)), links.velocities(data)
        for row, (name, (x, y, z)) in enumerate(zip(links.names, data.xpos[links.bodies].tolist(), strict=True)):
            area, height, _ = self._boxes[name]
            depth = options.fluid_level + waves.height(x, y, time) - (z - height / 2)
            if depth <= 0:
                continue
            speed = float(velocities[row, 2]) - waves.vertical_velocity(x, y, time)
            lift = weight * area * min(depth, height) - options.fluid_drag * speed * abs(speed)
            forces[row, 2] = max(lift, 0.0)
        centres = np.array([self._boxes[name][2] for name in links.names])
        places = data.xpos[links.bodies] + (links.axes(data) * centres[:, None, :]).sum(axis=2)
        links.push(data, forces, cross(places - data.xipos[links.bodies], forces))
