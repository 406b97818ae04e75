"""Run part `--teleop`: drive with the keyboard; keys also pause and step a run that the options pause."""

from __future__ import annotations

import re
import sys
from collections import deque
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, ClassVar, Final

import typer

from simkit.bridges.teleop import KEY_TIMEOUT
from simkit.cli.run_part import OpenRun, RunPart, fill_in_value
from simkit.cli.run_verdict import RunVerdict
from simkit.cli.terminal.options import option
from simkit.cli.terminal.output import print_message, print_status
from simkit.errors import InputError
from simkit.run_spec import RunSpec

if TYPE_CHECKING:
    from simkit.bridges.teleop import Teleop
    from simkit.cli.terminal.keyboard import Keyboard, WindowsKeyboard
    from simkit.runtime import Simulation

_TOPIC: Final = re.compile(r"\w*/[\w/]*", re.ASCII)
HINT: Final = "space resumes, n advances one step, Ctrl-C ends"
_KEY_TIMEOUT_HELP = "Simulated seconds without a key after which --teleop stops; inf: never."


@dataclass
class KeyboardControl(RunPart):
    """Keyboard of the terminal. The topic of `--teleop` is empty for the world's only velocity topic."""

    place: ClassVar[int] = 10

    teleop: Annotated[str | None, option("Drive with the keyboard, on this velocity topic.", "[TOPIC]")] = None
    key_timeout: Annotated[float, option(_KEY_TIMEOUT_HELP, "S")] = KEY_TIMEOUT
    driver: Teleop | None = field(init=False, default=None)

    def __post_init__(self) -> None:
        """Check the value of --key-timeout."""
        if not self.key_timeout > 0:
            raise typer.BadParameter(f"{self.key_timeout} is not greater than 0", param_hint="--key-timeout")

    @classmethod
    def complete_words(cls, words: list[str]) -> list[str]:
        """Give --teleop its empty topic, unless the next word has a slash and no dot, and is not a file."""
        return fill_in_value(words, "--teleop", "", lambda word: _TOPIC.fullmatch(word) and not Path(word).exists())

    @property
    def is_watched(self) -> bool:
        """True if somebody drives."""
        return self.teleop is not None

    @contextmanager
    def around_run(self, spec: RunSpec, verdict: RunVerdict) -> Iterator[None]:
        """Check whether keys can be read for --teleop.

        Raises:
            InputError: SK-CLI-050 standard input is not a terminal.
        """
        from simkit.cli.terminal.keyboard import open_keyboard

        if self.teleop is not None and open_keyboard(sys.stdin) is None:
            raise InputError(
                "SK-CLI-050",
                "--teleop needs a terminal, but standard input is not a terminal",
                help="drive with --cmd-vel V,W or --script FILE.yaml, or with `simkit topic pub` in another terminal",
            )
        yield

    def after_loading(self, sim: Simulation) -> None:
        """Find the topic of --teleop."""
        if self.teleop is not None:
            from simkit.bridges.teleop import Teleop, find_target

            self.driver = Teleop(sim, find_target(sim, self.teleop), self.key_timeout)

    @contextmanager
    def around_loop(self, run: OpenRun) -> Iterator[None]:
        """Connect the keyboard to the loop, so that keys pause, step and drive the run."""
        if self.driver is not None:
            from simkit.cli.terminal.teleop_display import DriverLine

            run.progress_lines = DriverLine(run.sim, self.driver).lines
        keyboard = self._keyboard(run.spec)
        if keyboard is None:
            yield
            return
        keys = RunKeys(run.sim, keyboard, self.driver)
        run.loop.pollers.append(keys.poll)
        run.loop.on_pause = keys.say_paused
        if self.driver is not None:
            run.loop.senders.append(self.driver)
        with keyboard:
            yield

    def _keyboard(self, spec: RunSpec) -> Keyboard | WindowsKeyboard | None:
        """Open the terminal's keyboard for teleop, or if the options pause the run and its output is on the terminal.

        Keys that are typed during any other run are for the shell, which reads them after the run. If the output goes
        to a pager, the pager reads the keys. simkit then reads them only for teleop.
        """
        from simkit.cli.terminal.keyboard import open_keyboard

        if self.driver is None:
            is_paused_by_options = spec.paused or spec.steps is not None
            has_output = sys.stdout is not None and not sys.stdout.closed and sys.stdout.isatty()
            if not (is_paused_by_options and has_output):
                return None
        return open_keyboard(sys.stdin)


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
        if self._step_ends is not None and not self._is_stepping():
            if self._sim.control.pausing.is_paused:
                print_status(f"t={self._sim.time:.9g} s")
            self._step_ends = None
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
            print_message(f"paused at t={self._sim.time:g} s: {HINT}")

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
