"""Watching for events while somebody hears of them, and none of the rest of the time."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Protocol


class Watcher(Protocol):
    """A plugin that compares each step with the one before.

    Attributes:
        sim: its simulation.
        _was_heard: whether somebody heard it when that was last asked; False after `load`.
    """

    sim: Any
    _was_heard: bool

    def begin(self) -> None:
        """Takes the present state for that of the step before."""


def watch_while_heard(plugin: Watcher, publishers: Sequence[Any], method: str) -> None:
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
        sim.bus.on_audience(publisher.topic, sim.on_demand.look)
    sim.on_demand.add(is_heard, None, sim.faults.task(plugin, method))
