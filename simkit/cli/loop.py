"""The loop around the loop: advances in short slices, so that commands, pace, progress and Ctrl-C get their turn."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from simkit.cli.console import say

if TYPE_CHECKING:
    from simkit.cli.interrupts import Interrupts
    from simkit.sinks.commands import Commands

_LONG, _SHORT = 0.05, 0.02  # [s] of wall time that a slice may and should take
_PACED = 0.02  # [s] of wall time that a slice stands for when a real-time factor is held
_PATH = 0.05  # [s] of simulated time between two points of a path
_STILL = 0.02  # [s] of wall time between two looks at whether a paused world goes on


class Loop:
    """Runs a simulation to an end.

    Args:
        sim: the simulation.
        commands: sent at their ticks.
        interrupts: asked between slices.
        watchers: called after every slice.
        rtf: highest real-time factor; None for as fast as it goes.
        follow: whether slices are short enough to draw a path from.
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
        self._sim, self._commands, self._interrupts, self._watchers = sim, commands, interrupts, watchers
        self._rtf = rtf
        self._longest = max(1, round(_PATH / sim.timestep)) if follow else 1 << 30
        if rtf is not None:
            self._longest = min(self._longest, max(1, round(_PACED * rtf / sim.timestep)))
        self._slice = min(max(1, round(0.01 / sim.timestep)), self._longest)
        self.keep_going: Callable[[], bool] = lambda: True
        self.before_slice: Callable[[], None] | None = None

    def run(self, duration: float | None) -> bool:
        """Advances `duration` [s], for ever where None; whether it came to its end without being stopped.

        What a plugin took back by a reset on the way counts, so that a run comes to an end.
        """
        sim = self._sim
        start_tick, start_wall = sim.tick, time.perf_counter()
        end = None if duration is None else sim.steps + round(duration / sim.timestep)
        was_paused = False
        with sim.pausing.served():
            while end is None or sim.steps < end:
                if self._interrupts.exit_code or not self.keep_going():
                    return False
                self._commands.send_due()
                if self.before_slice is not None:
                    self.before_slice()
                before = sim.tick
                if not sim.paused:
                    self._advance(end)
                for watch in self._watchers:
                    watch()
                if sim.paused:
                    if not was_paused:
                        say(f"paused at t={sim.time:g} s until a service lets it go on (Ctrl-C ends)")
                    time.sleep(_STILL)
                if sim.paused or was_paused or sim.tick < before:  # the pace counts from where it goes on
                    start_tick, start_wall = sim.tick, time.perf_counter()
                was_paused = sim.paused
                rtf = self._pace()
                if rtf is not None:
                    ahead = (sim.tick - start_tick) * sim.timestep / rtf - (time.perf_counter() - start_wall)
                    if ahead > 0:
                        time.sleep(ahead)
        return True

    def _pace(self) -> float | None:
        """The highest real-time factor: what the user asked for, else what a service did."""
        asked: float | None = self._sim.pausing.pace
        return self._rtf if self._rtf is not None else asked

    def _advance(self, end: int | None) -> None:
        sim = self._sim
        pace = self._pace()
        longest = self._slice if pace is None else max(1, round(_PACED * pace / sim.timestep))
        stop = sim.tick + min(self._slice, longest)
        if end is not None:
            stop = min(stop, sim.tick + end - sim.steps)
        ahead = self._commands.next_tick
        if ahead is not None:
            stop = min(stop, max(ahead, sim.tick + 1))
        whole = stop - sim.tick == self._slice
        begun = time.perf_counter()
        sim.pausing.advance(stop - sim.tick)
        taken = time.perf_counter() - begun
        if taken > _LONG:
            self._slice = max(1, self._slice // 2)
        elif whole and taken < _SHORT:
            self._slice = min(self._slice * 2, self._longest)
