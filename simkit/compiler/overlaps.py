"""What starts inside something else, and is reported; the runtime lets it out slowly."""

from __future__ import annotations

from typing import Final

import mujoco

from simkit.compiler.names import NameMap
from simkit.diagnostics import Diagnostics, Where

DEEP: Final = 0.005
"""Overlaps up to this depth [m] at the start are ordinary and push things apart gently."""

_REPORTED_MOST: Final = 20


def report_overlaps(model: mujoco.MjModel, names: NameMap, diagnostics: Diagnostics, where: Where) -> None:
    """Warns of each pair of collisions that overlap deeply in the first state; the deepest contact of a pair counts."""
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    mujoco.mj_collision(model, data)
    deepest: dict[tuple[str, str], float] = {}
    for i in (data.contact.dist < -DEEP).nonzero()[0] if data.ncon else ():
        first, second = (names.geom_owner(g)[1] for g in data.contact.geom[i])
        if not (first and second):  # a cloth or the like, of a file of the engine's own
            continue
        pair = (first, second)
        deepest[pair] = max(deepest.get(pair, 0.0), -float(data.contact.dist[i]))
    for (first, second), depth in sorted(deepest.items(), key=lambda item: -item[1])[:_REPORTED_MOST]:
        diagnostics.warning(
            "SK-PHYS-024",
            f"{second} starts {depth * 1e3:.0f} mm inside {first}: contact moves them apart, slowly",
            names.link(names.geom_owner_link(second)).scene.where if names.geom_owner_link(second) else where,
            "move one of them in the file",
        )
