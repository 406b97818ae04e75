"""Runs of a sweep in one process, in a world that stays loaded between them."""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Final

from simkit import RunSpec, Simulation, apply_overrides
from simkit.build import read_scene
from simkit.errors import InputError, SimkitError, raise_together
from simkit.plugins.discovery.python_plugins import copied_plugins
from simkit.recording import Recorder
from simkit.runtime.engine.snapshot import state_hash
from simkit.scene.overrides import apply_overrides as apply_to_scene
from simkit.scene.overrides import check_used, value_text
from simkit.testing import Watch, count_left_out, newly_left_out, open_scenario, run_scenario
from simkit.testing.scenarios.scenario_run import ScenarioCommands, ScenarioResult
from simkit_learning.sweeps.design import SweepRow
from simkit_learning.sweeps.metrics import RunMetrics
from simkit_learning.sweeps.parameter_space import Scalar
from simkit_learning.sweeps.result_store import StoredRow
from simkit_learning.sweeps.sweep_spec import SweepSpec
from simkit_verification.testing.bundles import BundleRecorder
from simkit_verification.testing.bundles.bundle_writer import pack_load_failure, write_bundle
from simkit_verification.testing.bundles.manifest import CHECK, Failure, failure_from_error

_STATUS: Final = {0: "ok", 1: "error", 2: "invalid", 3: "diverged", 4: "plugin", 5: "failed"}
CHECKS_FAILED: Final = "SK-SWEEP-006"
CRASHED: Final = "SK-SWEEP-007"
LEFT_OUT: Final = "SK-SWEEP-012"
_LONGEST_MESSAGE: Final = 500


@dataclass
class RowResult:
    """Result of one run.

    Attributes:
        row: run with its values.
        metrics: values of the metrics by name; empty if the run did not reach its end.
        exit_code: exit code that `simkit run` has for this end.
        status: the same as a word: "ok", "failed" (a check), "diverged", "plugin", "invalid" or "error".
        end: end of the run: "duration", "until", "timeout", "wall_timeout", or empty after an error.
        code, message: diagnostic code and first line of the failure; empty without one.
        time: simulated time at the end [s].
        steps: number of steps.
        state_hash: hash of the physics state at the end.
        wall_time: wall time of the run with its loading or reset [s].
    """

    row: SweepRow
    metrics: dict[str, Scalar] = field(default_factory=dict)
    exit_code: int = 0
    end: str = ""
    code: str = ""
    message: str = ""
    time: float = 0.0
    steps: int = 0
    state_hash: str = ""
    wall_time: float = 0.0

    @property
    def status(self) -> str:
        """End of the run as a word."""
        return _STATUS.get(self.exit_code, "error")

    def fail(self, error: Exception) -> None:
        """Store an error."""
        self.exit_code = error.exit_code if isinstance(error, SimkitError) else 1
        self.code = (
            str(getattr(error, "code", "") or "SK-CORE-001") if isinstance(error, SimkitError) else "SK-CORE-001"
        )
        text = str(error) if isinstance(error, SimkitError) else f"{type(error).__name__}: {error}"
        self.message = (text.strip() or type(error).__name__).splitlines()[0][:_LONGEST_MESSAGE]

    def plain(self) -> StoredRow:
        """Return the columns of the table by name, and the wall time."""
        return {
            "run": self.row.run, "seed": self.row.seed, "values": dict(self.row.values), "metrics": self.metrics,
            "exit_code": self.exit_code, "status": self.status, "end": self.end, "code": self.code,
            "message": self.message, "time": self.time, "steps": self.steps, "state_hash": self.state_hash,
            "wall_time": round(self.wall_time, 6),
        }  # fmt: skip


@dataclass(frozen=True)
class SweepTask:
    """Task of a runner.

    Attributes:
        row: run to make.
        keep: bundle to write; None to run without one.
    """

    row: SweepRow
    keep: Path | None = None


class RowRunner:
    """Runner of a sweep's rows; one worker has one.

    A world stays loaded between runs: it is reset, or numbers that the parameters change are written into its compiled
    model. It is loaded again if a parameter changes more than such numbers. The bits are the same.

    Args:
        spec: sweep.

    Attributes:
        left_out: what the worlds of the sweep run without; None before the first world, if the sweep does not say it.
    """

    def __init__(self, spec: SweepSpec) -> None:
        self._spec, self.left_out = spec, spec.left_out
        self._sim: Simulation | None = None
        self._key: object = None

    def run_task(self, task: SweepTask) -> RowResult:
        """Run a row, or repeat it and write its bundle."""
        return self.run(task.row) if task.keep is None else self.keep(task.row, task.keep)

    def run(self, row: SweepRow) -> RowResult:
        """Run a row; a failure is a result too."""
        begun = time.perf_counter()
        result = RowResult(row)
        sim: Simulation | None = None
        try:
            spec = self._spec.row_spec(row)
            sim = self.world(spec)
            self._measure(spec, sim, result)
        except Exception as error:  # noqa: BLE001 - any failure of a run is a row of the table
            result.fail(error)
            _note_end(result, sim)
            self.close()
        result.wall_time = time.perf_counter() - begun
        return result

    def keep(self, row: SweepRow, target: Path) -> RowResult:
        """Repeat a run and write its bundle and, if topics are chosen, its bag beside it.

        Args:
            row: run.
            target: bundle to write.
        """
        self.close()
        result = RowResult(row)
        try:
            spec = self._spec.row_spec(row)
        except InputError as error:  # it may not be run, so there is nothing to pack
            result.fail(error)
            return result
        try:
            sim = self.world(spec)
        except Exception as error:  # noqa: BLE001 - the bundle repeats the failure
            result.fail(error)
            with suppress(SimkitError, OSError):
                pack_load_failure(spec, target.parent, failure_from_error(error)).replace(target)
            return result
        failure: Failure | None = None
        recorder = BundleRecorder(sim, run=spec)
        bag = self._open_bag(sim, target.with_suffix(".mcap"))
        try:
            self._measure(spec, sim, result)
            if result.exit_code:
                failure = Failure(CHECK, "", result.message)
        except Exception as error:  # noqa: BLE001 - the bundle repeats the failure
            result.fail(error)
            _note_end(result, sim)
            failure = failure_from_error(error)
        finally:
            if bag is not None:
                bag.close()
        write_bundle(recorder, target, failure, overwrite=True)
        self.close()
        return result

    def close(self) -> None:
        """Close the world; the next run loads it again."""
        sim, self._sim, self._key = self._sim, None, None
        if sim is not None:
            with suppress(Exception):  # a plugin may raise while it is closed
                sim.close()

    @contextmanager
    def closed_on_error(self) -> Iterator[None]:
        """Close the world if the block raises an exception."""
        try:
            yield
        except BaseException:
            self.close()
            raise

    def _open_bag(self, sim: Simulation, path: Path) -> Recorder | None:
        if not self._spec.bag_topics:
            return None
        return Recorder(sim, path, overwrite=True, topics=self._spec.bag_topics)

    def world(self, spec: RunSpec) -> Simulation:
        """Return the world of a run at t = 0."""
        key = (spec.spawn, repr(spec.options.get("xacro_args")))
        sim = self._sim
        if sim is not None and self._spec.is_warm and key == self._key:
            assert sim.run_spec is not None
            if spec.overrides == sim.run_spec.overrides:
                sim.reset(seed=spec.seed)
                return sim
            if apply_overrides(sim, spec.overrides, spec.seed):
                return sim
        self.close()
        self._sim = sim = open_scenario(replace(spec, plugins=copied_plugins(spec.plugins)))
        self._key = key
        check_used(sim.diagnostics)
        self._check_left_out(sim)
        return sim

    def _check_left_out(self, sim: Simulation) -> None:
        """Raise InputError if the world of a run lacks a plugin that the other runs have."""
        now = count_left_out(sim.diagnostics)
        self.left_out = now if self.left_out is None else self.left_out
        if names := newly_left_out(self.left_out, now):
            text = f"the world of this run is without {', '.join(names)}, which other runs have"
            raise InputError(LEFT_OUT, text, help="load the world with the values of this run to see the reason")

    def _measure(self, spec: RunSpec, sim: Simulation, result: RowResult) -> None:
        with RunMetrics(sim, self._spec.row_metrics(result.row)) as metrics:
            outcome = run_scenario(spec, sim)
            result.metrics = metrics.values()
        result.end = outcome.reason
        _note_end(result, sim)
        if not outcome.passed:
            result.exit_code, result.code = 5, CHECKS_FAILED
            result.message = _failed_checks(outcome)


def _note_end(result: RowResult, sim: Simulation | None) -> None:
    """Store time, steps and state at the end of a run; nothing for a world that was not loaded."""
    if sim is not None:
        with suppress(Exception):  # the state after a failure may be unreadable
            result.time, result.steps, result.state_hash = sim.time, sim.tick, state_hash(sim)


def _failed_checks(outcome: ScenarioResult) -> str:
    lines = [f"{result.check.title}: {result.message}" for result in outcome.results if not result.passed]
    return "; ".join(lines or ["the run was stopped at its wall-clock limit"])[:_LONGEST_MESSAGE]


def check_runs(spec: SweepSpec, rows: list[SweepRow]) -> tuple[RowRunner, SweepRow]:
    """Check the parameters, metrics and commands of a sweep on its world before the first run.

    A parameter whose path exists but whose value is out of range in some rows is no error here: these rows fail.

    Args:
        spec: sweep.
        rows: some of its rows, with different values.

    Returns:
        Runner with a loaded world, and the row of this world.

    Raises:
        InputError: SK-SWEEP-002 a parameter cannot be set with any of the values; an expression or a command has an
            error; the world cannot be loaded. The message lists all problems.
    """
    runner = RowRunner(spec)
    failures: list[InputError] = []
    with runner.closed_on_error():
        for row in rows:
            try:
                sim = runner.world(spec.row_spec(row))
            except InputError as error:
                failures.append(error)
            else:
                raise_together([*_expression_problems(spec, row, sim), *_command_problems(spec, rows, sim)])
                return runner, row
        raise failures[0]


def _expression_problems(spec: SweepSpec, row: SweepRow, sim: Simulation) -> list[InputError]:
    """Return the errors of the expressions of metrics and conditions in a world."""
    run = spec.row_spec(row)
    problems: list[InputError] = []
    try:
        RunMetrics(sim, spec.row_metrics(row))
    except InputError as error:
        problems.append(error)
    try:
        Watch(sim, run.checks, until=run.until, timeout=run.longest)
    except InputError as error:
        problems.append(error)
    return problems


def _command_problems(spec: SweepSpec, rows: Sequence[SweepRow], sim: Simulation) -> list[InputError]:
    """Return the error of the commands in a world; none if they are valid with the values of any row."""
    problems: list[InputError] = []
    for row in rows:
        try:
            with ScenarioCommands(spec.row_spec(row), sim):
                return []
        except InputError as error:
            problems.append(error)
    return problems[:1]


def parameter_problems(spec: SweepSpec, rows: Sequence[SweepRow], names: Sequence[str]) -> Mapping[str, InputError]:
    """Return the error of each of several parameters that no row can set, by the parameter's name."""
    scene, _ = read_scene(spec.run.source, **spec.run.source_options())
    problems: dict[str, InputError] = {}
    for name in names:
        if name.isidentifier():
            continue
        for row in rows:
            paths = [path for path in row.values if path == name or path.endswith(".count")]  # a path may name a copy
            try:
                apply_to_scene(
                    scene, [f"{path}={value_text(row.values[path])}" for path in paths] if name in paths else []
                )
            except InputError as error:
                problems.setdefault(name, error)
            else:
                problems.pop(name, None)
                break
    return problems
