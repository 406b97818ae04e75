"""Keys of a run: space pauses and resumes, n advances one step, all other keys drive."""

from __future__ import annotations

from collections import deque
from typing import TYPE_CHECKING

from simkit.cli.terminal.output import print_status

if TYPE_CHECKING:
    from simkit.bridges.teleop import Teleop
    from simkit.cli.terminal.keyboard import Keyboard, WindowsKeyboard
    from simkit.runtime import Simulation

HINT = "space resumes, n advances one step, Ctrl-C ends"


class RunKeys:
    """Key handler; the run polls it between its slices.

    Args:
        sim: simulation to control.
        keyboard: source of the keys.
        teleop: receiver of the driving keys; None without teleop.
    """

    def __init__(self, sim: Simulation, keyboard: Keyboard | WindowsKeyboard, teleop: Teleop | None = None) -> None:
        self._sim, self._keyboard, self._teleop = sim, keyboard, teleop
        self._has_reported_loss = self._was_hinted = False
        self._left: deque[str] = deque()
        self._step_ends: int | None = None  # tick of the end of the step

    def poll(self) -> None:
        """Process the keys pressed since the last call, in order. Keys after a step key wait until the step ends."""
        if not self._left:
            self._left.extend(self._keyboard.read())
        while self._left and not self._is_stepping():
            self.press(self._left.popleft())
        if self._keyboard.is_lost and self._teleop is not None and not self._has_reported_loss:
            self._has_reported_loss = True
            self._teleop.release_keys()
            print_status("the terminal has closed: the robot is stopped, and keys have no effect any more")

    def _is_stepping(self) -> bool:
        """Check whether the run still executes a step that a key requested."""
        until: int | None = self._sim.control.pausing.until
        return until is not None and until == self._step_ends and self._sim.tick < until

    def say_paused(self) -> None:
        """Print once which keys a paused run accepts."""
        if not self._was_hinted:
            self._was_hinted = True
            print_status(f"paused at t={self._sim.time:g} s: {HINT}")

    def press(self, key: str) -> None:
        """Process a key; an unknown key has no effect."""
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
