"""Buoyancy of a slender hull in waves: `vrx::Surface` of VRX.

The hull is a half cylinder. Each of its n points carries the n-th part of the length; see
`simkit_water_and_air.plugins.fluids.hull_points`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from simkit import Params
from simkit.extend import Options, OptionsOf, block, find_named_link, listens, number, text
from simkit_water_and_air.plugins.fluids.hull_points import hull_wrench
from simkit_water_and_air.plugins.fluids.link_forces import PushedLinks, moving_data
from simkit_water_and_air.plugins.fluids.wave_field import PARAMETERS, WavefieldOptions, WavesBase

if TYPE_CHECKING:
    from simkit import Model
    from simkit.extend import SceneModel, SpecBuilder


class PointsOptions(Options):
    """Options of the `<points>` block; it contains `<point>` elements [m, link frame]."""


class SurfaceOptions(Options):
    """Options of `Surface`."""

    link_name: str = text(None, required=True)
    hull_length: float = number(4.9, "m", minimum=0, maximum=1e4)
    hull_radius: float = number(0.213, "m", minimum=1e-6, maximum=1e4)
    fluid_level: float = number(0.0, "m", minimum=-1e6, maximum=1e6)
    fluid_density: float = number(997.7735, "kg/m³", minimum=0, maximum=1e9)
    points: PointsOptions = block(PointsOptions)
    wavefield: WavefieldOptions = block(WavefieldOptions)


class Surface(WavesBase):
    """Lifts a hull at some points by the depth of each point below the surface of the waves.

    The waves are set by `<wavefield>` or by messages on its `<topic>`; without both, the water is calm.
    """

    endpoints = (listens("/wavefield/parameters", PARAMETERS, named_by=("wavefield/topic",)),)
    options = OptionsOf(SurfaceOptions)
    filenames = ("libSurface.so",)
    names = ("vrx::Surface",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        options = self.options.read_all()
        self._link = find_named_link(scene, "link_name", params)
        self.read_waves(options.wavefield)
        self._points = [point.vector3("point") for point in options.points.params.each("point")]
        if not self._points:
            message = f"plugin {self.name!r} has no <points> with <point> elements, so it applies no force"
            params.warning("SK-PLUGIN-139", message, "add the points of the hull that displace water")

    def load(self, parent: Model, params: Params) -> None:
        self._links = PushedLinks(self.sim, (self._link,))
        self.listen_to_waves(self.options.wavefield)

    def before_step(self) -> None:
        """Apply the buoyant force for the next step."""
        if not self._links.is_current:
            self._links = PushedLinks(self.sim, (self._link,))
        if not len(self._links):
            return
        options, data = self.options, moving_data(self.sim)
        length = options.hull_length / max(len(self._points), 1)
        wrench = hull_wrench(
            data,
            self._links.ids[0],
            self._points,
            options.hull_radius,
            options.fluid_density * length,
            options.fluid_level,
            self._waves,
            self.sim.time,
            self.sim.mj_model.opt.gravity.tolist(),
        )
        self._links.push_some(data, {0: wrench})
