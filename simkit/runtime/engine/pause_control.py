"""Whether a run stands still: what pausing, stepping and running to a time mean.

As with gz's server, it is the one who keeps a world running (`simkit run`) that stands still while the world is paused,
and goes on when it is resumed. A script that calls `step` or `run` says itself how far to go, as with gz's multi-step,
and gets there.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from simkit.runtime.engine.engine import Engine


class Advance(Protocol):
    """Makes the steps up to a tick."""

    def __call__(self, target: int, *, is_served: bool = False) -> None:
        """Advances to `target`; a run that is served ends earlier where it is told to halt."""


class CommandGeneration(Protocol):
    """Commands that wait for the next step."""

    generation: int


class PauseControl:
    """Where a run is to stop.

    Args:
        engine: that is advanced.
        advance: makes the steps.
        commands: another generation of them tells of a restore or a reset.

    Attributes:
        until: the tick beyond which it does not go by itself; None where it runs on.
        is_stepping: whether it is on its way there by steps that were asked for.
        pace: the highest real-time factor that somebody asked for; None for none. It is no state of the world.
        is_served: whether somebody keeps the world running, so that what is asked for is done by them.
        is_over: whether the run has come to its end, so that `advance` goes no further; no state of the world.
    """

    def __init__(self, engine: Engine, advance: Advance, commands: CommandGeneration) -> None:
        self._engine, self._advance, self._commands = engine, advance, commands
        self.until: int | None = None
        self.is_stepping = False
        self.pace: float | None = None
        self.is_served = self.is_over = False
        self._watchers: list[Callable[[], None]] = []

    @property
    def is_paused(self) -> bool:
        """Whether the world stands still."""
        return self.until is not None and self._engine.tick >= self.until

    def on_change(self, callback: Callable[[], None]) -> None:
        """Calls back whenever somebody pauses the world, resumes it, or asks for steps."""
        self._watchers.append(callback)

    def pause(self) -> None:
        """Has the world stand still, once the step under way is done."""
        self._set(self._engine.tick, is_stepping=False)

    def resume(self) -> None:
        """Lets the world go on."""
        self._set(None, is_stepping=False)

    def step(self, count: int) -> None:
        """Has a world that is paused do so many steps, and pause again; more of them add up."""
        left = self.until - self._engine.tick if self.until is not None and self.is_stepping else 0
        self._set(self._engine.tick + max(0, left) + count, is_stepping=True)

    def run_to(self, time_ns: int) -> None:
        """Has the world go on to the first tick at or after a simulated time [ns], and pause there."""
        clock = self._engine.clock
        tick = clock.ticks(time_ns / 1e9)
        while clock.time_ns(tick) < time_ns:
            tick += 1
        while tick > 0 and clock.time_ns(tick - 1) >= time_ns:
            tick -= 1
        self._set(tick, is_stepping=False)

    def catch_up(self) -> None:
        """Goes where the run is to stop, where nobody else will: outside a step, in a world that nobody serves."""
        engine = self._engine
        if self.until is not None and not self.is_served and not engine.is_stepping and self.until > engine.tick:
            self._advance(self.until)

    @contextmanager
    def served(self) -> Iterator[None]:
        """Says that the world is kept running within."""
        self.is_served = True
        try:
            yield
        finally:
            self.is_served = False

    def end(self) -> None:
        """Has a run that is served end with the step under way."""
        self.is_over = True
        self._engine.loop.halt()

    def advance(self, count: int) -> None:
        """Goes on by up to `count` steps, as far as the world is let: what `simkit run` does again and again.

        It ends where a hook goes back to another time, which may be the one at which it began.
        """
        engine = self._engine
        end, commands = engine.tick + count, self._commands
        generation = commands.generation
        while commands.generation == generation and not self.is_over:
            stop = end if self.until is None else min(end, self.until)
            if engine.tick >= stop:
                return
            self._advance(stop, is_served=True)

    def _set(self, until: int | None, *, is_stepping: bool) -> None:
        if (until, is_stepping) == (self.until, self.is_stepping):
            return
        self.until, self.is_stepping = until, is_stepping
        self._engine.loop.halt()
        for watcher in self._watchers:
            watcher()

    def get_state(self) -> tuple[int | None, bool]:
        return self.until, self.is_stepping

    def set_state(self, state: tuple[int | None, bool]) -> None:
        self.until, self.is_stepping = state
