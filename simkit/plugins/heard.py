"""Readings that are taken only while somebody hears them: a run in which nobody does has no such task at all."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable

    from simkit.plugins.base import Plugin

_NS = 1_000_000_000


def publish_while_heard(
    plugin: Plugin, publisher: Any, rate: float, method: str, also: Callable[[], bool] = lambda: False
) -> None:
    """Calls a method of a plugin after steps, as `after_step` would be, while somebody hears its publisher.

    Args:
        plugin: whose method it is; what it raises is met as from a hook.
        publisher: by whom it publishes.
        rate: [Hz] on the grid of simulated time; 0 is every step.
        method: its name; without arguments.
        also: another reason to call it; say `sim.on_demand.look()` where that changes.
    """
    sim = plugin.sim
    sim.bus.on_audience(publisher.topic, sim.on_demand.look)
    task = sim.faults.task(plugin, method)
    sim.on_demand.add(lambda: publisher.active and (publisher.wanted or also()), rate or None, task)


def instants(plugin: Plugin, rate: float) -> int:
    """How many instants of a rate [Hz] (0: steps) have come since t = 0, whether anybody was there or not."""
    if rate <= 0:
        return int(plugin.sim.tick)
    return math.floor(plugin.sim.time_ns * rate / _NS + 1e-6)
