"""Drag and added mass of a boat, with positive diagonal coefficients as in the plugins of VRX.

In the axes of the link, with the velocity ν = (u, v, w, p, q, r) of its centre of mass, the wrench at the centre of
mass is -M·dν/dt - D(ν)·ν. The added mass M and the drag D = linear + quadratic·|ν| are diagonal, with positive
elements. The Coriolis forces of the added mass are left out, as in VRX.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from simkit import ModelPlugin, Params
from simkit.extend import LARGEST, Options, Vector, number
from simkit.linear_algebra import matmul
from simkit_water_and_air.plugins.fluids.added_mass import SmoothedAcceleration, own_inertia
from simkit_water_and_air.plugins.fluids.link_forces import PushedLinks, cross, moving_data

if TYPE_CHECKING:
    from simkit import Model
    from simkit.extend import SceneModel

MOST: Final = 1e12
"""Largest coefficient that is accepted."""


class DragOptions(Options):
    """Added masses and drags of a boat."""

    added_x: float = number(5.0, "kg", element="xDotU", minimum=0, maximum=MOST)
    added_y: float = number(5.0, "kg", element="yDotV", minimum=0, maximum=MOST)
    added_yaw: float = number(1.0, "kg·m²", element="nDotR", minimum=0, maximum=MOST)
    linear_x: float = number(20.0, "N·s/m", element="xU", minimum=-MOST, maximum=MOST)
    linear_y: float = number(20.0, "N·s/m", element="yV", minimum=-MOST, maximum=MOST)
    linear_z: float = number(20.0, "N·s/m", element="zW", minimum=-MOST, maximum=MOST)
    linear_roll: float = number(20.0, "N·m·s", element="kP", minimum=-MOST, maximum=MOST)
    linear_pitch: float = number(20.0, "N·m·s", element="mQ", minimum=-MOST, maximum=MOST)
    linear_yaw: float = number(20.0, "N·m·s", element="nR", minimum=-MOST, maximum=MOST)
    quadratic_x: float = number(0.0, "N·s²/m²", element="xUU", minimum=-MOST, maximum=MOST)
    quadratic_y: float = number(0.0, "N·s²/m²", element="yVV", minimum=-MOST, maximum=MOST)
    quadratic_yaw: float = number(0.0, "N·m·s²", element="nRR", minimum=-MOST, maximum=MOST)


def report_negative(options: DragOptions) -> None:
    """Warn about negative drags, which have the sign of gz's `Hydrodynamics`."""
    for name, field in options.fields().items():
        if not name.startswith(("linear_", "quadratic_")) or getattr(options, name) >= 0:
            continue
        element = options.params.block(field.element)
        text = f"<{element.name}>{element.value}</{element.name}> is negative"
        effect = "the water accelerates the link along its velocity instead of braking it"
        hint = f"write a positive number: <{element.name}>{element.value.lstrip('-')}</{element.name}>"
        element.warning("SK-PLUGIN-118", f"{text}: {effect}", hint)


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
        velocity = np.concatenate((matmul(linear[0], axes), matmul(spin[0], axes)))
        acceleration = self._acceleration.update(velocity, self.period)
        wrench = -self._added * acceleration - (self._linear + self._quadratic * np.abs(velocity)) * velocity
        force, torque = np.clip((matmul(axes, wrench[:3]), matmul(axes, wrench[3:])), -self._limit, self._limit)
        self._links.push(data, force[None], torque[None])
