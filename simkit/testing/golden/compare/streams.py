"""Comparison of two streams of one topic: times, fields, texts, noise statistics and bits."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np
import numpy.typing as npt

from simkit.diagnostics import shorten
from simkit.msgs.field_units import unit_of
from simkit.number_text import counted
from simkit.run_spec import RunSpec, Tolerance
from simkit.testing.golden.compare.difference import Difference, DifferenceKind
from simkit.testing.golden.compare.number_columns import compare_column, compare_orientation, quaternion_paths
from simkit.testing.golden.compare.pictures import compare_pictures
from simkit.testing.golden.compare.tolerances import (
    FieldFinding,
    FieldTerms,
    joint_unit,
    quantity_text,
    time_text,
    tolerance_of,
    value_text,
)
from simkit.testing.run_record.noise_statistics import NoiseStatistics, StatisticDifference, statistic_differences
from simkit.testing.run_record.record import Column, Stream

_REGULAR = 0.02  # allowed relative deviation of intervals at a steady rate; a period may lie between two steps
_EVENTS = 0.02  # share of messages that may be missing or additional on another machine, for topics without a rate

Times = npt.NDArray[np.int64]


def compare_times(golden: Stream, run: Stream, timestep: float, is_exact: bool) -> tuple[int, Difference | None]:
    """Return the number of messages before the first one whose time differs, and describe this difference.

    Args:
        golden: Stream of the golden run.
        run: Stream of the new run, of the same topic.
        timestep: Physics time step [s]; on another machine an event may shift by one step.
        is_exact: True if times must be equal.
    """
    a, b = golden.times_ns, run.times_ns
    both = min(len(a), len(b))
    rates = _rate(a), _rate(b)
    allowed = 0 if is_exact or any(rates) else shift_allowed(timestep)
    apart = np.flatnonzero(np.abs(a[:both] - b[:both]) > allowed)
    same = int(apart[0]) if apart.size else both
    is_near = not is_exact and rates[0] is None and abs(len(a) - len(b)) <= max(1.0, _EVENTS * len(a))
    if same == len(a) == len(b) or is_near:
        return same, None
    return same, _first_time_difference(golden, run, same, rates)


def shift_allowed(timestep: float) -> int:
    """Return the maximum time by which an event may shift on another machine [ns]: 1.5 steps."""
    return int(timestep * 1.5e9)


def _first_time_difference(
    golden: Stream, run: Stream, same: int, rates: tuple[float | None, float | None]
) -> Difference:
    a, b, topic = golden.times_ns, run.times_ns, run.topic
    counts = (
        f"{counted(len(a), 'message')} became {len(b)}"
        if len(a) != len(b)
        else f"{counted(len(a), 'message')} as before"
    )
    kind: DifferenceKind = "count" if len(a) != len(b) else "time"
    size = float(abs(len(b) - len(a))) if kind == "count" else abs(float(b[same] - a[same])) * 1e-9
    unit = "messages" if kind == "count" else "s"
    if rates[0] and rates[1] and abs(rates[1] / rates[0] - 1.0) > 1e-3:
        words = f"{rates[0]:.4g} Hz became {rates[1]:.4g} Hz: {counts}"
        kind, size, unit = "count", abs(rates[1] - rates[0]), "Hz"
    elif not len(b) or not len(a):
        words = f"{counted(len(b), 'message') if len(b) else 'no messages'} instead of {len(a) or 'none'}"
    elif same == len(b):
        words = f"ends at {_time_text(b[-1])}: {counts}"
    elif same == len(a):
        words = f"continues after {_time_text(a[-1])}: {counts}"
    elif len(a) == len(b) and np.ptp(b - a) == 0:
        words, same = f"every message is sent {_later(int(b[0] - a[0]))}", 0
    else:
        words = f"message {same + 1} is sent {_later(int(b[same] - a[same]))} at {_time_text(b[same])}; {counts}"
    return Difference(topic, "", kind, _seconds(b, same, a), size, unit, f"{topic}: {words}", "the same times", same)


def _rate(times: Times) -> float | None:
    """Return the rate of a steady topic [Hz]; None if the topic is not steady."""
    if len(times) < 3:
        return None
    # the first reading comes after the first step, not after a period, so the first interval is left out
    gaps = np.diff(times)[1:]
    mean = float(gaps.mean())
    if mean <= 0.0 or float(np.abs(gaps - np.median(gaps)).mean()) > max(_REGULAR * mean, 1e6):
        return None
    rate, error = 1e9 / mean, 2e6 / float(gaps.sum())  # sensors are read after a step, so readings are up to 2 ms late
    return float(round(rate)) if abs(rate - round(rate)) <= error * rate else rate


def _seconds(times: Times, index: int, others: Times) -> float:
    for known in (times, others):
        if index < len(known):
            return float(known[index]) * 1e-9
    last = [float(known[-1]) for known in (times, others) if len(known)]
    return min(last) * 1e-9 if last else 0.0


def begin_time(stream: Stream) -> float:
    """Return the time of the first message [s]; 0 without messages."""
    return float(stream.times_ns[0]) * 1e-9 if len(stream.times_ns) else 0.0


def _time_text(time_ns: np.int64) -> str:
    return time_text(float(time_ns) * 1e-9)


def _later(nanoseconds: int) -> str:
    words = quantity_text(abs(nanoseconds) * 1e-9, "s", signed=False)
    return f"{words} {'later' if nanoseconds > 0 else 'earlier'}"


def difference_in_bits(golden: Stream, run: Stream) -> Difference:
    """Describe a difference that is known only from hashes: `bits differ from t in 3–4 s, by less than 31 µm`."""
    both = min(len(golden.chunks), len(run.chunks))
    second = next((i for i in range(both) if golden.chunks[i] != run.chunks[i]), both)
    times = run.times_ns
    first = next((i for i, t in enumerate(times.tolist()) if t >= second * 1_000_000_000), -1)
    words = f"{run.topic}: bits differ from t in {second}–{second + 1} s"
    rounding = rounding_text(golden)
    if golden.pictures is not None or any(path.startswith("points.") for path in golden.columns):
        words += ", in data that golden runs do not store"
    elif rounding:
        words += f", by less than {rounding}"
    time = float(times[first]) * 1e-9 if first >= 0 else float(second)
    return Difference(run.topic, "", "bits", time, math.nan, "", words, "the same bits", first)


def rounding_text(stream: Stream) -> str:
    """Return the largest rounding error for each unit in a stream as text, such as `31 µm`; may be empty."""
    by_unit: dict[str, float] = {}
    for path, column in stream.columns.items():
        if column.step:
            unit = unit_of(stream.type_name, path)
            by_unit[unit] = max(by_unit.get(unit, 0.0), column.step / 2.0)
    texts = [quantity_text(step, unit, signed=False) for unit, step in sorted(by_unit.items())]
    return ", ".join(texts[:3])


Ranked = list[tuple[float, Difference]]

_NOTED_SHARE = 0.1  # notes do not mention a difference below this share of the tolerance


@dataclass
class StreamComparison:
    """Result of comparing two streams.

    Attributes:
        differences: Differences beyond the tolerance, ordered by their ratio to the tolerance, largest first.
        notes: Sentences about differences within the tolerance.
    """

    differences: list[Difference] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)


@dataclass(frozen=True)
class StreamPair:
    """Streams of one topic in both runs, and the settings of their comparison.

    Attributes:
        golden, run: Streams of the same topic.
        scenario: Scenario with the tolerances.
        is_exact: True if bits must be equal.
        timestep: Physics time step [s].
        joints: Unit of each joint's position, by joint name.
    """

    golden: Stream
    run: Stream
    scenario: RunSpec
    is_exact: bool
    timestep: float
    joints: Mapping[str, str] = field(default_factory=dict)

    def tolerance(self, path: str) -> Tolerance:
        """Return the tolerance of a field."""
        return tolerance_of(self.scenario, self.golden.topic, self.golden.type_name, path)

    def terms(self, path: str, count: int) -> FieldTerms:
        """Return the settings for comparing a field.

        Args:
            path: Path of the field.
            count: Number of messages to compare, from the first one on.
        """
        tolerance, unit = self.tolerance(path), unit_of(self.golden.type_name, path)
        if unit == "ns" and not self.is_exact and not tolerance.absolute:
            tolerance = replace(tolerance, absolute=float(shift_allowed(self.timestep)))
        if " or " in unit:
            unit = self._unit_of_joints(unit)
        return FieldTerms(self.run, path, tolerance, self.is_exact or tolerance.exact, count, unit)

    def _unit_of_joints(self, unit: str) -> str:
        """Return the unit of a joint field, if all joints rotate or all joints slide."""
        names = next((texts[0].split(", ") for path, texts in self.run.words.items() if path == "name" and texts), [])
        kinds = {self.joints.get(name, "") for name in names}
        return joint_unit(unit, kinds.pop() if len(kinds) == 1 else "")


def compare_stream(pair: StreamPair) -> StreamComparison:
    """Compare the streams of a topic."""
    golden, run = pair.golden, pair.run
    comparison = StreamComparison()
    if golden.digest and golden.digest == run.digest and np.array_equal(golden.times_ns, run.times_ns):
        return comparison
    if golden.type_name != run.type_name:
        words, time = f"{run.topic}: {golden.type_name} became {run.type_name}", begin_time(golden)
        comparison.differences.append(Difference(run.topic, "", "text", time, math.nan, "", words, "the same type"))
        return comparison
    message_tolerance = pair.tolerance("")
    if message_tolerance.exact:
        pair = replace(pair, is_exact=True)
    count, timing = compare_times(golden, run, pair.timestep, pair.is_exact)
    if timing is not None:
        comparison.differences.append(timing)
    ranked = [*_compare_numbers(pair, count, comparison), *_missing_fields(pair), *_compare_texts(pair, count)]
    if golden.pictures is not None or run.pictures is not None:
        ranked += compare_pictures(golden, run, message_tolerance, pair.is_exact, count, comparison.notes)
    if golden.statistics or run.statistics:
        ranked += _compare_statistics(pair, comparison)
    ranked.sort(key=lambda ranking: -ranking[0])
    comparison.differences += [difference for _, difference in ranked]
    if not comparison.differences:
        _compare_bits(pair, comparison)
    return comparison


# ---------------------------------------------------------------------- fields


def _compare_numbers(pair: StreamPair, count: int, found: StreamComparison) -> Ranked:
    """Compare all columns of numbers; treat the four columns of an orientation as one."""
    golden, run = pair.golden.columns, pair.run.columns
    ranked: Ranked = []
    common = [path for path in golden if path in run]
    compared: set[str] = set()
    for base in quaternion_paths(common):
        terms = pair.terms(base, count)
        parts = [f"{base}.{axis}" for axis in "xyzw"]
        if terms.tolerance.ignore:
            compared.update(parts)
            continue
        result = compare_orientation(terms, [golden[part] for part in parts], [run[part] for part in parts])
        if result is not None:
            compared.update(parts)
            _keep_first(result, terms, ranked, found)
    for path in common:
        if path in compared or pair.tolerance(path).ignore:
            continue
        is_setting = _is_setting(golden[path]) and _is_setting(run[path])  # constant: message times have no effect
        terms = pair.terms(path, min(len(golden[path].values), len(run[path].values)) if is_setting else count)
        _keep_first(compare_column(terms, golden[path], run[path]), terms, ranked, found)
    return ranked


def _is_setting(column: Column) -> bool:
    """Check whether a column has the same value in every message."""
    values = column.values
    return column.lengths is None and values.ndim == 1 and len(values) > 1 and bool((values == values[0]).all())


def _keep_first(result: FieldFinding, terms: FieldTerms, ranked: Ranked, found: StreamComparison) -> None:
    if result.difference is not None:
        ranked.append((result.excess, result.difference))
    elif result.excess > _NOTED_SHARE and result.off > 0.0 and not terms.is_exact:
        off = quantity_text(result.off, terms.unit, signed=False)
        found.notes.append(f"{terms.name}: up to {off} off, within {terms.allowed}")


def _missing_fields(pair: StreamPair) -> Ranked:
    """Find fields that only one of the two runs has."""
    golden, run = pair.golden, pair.run
    if not len(golden.times_ns) or not len(run.times_ns):
        return []  # a topic without messages has no fields, and the missing messages are already reported
    ranked: Ranked = []
    for path in sorted(golden.columns.keys() ^ run.columns.keys()):
        tolerance = pair.tolerance(path)
        if tolerance.ignore or tolerance.statistics or path in golden.statistics or path in run.statistics:
            continue
        kind: DifferenceKind = "extra" if path in run.columns else "missing"
        words = f"{run.topic}.{path}: is {'new' if kind == 'extra' else 'gone'}"
        difference = Difference(run.topic, path, kind, begin_time(run), math.nan, "", words, "the same fields")
        ranked.append((math.inf, difference))
    return ranked


def _compare_texts(pair: StreamPair, count: int) -> Ranked:
    """Compare text fields and find the first message that differs."""
    run = pair.run
    ranked: Ranked = []
    for path, mine in pair.golden.words.items():
        other = run.words.get(path)
        if other is None or pair.tolerance(path).ignore:
            continue
        both = min(count, len(mine), len(other))
        apart = [i for i in range(both) if mine[i] != other[i]]
        if not apart:
            continue
        first, rest = apart[0], both - apart[0]
        was, now = (shorten(texts[first].replace("\n", " "), 60) for texts in (mine, other))
        words = f"{run.topic}.{path}: “{was}” became “{now}”"
        time = float(run.times_ns[first]) * 1e-9
        words += f" {'at' if len(apart) == 1 else 'from'} {time_text(time)}"
        if len(apart) < rest:
            words += f", in {len(apart)} of {counted(rest, 'message')}"
        difference = Difference(run.topic, path, "text", time, math.nan, "", words, "the same text", first)
        ranked.append((math.inf, difference))
    return ranked


# ---------------------------------------------------------------------- noise


def _compare_statistics(pair: StreamPair, found: StreamComparison) -> Ranked:
    """Compare the noise statistics of the fields for which both runs have statistics."""
    golden, run = pair.golden, pair.run
    ranked: Ranked = []
    for path in sorted(golden.statistics.keys() | run.statistics.keys()):
        if pair.tolerance(path).ignore:
            continue
        mine, other = golden.statistics.get(path), run.statistics.get(path)
        if mine is None or other is None:
            holder = "the golden run" if other is None else "the new run"
            found.notes.append(f"{run.topic}.{path}: only {holder} has noise statistics; they are not compared")
            continue
        for deviance in statistic_differences(mine, other, *_allowed_by_scenario(pair.scenario, golden.topic, path)):
            ranked.append((math.inf, statistic_text(deviance, run, path, mine, other)))
    return ranked


def _allowed_by_scenario(scenario: RunSpec, topic: str, path: str) -> tuple[float, float]:
    """Return the absolute and relative tolerance that a scenario adds to the statistical tolerance."""
    tolerances = [t for t in scenario.tolerance(topic, path) if t.absolute is not None or t.relative is not None]
    return (tolerances[0].absolute or 0.0, tolerances[0].relative or 0.0) if tolerances else (0.0, 0.0)


def _compare_bits(pair: StreamPair, found: StreamComparison) -> None:
    """Compare the digests of streams whose stored values are equal."""
    loose = sorted(_loose_fields(pair))
    if pair.is_exact and not loose:
        found.differences.append(difference_in_bits(pair.golden, pair.run))
    elif pair.is_exact:
        left = ", ".join(loose[:3]) + (" …" if len(loose) > 3 else "")
        found.notes.append(f"{pair.run.topic}: bits differ, but only in fields that are not compared ({left})")


def _loose_fields(pair: StreamPair) -> set[str]:
    """Return the fields that the digest includes although their samples are not compared."""
    golden, run = pair.golden, pair.run
    of_noise = {*golden.statistics, *run.statistics}
    fields = {*golden.columns, *run.columns, *golden.words, *run.words}
    return of_noise | {path for path in fields if pair.tolerance(path).ignore}


def statistic_text(
    deviance: StatisticDifference, run: Stream, path: str, golden: NoiseStatistics, other: NoiseStatistics
) -> Difference:
    """Describe a difference in noise: `/imu.angular_velocity.x: the noise's deviation 0.0002 rad/s became …`.

    Args:
        deviance: Statistic that differs.
        run: Stream of the new run.
        path: Path of the field.
        golden: Statistics of the golden run.
        other: Statistics of the new run.
    """
    unit = unit_of(run.type_name, path)
    place = f"[{deviance.component}]" if golden.mean.size > 1 else ""
    samples = f"in {counted(other.count, 'sample')}"
    if other.count != golden.count:
        samples = f"in {golden.count} and {other.count} samples"
    a, b = value_text(deviance.golden, unit, 4), value_text(deviance.run, unit, 4)
    size, allowed = abs(deviance.run - deviance.golden), ""
    if deviance.what == "count":
        text = f"{deviance.golden:g} samples of the noise became {deviance.run:g}"
        unit, allowed = "samples", "enough samples on both sides"
    elif deviance.what == "mean":
        text = f"the noise's mean {a} became {b} {samples}"
        allowed = f"{quantity_text(deviance.limit, unit, signed=False)} by chance"
    elif deviance.what == "distribution":
        at = value_text(deviance.at, unit, 3)
        text = f"{100 * deviance.golden:.1f} % of the noise below {at} from its mean became {100 * deviance.run:.1f} %"
        text += f" {samples}: another distribution"
        allowed, unit = f"{100 * deviance.limit:.2g} % by chance", ""
    else:
        what = "deviation" if deviance.what == "deviation" else f"Allan deviation over {deviance.at:g} s"
        text = f"the noise's {what} {a} became {b}{_percent(deviance)} {samples}"
        allowed = f"{100 * (deviance.limit - 1):.2g} % by chance"
    time = float(run.times_ns[0]) * 1e-9 if len(run.times_ns) else 0.0
    words = f"{run.topic}.{path}{place}: {text}"
    return Difference(run.topic, path, "statistics", time, size, unit, words, allowed)


def _percent(deviance: StatisticDifference) -> str:
    if not deviance.golden or not math.isfinite(deviance.run / deviance.golden):
        return ""
    percent = 100.0 * (deviance.run / deviance.golden - 1.0)
    return f" ({percent:+.3g} %)".replace("-", "−")
