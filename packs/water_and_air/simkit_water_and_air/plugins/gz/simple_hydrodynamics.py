"""Drag and added mass of a boat: `vrx::SimpleHydrodynamics` of VRX, by `fluids.boat_drag`."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from simkit import Params
from simkit.extend import LARGEST, OptionsOf, find_named_link, number, text
from simkit_water_and_air.plugins.fluids.boat_drag import MOST, BoatDragBase, DragOptions, report_negative

if TYPE_CHECKING:
    from simkit.extend import SceneModel, SpecBuilder


class SimpleHydrodynamicsOptions(DragOptions):
    """Options of `SimpleHydrodynamics`."""

    link_name: str = text(None, required=True)
    added_z: float = number(0.1, "kg", element="zDotW", minimum=0, maximum=MOST)
    added_roll: float = number(0.1, "kg·m²", element="kDotP", minimum=0, maximum=MOST)
    added_pitch: float = number(0.1, "kg·m²", element="mDotQ", minimum=0, maximum=MOST)
    quadratic_z: float = number(0.0, "N·s²/m²", element="zWW", minimum=-MOST, maximum=MOST)
    quadratic_roll: float = number(0.0, "N·m·s²", element="kPP", minimum=-MOST, maximum=MOST)
    quadratic_pitch: float = number(0.0, "N·m·s²", element="mQQ", minimum=-MOST, maximum=MOST)
    max_effort: float = number(10000.0, "N or N·m", minimum=0, maximum=LARGEST)


class SimpleHydrodynamics(BoatDragBase):
    """Applies the drag and the added mass of water to a boat; unlike `Hydrodynamics`, all coefficients are positive.

    No component of force and torque in world axes exceeds `<max_effort>`.
    """

    options = OptionsOf(SimpleHydrodynamicsOptions)
    filenames = ("libSimpleHydrodynamics.so",)
    names = ("vrx::SimpleHydrodynamics",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        o = self.options.read_all()
        report_negative(o)
        self._link = find_named_link(scene, "link_name", params)
        self._limit = o.max_effort
        self.set_up_drag(
            scene,
            np.array([o.added_x, o.added_y, o.added_z, o.added_roll, o.added_pitch, o.added_yaw]),
            np.array([o.linear_x, o.linear_y, o.linear_z, o.linear_roll, o.linear_pitch, o.linear_yaw]),
            np.array(
                [o.quadratic_x, o.quadratic_y, o.quadratic_z, o.quadratic_roll, o.quadratic_pitch, o.quadratic_yaw]
            ),
        )
