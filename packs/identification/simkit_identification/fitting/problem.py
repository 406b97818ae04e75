"""Problem of a fit: the run, the recordings, and what is compared; and its runs in worker processes."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from simkit import RunSpec
from simkit.errors import InputError
from simkit.testing import run_scenario
from simkit_identification.fitting.motion import Motion, MotionRun
from simkit_identification.fitting.readings import Readings, RunReadings, aligned
from simkit_learning.sweeps.design import Design, SweepRow
from simkit_learning.sweeps.row_runner import RowResult, RowRunner, SweepTask
from simkit_learning.sweeps.sweep_spec import SweepSpec

if TYPE_CHECKING:
    from simkit import Simulation

Floats = npt.NDArray[np.float64]


@dataclass(frozen=True)
class RepeatedRecording:
    """Recording that runs repeat.

    Attributes:
        name: name in messages.
        run: run that repeats it, without the values of the parameters.
        readings: recorded readings that are compared.
        motion: recorded motion of a model; None for a bag with commands.
        windows: first and last sample of each window of the motion.
    """

    name: str
    run: RunSpec
    readings: tuple[Readings, ...]
    motion: Motion | None = None
    windows: tuple[tuple[int, int], ...] = ()

    @property
    def topics(self) -> list[str]:
        """Topics that are compared."""
        return list(dict.fromkeys(reading.channel.topic for reading in self.readings))

    @property
    def size(self) -> int:
        """Number of compared numbers."""
        return sum(reading.values.size for reading in self.readings)

    def with_channels(self, chosen: Sequence[bool]) -> RepeatedRecording:
        """Return the recording with some of its channels."""
        return replace(self, readings=tuple(r for r, is_chosen in zip(self.readings, chosen, strict=True) if is_chosen))


@dataclass(frozen=True)
class FitProblem(SweepSpec):
    """Problem of a fit, with all that its runs need; worker processes receive it once.

    Attributes:
        recordings: recordings.
    """

    recordings: tuple[RepeatedRecording, ...] = ()


def fit_problem(run: RunSpec, recordings: Sequence[RepeatedRecording]) -> FitProblem:
    """Return the problem of a run and its recordings."""
    return FitProblem(run, Design(()), recordings=tuple(recordings))


@dataclass(frozen=True)
class ReplayTask(SweepTask):
    """Task of a runner: repeat one recording with the values of its row.

    Attributes:
        recording: index of the recording.
    """

    recording: int = 0


@dataclass
class ReplayResult(RowResult):
    """Result of one repetition.

    Attributes:
        values: simulated readings at the recorded times, shape (size,); None after a failure.
    """

    values: Floats | None = None


class ReplayRunner(RowRunner):
    """Runner of a fit: repeats recordings in a world that stays loaded between runs.

    Args:
        spec: problem of the fit.
    """

    def __init__(self, spec: FitProblem) -> None:
        super().__init__(spec)
        self._problem = spec

    def run_task(self, task: SweepTask) -> ReplayResult:
        """Repeat a recording; a failure is a result too."""
        assert isinstance(task, ReplayTask)
        begun = time.perf_counter()
        result = ReplayResult(task.row)
        recording = self._problem.recordings[task.recording]
        try:
            result.values = self.replay(recording, task.row)
        except Exception as error:  # noqa: BLE001 - the search treats a failed run as a large cost
            result.fail(error)
            if not isinstance(error, InputError):
                self.close()
        result.wall_time = time.perf_counter() - begun
        return result

    def replay(self, recording: RepeatedRecording, row: SweepRow) -> Floats:
        """Return the simulated readings of a recording, shape (size,).

        Raises:
            SimkitError: the run failed.
        """
        spec = replace(self._problem, run=recording.run).row_spec(row)
        sim = self.world(spec)
        if recording.motion is not None:
            values = MotionRun(sim, recording.motion).values(recording.windows)
            return values.ravel()
        return np.concatenate([values.ravel() for values in _run_bag(sim, spec, recording)])


def _run_bag(sim: Simulation, spec: RunSpec, recording: RepeatedRecording) -> list[Floats]:
    """Run a world with the commands of a bag and return its readings at the recorded times."""
    with RunReadings(sim, recording.topics) as collector:
        run_scenario(spec, sim, judged=False)
        by_channel = {readings.channel: readings for readings in collector.readings()}
    return [aligned(recorded, by_channel.get(recorded.channel)) for recorded in recording.readings]
