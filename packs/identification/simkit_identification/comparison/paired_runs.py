"""Paired comparison of two sets of runs that have the same seeds (common random numbers)."""

from __future__ import annotations

import csv
import math
import os
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np

from simkit.errors import InputError
from simkit.extend import counted
from simkit.input_file import read_failure, read_input_text
from simkit.recording import matches_topic
from simkit_identification.comparison.row import Row
from simkit_identification.comparison.rows import with_verdicts
from simkit_identification.comparison.sources import ASIDE, is_bag, read_bag
from simkit_identification.comparison.table import Comparison
from simkit_identification.comparison.tolerances import Tolerance, tolerance_of
from simkit_identification.measures.context import Context
from simkit_identification.measures.measure import estimate
from simkit_identification.measures.recording import Floats
from simkit_identification.measures.registry import measures_of

_UNPAIRED: Final = "SK-COMPARE-004"
_TABLE: Final = "results.csv"
_LARGEST: Final = 256 << 20  # [bytes] of a table
_NO_METRICS: Final = frozenset({"run", "exit_code", "status", "end", "code", "message", "steps", "state_hash"})
_LEAST: Final = 3  # pairs

Metrics = dict[str, float]


@dataclass(frozen=True)
class PairedRow(Row):
    """Metric of two sets of runs.

    Attributes:
        pairs: number of pairs.
        unpaired: confidence interval of the difference if the runs were independent.
        correlation: correlation of the metric in the runs of a pair.
        saving: ratio of the numbers of runs that independent and paired runs need for the same interval.
    """

    pairs: int = 0
    unpaired: tuple[float, float] = (math.nan, math.nan)
    correlation: float = math.nan
    saving: float = math.nan


def is_set(source: Any) -> bool:
    """Check whether a source is a set of runs: the table or folder of a sweep, or a folder of bags."""
    if hasattr(source, "to_dict") and hasattr(source, "columns"):
        return True
    if not isinstance(source, (str, os.PathLike)):
        return False
    path = Path(source)
    if path.is_file():
        return path.suffix.lower() == ".csv"
    return path.is_dir() and not is_bag(path) and ((path / _TABLE).is_file() or any(_bags_in(path)))


def _bags_in(folder: Path) -> Iterator[Path]:
    return (path for path in sorted(folder.iterdir()) if is_bag(path))


def compare_sets(a: Any, b: Any, confidence: float, tolerances: list[Tolerance]) -> Comparison:
    """Compare two sets of runs pair by pair.

    Raises:
        InputError: SK-COMPARE-004 the sets have too few common runs, or no common metric.
    """
    if b is None or not is_set(b):
        text = "the first source is a set of runs, so the second one must be a set, too"
        raise InputError(_UNPAIRED, text, help="a set is the folder or table of a sweep, or a folder of bags")
    first, second = _runs_of(a), _runs_of(b)
    common = [key for key in first if key in second]
    names = _title(a, "table a"), _title(b, "table b")
    if len(common) < _LEAST:
        text = f"{names[0]} and {names[1]} have {len(common)} runs in common; a paired comparison needs {_LEAST}"
        raise InputError(_UNPAIRED, text, help="make both sets with the same seeds, or with bags of the same names")
    metrics = dict.fromkeys(name for key in common for name in first[key] if name in second[key])
    rows: list[Row] = []
    for name in metrics:
        pairs = [(first[k].get(name, math.nan), second[k].get(name, math.nan)) for k in common]
        values = np.array([pair for pair in pairs if all(map(math.isfinite, pair))], np.float64).reshape(-1, 2)
        if len(values) >= _LEAST and (np.ptp(values) > 0.0):
            rows.append(paired_row(name, values[:, 0], values[:, 1], confidence, tolerances))
    if not rows:
        raise InputError(_UNPAIRED, f"{names[0]} and {names[1]} have no metric in common that varies")
    left = len(first) + len(second) - 2 * len(common)
    notes = [
        f"{counted(len(common), 'pair')} of runs" + (f"; {left} runs without a partner are left out" if left else "")
    ]
    return Comparison(*names, with_verdicts(rows, confidence), confidence, notes)


def paired_row(
    name: str, a: Floats, b: Floats, confidence: float = 0.95, tolerances: Sequence[Tolerance] = ()
) -> PairedRow:
    """Return the paired comparison of a metric.

    Args:
        name: name of the metric; `TOPIC QUANTITY` for a quantity of bags.
        a: values of the runs, shape (pairs,).
        b: values of the other runs, in the same order.
        confidence: confidence of the intervals.
        tolerances: tolerances, the default last.
    """
    from scipy.stats import t as student

    count = len(a)
    differences = b - a
    mean = float(differences.mean())
    variances = float(a.var(ddof=1)), float(b.var(ddof=1))
    of_pairs = float(differences.var(ddof=1))
    error, unpaired_error = math.sqrt(of_pairs / count), math.sqrt((variances[0] + variances[1]) / count)
    width = float(student.isf((1.0 - confidence) / 2.0, count - 1)) * error
    unpaired_width = float(student.isf((1.0 - confidence) / 2.0, 2 * count - 2)) * unpaired_error
    chance = float(2.0 * student.sf(abs(mean) / error, count - 1)) if error else float(mean == 0.0)
    product = math.sqrt(variances[0] * variances[1])
    covariance = 0.5 * (variances[0] + variances[1] - of_pairs)
    topic, space, quantity = name.partition(" ") if name.startswith("/") else ("", "", name)
    scale = max(abs(float(a.mean())), abs(float(b.mean())))
    tolerance = tolerance_of(list(tolerances), topic, quantity, scale) if tolerances else 0.0
    saving = (variances[0] + variances[1]) / of_pairs if of_pairs else math.inf
    return PairedRow(
        topic, quantity if space or not topic else name, "", float(a.mean()), float(b.mean()), mean,
        (mean - width, mean + width), chance, "not tested", tolerance,
        f"independent runs: ±{unpaired_width:.3g}; pairs need {saving:.3g} × fewer runs",
        count, (mean - unpaired_width, mean + unpaired_width), covariance / product if product else math.nan, saving,
    )  # fmt: skip


def _title(source: Any, otherwise: str) -> str:
    return str(source) if isinstance(source, (str, os.PathLike)) else otherwise


def _runs_of(source: Any) -> dict[tuple[object, ...], Metrics]:
    """Return the metrics of each run by the key of its pair."""
    if hasattr(source, "to_dict"):
        return _keyed(source.to_dict("records"))
    path = Path(source)
    if path.is_file() or (path / _TABLE).is_file():
        return _keyed(_csv_rows(path if path.is_file() else path / _TABLE))
    runs: dict[tuple[object, ...], Metrics] = {}
    for bag in _bags_in(path):
        runs[(bag.stem,)] = _bag_metrics(bag)
    return runs


def _csv_rows(path: Path) -> list[Mapping[str, str]]:
    try:
        text = read_input_text(path, _LARGEST)
    except (OSError, ValueError) as error:
        raise InputError(_UNPAIRED, f"{path} cannot be read: {read_failure(error)}") from None
    return list(csv.DictReader(text.splitlines()))


def _keyed(rows: Sequence[Mapping[str, Any]]) -> dict[tuple[object, ...], Metrics]:
    """Return the numbers of rows by seed, and by the number of the row among those of this seed."""
    seen: Counter[str] = Counter()
    runs: dict[tuple[object, ...], Metrics] = {}
    for row in rows:
        seed = str(row.get("seed", ""))
        key = (seed, seen[seed])
        seen[seed] += 1
        if str(row.get("exit_code", "0")) not in ("0", "0.0"):
            continue
        numbers = {str(name): _number(value) for name, value in row.items() if name not in _NO_METRICS | {"seed"}}
        runs[key] = {name: value for name, value in numbers.items() if value is not None}
    return runs


def _number(value: Any) -> float | None:
    if isinstance(value, str) and value.lower() in ("true", "false"):
        return float(value.lower() == "true")
    try:
        return float(value)
    except (TypeError, ValueError):
        return None


def _bag_metrics(path: Path) -> Metrics:
    """Return the value of each quantity of a bag by `TOPIC QUANTITY`."""
    recording = read_bag(path, lambda topic: not matches_topic(topic, ASIDE))
    context = Context(recording, recording.duration, recording.still_intervals())
    metrics: Metrics = {}
    for topic, stream in recording.streams.items():
        for measure in measures_of(stream, context).values():
            if not measure.is_ratio:
                metrics[f"{topic} {measure.quantity}"] = estimate(measure, 0.95).value
    return metrics
