"""Welds between two links that plugins add, close and open while the simulation runs."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from simkit.runtime import Simulation


def has_weld(sim: Simulation, weld: str) -> bool:
    """Check whether a weld exists; the removal of one of its links removes it."""
    try:
        sim.engine.names.equality(weld)
    except KeyError:
        return False
    return True


def close_weld(sim: Simulation, weld: str, parent_link: str, child_link: str) -> None:
    """Fix a link to another link in their present relative pose; the links are scoped names."""
    if not has_weld(sim, weld):
        sim.contents.add_weld(weld, parent_link, child_link)
    sim.contents.set_weld(weld, True)


def open_weld(sim: Simulation, weld: str) -> bool:
    """Release the links of a weld; return False if the weld no longer exists."""
    exists = has_weld(sim, weld)
    if exists:
        sim.contents.set_weld(weld, False)
    return exists
