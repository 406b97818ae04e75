"""Keeps what a bundle needs while a simulation runs, and writes it when it is asked to, or when something fails."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any, Final

from simkit.errors import InputError, SimkitError
from simkit.runtime.engine.snapshot import state_hash
from simkit.testing.bundles.journal_writer import JournalWriter
from simkit.testing.bundles.manifest import Failure, RunEnd
from simkit.testing.bundles.message_window import MessageWindow, StateHashes

if TYPE_CHECKING:
    from simkit.runtime import Simulation

WINDOW_SECONDS: Final = 10.0
"""So much of a run's end is kept, where nothing is said [s]."""
NOT_RECORDED: Final = "SK-BUNDLE-007"


class BundleRecorder:
    """Writes down what comes into a run and keeps its last seconds; a context manager around it.

    Args:
        sim: as `simkit.load` gave it, nothing done yet.
        seconds: how much of the end is kept [s] of simulated time.
        topics: shell patterns of topics that are kept although they are pictures.
        write_failed: writes a bundle when something is raised within the `with`; None for no bundle.

    Attributes:
        sim: the simulation.
        journal: what came in.
        window: the last seconds.
        marks: of the state.
        written: where it was written, once it was.

    Raises:
        InputError: SK-BUNDLE-007 the run has begun already, or was not loaded by `simkit.load`.
    """

    def __init__(
        self,
        sim: Simulation,
        seconds: float = WINDOW_SECONDS,
        topics: Sequence[str] = (),
        write_failed: Callable[[BundleRecorder, Exception], Path] | None = None,
    ) -> None:
        if sim.run_spec is None or sim.engine.steps or sim.communication.bus.inbox:
            why = "has begun already" if sim.run_spec is not None else "was not loaded by simkit.load"
            raise InputError(
                f"{NOT_RECORDED} a bundle begins with the run, and this one {why}; keep it right after load",
                NOT_RECORDED,
            )
        if sim.communication.bus.journal is not None:
            raise InputError(f"{NOT_RECORDED} this run is kept already", NOT_RECORDED)
        self.sim, self.seconds, self.topics, self._write_failed = sim, float(seconds), tuple(topics), write_failed
        self.written: Path | None = None
        self.window = MessageWindow(sim, seconds, topics)
        self.marks = StateHashes(sim)
        self.journal = JournalWriter(sim)
        self._listen()

    def end(self, failure: Failure | None = None) -> RunEnd:
        """How the run stands."""
        sim = self.sim
        return RunEnd(sim.engine.steps, sim.tick, sim.time_ns, state_hash(sim), failure)

    def _listen(self) -> None:
        sim, sources = self.sim, self.journal.sources
        read = self._read = sim.contents.models_reader

        def heard(source: Any, *args: Any, **named: Any) -> Any:
            sources.append(str(source))
            return read(source, *args, **named)

        sim.contents.models_reader = heard
        self.journal.keeper = self
        sim.communication.bus.journal = self.journal

    def close(self) -> None:
        """Keeps nothing more; what was kept stays."""
        self.sim.communication.bus.journal, self.sim.contents.models_reader = None, self._read
        self.window.close()
        self.marks.close()

    def __enter__(self) -> BundleRecorder:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._write_failed is not None and isinstance(error, Exception):
            try:
                self.written = self._write_failed(self, error)
            except (SimkitError, OSError) as problem:  # what went wrong with the run goes on being raised
                error.add_note(f"no bundle was written: {problem}")
            else:
                error.add_note(f"a bundle that repeats this: simkit replay {self.written}")
        self.close()


def recorder_of(sim: Simulation) -> BundleRecorder:
    """Who keeps a simulation.

    Raises:
        InputError: SK-BUNDLE-007 nobody does.
    """
    journal = sim.communication.bus.journal
    keeper = getattr(journal, "keeper", None)
    if not isinstance(keeper, BundleRecorder):
        raise InputError(
            f"{NOT_RECORDED} this run is not kept: call simkit.testing.bundles.keep(sim) right after load", NOT_RECORDED
        )
    return keeper
