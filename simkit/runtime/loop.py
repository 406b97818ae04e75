"""The one loop in the house: commands in, the engine on, readings out, and only when something is due."""

from __future__ import annotations

import atexit
import threading
import weakref
from collections.abc import Callable
from typing import Any

from simkit.errors import PluginError, SimkitError
from simkit.runtime.physics import Physics
from simkit.runtime.scheduler import Scheduler
from simkit.runtime.topics import TopicBus

Fill = Callable[[Scheduler], None]

_LONGEST_WAIT = 5.0  # [s] of wall time, for what runs on other threads at the end of the program


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
        self._idle = threading.Event()
        self._idle.set()
        _loops.add(self)

    @property
    def is_running(self) -> bool:
        """Whether it is advancing."""
        return self._running

    def reschedule(self) -> None:
        """Takes changed rates, sensors and plugins into account; within a hook, once the tick is dealt with."""
        self._is_outdated = True
        if not self._running:
            self._refill()

    def advance(self, target: int) -> None:
        """Runs up to the tick `target`.

        Raises:
            SystemExit: the program has ended, and this is a thread that nobody waits for.
        """
        self._running = True
        self._idle.clear()
        try:
            self._run(target)
        finally:
            self._running = False
            self._idle.set()

    def _refill(self) -> None:
        self._is_outdated = False
        self.scheduler.clear()
        self._fill(self.scheduler)
        self.scheduler.rewind(self._physics.tick)

    def _run(self, target: int) -> None:
        physics, bus = self._physics, self._bus
        before, sense, after = self.scheduler.before, self.scheduler.sense, self.scheduler.after
        while physics.tick < target:
            _stop_at_the_end()
            tick = physics.tick
            stop = min(target, before.next, sense.next, after.next)
            has_every = before.every or after.every or sense.every
            if has_every and stop - tick > 1:
                self._walk(stop - 1)
                continue
            if bus.inbox:
                bus.deliver_inputs()
            if before.every or before.next <= tick:
                for task in before.due(tick):
                    task(tick)
            physics.advance(1 if has_every else max(1, stop - tick))
            tick = physics.tick
            # nothing is measured or published of a state with bad numbers
            physics.check()
            # who is called back may reset or restore: then the rest of this tick is not to be
            if sense.next <= tick or sense.every:
                for task in sense.due(tick):
                    task(tick)
                    if physics.tick != tick:
                        break
            if physics.tick == tick and (after.next <= tick or after.every):
                for task in after.due(tick):
                    task(tick)
                    if physics.tick != tick:
                        break
            if self._is_outdated:
                self._refill()

    def _walk(self, stop: int) -> None:
        """Up to the tick `stop`, through steps at which only what runs at every step is due."""
        physics, bus = self._physics, self._bus
        before, after = self.scheduler.before.every, [*self.scheduler.sense.every, *self.scheduler.after.every]
        tick = physics.tick
        while tick < stop and not self._is_outdated:
            _stop_at_the_end()
            if bus.inbox:
                bus.deliver_inputs()
            for task in before:
                task(tick)
            physics.single()
            tick += 1
            physics.check()
            for task in after:
                task(tick)
                if physics.tick != tick:
                    break
        if self._is_outdated:
            self._refill()


_loops: weakref.WeakSet[Loop] = weakref.WeakSet()
_ending: int | None = None
"""The thread that ends the program, once it does."""


def _stop_at_the_end() -> None:
    if _ending is not None and _ending != threading.get_ident():
        raise SystemExit  # ends this thread, without a word


def end_others() -> None:
    """Ends the loops of other threads: the engine must not be at work when the interpreter goes away under it."""
    global _ending
    _ending = threading.get_ident()
    for loop in list(_loops):
        if not loop._idle.wait(_LONGEST_WAIT):
            break


atexit.register(end_others)


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
