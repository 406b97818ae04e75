"""Sweep files: a scenario file with further keys for parameters, samples, seeds and metrics."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Final, TypeVar

from simkit import RunSpec
from simkit.code_requests import CodeRequest
from simkit.errors import InputError
from simkit.extend import Diagnostics
from simkit.run_spec import FilePath
from simkit.testing.conditions.parser import parse
from simkit.testing.scenarios.code_permission import permit_code
from simkit.testing.scenarios.scenario_file import parse_scenario
from simkit.testing.scenarios.yaml_document import Document, ValueReader
from simkit_learning.sweeps.design import Design
from simkit_learning.sweeps.metrics import FileMetric
from simkit_learning.sweeps.sweep import Parameters, make_design
from simkit_learning.sweeps.sweep_spec import (
    BAG_TOPICS,
    DESIGN_SEED,
    KEEP,
    SAMPLES,
    SAMPLING,
    SWEEP_OPTIONS,
    Metric,
    SweepOption,
    SweepSpec,
    sequence_of_seeds,
)

_Value = TypeVar("_Value")

SWEEP_KEYS: Final = ("parameters", "correlated", "seeds", "metrics", *(option.key for option in SWEEP_OPTIONS))
"""Keys of a sweep file beside those of a scenario file."""
_CORRELATED_KEYS: Final = ("parameters", "mean", "deviation", "correlation")


def read_sweep(
    path: str | Path,
    folders: Sequence[FilePath] = (),
    *,
    allow_code: bool = False,
    plugin_paths: Sequence[FilePath] = (),
) -> SweepSpec:
    """Read a sweep file.

    Args:
        path: file.
        folders: folders in which the file may name files, beside its own folder and its project.
        allow_code: allow the plugin folders and metric functions that the file names. Their code has the same rights
            as the user.
        plugin_paths: allow the code in these folders only.

    Raises:
        LoadError: the file has problems (SK-SCEN-001 to SK-SCEN-004, SK-SWEEP-001, SK-COND-001, SK-URI-003), or
            SK-SCEN-008 it names code that is not allowed; the error lists all.
    """
    diagnostics = Diagnostics()
    document = Document(Path(path), diagnostics, folders)
    if document.values is None:
        diagnostics.raise_if_errors()
    run = parse_scenario(document, also=SWEEP_KEYS)
    fields = document.values if isinstance(document.values, dict) else {}
    reader = _SweepReader(document, {key: value for key, value in fields.items() if key in SWEEP_KEYS})
    refused = (
        [] if allow_code else [request for request in reader.code_requests(run) if not request.is_within(plugin_paths)]
    )
    diagnostics.extend(request.diagnostic() for request in refused)
    # if something is refused, the refusal is raised below, and no launch file is executed
    permitted = permit_code(replace(run, launch="") if refused else run, allow_code=True)
    spec = reader.sweep(permitted, runs_code=not refused)
    diagnostics.raise_if_errors()
    assert spec is not None
    return spec


def _function_name(metric: object) -> str | None:
    """Return the name of a metric's Python function; None for any other metric."""
    name = metric["python"] if isinstance(metric, Mapping) and set(metric) == {"python"} else None
    return name if isinstance(name, str) else None


class _SweepReader(ValueReader):
    """Reader of the values of a sweep."""

    def sweep(self, run: RunSpec, *, runs_code: bool) -> SweepSpec | None:
        metrics, keep = self._metrics(runs_code=runs_code), self._option(KEEP)
        topics = self._option(BAG_TOPICS)
        bags = (topics,) if isinstance(topics, str) else tuple(topics)
        design = self._design(run.seed)
        files = self._document.files
        return None if design is None else SweepSpec(run, design, metrics, keep, bags, files=files)

    def _option(self, option: SweepOption[_Value]) -> _Value:
        """Return the value of an option, or report it and return the default."""
        value = self._fields.get(option.key, option.default)
        if option.allows(value):
            return value
        self._wrong(value, option.expected, option.key)
        return option.default

    def _design(self, seed: int) -> Design | None:
        samples, sampling = self._option(SAMPLES), self._option(SAMPLING)
        try:
            seeds = sequence_of_seeds(self._fields.get("seeds"), seed)
        except InputError as error:
            self._report(error, "seeds")
            seeds = (0, 1)  # with these, the parameters are checked too
        value = self._fields.get("parameters", {})
        parameters: Parameters
        if isinstance(value, str):
            parameters = self._document.path.parent / value
            if self._document.refuses(self._document.files.refusal(parameters), "parameters"):
                return None
        elif isinstance(value, dict):
            parameters = {**value, **self._correlated()}
        elif isinstance(value, list):
            parameters = value
        else:
            self._wrong(value, "a mapping, a list of mappings, or the name of a CSV file", "parameters")
            return None
        try:
            return make_design(
                parameters, seeds, samples=samples, sampling=sampling, design_seed=self._option(DESIGN_SEED)
            )
        except InputError as error:
            self._report(error, "parameters")
            return None

    def _report(self, error: InputError, key: str) -> None:
        """Report each line of an error at its parameter."""
        for line in str(error).splitlines():
            message = line.removeprefix(error.code).strip()
            name = message.partition("'")[2].partition("'")[0] if message.startswith("parameter ") else None
            keys = (key,) if name is None else (key, name)
            self._document.error(
                error.code, message, *(keys if not message.startswith(("samples", "sampling")) else ())
            )

    def _correlated(self) -> dict[tuple[str, ...], dict[str, object]]:
        listed = self._fields.get("correlated", [])
        if not isinstance(listed, list):
            self._wrong(listed, "a list of groups of parameters", "correlated")
            return {}
        spaces: dict[tuple[str, ...], dict[str, object]] = {}
        for number, item in enumerate(listed):
            at = ("correlated", number)
            fields = self._document.only(item, _CORRELATED_KEYS, "a group of parameters", *at)
            names = fields.get("parameters")
            if not isinstance(names, list) or len(names) < 2 or not all(isinstance(name, str) for name in names):
                self._wrong(names, "a list of at least two parameters", *at, "parameters")
                continue
            space: dict[str, object] = {"normal": [fields.get("mean"), fields.get("deviation")]}
            if "correlation" in fields:
                space["correlation"] = fields["correlation"]
            spaces[tuple(names)] = space
        return spaces

    def code_requests(self, run: RunSpec) -> list[CodeRequest]:
        """Return the plugin folders and metric functions that the file names."""
        requests = list(run.code_requests)
        for name, value in self._mapping("metrics").items():
            if (text := _function_name(value)) is not None:
                source = text.rpartition(":")[0]
                file = self._document.path.parent / source if source.endswith(".py") else None
                words = f"metric {name!r:.80} names the function {text!r:.200}"
                requests.append(CodeRequest(words, file, self._document.where("metrics", name)))
        return requests

    def _metrics(self, *, runs_code: bool) -> dict[str, Metric]:
        metrics: dict[str, Metric] = {}
        for name, value in self._mapping("metrics").items():
            if (text := _function_name(value)) is not None:
                if not runs_code:
                    continue
                try:
                    metrics[name] = FileMetric(text, self._document.path.parent)
                except InputError as error:
                    self._document.error(error.code, error.message, "metrics", name, hint=error.help)
            elif isinstance(value, (str, int, float)):
                metrics[name] = str(value)
                self._check_expression(str(value), name)
            else:
                self._wrong(value, "an expression, or {python: file.py:function}", "metrics", name)
        return metrics

    def _check_expression(self, expression: str, name: str) -> None:
        if "{" in expression:  # it has variables, and is checked with the first run
            return
        try:
            parse(expression)
        except InputError as error:
            self._document.error(error.code, f"metric {name!r}: {error.message}", "metrics", name, hint=error.help)
