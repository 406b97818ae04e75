"""The loop around the loop: advances in short slices, so that commands, pace, progress and Ctrl-C get their turn."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Protocol

from simkit.cli.console import say

if TYPE_CHECKING:
    from simkit.cli.running.interrupts import Interrupts
    from simkit.live.server import Server
    from simkit.sinks.commands import Commands

_LONG, _SHORT = 0.05, 0.02  # [s] of wall time that a slice may and should take
_PACED = 0.02  # [s] of wall time that a slice stands for when a real-time factor is held
_PATH = 0.05  # [s] of simulated time between two points of a path
_STILL = 0.02  # [s] of wall time between two looks at keys, and at whether a paused world goes on
_BEHIND = 0.25  # [s] of wall time that is caught up; of more (a process that was stopped) the pace counts anew


class Sender(Protocol):
    """Sends commands at their ticks."""

    @property
    def next_tick(self) -> int | None:
        """The tick at which something is to be sent next; None for not at all."""
        ...

    def send_due(self) -> None:
        """Sends what is due at the present tick."""
        ...


class Loop:
    """Runs a simulation to an end.

    Args:
        sim: the simulation.
        commands: sent at their ticks.
        interrupts: asked between slices.
        watchers: called after every slice.
        rtf: highest real-time factor, until somebody asks for another; None for what was asked for, else as fast as it
            goes.
        follow: whether slices are short enough to draw a path from.

    Attributes:
        keep_going, is_over: asked between slices: the run was ended, or has come to its end.
        before_slice: called before each.
        senders: all that sends commands.
        poll_keys: called between slices and while the run waits: what a driver at the keyboard says.
        server: lets other processes talk to the run.
        on_pause: called when the world comes to stand still.
    """

    def __init__(
        self,
        sim: Any,
        commands: Commands,
        interrupts: Interrupts,
        watchers: list[Callable[[], None]],
        *,
        rtf: float | None = None,
        follow: bool = False,
    ) -> None:
        self._sim, self._interrupts, self._watchers = sim, interrupts, watchers
        if rtf is not None:
            sim.pausing.pace = rtf
        self._longest = max(1, round(_PATH / sim.timestep)) if follow else 1 << 30
        self._slice = min(max(1, round(0.01 / sim.timestep)), self._longest)
        self._count_anew()
        self.senders: list[Sender] = [commands]
        self.keep_going: Callable[[], bool] = lambda: True
        self.is_over: Callable[[], bool] = lambda: False
        self.before_slice: Callable[[], None] | None = None
        self.poll_keys: Callable[[], None] | None = None
        self.server: Server | None = None
        self.on_pause: Callable[[], None] = self._say_paused

    def run(self, duration: float | None) -> bool:
        """Advances `duration` [s], for ever where None; whether it came to its end without being stopped.

        What a plugin took back by a reset on the way counts, so that a run comes to an end.
        """
        sim = self._sim
        end = None if duration is None else sim.steps + round(duration / sim.timestep)
        self._count_anew()
        was_paused = False
        with sim.pausing.served():
            while end is None or sim.steps < end:
                if self._interrupts.exit_code or not self.keep_going() or self.is_over():
                    return False
                before = sim.tick
                self._take_commands()
                if not sim.paused:
                    self._advance(end)
                for watch in self._watchers:
                    watch()
                if sim.paused and not was_paused:
                    self.on_pause()
                if sim.paused or was_paused or sim.tick < before:
                    self._count_anew()
                was_paused = sim.paused
                self._wait(_STILL if was_paused else self._ahead())
        return True

    def _take_commands(self) -> None:
        """What comes in between two slices: keys, commands that are due, what clients ask for."""
        if self.poll_keys is not None:
            self.poll_keys()
        for sender in self.senders:
            sender.send_due()
        if self.before_slice is not None:
            self.before_slice()
        if self.server is not None:
            self.server.poll()

    def _say_paused(self) -> None:
        say(f"paused at t={self._sim.time:g} s until a service lets it go on (Ctrl-C ends)")

    # ------------------------------------------------------------------ pace

    def _count_anew(self) -> None:
        """From here and now on."""
        self._start: tuple[int, float, float | None] = self._sim.tick, time.perf_counter(), self._sim.pausing.pace

    def _ahead(self) -> float:
        """How long the run is to wait so that it is no faster than it may be [s]."""
        tick, wall, pace = self._start
        if pace != self._sim.pausing.pace:
            self._count_anew()
            return 0.0
        if pace is None:
            return 0.0
        ahead: float = (self._sim.tick - tick) * self._sim.timestep / pace - (time.perf_counter() - wall)
        if ahead < -_BEHIND:
            self._count_anew()
        return ahead

    def _wait(self, seconds: float) -> None:
        """Lets wall time pass, which is the clients' [s]; not all of it where the world is paused, or let go on."""
        sim, end = self._sim, time.perf_counter() + seconds
        was_paused, pace, until = sim.paused, sim.pausing.pace, sim.pausing.until
        while (left := end - time.perf_counter()) > 0 and not self._interrupts.exit_code:
            if self.server is None:
                time.sleep(min(left, _STILL))
            else:
                self.server.poll(min(left, _STILL))
            if self.poll_keys is not None:
                self.poll_keys()
            if (sim.paused, sim.pausing.pace, sim.pausing.until) != (was_paused, pace, until):
                return

    # ------------------------------------------------------------------ a slice

    def _advance(self, end: int | None) -> None:
        sim = self._sim
        pace = sim.pausing.pace
        longest = self._slice if pace is None else max(1, round(_PACED * pace / sim.timestep))
        stop = sim.tick + min(self._slice, longest)
        if end is not None:
            stop = min(stop, sim.tick + end - sim.steps)
        for ahead in [sender.next_tick for sender in self.senders]:
            if ahead is not None:
                stop = min(stop, max(ahead, sim.tick + 1))
        whole = stop - sim.tick == self._slice
        begun = time.perf_counter()
        sim.pausing.advance(stop - sim.tick)
        taken = time.perf_counter() - begun
        long, short = (_LONG, _SHORT) if self.server is None else self.server.slices(_LONG, _SHORT)
        if taken > long:
            self._slice = max(1, self._slice // 2)
        elif whole and taken < short:
            self._slice = min(self._slice * 2, self._longest)
