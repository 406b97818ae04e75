"""What the engine draws of a light whose description was changed."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import mujoco

from simkit.compiler.lights import add_light
from simkit.pose import IDENTITY

if TYPE_CHECKING:
    from simkit.runtime.light import Light
    from simkit.runtime.simulation import Simulation

_DRAWN: Final = ("diffuse", "specular", "attenuation", "range", "cutoff", "exponent", "castshadow")


def redraw(sim: Simulation, light: Light) -> None:
    """Writes to the model what the compiler would have made of the light as it is described now."""
    index = mujoco.mj_name2id(sim.mj_model, mujoco.mjtObj.mjOBJ_LIGHT, light.scoped)
    if index < 0:
        return
    spec = mujoco.MjSpec()
    add_light(spec.worldbody, light.scene, IDENTITY, sim.world.surroundings.shadows)
    drawn = spec.worldbody.lights[0]
    for field in _DRAWN:
        sim.touch(f"light_{field}")[index] = getattr(drawn, field)
