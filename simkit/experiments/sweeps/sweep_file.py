"""Sweep files: a scenario file with further keys for parameters, samples, seeds and metrics."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Final, cast

from simkit.code_requests import CodeRequest
from simkit.diagnostics import Diagnostics
from simkit.errors import InputError
from simkit.experiments.sweeps.design import SAMPLINGS
from simkit.experiments.sweeps.metrics import FileMetric
from simkit.experiments.sweeps.sweep import make_design
from simkit.experiments.sweeps.sweep_spec import Keep, Metric, SweepSpec, sequence_of_seeds
from simkit.run_spec import FilePath, RunSpec
from simkit.testing.conditions.parser import parse
from simkit.testing.scenarios.code_permission import permit_code
from simkit.testing.scenarios.scenario_file import parse_scenario
from simkit.testing.scenarios.yaml_document import Document, ValueReader

SWEEP_KEYS: Final = (
    "parameters",
    "correlated",
    "seeds",
    "samples",
    "sampling",
    "design_seed",
    "metrics",
    "keep",
    "bags",
)
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
    reader = _SweepReader(document, {key: one for key, one in fields.items() if key in SWEEP_KEYS})
    refused = [] if allow_code else [one for one in reader.code_requests(run) if not one.is_within(plugin_paths)]
    diagnostics.extend(request.diagnostic() for request in refused)
    spec = reader.sweep(permit_code(run, allow_code=True), runs_code=not refused)  # else, the refusal is raised below
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
        metrics, keep = self._metrics(runs_code=runs_code), self._keep()
        bags = self.texts("bags")
        design = self._design(run.seed)
        files = self._document.files
        return None if design is None else SweepSpec(run, design, metrics, keep, bags, files=files)

    def _design(self, seed: int) -> Any:
        samples = self.whole("samples", 0, 1) if "samples" in self._fields else None
        sampling = self.text("sampling", "random")
        if sampling not in SAMPLINGS:
            self._wrong(sampling, f"one of {', '.join(SAMPLINGS)}", "sampling")
            sampling = "random"
        try:
            seeds = sequence_of_seeds(cast(Any, self._fields.get("seeds")), seed)
        except InputError as error:
            self._report(error, "seeds")
            seeds = (0, 1)  # with these, the parameters are checked too
        found: Any = self._fields.get("parameters", {})
        if isinstance(found, str):
            found = self._document.path.parent / found
            if self._document.refuses(self._document.files.refusal(found), "parameters"):
                return None
        elif isinstance(found, dict):
            found = {**found, **self._correlated()}
        elif not isinstance(found, list):
            self._wrong(found, "a mapping, a list of mappings, or the name of a CSV file", "parameters")
            return None
        try:
            return make_design(
                found, seeds, samples=samples, sampling=sampling, design_seed=self.whole("design_seed", 0, 0)
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

    def _correlated(self) -> dict[tuple[str, ...], Any]:
        listed = self._fields.get("correlated", [])
        if not isinstance(listed, list):
            self._wrong(listed, "a list of groups of parameters", "correlated")
            return {}
        found = {}
        for number, item in enumerate(listed):
            at = ("correlated", number)
            fields = self._document.only(item, _CORRELATED_KEYS, "a group of parameters", *at)
            names = fields.get("parameters")
            if not isinstance(names, list) or len(names) < 2 or not all(isinstance(one, str) for one in names):
                self._wrong(names, "a list of at least two parameters", *at, "parameters")
                continue
            space = {"normal": [fields.get("mean"), fields.get("deviation")]}
            if "correlation" in fields:
                space["correlation"] = cast(Any, fields["correlation"])
            found[tuple(names)] = space
        return found

    def code_requests(self, run: RunSpec) -> list[CodeRequest]:
        """Return the plugin folders and metric functions that the file names."""
        found = list(run.code_requests)
        for name, value in self._mapping("metrics").items():
            if (text := _function_name(value)) is not None:
                source = text.rpartition(":")[0]
                file = self._document.path.parent / source if source.endswith(".py") else None
                words = f"metric {name!r:.80} names the function {text!r:.200}"
                found.append(CodeRequest(words, file, self._document.where("metrics", name)))
        return found

    def _metrics(self, *, runs_code: bool) -> dict[str, Metric]:
        found: dict[str, Metric] = {}
        for name, value in self._mapping("metrics").items():
            if (text := _function_name(value)) is not None:
                if not runs_code:
                    continue
                try:
                    found[name] = FileMetric(text, self._document.path.parent)
                except InputError as error:
                    self._document.error(error.code, str(error).removeprefix(error.code).strip(), "metrics", name)
            elif isinstance(value, (str, int, float)):
                found[name] = str(value)
                self._check_expression(str(value), name)
            else:
                self._wrong(value, "an expression, or {python: file.py:function}", "metrics", name)
        return found

    def _check_expression(self, expression: str, name: str) -> None:
        if "{" in expression:  # it has variables, and is checked with the first run
            return
        try:
            parse(expression)
        except InputError as error:
            message, _, hint = str(error).removeprefix(error.code).strip().partition("\n    help: ")
            self._document.error(error.code, f"metric {name!r}: {message}", "metrics", name, hint=hint)

    def _keep(self) -> Keep:
        value = self._fields.get("keep", 10)
        if value in ("failed", "all") or (isinstance(value, int) and not isinstance(value, bool) and value >= 0):
            return value
        self._wrong(value, "failed, all, or a number of failed runs", "keep")
        return 10
