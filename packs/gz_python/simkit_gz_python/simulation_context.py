"""Simulation whose plugin code runs now, for `Node` of gz-transport: the constructor has no simulation as argument."""

from __future__ import annotations

import weakref
from typing import TYPE_CHECKING, TypeAlias

if TYPE_CHECKING:
    from simkit import Plugin, Simulation

Running: TypeAlias = "tuple[Simulation, Plugin | None]"
"""Simulation, and the plugin whose code runs now; None for the plugin outside of hooks."""

_current: Running | None = None
_latest: weakref.ref[Simulation] | None = None


def enter_simulation(sim: Simulation, owner: Plugin | None) -> Running | None:
    """Set the simulation and the plugin whose code runs now.

    Returns:
        Previous simulation and plugin, the argument for `leave_simulation`.
    """
    global _current, _latest
    previous, _current = _current, (sim, owner)
    if _latest is None or _latest() is not sim:
        _latest = weakref.ref(sim)
    return previous


def leave_simulation(previous: Running | None) -> None:
    """Restore the simulation from before `enter_simulation`."""
    global _current
    _current = previous


def current_simulation() -> Running | None:
    """Return the current simulation and plugin; outside of hooks, the last simulation and no plugin."""
    if _current is not None:
        return _current
    sim = _latest() if _latest is not None else None
    return (sim, None) if sim is not None else None
