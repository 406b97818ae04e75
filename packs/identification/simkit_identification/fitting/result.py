"""Result of a fit: values, intervals, what the recording cannot tell, and the file of overrides."""

from __future__ import annotations

import os
import shlex
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from simkit import Diagnostic, RunSpec
from simkit.extend import counted
from simkit.scene.overrides import override_texts
from simkit.writers.atomic_output import write_atomically
from simkit_identification.fitting.fitted_values import ComparedTopic, FitCurve, FittedParameter, interval_text
from simkit_identification.fitting.problem import RepeatedRecording
from simkit_identification.fitting.report import write_chart, write_page
from simkit_identification.fitting.validation import Fold
from simkit_identification.result_texts import finite_or_none, percent

Floats = npt.NDArray[np.float64]


@dataclass(frozen=True)
class FitResult:
    """Result of a fit.

    Attributes:
        parameters: parameters with values and intervals.
        topics: compared topics, and those that tell nothing.
        correlations: correlation of the errors of two parameters by their paths.
        confusions: sentences about parameters that the recording cannot tell apart.
        folds: cross-validation.
        has_converged: False if the search ended before its tolerance.
        method: method of the search.
        message: reason of the end of the search.
        error_before, error_after: root mean square residual over the variation of the readings, with the first and
            the fitted values.
        runs, failed: number of runs, and of those that failed.
        seconds: wall time [s].
        run: run of the world with the fitted values.
        recordings: recordings.
        curves: readings for plots.
        diagnostics: warnings and notes.
    """

    parameters: tuple[FittedParameter, ...]
    topics: tuple[ComparedTopic, ...]
    correlations: dict[tuple[str, str], float]
    confusions: tuple[str, ...]
    folds: tuple[Fold, ...]
    has_converged: bool
    method: str
    message: str
    error_before: float
    error_after: float
    runs: int
    failed: int
    seconds: float
    run: RunSpec
    recordings: tuple[RepeatedRecording, ...]
    curves: tuple[FitCurve, ...] = ()
    diagnostics: tuple[Diagnostic, ...] = field(default=())

    @property
    def values(self) -> dict[str, float]:
        """Fitted values by path."""
        return {parameter.path: parameter.value for parameter in self.parameters}

    @property
    def intervals(self) -> dict[str, tuple[float, float]]:
        """Ends of the 95 % intervals by path."""
        return {parameter.path: (parameter.low, parameter.high) for parameter in self.parameters}

    @property
    def overrides(self) -> tuple[str, ...]:
        """Fitted values as overrides, `PATH=VALUE`, for `simkit.load` and `RunSpec`."""
        return tuple(override_texts(self.values))

    def save(self, path: str | Path) -> Path:
        """Write a scenario file with the world and the fitted values, for commands that read scenarios.

        Raises:
            InputError: SK-CLI-016 the file cannot be written.
        """
        target = Path(path)
        write_atomically(target, self.scenario_text(target.absolute().parent).encode())
        return target

    def scenario_text(self, folder: Path) -> str:
        """Return the text of the scenario file for a folder."""
        import yaml

        lines = ["# Fitted by `simkit fit`: value, 95 % interval and unit of each parameter."]
        beside = self.run.beside
        if "<" not in self.run.world:
            world = self.run.world if beside is None else _relative(beside, folder)
            lines.append(yaml.safe_dump({"world": world}, allow_unicode=True).strip())
        else:
            lines.append("# The world was given as text: add the key `world`.")
        lines.append("set:")
        lines += [
            f"  - {yaml.safe_dump(text, width=10000).strip().removesuffix('...').strip()}"
            for text in self.run.overrides
        ]
        for parameter, text in zip(self.parameters, self.overrides, strict=True):
            unit = f" {parameter.unit}" if parameter.unit else ""
            lines.append(f"  - {_yaml_text(text)}  # {interval_text(parameter)}{unit}")
        return "\n".join(lines) + "\n"

    def fitted_run(self) -> RunSpec:
        """Return the run specification of the world with the fitted values."""
        return replace(self.run, overrides=(*self.run.overrides, *self.overrides))

    def report(self, path: str | Path) -> Path:
        """Write an HTML page with the values and plots of the readings before and after.

        Raises:
            InputError: SK-CLI-016 the page cannot be written.
        """
        return write_page(self.run.title, vars(self), self.overrides, Path(path))

    def plot(self, path: str | Path) -> Path:
        """Write a chart (.png or .svg) of the readings before and after.

        Raises:
            InputError: SK-BAG-012 another ending; SK-CLI-016 the chart cannot be written.
        """
        return write_chart(self.run.title, self.curves, Path(path))

    def as_dict(self) -> dict[str, Any]:
        """Return the result as plain data for JSON."""
        return {
            "parameters": [
                {
                    "path": p.path, "value": p.value, "low": p.low, "high": p.high, "start": p.start, "unit": p.unit,
                    "effective_readings": p.effective, "interval_follows_cost": p.is_followed,
                }
                for p in self.parameters
            ],
            "correlations": [{"parameters": list(pair), "value": value} for pair, value in self.correlations.items()],
            "not_told_apart": list(self.confusions),
            "topics": [
                {
                    "topic": t.topic, "readings": t.readings, "note": t.note,
                    "before": finite_or_none(t.before), "after": finite_or_none(t.after),
                }
                for t in self.topics
            ],
            "cross_validation": [
                {"held_out": f.name, "values": f.values, "error": f.error, "own_error": f.own_error} for f in self.folds
            ],
            "converged": self.has_converged, "method": self.method, "message": self.message,
            "error_before": self.error_before, "error_after": self.error_after,
            "runs": self.runs, "failed_runs": self.failed, "wall_time": self.seconds,
            "overrides": list(self.overrides),
        }  # fmt: skip

    def lines(self) -> list[str]:
        """Return the result as lines of text."""
        return [*_parameter_lines(self.parameters), "", *self._quality_lines()]

    def _quality_lines(self) -> list[str]:
        lines = [
            f"error: {percent(self.error_before)} of the variation of the readings before, "
            f"{percent(self.error_after)} after ({self.method}, {self.runs} runs, {self.seconds:.1f} s)"
        ]
        used = [f"{t.topic} {percent(t.before)} → {percent(t.after)}" for t in self.topics if not t.note]
        lines.append(f"compared: {', '.join(used)}" if used else "compared: nothing")
        lines += [f"not compared: {t.topic}: {t.note}" for t in self.topics if t.note]
        lines += self._fold_lines()
        world = "WORLD" if "<" in self.run.world else shlex.quote(self.run.world)
        texts = " ".join(f"--set {shlex.quote(text)}" for text in self.overrides)
        lines.append(f"use them: simkit run {world} {texts}")
        return lines

    def _fold_lines(self) -> list[str]:
        if not self.folds:
            return []
        lines = [f"cross-validation, {counted(len(self.folds), 'part')} held out in turn:"]
        for path in self.folds[0].values:
            found = [fold.values[path] for fold in self.folds]
            lines.append(f"  {path}: {min(found):.6g} to {max(found):.6g}")
        ratio = max(fold.error / max(fold.own_error, 1e-12) for fold in self.folds)
        lines.append(f"  residuals of the held-out parts: at most {ratio:.3g} times those of the fit")
        return lines


def _yaml_text(text: str) -> str:
    """Return a text as one line of YAML."""
    import yaml

    return str(yaml.safe_dump(text, width=10000)).strip().removesuffix("...").strip()


def _relative(path: Path, folder: Path) -> str:
    return Path(os.path.relpath(path.absolute(), folder)).as_posix()


def _parameter_lines(parameters: Sequence[FittedParameter]) -> list[str]:
    rows = [("parameter", "first", "fitted", "95 % interval")]
    rows += [
        (p.path, f"{p.start:.5g}", f"{p.value:.6g}", interval_text(p) + (f"  {p.unit}" if p.unit else ""))
        for p in parameters
    ]
    widths = [max(len(row[i]) for row in rows) for i in range(3)]
    return [
        "  ".join(cell.ljust(width) for cell, width in zip(row, (*widths, 0), strict=True)).rstrip() for row in rows
    ]
