"""Step loop of a simulation: deliver commands, advance the physics, run due tasks."""

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
ScheduleInputs = Callable[[], object]

_LONGEST_WAIT = 5.0  # [s] of wall time that the program waits for the loops of other threads when it exits


class CommandSource(Protocol):
    """Commands that wait for the next step."""

    @property
    def inbox(self) -> Sized:
        """Waiting commands; empty if there are none."""

    @property
    def revision(self) -> int:
        """Counter that changes with every change of readers and publishers."""

    def deliver_inputs(self) -> None:
        """Pass the waiting commands to their inputs."""


class StepLoop:
    """Loop that advances the physics from one due tick to the next.

    Args:
        physics: physics to advance.
        commands: source of the commands that are delivered between two steps.
        fill: function that adds every task to the scheduler, in document order.
        inputs: function that returns what `fill` reads and a restored state may change; None if the tasks have states
            of their own.
    """

    def __init__(self, physics: Physics, commands: CommandSource, fill: ScheduleFiller, inputs: ScheduleInputs) -> None:
        self.scheduler = Scheduler(physics.clock)
        self._physics, self._commands, self._fill, self._inputs = physics, commands, fill, inputs
        self._filled_from: object = None
        self.jumped = self._target = 0
        self._readers = -1  # revision of the readers that the scheduler considers
        self.is_running = self._is_outdated = self._is_served = self._halts = False
        self._deferred: list[Callable[[], None]] = []
        self._idle = threading.Event()
        self._idle.set()
        _OPEN_LOOPS.loops.add(self)

    def reschedule(self) -> None:
        """Apply changed rates, sensors and plugins; within a hook, after the other tasks of the tick."""
        self._filled_from = None
        self.rewind()

    def rewind(self) -> None:
        """Continue from the present tick, which a restored state has set; equal tasks stay.

        Learning resets a world after every few seconds. Filling the schedule takes a fifth of the time of a reset.
        """
        self._is_outdated = True
        if not self.is_running:
            self._refill()

    def defer(self, call: Callable[[], None]) -> None:
        """Call a function at the end of the present step, after all tasks of its tick."""
        self._deferred.append(call)
        self._is_outdated = True

    def drop_deferred(self) -> None:
        """Drop the deferred calls, because another state replaces the present step."""
        self._deferred.clear()

    def halt(self) -> None:
        """End the run with the present step, if the run was started with `is_served`."""
        self._halts = self._halts or self._is_served

    def interrupt(self) -> None:
        """End the present call of `advance` with the present step, because other code must run at its tick."""
        self._halts = self.is_running

    def advance(self, target: int, *, is_served: bool = False) -> None:
        """Run up to the tick `target`.

        If a hook resets or restores, the total number of steps stays the same.

        Args:
            target: last tick.
            is_served: allow `halt` to end the run earlier.

        Raises:
            InputError: the loop is already running.
            SystemExit: the program is ending, and this thread is not waited for.
        """
        if self.is_running:
            message = "the simulation is already stepping; a hook, a callback or a second thread cannot step it"
            raise InputError("SK-CORE-003", message, shows_code=False)
        try:  # an interrupt can arrive after any of the next lines
            self.is_running, self._is_served, self._halts = True, is_served, False
            self._target = target
            self._idle.clear()
            self._run()
        finally:
            self.is_running = self._is_served = self._halts = False
            self._deferred.clear()
            self._idle.set()

    def advance_physics(self, target: int) -> bool:
        """Run up to the tick `target` if nothing but the physics runs on the way; else return False without a step.

        Any thread may call it between two calls of `advance`, while the thread of those waits.
        """
        before, sense, after = self.scheduler.before, self.scheduler.sense, self.scheduler.after
        if (
            self.is_running
            or self._is_outdated
            or self._commands.inbox
            or before.next < target
            or sense.next <= target
            or after.next <= target
            or before.every
            or sense.every
            or after.every
            or _OPEN_LOOPS.ending is not None
        ):
            return False
        physics = self._physics
        physics.advance(target - physics.tick)
        physics.check()
        return True

    def jump(self, ticks: int) -> None:
        """Shift the target by the number of ticks that a restore or reset moved the run."""
        self.jumped += ticks
        self._target += ticks

    def deliver_inputs(self) -> None:
        """Pass commands that wait for the next step to their inputs now."""
        if self._commands.inbox:
            self._commands.deliver_inputs()

    def _refill(self) -> None:
        deferred, self._deferred = self._deferred, []
        for call in deferred:
            call()
        self._is_outdated = False
        if self._filled_from is None or self._inputs() != self._filled_from:
            self.scheduler.clear()
            self._fill(self.scheduler)
            self._filled_from = self._inputs()
        self.scheduler.rewind(self._physics.tick)
        self._readers = self._commands.revision

    def _run(self) -> None:
        physics, commands, program = self._physics, self._commands, _OPEN_LOOPS
        before, sense, after = self.scheduler.before, self.scheduler.sense, self.scheduler.after
        while physics.tick < self._target and not self._halts:
            if program.ending is not None:
                program.end_this_thread()
            tick = physics.tick
            if self._readers != commands.revision:
                self._readers = commands.revision
                self.scheduler.renew_readers(tick)
            stop = sense.stop_before(tick, min(self._target, before.next, after.next))
            has_every = bool(before.every or after.every or sense.every)
            if has_every and stop - tick > 1 and not commands.inbox:
                self._run_single_steps(stop - 1)
                continue
            if commands.inbox:
                commands.deliver_inputs()
                if self._is_outdated:  # changes by an input apply from this step on
                    self._refill()
                    tick, has_every = physics.tick, bool(before.every or after.every or sense.every)
                    stop = sense.stop_before(tick, min(self._target, before.next, after.next))
                if commands.inbox:  # commands that an input sent belong to the next step
                    stop = tick + 1
            if before.every or before.next <= tick:
                for task in before.due(tick):
                    task(tick)
                if physics.tick == tick and not (self._is_outdated or commands.inbox):
                    # all due tasks are done: advance to the next due tick in one call
                    stop = sense.stop_before(tick, min(self._target, before.next, after.next))
            physics.advance(1 if has_every or self._halts else max(1, stop - tick))
            tick = physics.tick
            # a state with NaN or infinite numbers is neither measured nor published
            physics.check()
            # a callback may reset or restore: then the remaining tasks of this tick are skipped
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
        """Run up to the tick `stop`, through steps at which only the tasks of every step are due."""
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
    """All loops of the process: MuJoCo must not run while the interpreter shuts down.

    Attributes:
        loops: existing loops.
        ending: id of the thread that ends the program; None before its end.
    """

    def __init__(self) -> None:
        self.loops: weakref.WeakSet[StepLoop] = weakref.WeakSet()
        self.ending: int | None = None

    def end_this_thread(self) -> None:
        """End the calling thread silently, unless it is the thread that ends the program."""
        if self.ending != threading.get_ident():
            raise SystemExit


_OPEN_LOOPS: Final = _OpenLoops()


def stop_other_loops() -> None:
    """Stop the loops of other threads."""
    _OPEN_LOOPS.ending = threading.get_ident()
    for loop in list(_OPEN_LOOPS.loops):
        if not loop._idle.wait(_LONGEST_WAIT):
            break


atexit.register(stop_other_loops)
