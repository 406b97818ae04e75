"""Advance a run in short slices, with commands, pace, progress and Ctrl-C between two of them."""

from __future__ import annotations

import os
import signal
import stat
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from types import FrameType
from typing import TYPE_CHECKING, Protocol

from simkit.cli.terminal.blocked_plugins import describe_blocking_plugin
from simkit.cli.terminal.output import print_status
from simkit.cli.wall_time_limit import SignalHandler

if TYPE_CHECKING:
    from simkit.bridges.live.server import Server
    from simkit.recording.command_script import Commands
    from simkit.runtime import Simulation


_LONG, _SHORT = 0.05, 0.02  # [s] of wall time that a slice may and should take
_PACED = 0.02  # [s] of wall time that a slice stands for when a real-time factor is held
_PATH = 0.05  # [s] of simulated time between two points of a path
_PAUSE_POLL_SECONDS = 0.02  # [s] of wall time between two looks at keys, and at whether a paused world goes on
_MAX_LAG_SECONDS = 0.25  # [s] of wall time that is caught up; of more (a process that was stopped) the pace counts anew


class CommandSender(Protocol):
    """Sends commands at their ticks."""

    @property
    def next_tick(self) -> int | None:
        """The tick at which something is to be sent next; None for not at all."""
        ...

    def send_due(self) -> None:
        """Sends what is due at the present tick."""
        ...


class RunLoop:
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
        sim: Simulation,
        commands: Commands,
        interrupts: Interrupts,
        watchers: list[Callable[[], None]],
        *,
        rtf: float | None = None,
        follow: bool = False,
    ) -> None:
        self._sim, self._interrupts, self._watchers = sim, interrupts, watchers
        if rtf is not None:
            sim.control.pausing.pace = rtf
        self._longest = max(1, round(_PATH / sim.timestep)) if follow else 1 << 30
        self._slice = min(max(1, round(0.01 / sim.timestep)), self._longest)
        self._count_anew()
        self.senders: list[CommandSender] = [commands]
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
        end = None if duration is None else sim.engine.steps + round(duration / sim.timestep)
        self._count_anew()
        was_paused = False
        with sim.control.pausing.served():
            while end is None or sim.engine.steps < end:
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
                self._wait(_PAUSE_POLL_SECONDS if was_paused else self._ahead())
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
        print_status(f"paused at t={self._sim.time:g} s until a service lets it go on (Ctrl-C ends)")

    # ------------------------------------------------------------------ pace

    def _count_anew(self) -> None:
        """From here and now on."""
        self._start: tuple[int, float, float | None] = (
            self._sim.tick,
            time.perf_counter(),
            self._sim.control.pausing.pace,
        )

    def _ahead(self) -> float:
        """How long the run is to wait so that it is no faster than it may be [s]."""
        tick, wall, pace = self._start
        if pace != self._sim.control.pausing.pace:
            self._count_anew()
            return 0.0
        if pace is None:
            return 0.0
        ahead: float = (self._sim.tick - tick) * self._sim.timestep / pace - (time.perf_counter() - wall)
        if ahead < -_MAX_LAG_SECONDS:
            self._count_anew()
        return ahead

    def _wait(self, seconds: float) -> None:
        """Lets wall time pass, which is the clients' [s]; not all of it where the world is paused, or let go on."""
        sim, end = self._sim, time.perf_counter() + seconds
        was_paused, pace, until = sim.paused, sim.control.pausing.pace, sim.control.pausing.until
        while (left := end - time.perf_counter()) > 0 and not self._interrupts.exit_code:
            if self.server is None:
                time.sleep(min(left, _PAUSE_POLL_SECONDS))
            else:
                self.server.poll(min(left, _PAUSE_POLL_SECONDS))
            if self.poll_keys is not None:
                self.poll_keys()
            if (sim.paused, sim.control.pausing.pace, sim.control.pausing.until) != (was_paused, pace, until):
                return

    # ------------------------------------------------------------------ a slice

    def _advance(self, end: int | None) -> None:
        sim = self._sim
        pace = sim.control.pausing.pace
        longest = self._slice if pace is None else max(1, round(_PACED * pace / sim.timestep))
        stop = sim.tick + min(self._slice, longest)
        if end is not None:
            stop = min(stop, sim.tick + end - sim.engine.steps)
        for ahead in [sender.next_tick for sender in self.senders]:
            if ahead is not None:
                stop = min(stop, max(ahead, sim.tick + 1))
        whole = stop - sim.tick == self._slice
        begun = time.perf_counter()
        sim.control.pausing.advance(stop - sim.tick)
        taken = time.perf_counter() - begun
        long, short = (_LONG, _SHORT) if self.server is None else self.server.slices(_LONG, _SHORT)
        if taken > long:
            self._slice = max(1, self._slice // 2)
        elif whole and taken < short:
            self._slice = min(self._slice * 2, self._longest)


class Interrupts:
    """While entered, an interrupt is noted instead of raised.

    Args:
        noted: called when one is.

    Attributes:
        exit_code: 0, or what the process is to return for the signal that came.
    """

    def __init__(self, noted: Callable[[], None] | None = None) -> None:
        self.exit_code = 0
        self._noted = noted
        self._before: dict[int, SignalHandler] = {}

    def __enter__(self) -> Interrupts:
        if threading.current_thread() is threading.main_thread():
            for number in (signal.SIGINT, signal.SIGTERM):
                self._before[number] = signal.signal(number, self._note)
            hang_up = getattr(signal, "SIGHUP", None)  # Windows has none
            if hang_up is not None and signal.getsignal(hang_up) is signal.SIG_DFL:
                self._before[hang_up] = signal.signal(hang_up, self._hang_up)
        return self

    def __exit__(self, *_: object) -> None:
        for number, handler in self._before.items():
            signal.signal(number, handler)

    def _hang_up(self, number: int, frame: FrameType | None) -> None:
        """The terminal is gone: what would still be written to it goes nowhere."""
        nowhere = os.open(os.devnull, os.O_WRONLY)
        for file in (1, 2):
            with suppress(OSError):
                if stat.S_ISCHR(os.fstat(file).st_mode):  # isatty says no of a terminal that is gone
                    os.dup2(nowhere, file)
        os.close(nowhere)
        self._note(number, frame)

    def _note(self, number: int, frame: FrameType | None) -> None:
        if self.exit_code:
            found = describe_blocking_plugin(frame)
            raise KeyboardInterrupt(f"in the middle of {found[1]}" if found else "")
        self.exit_code = 128 + number
        if self._noted is not None:
            self._noted()
