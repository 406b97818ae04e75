"""Loop that advances a run in short slices, with commands, pace, progress and Ctrl-C between the slices."""

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
from simkit.cli.terminal.output import print_line, print_message
from simkit.cli.wall_time_limit import SignalHandler
from simkit.interrupts import note_stop_request

if TYPE_CHECKING:
    from simkit.bridges.live.server import Server
    from simkit.recording.command_script import Commands
    from simkit.runtime import Simulation


_LONG, _SHORT = 0.05, 0.02  # [s] of wall time above which slices are halved, and below which they are doubled
_PACED = 0.02  # [s] of wall time per slice with a limited real-time factor
_PAUSE_POLL_SECONDS = 0.02  # [s] of wall time between two checks for keys and for the end of a pause
_MAX_LAG_SECONDS = 0.25  # [s] of wall time that a run catches up; after a longer lag (Ctrl-Z) the pace restarts


class CommandSender(Protocol):
    """Protocol of a sender of commands at given ticks."""

    @property
    def next_tick(self) -> int | None:
        """Tick of the next command; None if there is none."""
        ...

    def send_due(self) -> None:
        """Send the commands that are due at the present tick."""
        ...


class RunLoop:
    """Loop that runs a simulation to its end.

    Args:
        sim: simulation to run.
        commands: commands to send at their ticks.
        interrupts: Ctrl-C handler, checked between slices.
        watchers: callbacks after every slice.
        rtf: highest real-time factor, until a client changes it; None keeps the simulation's current limit.

    Attributes:
        watchers: callbacks after every slice.
        senders: all senders of commands.
        pollers: callbacks between slices and during waits, for the keyboard and the requests of users.
        before_slice: callbacks before each slice.
        slice_limits: functions that adapt two lengths of slices [s, wall time]: slices above the first are halved,
            slices below the second are doubled.
        early_ends: checks between slices; a text, the reason, ends the run before its end.
        is_over: check between slices; True ends the run because it has reached its goal.
        server: server for other processes.
        on_pause: callback when the world becomes paused, or is paused at the start.
        resumers: names of what can resume a paused world without a terminal, for the message about the pause.
        start_lines: lines that are printed on standard output when the loop starts, after all other messages.
    """

    def __init__(
        self,
        sim: Simulation,
        commands: Commands,
        interrupts: Interrupts,
        watchers: list[Callable[[], object]],
        *,
        rtf: float | None = None,
    ) -> None:
        self._sim, self._interrupts, self.watchers = sim, interrupts, watchers
        if rtf is not None:
            sim.control.pausing.pace = rtf
        self._longest = 1 << 30
        self._slice = max(1, round(0.01 / sim.timestep))
        self._restart_pace()
        self.senders: list[CommandSender] = [commands]
        self.pollers: list[Callable[[], object]] = []
        self.before_slice: list[Callable[[], object]] = []
        self.slice_limits: list[Callable[[float, float], tuple[float, ...]]] = []
        self.early_ends: list[Callable[[], str]] = []
        self.is_over: Callable[[], bool] = lambda: False
        self.server: Server | None = None
        self.on_pause: Callable[[], None] = self._say_paused
        self.resumers = ["a service"]
        self.start_lines: list[str] = []

    def run(self, duration: float | None) -> bool:
        """Advance `duration` [s], or for ever if it is None; return True if the run reached its end.

        Steps before a reset by a plugin count too. Otherwise a plugin that resets the world regularly would prevent the
        end of the run.
        """
        sim = self._sim
        end = None if duration is None else sim.engine.steps + round(duration / sim.timestep)
        self._restart_pace()
        was_paused = sim.paused
        if was_paused:
            self.on_pause()
        while self.start_lines:
            print_line(self.start_lines.pop(0))
        with sim.control.pausing.served():
            while end is None or sim.engine.steps < end:
                if self._interrupts.exit_code or self.early_end() or self.is_over():
                    return False
                before = sim.tick
                self._take_commands()
                if not sim.paused:
                    self._advance(end)
                for watch in self.watchers:
                    watch()
                if sim.paused and not was_paused:
                    self.on_pause()
                if sim.paused or was_paused or sim.tick < before:
                    self._restart_pace()
                was_paused = sim.paused
                self._wait(_PAUSE_POLL_SECONDS if was_paused else self._ahead())
        return True

    def early_end(self) -> str:
        """Return the reason why the run must end before its end; empty to continue."""
        return next(filter(None, (check() for check in self.early_ends)), "")

    def limit_slices(self, seconds: float) -> None:
        """Make no slice longer than a simulated time [s]."""
        self._longest = max(1, round(seconds / self._sim.timestep))
        self._slice = min(self._slice, self._longest)

    def _take_commands(self) -> None:
        """Process the input between two slices: keys, due commands and requests of clients."""
        for poll in self.pollers:
            poll()
        for sender in self.senders:
            sender.send_due()
        for callback in self.before_slice:
            callback()
        if self.server is not None:
            self.server.poll()

    def _say_paused(self) -> None:
        print_message(f"paused at t={self._sim.time:g} s until {' or '.join(self.resumers)} resumes it (Ctrl-C ends)")

    # ------------------------------------------------------------------ pace

    def _restart_pace(self) -> None:
        """Restart the measurement of the pace at the present tick and wall time."""
        self._start: tuple[int, float, float | None] = (
            self._sim.tick,
            time.perf_counter(),
            self._sim.control.pausing.pace,
        )

    def _ahead(self) -> float:
        """Return the wall time [s] by which the run is ahead of its highest real-time factor; negative if it lags."""
        tick, wall, pace = self._start
        if pace != self._sim.control.pausing.pace:
            self._restart_pace()
            return 0.0
        if pace is None:
            return 0.0
        ahead: float = (self._sim.tick - tick) * self._sim.timestep / pace - (time.perf_counter() - wall)
        if ahead < -_MAX_LAG_SECONDS:
            self._restart_pace()
        return ahead

    def _wait(self, seconds: float) -> None:
        """Serve clients for some wall time [s]. Return early if the world is paused or resumed, or the pace changes."""
        sim, end = self._sim, time.perf_counter() + seconds
        was_paused, pace, until = sim.paused, sim.control.pausing.pace, sim.control.pausing.until
        while (left := end - time.perf_counter()) > 0 and not self._interrupts.exit_code:
            if self.server is None:
                time.sleep(min(left, _PAUSE_POLL_SECONDS))
            else:
                self.server.poll(min(left, _PAUSE_POLL_SECONDS))
            for poll in self.pollers:
                poll()
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
        is_full_slice = stop - sim.tick == self._slice
        begun = time.perf_counter()
        sim.control.pausing.advance(stop - sim.tick)
        elapsed = time.perf_counter() - begun
        long, short = (_LONG, _SHORT) if self.server is None else self.server.slices(_LONG, _SHORT)
        for limits in self.slice_limits:
            long, short = limits(long, short)
        if elapsed > long:
            self._slice = max(1, self._slice // 2)
        elif is_full_slice and elapsed < short:
            self._slice = min(self._slice * 2, self._longest)


class Interrupts:
    """Context manager that stores an interrupt instead of raising it.

    Args:
        noted: callback for a stored interrupt.

    Attributes:
        exit_code: 0, or the exit code of the process for the received signal.
    """

    def __init__(self, noted: Callable[[], None] | None = None) -> None:
        self.exit_code = 0
        self._noted = noted
        self._before: dict[int, SignalHandler] = {}

    def __enter__(self) -> Interrupts:
        if threading.current_thread() is threading.main_thread():
            for number in (signal.SIGINT, signal.SIGTERM):
                self._before[number] = signal.signal(number, self._note)
            hang_up = getattr(signal, "SIGHUP", None)  # Windows has no SIGHUP
            if hang_up is not None and signal.getsignal(hang_up) is signal.SIG_DFL:
                self._before[hang_up] = signal.signal(hang_up, self._hang_up)
        return self

    def __exit__(self, *_: object) -> None:
        for number, handler in self._before.items():
            signal.signal(number, handler)

    def _hang_up(self, number: int, frame: FrameType | None) -> None:
        """Redirect output to the null device after the terminal has closed."""
        null_device = os.open(os.devnull, os.O_WRONLY)
        for file in (1, 2):
            with suppress(OSError):
                if stat.S_ISCHR(os.fstat(file).st_mode):  # isatty is False for a closed terminal
                    os.dup2(null_device, file)
        os.close(null_device)
        self._note(number, frame)

    def _note(self, number: int, frame: FrameType | None) -> None:
        if self.exit_code:
            blocker = describe_blocking_plugin(frame)
            raise KeyboardInterrupt(f"in the middle of {blocker[1]}" if blocker else "")
        self.exit_code = 128 + number
        note_stop_request()
        if self._noted is not None:
            self._noted()
