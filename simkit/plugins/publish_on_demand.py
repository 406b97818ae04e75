"""Callbacks after a step that run only while a topic of the plugin has subscribers."""

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
    """Call a method of a plugin after steps, like `after_step`, but only while its publisher has subscribers.

    Args:
        plugin: plugin with the method; exceptions in the method are handled as in a hook.
        publisher: publisher that the method uses.
        rate: rate of the calls in simulated time [Hz]; 0 for every step.
        method: name of the method, which has no arguments.
        also: function that returns true if the method must be called even without subscribers. After a change of the
            result, call `sim.communication.on_demand.look()`.
    """
    sim = plugin.sim
    sim.communication.bus.on_readers_change(publisher.topic, sim.communication.on_demand.look)
    task = sim.engine.faults.task(plugin, method)
    sim.communication.on_demand.add(lambda: publisher.active and (publisher.wanted or also()), rate or None, task)


def count_instants(plugin: Plugin, rate: float) -> int:
    """Return how many times a task with this rate [Hz] (0 for every step) is due from t = 0 until now.

    The result does not depend on subscribers.
    """
    if rate <= 0:
        return int(plugin.sim.tick)
    return math.floor(plugin.sim.time_ns * rate / _NS + 1e-6)


class Watcher(Protocol):
    """Plugin that compares the state after each step with the state after the previous step.

    Attributes:
        sim: simulation of the plugin.
        _was_heard: whether a publisher had subscribers at the last check; False after `load`.
    """

    sim: Simulation
    _was_heard: bool

    def begin(self) -> None:
        """Store the present state for the comparison after the next step."""


def watch_while_subscribed(
    plugin: Watcher, publishers: Sequence[Publisher], method: str, rate: float | None = None
) -> None:
    """Call a method of a plugin after steps while one of its publishers has subscribers.

    When the first subscriber connects, `plugin.begin()` is called. An event in the next step is therefore published,
    and the events do not depend on the time of the subscription.

    Args:
        plugin: plugin with the method.
        publishers: publishers that the method uses.
        method: name of the method, which has no arguments.
        rate: rate of the calls in simulated time [Hz]; None for every step.
    """
    sim = plugin.sim

    def has_subscribers() -> bool:
        subscribed = any(publisher.active and publisher.wanted for publisher in publishers)
        if subscribed and not plugin._was_heard:
            plugin.begin()
        plugin._was_heard = subscribed
        return subscribed

    for publisher in publishers:
        sim.communication.bus.on_readers_change(publisher.topic, sim.communication.on_demand.look)
    sim.communication.on_demand.add(has_subscribers, rate, sim.engine.faults.task(plugin, method))
