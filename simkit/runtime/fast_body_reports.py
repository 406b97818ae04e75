"""Warnings of bodies that are too fast for the length of a step."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from simkit.diagnostics import NOWHERE

if TYPE_CHECKING:
    from simkit.runtime.simulation import Simulation
    from simkit.runtime.speculative import Approach


class FastBodyReports:
    """Warns of what may pass through something else, once for each pair of collisions."""

    def __init__(self, sim: Simulation) -> None:
        self._sim = sim
        self._told: set[frozenset[str]] = set()

    def __call__(self, approaches: list[Approach]) -> None:
        """Warn of the pairs that are new."""
        sim = self._sim
        names = sim.structure.compiled.names
        for found in approaches:
            link, one, _ = names.geom_owner(found.geom)
            _, other, _ = names.geom_owner(found.other)
            one, other = one or "a geom", other or "a geom"
            pair = frozenset((one, other))
            if pair in self._told:
                continue
            self._told.add(pair)
            what = f"the height map {other}" if found.is_height_field else other
            travel = found.speed * sim.timestep
            message = (
                f"{one} may pass through {what}: it comes at {found.speed:.3g} m/s, {travel:.3g} m in a step of "
                f"{sim.timestep:g} s, and the thinner of the two is {found.thickness:.3g} m thick"
            )
            where = names.link(link).scene.where if link in names.links else NOWHERE
            sim.reports.warning(
                "SK-PHYS-031", message, where, f"<max_step_size>{_rounded_down(found.step):g}</max_step_size>"
            )


def _rounded_down(value: float) -> float:
    """Return a positive number with one digit that is not larger."""
    unit = 10.0 ** math.floor(math.log10(value))
    return math.floor(value / unit * (1.0 + 1e-12)) * unit
