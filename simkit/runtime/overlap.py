"""What starts inside something else comes out slowly.

A contact corrects a depth r within its time constant, at a speed of up to r / (e · constant): 5 cm within 4 ms would
throw a body up a metre. So a geom that begins deep in another gets a longer constant until it is out.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, Final

from simkit.compiler.overlaps import DEEP

if TYPE_CHECKING:
    from simkit.runtime.simulation import Simulation

SPEED: Final = 0.1
"""[m/s] at which it comes out at most; it goes on rising by SPEED² / 2g = 0.5 mm."""

RATE: Final = 50.0
"""[Hz] at which it is looked whether it is out."""

_OUT: Final = 0.001
_GENTLE: Final = 2**31 - 1
_SOLIMP: Final = (0.9999, 0.9999, 0.001, 0.5, 2.0)
_FIELDS: Final = ("geom_solref", "geom_solimp", "geom_priority", "geom_friction", "geom_condim")


def is_any_gentle(model: Any) -> bool:
    """Whether some geom is on its way out of another."""
    return bool((model.geom_priority == _GENTLE).any())


def soften(sim: Simulation, geoms: Iterable[int] | None = None) -> None:
    """Looks for deep overlaps now, those of `geoms` or all, and softens the geoms that move."""
    model = sim.mj_model
    chosen = None if geoms is None else set(geoms)
    deepest: dict[int, float] = {}
    weakest: dict[int, tuple[float, int]] = {}
    data = sim.physics.fresh()
    for i in (data.contact.dist <= -DEEP).nonzero()[0] if data.ncon else ():
        contact = data.contact[int(i)]
        pair = [int(g) for g in contact.geom]
        if min(pair) < 0 or (chosen is not None and not chosen & set(pair)):
            continue
        for geom in pair:
            if model.body_weldid[model.geom_bodyid[geom]] == 0:
                continue
            deepest[geom] = max(deepest.get(geom, 0.0), -float(contact.dist))
            mu, dim = weakest.get(geom, (math.inf, 6))
            weakest[geom] = (min(mu, float(contact.friction[0])), min(dim, int(contact.dim)))
    if not deepest:
        return
    solref, solimp, priority, friction, condim = (sim.touch(field) for field in _FIELDS)
    for geom, depth in deepest.items():
        solref[geom] = (max(depth / (math.e * SPEED), 2.0 * sim.timestep), 1.0)
        solimp[geom] = _SOLIMP
        # the highest priority decides for the pair; the pair's friction stays what it was
        priority[geom] = _GENTLE
        friction[geom, 0], condim[geom] = weakest[geom]
    sim.reschedule()


def harden(sim: Simulation) -> None:
    """Gives back its own contact to every geom that is out."""
    model, data = sim.mj_model, sim.physics.fresh()
    inside = {int(g) for c in data.contact if c.dist < -_OUT for g in c.geom}
    out = [int(g) for g in (model.geom_priority == _GENTLE).nonzero()[0] if int(g) not in inside]
    if not out:
        return
    for field in _FIELDS:
        values, own = sim.touch(field), sim.original(field)
        values[out] = own[out]
    if not is_any_gentle(model):
        sim.reschedule()
