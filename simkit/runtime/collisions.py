"""Which collisions make contacts, switched while a run goes on."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from simkit.runtime.physics import STALE

if TYPE_CHECKING:
    from simkit.runtime.simulation import Simulation

_FIELDS = ("geom_contype", "geom_conaffinity")


def enable_collisions(sim: Simulation, links: Iterable[str], enabled: bool, only: str = "") -> None:
    """Lets the collisions of links make contacts, or not; rays see them all the same.

    Args:
        sim: the simulation.
        links: scoped names.
        enabled: whether they do.
        only: scoped name of the one collision that is meant; all of the links' where it is empty.
    """
    names = sim.names
    geoms = [g for link in links for g in names.link(link).geoms if not only or names.geom_owner(g)[1] == only]
    for field in _FIELDS:
        values = sim.touch(field)
        values[geoms] = sim.original(field)[geoms] if enabled else 0
    sim.physics.changed(STALE)
