"""Call a method of a plugin after steps only while somebody subscribes to what it publishes."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from simkit.plugins.base import Plugin
    from simkit.runtime import Publisher, Simulation


_NS = 1_000_000_000


def publish_while_subscribed(
    plugin: Plugin, publisher: Publisher, rate: float, method: str, also: Callable[[], bool] = lambda: False
) -> None:
    """Calls a method of a plugin after steps, as `after_step` would be, while somebody hears its publisher.

    Args:
        plugin: whose method it is; what it raises is met as from a hook.
        publisher: by whom it publishes.
        rate: [Hz] on the grid of simulated time; 0 is every step.
        method: its name; without arguments.
        also: another reason to call it; say `sim.communication.on_demand.look()` where that changes.
    """
    sim = plugin.sim
    sim.communication.bus.on_readers_change(publisher.topic, sim.communication.on_demand.look)
    task = sim.engine.faults.task(plugin, method)
    sim.communication.on_demand.add(lambda: publisher.active and (publisher.wanted or also()), rate or None, task)


def set_before_step_rate(plugin: Plugin, rate: float | None) -> None:
    """Has `before_step` of a plugin called at this rate [Hz] from now on."""
    if rate != plugin.before_step_rate:
        plugin.before_step_rate = rate
        plugin.sim.engine.reschedule()


def set_after_step_rate(plugin: Plugin, rate: float | None) -> None:
    """Has `after_step` of a plugin called at this rate [Hz] from now on."""
    if rate != plugin.after_step_rate:
        plugin.after_step_rate = rate
        plugin.sim.engine.reschedule()


def count_instants(plugin: Plugin, rate: float) -> int:
    """How many instants of a rate [Hz] (0: steps) have come since t = 0, whether anybody was there or not."""
    if rate <= 0:
        return int(plugin.sim.tick)
    return math.floor(plugin.sim.time_ns * rate / _NS + 1e-6)


class Watcher(Protocol):
    """A plugin that compares each step with the one before.

    Attributes:
        sim: its simulation.
        _was_heard: whether somebody heard it when that was last asked; False after `load`.
    """

    sim: Simulation
    _was_heard: bool

    def begin(self) -> None:
        """Takes the present state for that of the step before."""


def watch_while_subscribed(plugin: Watcher, publishers: Sequence[Publisher], method: str) -> None:
    """Calls a method of a plugin after every step while somebody hears one of its publishers.

    When that begins, `plugin.begin()` is called first, so that an event in the very next step is told too, and the
    events are the same whoever listens from when on.
    """
    sim = plugin.sim

    def is_heard() -> bool:
        heard = any(publisher.active and publisher.wanted for publisher in publishers)
        if heard and not plugin._was_heard:
            plugin.begin()
        plugin._was_heard = heard
        return heard

    for publisher in publishers:
        sim.communication.bus.on_readers_change(publisher.topic, sim.communication.on_demand.look)
    sim.communication.on_demand.add(is_heard, None, sim.engine.faults.task(plugin, method))
