"""Keeps what a bundle needs while a simulation runs, and writes it when it is asked to, or when something fails."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any, Final

from simkit.errors import InputError, SimkitError
from simkit.runtime.engine.snapshot import state_hash
from simkit.testing.bundles.journal_writer import JournalWriter
from simkit.testing.bundles.manifest import CHECK, Failure, RunEnd
from simkit.testing.bundles.message_window import MessageWindow, StateHashes

if TYPE_CHECKING:
    from simkit.runtime import Simulation
    from simkit.testing.conditions import CheckResult

WINDOW_SECONDS: Final = 10.0
"""So much of a run's end is kept, where nothing is said [s]."""
NOT_RECORDED: Final = "SK-BUNDLE-007"
_FOLDERS: Final = re.compile(r"(?<![\w:/.])(?:[A-Za-z]:)?(?:[/\\][^\s/\\:'\"()]+)*[/\\](?=[^\s/\\:'\"()]+\.\w)")


class BundleRecorder:
    """Writes down what comes into a run and keeps its last seconds; a context manager around it.

    Args:
        sim: as `simkit.load` gave it, nothing done yet.
        seconds: how much of the end is kept [s] of simulated time.
        topics: shell patterns of topics that are kept although they are pictures.
        folder: where a bundle is written when something is raised within the `with`; None for nowhere.

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
        folder: Path | None = None,
    ) -> None:
        if sim.origin is None or sim.steps or sim.bus.inbox:
            why = "has begun already" if sim.origin is not None else "was not loaded by simkit.load"
            raise InputError(
                f"{NOT_RECORDED} a bundle begins with the run, and this one {why}; keep it right after load",
                NOT_RECORDED,
            )
        if sim.bus.journal is not None:
            raise InputError(f"{NOT_RECORDED} this run is kept already", NOT_RECORDED)
        self.sim, self.seconds, self.topics, self._folder = sim, float(seconds), tuple(topics), folder
        self.written: Path | None = None
        self.window = MessageWindow(sim, seconds, topics)
        self.marks = StateHashes(sim)
        self.journal = JournalWriter(sim)
        self._listen()

    def end(self, failure: Failure | None = None) -> RunEnd:
        """How the run stands."""
        sim = self.sim
        return RunEnd(sim.steps, sim.tick, sim.time_ns, state_hash(sim), failure)

    def _listen(self) -> None:
        sim, sources = self.sim, self.journal.sources
        read = self._read = sim.models_reader

        def heard(source: Any, *args: Any, **named: Any) -> Any:
            sources.append(str(source))
            return read(source, *args, **named)

        sim.models_reader = heard
        self.journal.keeper = self
        sim.bus.journal = self.journal

    def close(self) -> None:
        """Keeps nothing more; what was kept stays."""
        self.sim.bus.journal, self.sim.models_reader = None, self._read
        self.window.close()
        self.marks.close()

    def __enter__(self) -> BundleRecorder:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._folder is not None and isinstance(error, Exception):
            try:
                self.written = write_failed(self, self._folder, error)
            except (SimkitError, OSError) as problem:  # what went wrong with the run goes on being raised
                error.add_note(f"no bundle was written: {problem}")
            else:
                error.add_note(f"a bundle that repeats this: simkit replay {self.written}")
        self.close()


def keep(
    sim: Simulation, folder: str | Path | None = None, *, seconds: float = WINDOW_SECONDS, topics: Sequence[str] = ()
) -> BundleRecorder:
    """Begins to keep what a bundle needs; to be called right after `simkit.load`.

    Args:
        sim: the simulation.
        folder: where a bundle is written when something is raised within `with keep(…)`.
        seconds: how much of the end is kept [s] of simulated time.
        topics: shell patterns of topics that are kept although they are pictures.

    Raises:
        InputError: SK-BUNDLE-007 the run has begun already.
    """
    return BundleRecorder(sim, seconds, topics, None if folder is None else Path(folder))


def write_bundle(
    kept: BundleRecorder | Simulation,
    path: str | Path,
    failure: BaseException | Failure | None = None,
    *,
    name: str = "",
    overwrite: bool = False,
    with_code: bool = True,
) -> Path:
    """Writes the run up to now into one file, which is there as a whole or not at all.

    Args:
        kept: what `keep` gave, or its simulation, between two steps.
        path: of the file.
        failure: what the run ended with, if it failed.
        name: of the run; else the world's.
        overwrite: whether a file that is there is replaced.
        with_code: whether the code of plugins in the user's folders is packed.

    Returns:
        The path.

    Raises:
        InputError: SK-BUNDLE-006 the world cannot be packed, SK-BUNDLE-007 the run is not kept, SK-CLI-016 the place
            cannot be written.
    """
    from simkit.testing.bundles.bundle_writer import pack_run

    keeper = kept if isinstance(kept, BundleRecorder) else recorder_of(kept)
    found = failure_from_error(failure) if isinstance(failure, BaseException) else failure
    return pack_run(keeper, Path(path), found, name=name, overwrite=overwrite, with_code=with_code)


def write_failed(
    keeper: BundleRecorder, folder: Path, failure: BaseException | Failure, *, with_code: bool = True
) -> Path:
    """Writes a bundle of a run that failed, named after the world, the error and the content.

    Raises:
        InputError: as `write_bundle`.
    """
    from simkit.testing.bundles.bundle_writer import pack_failed_run

    found = failure_from_error(failure) if isinstance(failure, BaseException) else failure
    return pack_failed_run(keeper, folder, found, with_code=with_code)


def recorder_of(sim: Simulation) -> BundleRecorder:
    """Who keeps a simulation.

    Raises:
        InputError: SK-BUNDLE-007 nobody does.
    """
    journal = sim.bus.journal
    keeper = getattr(journal, "keeper", None)
    if not isinstance(keeper, BundleRecorder):
        raise InputError(
            f"{NOT_RECORDED} this run is not kept: call simkit.bundle.keep(sim) right after load", NOT_RECORDED
        )
    return keeper


def failure_from_error(error: BaseException) -> Failure:
    """An error as a bundle has it."""
    code = str(getattr(error, "code", "") or "") if isinstance(error, SimkitError) else ""
    return Failure(type(error).__name__, code, strip_folders(str(error))[:20_000])


def failure_from_checks(results: Iterable[CheckResult], *, was_given_up: bool = False) -> Failure | None:
    """What did not hold as a bundle has it; None where all did, and the run was not given up for its wall time."""
    lines = [f"{result.check.title}: {result.message}" for result in results if not result.passed]
    if was_given_up and not lines:
        lines = ["the run was given up for its wall time"]
    return Failure(CHECK, "", strip_folders("\n".join(lines))[:20_000]) if lines else None


def strip_folders(text: str) -> str:
    """A text in which files stand without the folders that they are in, which are elsewhere on another machine."""
    return _FOLDERS.sub("", text)
