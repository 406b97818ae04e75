"""The one loop in the house: commands in, the engine on, readings out, and only when something is due."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from simkit.errors import PluginError, SimkitError
from simkit.runtime.physics import Physics
from simkit.runtime.scheduler import Scheduler
from simkit.runtime.topics import TopicBus

Fill = Callable[[Scheduler], None]


class Loop:
    """Advances the physics from one due tick to the next.

    Args:
        physics: what is advanced.
        bus: whose queued commands are delivered between two steps.
        fill: puts every task into the scheduler, in document order.
    """

    def __init__(self, physics: Physics, bus: TopicBus, fill: Fill) -> None:
        self.scheduler = Scheduler(physics.clock)
        self._physics, self._bus, self._fill = physics, bus, fill
        self._running = self._is_outdated = False

    def reschedule(self) -> None:
        """Takes changed rates, sensors and plugins into account; within a hook, once the tick is dealt with."""
        self._is_outdated = True
        if not self._running:
            self._refill()

    def advance(self, target: int) -> None:
        """Runs up to the tick `target`."""
        self._running = True
        try:
            self._run(target)
        finally:
            self._running = False

    def _refill(self) -> None:
        self._is_outdated = False
        self.scheduler.clear()
        self._fill(self.scheduler)
        self.scheduler.rewind(self._physics.tick)

    def _run(self, target: int) -> None:
        physics, bus = self._physics, self._bus
        before, sense, after = self.scheduler.before, self.scheduler.sense, self.scheduler.after
        while physics.tick < target:
            tick = physics.tick
            if bus.inbox:
                bus.deliver_inputs()
            if before.every or before.next <= tick:
                for task in before.due(tick):
                    task(tick)
            if before.every or after.every or sense.every:
                count = 1
            else:
                count = max(1, min(target, before.next, sense.next, after.next) - tick)
            physics.advance(count)
            tick = physics.tick
            if sense.next <= tick or sense.every:
                physics.check()
                for task in sense.due(tick):
                    task(tick)
            if after.next <= tick or after.every:
                # a hook of every step costs more with a check each time: every 16th sees a bad number soon enough
                if tick & 15 == 0 or after.next <= tick:
                    physics.check()
                for task in after.due(tick):
                    task(tick)
            if self._is_outdated:
                self._refill()
        physics.check()


def guarded(sim: Any, plugin: Any, hook: str) -> Callable[..., None]:
    """A plugin's hook as a task; whatever it raises becomes a PluginError with name, place and time."""
    method = getattr(plugin, hook)

    def task(_: int = 0) -> None:
        try:
            method()
        except SimkitError:
            raise
        except Exception as error:
            raise PluginError(plugin.name, hook, sim.time, str(plugin.where), repr(error)) from error

    return task
