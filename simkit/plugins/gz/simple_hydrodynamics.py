"""Drag and added mass of a boat: `vrx::SimpleHydrodynamics` of VRX.

In the axes of the link, with the velocity ν = (u, v, w, p, q, r) of its centre of mass, the wrench at the centre of
mass is -M·dν/dt - D(ν)·ν. The added mass M and the drag D = linear + quadratic·|ν| are diagonal, with positive
elements. The Coriolis forces of the added mass are left out, as in VRX.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from simkit.params import LARGEST, Params
from simkit.plugins.base import ModelPlugin
from simkit.plugins.find_entities import find_named_link
from simkit.plugins.fluids.added_mass import SmoothedAcceleration, own_inertia
from simkit.plugins.fluids.link_forces import PushedLinks, cross, moving_data
from simkit.plugins.options import Options, OptionsOf, number, text
from simkit.pose import Vector

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.runtime import Model
    from simkit.scene import SceneModel

_MOST: Final = 1e12


class DragOptions(Options):
    """Added masses and drags of a boat."""

    added_x: float = number(5.0, "kg", element="xDotU", minimum=0, maximum=_MOST)
    added_y: float = number(5.0, "kg", element="yDotV", minimum=0, maximum=_MOST)
    added_yaw: float = number(1.0, "kg·m²", element="nDotR", minimum=0, maximum=_MOST)
    linear_x: float = number(20.0, "N·s/m", element="xU", minimum=-_MOST, maximum=_MOST)
    linear_y: float = number(20.0, "N·s/m", element="yV", minimum=-_MOST, maximum=_MOST)
    linear_z: float = number(20.0, "N·s/m", element="zW", minimum=-_MOST, maximum=_MOST)
    linear_roll: float = number(20.0, "N·m·s", element="kP", minimum=-_MOST, maximum=_MOST)
    linear_pitch: float = number(20.0, "N·m·s", element="mQ", minimum=-_MOST, maximum=_MOST)
    linear_yaw: float = number(20.0, "N·m·s", element="nR", minimum=-_MOST, maximum=_MOST)
    quadratic_x: float = number(0.0, "N·s²/m²", element="xUU", minimum=-_MOST, maximum=_MOST)
    quadratic_y: float = number(0.0, "N·s²/m²", element="yVV", minimum=-_MOST, maximum=_MOST)
    quadratic_yaw: float = number(0.0, "N·m·s²", element="nRR", minimum=-_MOST, maximum=_MOST)


class SimpleHydrodynamicsOptions(DragOptions):
    """Options of `SimpleHydrodynamics`."""

    link_name: str = text(None, required=True)
    added_z: float = number(0.1, "kg", element="zDotW", minimum=0, maximum=_MOST)
    added_roll: float = number(0.1, "kg·m²", element="kDotP", minimum=0, maximum=_MOST)
    added_pitch: float = number(0.1, "kg·m²", element="mDotQ", minimum=0, maximum=_MOST)
    quadratic_z: float = number(0.0, "N·s²/m²", element="zWW", minimum=-_MOST, maximum=_MOST)
    quadratic_roll: float = number(0.0, "N·m·s²", element="kPP", minimum=-_MOST, maximum=_MOST)
    quadratic_pitch: float = number(0.0, "N·m·s²", element="mQQ", minimum=-_MOST, maximum=_MOST)
    max_effort: float = number(10000.0, "N or N·m", minimum=0, maximum=LARGEST)


class BoatDragBase(ModelPlugin):
    """Base class of plugins that apply added mass and drag to a link. A subclass calls `set_up_drag` in `prepare`."""

    reads_at_load = ("inertial",)  # the smoothing follows from the mass

    _link: str
    _limit: float = LARGEST

    def set_up_drag(self, scene: SceneModel, added: Vector, linear: Vector, quadratic: Vector) -> None:
        """Set the added masses and the drags, in the order of ν, each of shape (6,)."""
        link = next((link for link in scene.all_links() if link.scoped == self._link), None)
        self._added, self._linear, self._quadratic = added, linear, quadratic
        self._acceleration = SmoothedAcceleration(own_inertia(link), added)

    def load(self, parent: Model, params: Params) -> None:
        self._links = PushedLinks(self.sim, (self._link,))

    def before_step(self) -> None:
        """Apply the wrench of the water for the next step."""
        if not self._links.is_current:
            self._links = PushedLinks(self.sim, (self._link,))
        if not len(self._links):
            return
        data = moving_data(self.sim)
        body, bodies = self._links.ids[0], self._links.bodies
        axes: Vector = data.xmat[body].reshape(3, 3)
        spin = data.cvel[bodies, :3]
        linear = self._links.velocities(data) + cross(spin, data.xipos[bodies] - data.xpos[bodies])
        velocity = np.concatenate((linear[0] @ axes, spin[0] @ axes))
        acceleration = self._acceleration.update(velocity, self.period)
        wrench = -self._added * acceleration - (self._linear + self._quadratic * np.abs(velocity)) * velocity
        force, torque = np.clip((axes @ wrench[:3], axes @ wrench[3:]), -self._limit, self._limit)
        self._links.push(data, force[None], torque[None])


class SimpleHydrodynamics(BoatDragBase):
    """Applies the drag and the added mass of water to a boat; unlike `Hydrodynamics`, all coefficients are positive.

    No component of force and torque in world axes exceeds `<max_effort>`.
    """

    options = OptionsOf(SimpleHydrodynamicsOptions)
    filenames = ("libSimpleHydrodynamics.so",)
    names = ("vrx::SimpleHydrodynamics",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        o = self.options.read_all()
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
