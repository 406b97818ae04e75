"""What keys do to a run: space pauses it and lets it go on, n does one step, the others drive."""

from __future__ import annotations

from collections import deque
from typing import TYPE_CHECKING

from simkit.cli.terminal.output import print_status

if TYPE_CHECKING:
    from simkit.cli.terminal.keyboard import Keyboard, WindowsKeyboard
    from simkit.cli.terminal.teleop import Teleop
    from simkit.runtime import Simulation

HINT = "space goes on, n does one step, Ctrl-C ends"


class RunKeys:
    """Asked between the slices of a run.

    Args:
        sim: the simulation.
        keyboard: where keys come from.
        teleop: takes those that drive.
    """

    def __init__(self, sim: Simulation, keyboard: Keyboard | WindowsKeyboard, teleop: Teleop | None = None) -> None:
        self._sim, self._keyboard, self._teleop = sim, keyboard, teleop
        self._was_told = self._was_hinted = False
        self._left: deque[str] = deque()
        self._step_ends: int | None = None  # the tick

    def poll(self) -> None:
        """Does what the keys pressed since say, each in its turn; what comes after a step, once that is done."""
        if not self._left:
            self._left.extend(self._keyboard.read())
        while self._left and not self._is_stepping():
            self.press(self._left.popleft())
        if self._keyboard.is_lost and self._teleop is not None and not self._was_told:
            self._was_told = True
            self._teleop.release_keys()
            print_status("the terminal is gone: the robot is stopped, no key will come any more")

    def _is_stepping(self) -> bool:
        """Whether a step that was asked for by a key is still to be done."""
        until: int | None = self._sim.control.pausing.until
        return until is not None and until == self._step_ends and self._sim.tick < until

    def say_paused(self) -> None:
        """Once, what keys a run that stands still waits for; that it does is seen."""
        if not self._was_hinted:
            self._was_hinted = True
            print_status(f"paused at t={self._sim.time:g} s: {HINT}")

    def press(self, key: str) -> None:
        """Does what a key says; one without a meaning does nothing."""
        pausing = self._sim.control.pausing
        if key == " ":
            if pausing.is_paused:
                pausing.resume()
                return
            if self._teleop is not None:
                self._teleop.stop()
            pausing.pause()
        elif key in (".", "n", "N"):
            pausing.step(1)
            self._step_ends = pausing.until
        elif self._teleop is not None:
            self._teleop.press(key)
