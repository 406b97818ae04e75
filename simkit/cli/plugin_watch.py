"""`simkit run --watch`: a plugin whose file was changed is reloaded, and the run goes on from where it is."""

from __future__ import annotations

import time
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from simkit.cli.terminal.output import print_error, print_status
from simkit.errors import PluginError

if TYPE_CHECKING:
    from simkit.cli.run_loop import Interrupts, RunLoop
    from simkit.runtime import Simulation, Snapshot

_POLL_SECONDS = 0.1  # [s] of wall time between two looks at the files while the run waits


class PluginWatch:
    """Polls between the slices of a run, and takes it up again after a plugin has raised and was mended.

    Args:
        sim: the simulation.
        plugin_paths: folders whose plugins are watched.
        interrupts: end the waiting.
        waits: whether the run waits for an edit when a plugin raises. A recording that goes on would have the time
            since the last slice twice, so with one it does not.
    """

    def __init__(self, sim: Simulation, plugin_paths: Sequence[Path], interrupts: Interrupts, *, waits: bool) -> None:
        from simkit.plugins.authoring.plugin_reload import PluginReloader

        self._sim, self._interrupts, self._waits = sim, interrupts, waits
        self._reloader = PluginReloader(sim, plugin_paths, print_status)
        self._checkpoint: Snapshot | None = None
        files = self._reloader.files
        if files:
            print_status(f"watching {', '.join(path.name for path in files)}")
        else:
            print_status("--watch: no plugin of this world comes from a file of yours (--plugin-path DIR allows some)")

    def poll(self) -> None:
        """Reloads what was changed."""
        self._reloader.poll()

    def keep(self) -> None:
        """Remembers the state before a slice."""
        if self._waits:
            self._checkpoint = self._sim.snapshot()

    def run(self, loop: RunLoop, duration: float | None) -> None:
        """Advances `duration` [s], for ever where None; a plugin that raises is waited for.

        Raises:
            PluginError: a plugin raised, and it is not to be waited for.
            typer.Exit: it was interrupted while it waited.
        """
        sim = self._sim
        end = None if duration is None else sim.tick + round(duration / sim.timestep)
        while True:
            left = None if end is None else (end - sim.tick) * sim.timestep
            try:
                loop.run(left)
                return
            except PluginError as error:
                if not self._waits or self._checkpoint is None or not self._reloader.files:
                    raise
                print_error(error)
                sim.restore(self._checkpoint)
                print_status(f"waiting at {sim.time:.6g} s for the plugin to be mended; Ctrl-C ends the run")
                if not self._is_mended():
                    raise typer.Exit(error.exit_code) from None

    def _is_mended(self) -> bool:
        while not self._reloader.poll():
            if self._interrupts.exit_code:
                return False
            time.sleep(_POLL_SECONDS)
        return True
