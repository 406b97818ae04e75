"""The one loop in the house: commands in, the engine on, readings out, and only when something is due."""

from __future__ import annotations

import atexit
import threading
import weakref
from collections.abc import Callable, Sized
from typing import Final, Protocol

from simkit.errors import InputError
from simkit.runtime.engine.physics_step import Physics
from simkit.runtime.engine.scheduler import Scheduler

ScheduleFiller = Callable[[Scheduler], None]

_LONGEST_WAIT = 5.0  # [s] of wall time, for what runs on other threads at the end of the program


class CommandSource(Protocol):
    """Commands that wait for the next step."""

    @property
    def inbox(self) -> Sized:
        """What waits; empty where nothing does."""

    def deliver_inputs(self) -> None:
        """Hands what waits to its inputs."""


class StepLoop:
    """Advances the physics from one due tick to the next.

    Args:
        physics: what is advanced.
        commands: delivered between two steps.
        fill: puts every task into the scheduler, in document order.
    """

    def __init__(self, physics: Physics, commands: CommandSource, fill: ScheduleFiller) -> None:
        self.scheduler = Scheduler(physics.clock)
        self._physics, self._commands, self._fill = physics, commands, fill
        self.jumped = self._target = 0
        self.is_running = self._is_outdated = self._is_served = self._halts = False
        self._deferred: list[Callable[[], None]] = []
        self._idle = threading.Event()
        self._idle.set()
        _OPEN_LOOPS.loops.add(self)

    def reschedule(self) -> None:
        """Takes changed rates, sensors and plugins into account; within a hook, once the tick is dealt with."""
        self._is_outdated = True
        if not self.is_running:
            self._refill()

    def defer(self, call: Callable[[], None]) -> None:
        """Has something done at the end of the step under way, once all that is due at its tick has been done."""
        self._deferred.append(call)
        self._is_outdated = True

    def drop_deferred(self) -> None:
        """Says that the step under way will not end: the state is set to another one."""
        self._deferred.clear()

    def halt(self) -> None:
        """Ends the run with the step under way, where it is one that heeds this."""
        self._halts = self._is_served

    def advance(self, target: int, *, is_served: bool = False) -> None:
        """Runs up to the tick `target`; where a hook goes back or forth in time on the way, as many steps all the same.

        Args:
            target: where to.
            is_served: whether `halt` ends the run earlier.

        Raises:
            InputError: it is advancing already.
            SystemExit: the program has ended, and this is a thread that nobody waits for.
        """
        if self.is_running:
            message = "a step is under way: a hook or callback cannot step the simulation, nor a second thread"
            raise InputError(message, "SK-CORE-003")
        self.is_running, self._is_served, self._halts = True, is_served, False
        self._target = target
        self._idle.clear()
        try:
            self._run()
        finally:
            self.is_running = self._is_served = self._halts = False
            self._deferred.clear()
            self._idle.set()

    def jump(self, ticks: int) -> None:
        """Told that the run was taken so many ticks further, or back, by a restore or a reset."""
        self.jumped += ticks
        self._target += ticks

    def _refill(self) -> None:
        deferred, self._deferred = self._deferred, []
        for call in deferred:
            call()
        self._is_outdated = False
        self.scheduler.clear()
        self._fill(self.scheduler)
        self.scheduler.rewind(self._physics.tick)

    def _run(self) -> None:
        physics, commands, program = self._physics, self._commands, _OPEN_LOOPS
        before, sense, after = self.scheduler.before, self.scheduler.sense, self.scheduler.after
        while physics.tick < self._target and not self._halts:
            if program.ending is not None:
                program.end_this_thread()
            tick = physics.tick
            stop = min(self._target, before.next, sense.next, after.next)
            has_every = bool(before.every or after.every or sense.every)
            if has_every and stop - tick > 1 and not commands.inbox:
                self._run_single_steps(stop - 1)
                continue
            if commands.inbox:
                commands.deliver_inputs()
                if self._is_outdated:  # what an input changes counts from this step on, whatever else is due when
                    self._refill()
                    tick, has_every = physics.tick, bool(before.every or after.every or sense.every)
                    stop = min(self._target, before.next, sense.next, after.next)
                if commands.inbox:  # what an input sent is taken with the next step
                    stop = tick + 1
            if before.every or before.next <= tick:
                for task in before.due(tick):
                    task(tick)
                if physics.tick == tick and not (self._is_outdated or commands.inbox):
                    # what was due is dealt with: on to what is due next, in one go
                    stop = min(self._target, before.next, sense.next, after.next)
            physics.advance(1 if has_every or self._halts else max(1, stop - tick))
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

    def _run_single_steps(self, stop: int) -> None:
        """Up to the tick `stop`, through steps at which only what runs at every step is due."""
        physics, commands, program = self._physics, self._commands, _OPEN_LOOPS
        before, after = self.scheduler.before.every, [*self.scheduler.sense.every, *self.scheduler.after.every]
        tick = physics.tick
        while tick < stop and not (self._is_outdated or self._halts or commands.inbox):
            if program.ending is not None:
                program.end_this_thread()
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


class _OpenLoops:
    """Every loop of the process: MuJoCo must not be at work when the interpreter goes away under it.

    Attributes:
        loops: those that are there.
        ending: the thread that ends the program, once it does.
    """

    def __init__(self) -> None:
        self.loops: weakref.WeakSet[StepLoop] = weakref.WeakSet()
        self.ending: int | None = None

    def end_this_thread(self) -> None:
        """Ends the calling thread, without a word, unless it is the one that ends the program."""
        if self.ending != threading.get_ident():
            raise SystemExit


_OPEN_LOOPS: Final = _OpenLoops()


def stop_other_loops() -> None:
    """Ends the loops of other threads."""
    _OPEN_LOOPS.ending = threading.get_ident()
    for loop in list(_OPEN_LOOPS.loops):
        if not loop._idle.wait(_LONGEST_WAIT):
            break


atexit.register(stop_other_loops)
