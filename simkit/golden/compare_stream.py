"""Two streams of one topic side by side."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from simkit.diagnostics import shortened
from simkit.golden.bits import difference_in_bits
from simkit.golden.compare_numbers import compare_column
from simkit.golden.compare_orientation import compare_orientation, quaternions
from simkit.golden.compare_times import begin_of, compare_times, shift_allowed
from simkit.golden.difference import Difference, DifferenceKind
from simkit.golden.record import Column, Stream
from simkit.golden.terms import Found, Terms
from simkit.golden.tolerances import tolerance_of
from simkit.golden.units import joint_unit, moment, quantity, unit_of
from simkit.scenario import Scenario, Tolerance

Ranked = list[tuple[float, Difference]]

_TOLD = 0.1  # part of a tolerance from which a difference within it is worth a note


@dataclass
class OfStream:
    """What comparing two streams gave.

    Attributes:
        differences: that count, the largest against its tolerance first.
        notes: of what is other and allowed.
    """

    differences: list[Difference] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)


@dataclass(frozen=True)
class Pair:
    """A topic of both runs, and how it is compared.

    Attributes:
        golden, run: of the same topic.
        scenario: whose tolerances count.
        is_exact: whether bits must be equal.
        timestep: of the physics [s].
        joints: unit of each joint's position, by its name.
    """

    golden: Stream
    run: Stream
    scenario: Scenario
    is_exact: bool
    timestep: float
    joints: Mapping[str, str] = field(default_factory=dict)

    def tolerance(self, path: str) -> Tolerance:
        """What is allowed a field."""
        return tolerance_of(self.scenario, self.golden.topic, self.golden.type_name, path)

    def terms(self, path: str, count: int) -> Terms:
        """How a field is compared.

        Args:
            path: of the field.
            count: how many messages from the first on.
        """
        tolerance, unit = self.tolerance(path), unit_of(self.golden.type_name, path)
        if unit == "ns" and not self.is_exact and not tolerance.absolute:
            tolerance = replace(tolerance, absolute=float(shift_allowed(self.timestep)))
        if " or " in unit:
            unit = self._unit_of_joints(unit)
        return Terms(self.run, path, tolerance, self.is_exact or tolerance.exact, count, unit)

    def _unit_of_joints(self, unit: str) -> str:
        """Of a field of joints that all turn, or all slide, one unit."""
        names = next((texts[0].split(", ") for path, texts in self.run.words.items() if path == "name" and texts), [])
        kinds = {self.joints.get(name, "") for name in names}
        return joint_unit(unit, kinds.pop() if len(kinds) == 1 else "")


def compare_stream(pair: Pair) -> OfStream:
    """Compares what a topic gave."""
    golden, run = pair.golden, pair.run
    found = OfStream()
    if golden.digest and golden.digest == run.digest and np.array_equal(golden.times_ns, run.times_ns):
        return found
    if golden.type_name != run.type_name:
        words, time = f"{run.topic}: {golden.type_name} became {run.type_name}", begin_of(golden)
        found.differences.append(Difference(run.topic, "", "text", time, math.nan, "", words, "the same type"))
        return found
    whole = pair.tolerance("")
    if whole.exact:
        pair = replace(pair, is_exact=True)
    count, timing = compare_times(golden, run, pair.timestep, pair.is_exact)
    if timing is not None:
        found.differences.append(timing)
    ranked = [*_numbers(pair, count, found), *_lost(pair), *_texts(pair, count)]
    if golden.pictures is not None or run.pictures is not None:
        from simkit.golden.compare_pictures import compare_pictures

        ranked += compare_pictures(golden, run, whole, pair.is_exact, count, found.notes)
    if golden.statistics or run.statistics:
        ranked += _statistics(pair, found)
    ranked.sort(key=lambda ranking: -ranking[0])
    found.differences += [difference for _, difference in ranked]
    if not found.differences:
        _bits(pair, found)
    return found


# ---------------------------------------------------------------------- fields


def _numbers(pair: Pair, count: int, found: OfStream) -> Ranked:
    """All columns, orientations as one."""
    golden, run = pair.golden.columns, pair.run.columns
    ranked: Ranked = []
    common = [path for path in golden if path in run]
    told: set[str] = set()
    for base in quaternions(common):
        terms = pair.terms(base, count)
        parts = [f"{base}.{axis}" for axis in "xyzw"]
        if terms.tolerance.ignore:
            told.update(parts)
            continue
        result = compare_orientation(terms, [golden[part] for part in parts], [run[part] for part in parts])
        if result is not None:
            told.update(parts)
            _keep(result, terms, ranked, found)
    for path in common:
        if path in told or pair.tolerance(path).ignore:
            continue
        is_setting = _is_setting(golden[path]) and _is_setting(run[path])  # does not depend on when it is said
        terms = pair.terms(path, min(len(golden[path].values), len(run[path].values)) if is_setting else count)
        _keep(compare_column(terms, golden[path], run[path]), terms, ranked, found)
    return ranked


def _is_setting(column: Column) -> bool:
    """Whether it says the same in every message."""
    values = column.values
    return column.lengths is None and values.ndim == 1 and len(values) > 1 and bool((values == values[0]).all())


def _keep(result: Found, terms: Terms, ranked: Ranked, found: OfStream) -> None:
    if result.difference is not None:
        ranked.append((result.excess, result.difference))
    elif result.excess > _TOLD and result.off > 0.0 and not terms.is_exact:
        off = quantity(result.off, terms.unit, signed=False)
        found.notes.append(f"{terms.name}: up to {off} off, within {terms.allowed}")


def _lost(pair: Pair) -> Ranked:
    """Fields that only one of the two has."""
    golden, run = pair.golden, pair.run
    if not len(golden.times_ns) or not len(run.times_ns):
        return []  # without a message there is no field; that is told already
    ranked: Ranked = []
    for path in sorted(golden.columns.keys() ^ run.columns.keys()):
        tolerance = pair.tolerance(path)
        if tolerance.ignore or tolerance.statistics or path in golden.statistics or path in run.statistics:
            continue
        kind: DifferenceKind = "extra" if path in run.columns else "missing"
        words = f"{run.topic}.{path}: is {'new' if kind == 'extra' else 'gone'}"
        difference = Difference(run.topic, path, kind, begin_of(run), math.nan, "", words, "the same fields")
        ranked.append((math.inf, difference))
    return ranked


def _texts(pair: Pair, count: int) -> Ranked:
    """Words: the first message in which they are other."""
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
        words = f"{run.topic}.{path}: “{_line(mine[first])}” became “{_line(other[first])}”"
        time = float(run.times_ns[first]) * 1e-9
        words += f" {'at' if len(apart) == 1 else 'from'} {moment(time)}"
        if len(apart) < rest:
            words += f", in {len(apart)} of {rest} messages"
        difference = Difference(run.topic, path, "text", time, math.nan, "", words, "the same text", first)
        ranked.append((math.inf, difference))
    return ranked


def _line(text: str) -> str:
    return shortened(text.replace("\n", " "), 60)


# ---------------------------------------------------------------------- noise


def _statistics(pair: Pair, found: OfStream) -> Ranked:
    """Statistics of the noise, where both have them."""
    from simkit.golden.statistic_words import difference_of
    from simkit.golden.statistics import deviances

    golden, run = pair.golden, pair.run
    ranked: Ranked = []
    for path in sorted(golden.statistics.keys() | run.statistics.keys()):
        if pair.tolerance(path).ignore:
            continue
        mine, other = golden.statistics.get(path), run.statistics.get(path)
        if mine is None or other is None:
            holder = "the golden" if other is None else "the run"
            found.notes.append(f"{run.topic}.{path}: only {holder} has statistics of it; it is not compared")
            continue
        for deviance in deviances(mine, other, *_said(pair.scenario, golden.topic, path)):
            ranked.append((math.inf, difference_of(deviance, run, path, mine, other)))
    return ranked


def _said(scenario: Scenario, topic: str, path: str) -> tuple[float, float]:
    """What a scenario itself allows beside chance."""
    said = [t for t in scenario.tolerance(topic, path) if t.absolute is not None or t.relative is not None]
    return (said[0].absolute or 0.0, said[0].relative or 0.0) if said else (0.0, 0.0)


# ---------------------------------------------------------------------- bits


def _bits(pair: Pair, found: OfStream) -> None:
    """All that was kept agrees, and the bits do not."""
    loose = sorted(_loose_fields(pair))
    if pair.is_exact and not loose:
        found.differences.append(difference_in_bits(pair.golden, pair.run))
    elif pair.is_exact:
        left = ", ".join(loose[:3]) + (" …" if len(loose) > 3 else "")
        found.notes.append(f"{pair.run.topic}: bits differ, and nothing that is compared ({left} left out)")


def _loose_fields(pair: Pair) -> set[str]:
    """Fields whose samples are not looked at, which the digest of the messages covers all the same."""
    golden, run = pair.golden, pair.run
    fields = {*golden.columns, *run.columns, *golden.words, *run.words, *golden.statistics, *run.statistics}
    tolerances = {path: pair.tolerance(path) for path in fields}
    return {path for path, t in tolerances.items() if t.ignore or path in golden.statistics or path in run.statistics}
