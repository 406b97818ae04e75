"""Fit of parameters of a world to recordings, by runs that repeat the recordings."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

import numpy as np
import numpy.typing as npt

from simkit import RunSpec, progress
from simkit.argument_checks import shown
from simkit.errors import InputError
from simkit.extend import Diagnostics, counted
from simkit.testing import open_scenario
from simkit_identification.fitting.codes import (
    AT_BOUND,
    INVALID_OPTION,
    INVALID_PARAMETER,
    NO_EFFECT,
    NOT_CONVERGED,
    NOT_SMOOTH,
    NOT_TOLD_APART,
    NOTHING_COMMON,
    RUNS_FAILED,
)
from simkit_identification.fitting.derivatives import Differences, choose_differences, derivatives
from simkit_identification.fitting.evaluation import Evaluator
from simkit_identification.fitting.fitted_values import ComparedTopic, FitCurve, FittedParameter
from simkit_identification.fitting.motion import Motion
from simkit_identification.fitting.noise_level import NoiseLevel, estimate_noise
from simkit_identification.fitting.parameters import Parameter, Vary, read_parameters_to_vary, without_noise
from simkit_identification.fitting.problem import RepeatedRecording, fit_problem
from simkit_identification.fitting.readings import check_fields
from simkit_identification.fitting.recordings import Bag, read_recordings
from simkit_identification.fitting.residuals import Residuals
from simkit_identification.fitting.result import FitResult
from simkit_identification.fitting.search import (
    METHODS,
    Found,
    Loss,
    Method,
    first_points,
    has_cma,
    search_cma,
    search_least_squares,
)
from simkit_identification.fitting.uncertainty import Uncertainty, describe_confusion, uncertainty_at
from simkit_identification.fitting.validation import Fold, cross_validate

Floats = npt.NDArray[np.float64]
_REWEIGHTED: Final = 2  # searches after the first, each with the weights that the last one's residuals give
_WIDE: Final = 0.03  # difference of a coordinate for derivatives of a noisy cost
_ROUGH: Final = 0.5  # relative change of derivatives with their differences at which a cost is noisy
_MOST_CURVES: Final = 400  # of all recordings in plots


@dataclass(frozen=True)
class FitOptions:
    """Options of a fit.

    Attributes:
        compare: patterns of the topics to compare; empty for all.
        skip: seconds at the beginning of each recording that are not compared.
        duration: seconds of each recording that are used; None for all.
        motion: `MODEL=TOPIC`: the recordings are free motions of a model, with its poses on this topic.
        window: length of the parts into which a free motion is cut [s]; None for the whole motion.
        play_topics: topics of the commands, `TOPIC` or `OLD:=NEW`; empty for all that the world subscribes to.
        method: "auto", "least-squares" or "cma".
        robust: True to reduce the influence of large residuals; None for free motions only.
        jobs: number of processes; None for one per core.
        seed: seed of the first points and of CMA-ES.
    """

    compare: tuple[str, ...] = ()
    skip: float = 0.0
    duration: float | None = None
    motion: str = ""
    window: float | None = None
    play_topics: tuple[str, ...] = ()
    method: Method = "auto"
    robust: bool | None = None
    jobs: int | None = None
    seed: int = 0

    def __post_init__(self) -> None:
        problems = []
        if self.method not in METHODS:
            problems.append(f"method: found {shown(self.method)}; expected {', '.join(METHODS)}")
        if not self.skip >= 0:
            problems.append(f"skip: found {shown(self.skip)}; expected seconds of at least 0")
        for name, value in (("duration", self.duration), ("window", self.window)):
            if value is not None and not value > 0:
                problems.append(f"{name}: found {shown(value)}; expected seconds above 0")
        if self.duration is not None and 0 < self.duration <= self.skip:
            problems.append(f"duration {self.duration:g} s is not above skip {self.skip:g} s")
        if problems:
            raise InputError(INVALID_OPTION, f"\n{INVALID_OPTION} ".join(problems))


def fit(
    world: str | os.PathLike[str] | RunSpec,
    recordings: Bag | Sequence[Bag],
    vary: Vary,
    *,
    compare: Sequence[str] = (),
    skip: float = 0.0,
    duration: float | None = None,
    motion: str = "",
    window: float | None = None,
    play_topics: Sequence[str] = (),
    method: Method = "auto",
    robust: bool | None = None,
    jobs: int | None = 1,
    seed: int = 0,
    on_stage: Callable[[str], None] | None = None,
) -> FitResult:
    """Find values of a world's parameters with which its runs repeat recordings.

    The world runs with the commands of each recording, without random noise. Its readings are compared with the
    recorded ones.

    Args:
        world: world, bare name, XML text, or run specification.
        recordings: bags, or `Motion` objects for the free motion of a model; one or several.
        vary: parameters: `PATH`, `PATH=START`, `PATH=LOW:HIGH` or `PATH=LOW:START:HIGH`, or values by path.
        compare: patterns of the topics to compare, each perhaps with a field: `/imu.angular_velocity`; empty for all
            topics that both have.
        skip: seconds at the beginning of each recording that are not compared.
        duration: seconds of each recording that are used; None for all.
        motion: `MODEL=TOPIC`, if the bags have free motions of a model.
        window: length of the parts into which a free motion is cut [s]; None for the whole motion.
        play_topics: topics of the commands, `TOPIC` or `OLD:=NEW`; empty for all that the world subscribes to.
        method: "auto", "least-squares" or "cma".
        robust: True to reduce the influence of large residuals; None for free motions only.
        jobs: number of processes; None for one per core.
        seed: seed of the first points and of CMA-ES; the same seed gives the same result.
        on_stage: function that receives a line about each stage.

    Returns:
        The values with their intervals.

    Raises:
        InputError: SK-FIT-001 to 011, or the world or a bag cannot be read.
    """
    options = FitOptions(
        (compare,) if isinstance(compare, str) else tuple(compare), skip, duration, motion, window,
        (play_topics,) if isinstance(play_topics, str) else tuple(play_topics), method, robust, jobs, seed,
    )  # fmt: skip
    listed = [recordings] if isinstance(recordings, (str, os.PathLike, Motion)) else list(recordings)
    run = world if isinstance(world, RunSpec) else RunSpec(os.fspath(world), folder=Path.cwd())
    return fit_run(run, listed, vary, options, on_stage or (lambda _: None))


def fit_run(
    run: RunSpec, bags: Sequence[Bag], vary: Vary, options: FitOptions, on_stage: Callable[[str], None]
) -> FitResult:
    """Fit parameters of a run to recordings; see `fit`.

    Raises:
        InputError: SK-FIT-001 to 011, or the world or a bag cannot be read.
    """
    begun = time.perf_counter()
    if not bags:
        raise InputError(INVALID_OPTION, "no recording: name at least one bag")
    with open_scenario(run) as sim:
        parameters = read_parameters_to_vary(sim, vary)
        quiet = replace(run, overrides=(*run.overrides, *without_noise(sim, [p.path for p in parameters])))
        recordings, notes = read_recordings(sim, quiet, bags, options)
        _check_deviations(parameters)
    on_stage(_describe_task(parameters, recordings))
    fitter = _Fitter(run, quiet, parameters, recordings, options, on_stage)
    result = fitter.result(notes)
    return replace(result, seconds=time.perf_counter() - begun)


def _check_deviations(parameters: Sequence[Parameter]) -> None:
    """Raise InputError for a deviation that has no first value, so that its noise cannot be switched on."""
    for parameter in parameters:
        if parameter.is_deviation and not parameter.start > 0:
            text = f"--vary {parameter.path}: its first value is 0, so the world has no such noise"
            raise InputError(INVALID_PARAMETER, text, help="write a first value above 0: --vary PATH=START")


def _describe_task(parameters: Sequence[Parameter], recordings: Sequence[RepeatedRecording]) -> str:
    topics = list(dict.fromkeys(readings.channel.topic for r in recordings for readings in r.readings))
    size = sum(recording.size for recording in recordings)
    names = ", ".join(topics[:6]) + (f" and {len(topics) - 6} more" if len(topics) > 6 else "")
    count = len(recordings)
    return (
        f"{len(parameters)} parameter{'s' * (len(parameters) != 1)}, {count} recording{'s' * (count != 1)}, "
        f"{counted(size, 'reading')} of {names}"
    )


class _Fitter:
    """One fit."""

    def __init__(
        self,
        run: RunSpec,
        quiet: RunSpec,
        parameters: Sequence[Parameter],
        recordings: Sequence[RepeatedRecording],
        options: FitOptions,
        on_stage: Callable[[str], None],
    ) -> None:
        self._run, self._quiet, self._options, self._on_stage = run, quiet, options, on_stage
        self._all, self._recordings = list(parameters), list(recordings)
        self._searched = [p for p in parameters if not p.is_deviation]
        self._deviations = [p for p in parameters if p.is_deviation]
        self._is_free = any(recording.motion is not None for recording in recordings)
        robust = self._is_free if options.robust is None else options.robust
        self._loss: Loss = "soft_l1" if robust else "linear"
        self.diagnostics = Diagnostics()

    def result(self, notes: Mapping[str, str]) -> FitResult:
        """Run the fit.

        Args:
            notes: topics that are not compared, with the reason.
        """
        # the deviations are switched off in all runs but the ones that measure them
        run = replace(self._quiet, overrides=(*self._quiet.overrides, *(f"{p.path}=0" for p in self._deviations)))
        recordings = [replace(r, run=replace(r.run, overrides=run.overrides)) for r in self._recordings]
        problem = fit_problem(run, recordings)
        with (
            progress.task("fitting") as task,
            Evaluator(problem, self._searched, self._options.jobs, task) as evaluate,
        ):
            residuals = Residuals(recordings, self._options.skip, () if self._is_free else self._options.compare)
            self._check_compared(residuals)
            start = np.zeros(len(self._searched))
            before = self._first_readings(evaluate, start)
            self._compare_only_known(residuals, before, notes)
            found, method = self._search(evaluate, residuals, start)
            after, uncertainty, folds = self._judge(evaluate, residuals, found.point, method, task)
            values = evaluate.values_of(found.point)
            levels = {p.path: estimate_noise(evaluate, residuals, values, after, p) for p in self._deviations}
            self._warn(evaluate, found, uncertainty)
            parameters = self._fitted(evaluate, found.point, uncertainty, levels)
            correlations = {}
            if uncertainty is not None:
                paths = [p.path for p in self._searched]
                correlations = {
                    (paths[i], paths[j]): float(uncertainty.correlation[i, j])
                    for i in range(len(paths))
                    for j in range(i + 1, len(paths))
                }
            return FitResult(
                parameters=parameters,
                topics=_compared_topics(residuals, before, after, notes),
                correlations=correlations,
                confusions=tuple(describe_confusion(self._searched, uncertainty)) if uncertainty is not None else (),
                folds=tuple(folds),
                has_converged=found.has_converged,
                method=method,
                message=found.message,
                error_before=residuals.relative_error(before),
                error_after=residuals.relative_error(after),
                runs=evaluate.runs,
                failed=evaluate.failed,
                seconds=0.0,
                run=self._run,
                recordings=tuple(self._recordings),
                curves=tuple(_curves(recordings, residuals, before, after)),
                diagnostics=tuple(self.diagnostics),
            )

    # ------------------------------------------------------------------ search

    def _first_readings(self, evaluate: Evaluator, start: Floats) -> Floats:
        (before,) = evaluate([start])
        if before is None:
            text = f"the run with the first values fails: {evaluate.failures[0]}"
            raise InputError(RUNS_FAILED, text, help="give other first values: --vary PATH=START")
        return before

    def _check_compared(self, residuals: Residuals) -> None:
        """Raise InputError if the options leave no recorded reading to compare."""
        last = float(np.max(residuals.times, initial=0.0))
        if last < self._options.skip:
            text = f"skip: found {self._options.skip:g} s, and the last reading is at {last:g} s"
            raise InputError(INVALID_OPTION, text)
        if not self._is_free:
            check_fields(self._options.compare, [(name.channel.topic, name.column) for name in residuals.columns])

    def _compare_only_known(self, residuals: Residuals, before: Floats, notes: Mapping[str, str]) -> None:
        if not np.any(np.isfinite(before) & np.isfinite(residuals.recorded)):
            listed = "; ".join(f"{topic}: {note}" for topic, note in notes.items()) or "none"
            raise InputError(NOTHING_COMMON, f"the runs publish no number that the recording has; topics: {listed}")

    def _search(self, evaluate: Evaluator, residuals: Residuals, start: Floats) -> tuple[Found, str]:
        """Return the best point, and the method that found it."""
        if not self._searched:
            return Found(start, 0.0, True, "only noise is fitted"), "likelihood"
        differences = choose_differences(evaluate, start)
        _, slopes = derivatives(evaluate, start, differences, is_central=False)
        self._check_effect(differences)
        residuals.use_columns_with_effect(slopes)
        if not residuals.count:
            raise InputError(NO_EFFECT, "no compared reading depends on a parameter after the skipped seconds")
        method = self._method(evaluate, residuals, start, differences, slopes)
        point, _ = first_points(evaluate, residuals, self._loss, self._options.seed)
        self._on_stage(f"first points: {evaluate.runs} runs, {self._error_text(evaluate, residuals, point)}")
        found = self._one_search(evaluate, residuals, point, differences, method)
        for _ in range(_REWEIGHTED):
            (readings,) = evaluate([found.point])
            if readings is None:
                break
            residuals.reweight(readings)
            again = self._one_search(evaluate, residuals, found.point, differences, method)
            is_same = bool(np.max(np.abs(again.point - found.point), initial=0.0) < 1e-4)
            found = again
            if is_same:
                break
        return found, method

    def _one_search(
        self, evaluate: Evaluator, residuals: Residuals, point: Floats, differences: Differences, method: str
    ) -> Found:
        lowest = [np.inf]

        def on_step(cost: float) -> None:
            lowest[0] = min(lowest[0], cost)

        if method == "cma":
            found = search_cma(evaluate, residuals, point, self._loss, self._options.seed, on_step)
        else:
            found = search_least_squares(evaluate, residuals, point, differences, self._loss, on_step)
        self._on_stage(f"{method}: {evaluate.runs} runs, {self._error_text(evaluate, residuals, found.point)}")
        return found

    def _error_text(self, evaluate: Evaluator, residuals: Residuals, point: Floats) -> str:
        """Return the error at a point and its values as text."""
        (readings,) = evaluate([point])
        error = float("nan") if readings is None else residuals.relative_error(readings)
        values = zip(self._searched, evaluate.values_of(point), strict=True)
        return f"error {100.0 * error:.3g} %, " + ", ".join(f"{p.name} = {value:.5g}" for p, value in values)

    def _check_effect(self, differences: Differences) -> None:
        """Raise InputError for parameters that change no reading."""
        without = [p.path for p, has in zip(self._searched, differences.has_effect, strict=True) if not has]
        if without:
            text = "\n".join(f"{NO_EFFECT} {path}: changing it changes no compared reading" for path in without)
            help_ = "leave it out, record more topics or another motion, or check that the world uses it"
            raise InputError(NO_EFFECT, text.removeprefix(f"{NO_EFFECT} "), help=help_)

    def _method(
        self, evaluate: Evaluator, residuals: Residuals, start: Floats, differences: Differences, slopes: Floats
    ) -> str:
        """Return the method: least squares, unless derivatives depend on the differences that they are made of."""
        if self._options.method != "auto":
            return self._options.method
        if not self._is_free:  # scans make derivatives rough, yet least squares found TurtleBot3's wheels to 1e-6
            return "least-squares"
        wider = Differences(differences.steps * 4.0, differences.has_effect)
        _, others = derivatives(evaluate, start, wider, is_central=False)
        fine, coarse = residuals.jacobian(slopes), residuals.jacobian(others)
        size = np.maximum(np.linalg.norm(fine, axis=0), np.linalg.norm(coarse, axis=0))
        rough = np.linalg.norm(fine - coarse, axis=0) / np.maximum(size, 1e-300)
        names = [p.path for p, value in zip(self._searched, rough, strict=True) if value > _ROUGH and not p.step]
        if not names:
            return "least-squares"
        if len(self._searched) > 1 and not has_cma():
            text = f"the readings do not depend smoothly on {', '.join(names)}"
            help_ = "install the extra fit, so that CMA-ES searches"
            self.diagnostics.warning(NOT_SMOOTH, text, hint=help_)
            return "least-squares"
        return "cma"

    # ------------------------------------------------------------------ judgement

    def _judge(
        self, evaluate: Evaluator, residuals: Residuals, point: Floats, method: str, task: progress.Task
    ) -> tuple[Floats, Uncertainty | None, list[Fold]]:
        """Return the readings at the best point, its uncertainty and the folds of the cross-validation."""
        task.item = "intervals"
        if not self._searched:
            return self._first_readings(evaluate, point), None, []
        differences = choose_differences(evaluate, point, _WIDE if method == "cma" else 1e-3)
        after, slopes = derivatives(evaluate, point, differences, is_central=True)
        uncertainty = uncertainty_at(evaluate, residuals, point, after, slopes, self._loss)
        task.item = "cross-validation"
        names = [recording.name for recording in self._recordings]
        folds = cross_validate(evaluate, residuals, point, after, slopes, self._loss, names)
        return after, uncertainty, folds

    def _fitted(
        self,
        evaluate: Evaluator,
        point: Floats,
        uncertainty: Uncertainty | None,
        levels: Mapping[str, NoiseLevel],
    ) -> tuple[FittedParameter, ...]:
        fitted = []
        searched = {p.path: i for i, p in enumerate(self._searched)}
        for p in self._all:
            if p.path in levels:
                level = levels[p.path]
                fitted.append(
                    FittedParameter(p.path, p.start, level.value, level.low, level.high, p.unit, level.effective)
                )
                continue
            assert uncertainty is not None
            i = searched[p.path]
            low, high = p.value(uncertainty.low[i]), p.value(uncertainty.high[i])
            fitted.append(
                FittedParameter(
                    p.path, p.start, _rounded(p.value(float(point[i]))), low, high, p.unit,
                    float(uncertainty.effective[i]), uncertainty.followed[i],
                )
            )  # fmt: skip
        return tuple(fitted)

    def _warn(self, evaluate: Evaluator, found: Found, uncertainty: Uncertainty | None) -> None:
        warn = self.diagnostics.warning
        if not found.has_converged:
            text = f"the search ended before it converged: {found.message}"
            warn(NOT_CONVERGED, text, hint="give narrower bounds or other first values, or --method cma")
        for p, u in zip(self._searched, found.point, strict=True):
            low, high = p.limits()
            if (u - low) < 1e-3 * (high - low) or (high - u) < 1e-3 * (high - low):
                text = f"{p.path} = {p.value(float(u)):.6g} is at a bound of its range"
                warn(AT_BOUND, text, hint="widen the bounds, or vary what the value stands in for")
        if evaluate.failed:
            listed = "; ".join(evaluate.failures[:3])
            text = f"{evaluate.failed} of {evaluate.runs} runs failed and counted as a large cost: {listed}"
            warn(RUNS_FAILED, text, hint="bounds that exclude such values make the search faster")
        if uncertainty is not None:
            for sentence in describe_confusion(self._searched, uncertainty):
                warn(NOT_TOLD_APART, sentence, hint="fix one of them, or record a motion in which they act apart")


def _rounded(value: float) -> float:
    """Return a value with the digits that a search can find, so that files stay readable."""
    return float(f"{value:.9g}")


def _compared_topics(
    residuals: Residuals, before: Floats, after: Floats, notes: Mapping[str, str]
) -> tuple[ComparedTopic, ...]:
    topics = []
    for topic in dict.fromkeys(name.channel.topic for name in residuals.columns):
        columns = [i for i, name in enumerate(residuals.columns) if name.channel.topic == topic]
        here = np.isin(residuals.column, columns) & (residuals.weights > 0)
        count = int(np.count_nonzero(here))
        if not count:
            topics.append(ComparedTopic(topic, note="tells nothing about the parameters"))
            continue
        errors = residuals.relative_error(before, topic), residuals.relative_error(after, topic)
        topics.append(ComparedTopic(topic, count, *errors))
    return (*topics, *(ComparedTopic(topic, note=note) for topic, note in notes.items()))


def _curves(
    recordings: Sequence[RepeatedRecording], residuals: Residuals, before: Floats, after: Floats
) -> list[FitCurve]:
    """Return the compared columns, those that improve most first."""
    curves: list[tuple[float, FitCurve]] = []
    at = 0
    for recording in recordings:
        for readings in recording.readings:
            size = readings.values.size
            shape = readings.values.shape
            first, last = before[at : at + size].reshape(shape), after[at : at + size].reshape(shape)
            weights = residuals.weights[at : at + size].reshape(shape)
            kinds = residuals.column[at : at + size].reshape(shape)
            at += size
            for i, name in enumerate(readings.channel.columns):
                if not np.any(weights[:, i]):
                    continue
                deviation = float(residuals.deviations[kinds[0, i]])
                gain = np.nansum((first[:, i] - readings.values[:, i]) ** 2) / deviation**2
                label = f"{readings.channel.label}.{name}"
                curve = FitCurve(
                    label, recording.name, readings.times, readings.values[:, i], first[:, i], last[:, i], deviation
                )
                curves.append((float(gain), curve))
    curves.sort(key=lambda pair: -pair[0])
    return [curve for _, curve in curves[:_MOST_CURVES]]


__all__ = ["FitResult", "Motion", "fit"]
