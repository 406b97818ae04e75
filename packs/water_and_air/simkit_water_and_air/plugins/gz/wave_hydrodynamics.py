"""Water around the boats of asv_wave_sim: `gz-waves1-hydrodynamics-system`.

Parameters and defaults are those of `Hydrodynamics.cc` and `Physics.cc`; the forces are those of
`simkit_water_and_air.plugins.fluids.wet_surface`.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit import ModelPlugin, Params
from simkit.extend import Options, OptionsOf, Vector, block, boolean, number, texts, without_effect
from simkit.linear_algebra import matmul
from simkit_water_and_air.plugins.fluids.collision_volumes import link_triangles
from simkit_water_and_air.plugins.fluids.link_forces import PushedLinks, moving_data
from simkit_water_and_air.plugins.fluids.wet_surface import Drag, surface_wrench, wet_triangles

if TYPE_CHECKING:
    from simkit import Model
    from simkit.extend import SceneModel, SpecBuilder

_DENSITY: Final = 1025.0
_MOST: Final = 1e12


class WaveDragOptions(Options):
    """Options of `<hydrodynamics>`."""

    damping_on: bool = boolean(True)
    viscous_drag_on: bool = boolean(True)
    pressure_drag_on: bool = boolean(True)
    linear_1: float = number(1e-6, "N·s/m", element="cDampL1", minimum=0.0, maximum=_MOST)
    linear_2: float = number(1e-6, "N·s²/m²", element="cDampL2", minimum=0.0, maximum=_MOST)
    turning_1: float = number(1e-6, "N·m·s", element="cDampR1", minimum=0.0, maximum=_MOST)
    turning_2: float = number(1e-6, "N·m·s²", element="cDampR2", minimum=0.0, maximum=_MOST)
    positive_1: float = number(1e2, "Pa", element="cPDrag1", minimum=0.0, maximum=_MOST)
    positive_2: float = number(1e2, "Pa", element="cPDrag2", minimum=0.0, maximum=_MOST)
    positive_exponent: float = number(0.4, element="fPDrag", minimum=0.0, maximum=100.0)
    negative_1: float = number(1e2, "Pa", element="cSDrag1", minimum=0.0, maximum=_MOST)
    negative_2: float = number(1e2, "Pa", element="cSDrag2", minimum=0.0, maximum=_MOST)
    negative_exponent: float = number(0.4, element="fSDrag", minimum=0.0, maximum=100.0)
    speed: float = number(1.0, "m/s", element="vRDrag", minimum=1e-9, maximum=_MOST)


class WaveHydrodynamicsOptions(Options):
    """Options of `WaveHydrodynamics`."""

    enable: tuple[str, ...] = texts()
    hydrodynamics: WaveDragOptions = block(WaveDragOptions)
    markers: bool = without_effect()


class WaveHydrodynamics(ModelPlugin):
    """Lifts and brakes the links of a boat by the pressure and friction of calm water on their collisions.

    The surface is at z = 0. `<enable>` names the model or the links that get wet; without it, all links do.
    """

    options = OptionsOf(WaveHydrodynamicsOptions)
    filenames = ("gz-waves1-hydrodynamics-system", "gz-waves-hydrodynamics-system")
    reads_at_load = ("inertial", "geometry")

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        options = self.options.read_all()
        o = options.hydrodynamics
        self._drag = Drag(
            o.damping_on,
            o.viscous_drag_on,
            o.pressure_drag_on,
            (o.linear_1, o.linear_2),
            (o.turning_1, o.turning_2),
            (o.positive_1, o.positive_2, o.positive_exponent),
            (o.negative_1, o.negative_2, o.negative_exponent),
            o.speed,
        )
        self._surfaces: dict[str, Vector] = {}
        for link in scene.all_links():
            scope = f"::{link.scoped}::"
            if not options.enable or any(f"::{name}::" in scope for name in options.enable):
                triangles = link_triangles(link)
                if len(triangles):
                    self._surfaces[link.scoped] = triangles
        self._areas = {name: _area(triangles) for name, triangles in self._surfaces.items()}
        if not self._surfaces:
            names = ", ".join(repr(name) for name in options.enable) or "the model"
            params.warning("SK-PLUGIN-111", f"no link of {names} has a collision, so the water lifts nothing")

    def load(self, parent: Model, params: Params) -> None:
        self._links = PushedLinks(self.sim, tuple(self._surfaces))

    def before_step(self) -> None:
        """Apply the forces of the water for the next step."""
        if not self._links.is_current:
            self._links = PushedLinks(self.sim, tuple(self._surfaces))
        links = self._links
        if not len(links):
            return
        data = moving_data(self.sim)
        velocities, axes = links.velocities(data), links.axes(data)
        weight = _DENSITY * abs(float(self.sim.mj_model.opt.gravity[2]))
        forces, torques = np.zeros((len(links), 3)), np.zeros((len(links), 3))
        for row, name in enumerate(links.names):
            body, surface = links.ids[row], self._surfaces[name]
            corners = data.xpos[body] + matmul(surface.reshape(-1, 3), axes[row].T).reshape(-1, 3, 3)
            if float(corners[:, :, 2].min()) >= 0.0:
                continue
            wet, waterline = wet_triangles(corners)
            centre, turning = data.xipos[body], data.cvel[body, :3]
            linear = velocities[row] + np.cross(turning, centre - data.xpos[body])
            motion = np.concatenate((linear, turning))
            forces[row], torques[row] = surface_wrench(
                wet, self._areas[name], waterline, centre, motion, weight, _DENSITY, self._drag
            )
        links.push(data, forces, torques)


def _area(triangles: Vector) -> float:
    """Return the area of triangles [m²], shape (n, 3, 3)."""
    doubled = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    return math.fsum(np.sqrt(np.einsum("ij,ij->i", doubled, doubled)).tolist()) / 2
