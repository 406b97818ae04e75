"""Simulation whose plugin code runs at the moment, for Nodes of gz-transport, which have no such argument."""

from __future__ import annotations

import weakref
from typing import TYPE_CHECKING, TypeAlias

if TYPE_CHECKING:
    from simkit.plugins.base import Plugin
    from simkit.runtime import Simulation

Running: TypeAlias = "tuple[Simulation, Plugin | None]"
"""Simulation, and the plugin whose code runs in it."""

_current: Running | None = None
_latest: weakref.ref[Simulation] | None = None


def enter_simulation(sim: Simulation, owner: Plugin | None) -> Running | None:
    """Set the simulation and the plugin whose code runs; return the value for `leave_simulation`."""
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
    """Return the current simulation and plugin; outside of hooks the last simulation, and None as the plugin."""
    if _current is not None:
        return _current
    sim = _latest() if _latest is not None else None
    return (sim, None) if sim is not None else None
