"""Check of spinning and rolling friction that has no effect in contacts with other surfaces of the world."""

from __future__ import annotations

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.compiler.spec_builder import Compiled
from simkit.diagnostics import Diagnostics
from simkit.scene import SceneWorld

_SLIDING = 3  # dimension of a contact with sliding friction alone


def check_surfaces(world: SceneWorld, compiled: Compiled, diagnostics: Diagnostics) -> None:  # noqa: ARG001 - as others
    """Report collisions whose spinning or rolling friction another, more slippery surface switches off.

    A contact has the friction of the surface with the smaller coefficient. If this surface has no spinning and rolling
    friction, the contact has none.
    """
    model, names, reported = compiled.model, compiled.names, set()
    for link in names.links.values():
        where = {collision.scoped: collision.surface.where for collision in link.scene.collisions}
        for geom in link.geoms:
            name = names.geom_owner(geom)[1]
            if model.geom_condim[geom] <= _SLIDING or name in reported:
                continue
            others = _without_turning_friction(model, geom)
            if not others.size:
                continue
            reported.add(name)
            other = int(others[0])
            message = (
                f"collision {name!r}: its torsional or rolling friction has no effect in contacts with "
                f"{names.geom_owner(other)[1]!r}, whose friction coefficient is smaller "
                f"({model.geom_friction[other, 0]:g} instead of {model.geom_friction[geom, 0]:g})"
            )
            hint = "give the other surface the same friction coefficient, or torsional or rolling friction of its own"
            diagnostics.warning("SK-LINT-011", message, where.get(name, link.scene.where), hint)


def _without_turning_friction(model: mujoco.MjModel, geom: int) -> npt.NDArray[np.intp]:
    """Return the geoms that may touch a geom and whose surface switches off its spinning or rolling friction."""
    overruling = (model.geom_priority > model.geom_priority[geom]) & (model.geom_condim < model.geom_condim[geom])
    overruling &= model.body_weldid[model.geom_bodyid] != model.body_weldid[model.geom_bodyid[geom]]
    kinds, other = model.geom_contype[geom], model.geom_conaffinity[geom]
    overruling &= ((model.geom_contype & other) | (model.geom_conaffinity & kinds)) != 0
    geoms: npt.NDArray[np.intp] = overruling.nonzero()[0]
    return geoms
