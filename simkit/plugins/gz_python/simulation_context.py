"""The simulation whose plugin code runs now: a Node of gz-transport belongs to it without being told."""

from __future__ import annotations

import weakref
from typing import TYPE_CHECKING, TypeAlias

if TYPE_CHECKING:
    from simkit.plugins.base import Plugin
    from simkit.runtime import Simulation

Running: TypeAlias = "tuple[Simulation, Plugin | None]"
"""A simulation, and the plugin whose code runs in it."""

_current: Running | None = None
_latest: weakref.ref[Simulation] | None = None


def enter_simulation(sim: Simulation, owner: Plugin | None) -> Running | None:
    """Says whose code runs now; gives what is to be handed to `leave_simulation`."""
    global _current, _latest
    before, _current = _current, (sim, owner)
    if _latest is None or _latest() is not sim:
        _latest = weakref.ref(sim)
    return before


def leave_simulation(before: Running | None) -> None:
    """Back to what `enter_simulation` gave."""
    global _current
    _current = before


def current_simulation() -> Running | None:
    """The simulation and the plugin whose code runs; outside of hooks the last simulation that ran one, and None."""
    if _current is not None:
        return _current
    sim = _latest() if _latest is not None else None
    return (sim, None) if sim is not None else None
