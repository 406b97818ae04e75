"""Run part `--watch`: reload a plugin after its file has changed, and continue the run from the present state."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, ClassVar

import typer

from simkit.cli.terminal.output import print_error, print_status
from simkit.errors import PluginError
from simkit.extend import OpenRun, RunPart, option

if TYPE_CHECKING:
    from simkit import Simulation
    from simkit.cli.run_loop import Interrupts, RunLoop
    from simkit.runtime import Snapshot

_POLL_SECONDS = 0.1  # [s] of wall time between two checks of the files while the run waits


@dataclass
class WatchPlugins(RunPart):
    """Watch of the files of plugins during the run."""

    place: ClassVar[int] = 50

    watch: Annotated[bool, option("Reload a plugin when its file changes.", None, "--watch")] = False

    @contextmanager
    def around_loop(self, run: OpenRun) -> Iterator[None]:
        """Watch the files between slices."""
        if self.watch:
            folders = [Path(folder) for folder in run.spec.options.get("plugin_paths", ())]
            watch = PluginWatch(run.sim, folders, run.interrupts, waits=run.spec.recording is None)
            run.loop.watchers.append(watch.poll)
            run.loop.before_slice.append(watch.keep)
            run.advance = partial(watch.run, run.loop)
        yield


class PluginWatch:
    """Watcher of plugin files that is polled between the slices of a run.

    After a plugin has raised an error and was corrected, the watcher continues the run.

    Args:
        sim: simulation to watch.
        plugin_paths: folders of the watched plugins.
        interrupts: Ctrl-C handler; it ends the wait for a correction.
        waits: True to wait for a correction when a plugin raises an error. Must be False while the run is recorded,
            because the run repeats the last slice and the recording would contain it twice.
    """

    def __init__(self, sim: Simulation, plugin_paths: Sequence[Path], interrupts: Interrupts, *, waits: bool) -> None:
        from simkit_authoring.plugin_reload import PluginReloader

        self._sim, self._interrupts, self._waits = sim, interrupts, waits
        self._reloader = PluginReloader(sim, plugin_paths, print_status)
        self._checkpoint: Snapshot | None = None
        files = self._reloader.files
        if files:
            print_status(f"watching {', '.join(path.name for path in files)}")
        else:
            print_status("--watch: no plugin of this world is in a folder of yours; add one with --plugin-path DIR")

    def poll(self) -> None:
        """Reload the plugins whose files have changed."""
        self._reloader.poll()

    def keep(self) -> None:
        """Store the state before a slice."""
        if self._waits:
            self._checkpoint = self._sim.snapshot()

    def run(self, loop: RunLoop, duration: float | None) -> None:
        """Advance the run by `duration` [s], or for ever if it is None.

        If a plugin raises an error, wait until its file is corrected.

        Raises:
            PluginError: a plugin raised an error, and the watcher does not wait.
            typer.Exit: the user interrupted the wait.
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
                print_status(f"waiting at {sim.time:.6g} s for a correction of the plugin; Ctrl-C ends the run")
                if not self._is_corrected():
                    raise typer.Exit(error.exit_code) from None

    def _is_corrected(self) -> bool:
        while not self._reloader.poll():
            if self._interrupts.exit_code:
                return False
            time.sleep(_POLL_SECONDS)
        return True
