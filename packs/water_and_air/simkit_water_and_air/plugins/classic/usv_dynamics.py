"""Dynamics of a catamaran in Gazebo Classic: `libusv_gazebo_dynamics_plugin.so` of VRX.

Two hulls of length `boatLength`, `boatWidth` apart, are divided into `length_n` points each, which the water lifts
(see `simkit_water_and_air.plugins.fluids.hull_points`). Drag and added mass are those of `fluids.boat_drag`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from simkit import Params
from simkit.extend import OptionsOf, find_link, integer, number, text
from simkit_water_and_air.plugins.classic.ocean_waves import waves_of
from simkit_water_and_air.plugins.fluids.boat_drag import BoatDragBase, DragOptions, report_negative
from simkit_water_and_air.plugins.fluids.hull_points import hull_wrench
from simkit_water_and_air.plugins.fluids.link_forces import moving_data

if TYPE_CHECKING:
    from simkit.extend import SceneModel, SpecBuilder


class UsvDynamicsOptions(DragOptions):
    """Options of `UsvDynamicsPlugin`."""

    body_name: str = text(element="bodyName")
    water_level: float = number(0.5, "m", element="waterLevel", minimum=-1e6, maximum=1e6)
    water_density: float = number(997.7735, "kg/m³", element="waterDensity", minimum=0, maximum=1e9)
    hull_radius: float = number(0.213, "m", element="hullRadius", minimum=1e-6, maximum=1e4)
    width: float = number(1.0, "m", element="boatWidth", minimum=0, maximum=1e4)
    length: float = number(1.35, "m", element="boatLength", minimum=0, maximum=1e4)
    parts: int = integer(None, element="length_n", minimum=1, maximum=1000, required=True)
    wave_model: str = text()


class UsvDynamicsPlugin(BoatDragBase):
    """Lifts and brakes a catamaran in the waves of the model `<wave_model>`; the water is calm without such a model.

    The link is `<bodyName>`, or the first link of the model.
    """

    options = OptionsOf(UsvDynamicsOptions)
    filenames = ("libusv_gazebo_dynamics_plugin.so",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        o = self.options.read_all()
        report_negative(o)
        links = scene.all_links()
        link = find_link(scene, o.body_name, params.block("bodyName")) if o.body_name else next(iter(links), None)
        self._link = "" if link is None else link.scoped
        self.set_up_drag(
            scene,
            np.array([o.added_x, o.added_y, 0.1, 0.1, 0.1, o.added_yaw]),
            np.array([o.linear_x, o.linear_y, o.linear_z, o.linear_roll, o.linear_pitch, o.linear_yaw]),
            np.array([o.quadratic_x, o.quadratic_y, 0.0, 0.0, 0.0, o.quadratic_yaw]),
        )
        self._points = [
            (((part + 0.5) / o.parts - 0.5) * o.length, side * o.width / 2, 0.0)
            for side in (-1.0, 1.0)
            for part in range(o.parts)
        ]

    def before_step(self) -> None:
        """Apply drag and buoyancy for the next step."""
        super().before_step()
        if not len(self._links):
            return
        options, data = self.options, moving_data(self.sim)
        wrench = hull_wrench(
            data,
            self._links.ids[0],
            self._points,
            options.hull_radius,
            options.water_density * options.length / options.parts,
            options.water_level,
            waves_of(self, options.wave_model),
            self.sim.time,
            self.sim.mj_model.opt.gravity.tolist(),
        )
        self._links.push_some(data, {0: wrench})
