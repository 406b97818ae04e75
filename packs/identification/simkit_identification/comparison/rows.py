"""Rows of a comparison: measures of two recordings, their differences, and verdicts on all of them together."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from simkit_identification.comparison.row import Row, Verdict
from simkit_identification.comparison.tolerances import Tolerance, tolerance_of
from simkit_identification.measures.context import Context
from simkit_identification.measures.measure import Measure, Outcome, compare_measures, estimate
from simkit_identification.measures.recording import SignalRecording, Stream
from simkit_identification.measures.registry import measures_of

_UNKNOWN: Final = (math.nan, math.nan)
_ROUNDING: Final = 1e-12  # in any unit: smaller values are errors of rounding
_FEW: Final = "too few samples"
_NO_TEST: Final = "chance is unknown"


def rows_of_one(a: SignalRecording, topics: Sequence[str], confidence: float) -> list[Row]:
    """Return the rows of one recording alone."""
    context = Context(a, a.duration, a.still_intervals())
    rows: list[Row] = []
    for topic in topics:
        stream = a.streams[topic]
        rows.append(_count_row(stream, None))
        constant = 0
        for measure in measures_of(stream, context).values():
            if _is_constant(measure):
                constant += 1
                continue
            if measure.is_ratio or _is_nothing(measure):
                continue
            found = estimate(measure, confidence)
            interval = (found.low, found.high)
            rows.append(
                Row(
                    topic,
                    measure.quantity,
                    measure.unit,
                    found.value,
                    math.nan,
                    math.nan,
                    interval,
                    math.nan,
                    "measured",
                )
            )
        rows += _constant_row(topic, constant, 0)
    return rows


def rows_of_two(
    a: SignalRecording, b: SignalRecording, topics: Sequence[str], confidence: float, tolerances: list[Tolerance]
) -> list[Row]:
    """Return the rows of two recordings, with verdicts."""
    duration = min(a.duration, b.duration)
    contexts = tuple(Context(side, duration, side.still_intervals()) for side in (a, b))
    rows: list[Row] = []
    for topic in topics:
        one, two = a.streams.get(topic), b.streams.get(topic)
        if one is None or two is None or not one.count or not two.count:
            verdict: Verdict = "only in b" if one is None or not one.count else "only in a"
            counts = tuple(math.nan if s is None else float(s.count) for s in (one, two))
            rows.append(Row(topic, "messages", "", counts[0], counts[1], math.nan, _UNKNOWN, math.nan, verdict))
            continue
        rows.append(_count_row(one, two))
        if one.type_name != two.type_name:
            note = f"types {one.type_name} and {two.type_name}"
            rows.append(Row(topic, "type", "", math.nan, math.nan, math.nan, _UNKNOWN, 0.0, "differs", note=note))
        rows += _topic_rows(topic, measures_of(one, contexts[0]), measures_of(two, contexts[1]), confidence, tolerances)
    return with_verdicts(rows, confidence)


def _count_row(a: Stream, b: Stream | None) -> Row:
    """Return the row with the numbers of messages, which the rate and the gaps judge."""
    difference = math.nan if b is None else float(b.count - a.count)
    verdict: Verdict = "measured" if b is None else "same" if difference == 0.0 else "not tested"
    note = "" if not difference else "rate and gaps tell more"
    other = math.nan if b is None else float(b.count)
    return Row(a.topic, "messages", "", float(a.count), other, difference, _UNKNOWN, math.nan, verdict, note=note)


def _constant_row(topic: str, constant: int, other: int) -> list[Row]:
    if not constant:
        return []
    name = "fields without change"
    if not other:
        return [Row(topic, name, "", float(constant), math.nan, math.nan, _UNKNOWN, math.nan, "measured")]
    return [Row(topic, name, "", float(constant), float(other), 0.0, _UNKNOWN, math.nan, "same")]


def _topic_rows(
    topic: str, ours: dict[str, Measure], theirs: dict[str, Measure], confidence: float, tolerances: list[Tolerance]
) -> list[Row]:
    rows: list[Row] = []
    constant = 0
    for quantity in dict.fromkeys((*ours, *theirs)):
        a, b = ours.get(quantity), theirs.get(quantity)
        if a is None or b is None:
            rows += _lonely_row(topic, quantity, a, b, confidence)
            continue
        if _is_constant(a) and _is_constant(b):
            if np.array_equal(a.values[:1], b.values[:1]):
                constant += 1
                continue
            a, b = replace(a, kind="value"), replace(b, kind="value")
            outcome = compare_measures(a, b, confidence)._replace(chance=0.0)
        elif _is_nothing(a) and _is_nothing(b):
            continue
        else:
            outcome = compare_measures(a, b, confidence)
        rows.append(_row(topic, a, outcome, tolerances, _scale(a, b, outcome)))
    return rows + _constant_row(topic, constant, constant)


def _lonely_row(topic: str, quantity: str, a: Measure | None, b: Measure | None, confidence: float) -> list[Row]:
    """Return the row of a quantity that only one side has: a field that is missing, or a measure without samples."""
    measure = a or b
    assert measure is not None
    if _is_nothing(measure) or measure.is_ratio:
        return []
    value = estimate(measure, confidence).value
    values = (value, math.nan) if b is None else (math.nan, value)
    is_field = measure.kind == "paired" and not quantity.startswith(("forward", "sideways", "yaw rate"))
    side: Verdict = "only in a" if b is None else "only in b"
    verdict: Verdict = side if is_field else "not tested"
    return [
        Row(
            topic, quantity, measure.unit, *values, math.nan, _UNKNOWN, math.nan, verdict, note="" if is_field else side
        )
    ]


def _row(topic: str, a: Measure, outcome: Outcome, tolerances: list[Tolerance], scale: float) -> Row:
    size = max(_ROUNDING, tolerance_of(tolerances, topic, a.quantity, scale))
    interval = (outcome.low, outcome.high)
    note = ""
    if math.isnan(outcome.difference):
        note = _FEW if a.array is None else "the arrays have different shapes, or too few common returns"
    elif math.isnan(outcome.chance):
        note = _NO_TEST
    values = outcome.a, outcome.b, outcome.difference
    return Row(topic, a.quantity, a.unit, *values, interval, outcome.chance, "not tested", size, note)


def _scale(a: Measure, b: Measure, outcome: Outcome) -> float:
    """Return the size of the values of a row, to which a relative tolerance refers."""
    scale = max((abs(v) for v in (outcome.a, outcome.b) if math.isfinite(v)), default=0.0)
    if a.kind == "paired":
        for side in (a, b):
            finite = side.values[np.isfinite(side.values)]
            if len(finite):
                scale = max(scale, float(np.sqrt(np.mean(finite**2))))
    return scale


def _is_constant(measure: Measure) -> bool:
    if measure.kind != "paired" or measure.times is None:
        return False
    finite = measure.values[np.isfinite(measure.values)]
    return bool(not len(finite) or np.ptp(finite) == 0.0)


def _is_nothing(measure: Measure) -> bool:
    """Check whether a measure is a noise, gap or delay of exactly zero."""
    if measure.array is not None or measure.kind == "paired" or measure.quantity == "latency":
        return False
    smallest = _ROUNDING**2 if measure.kind in ("deviation", "power") else _ROUNDING
    return measure.kind in ("deviation", "power", "mean", "largest") and not np.any(np.abs(measure.values) > smallest)


def with_verdicts(rows: Sequence[Row], confidence: float) -> list[Row]:
    """Return rows with verdicts: the chance that any row differs by chance is 1 - confidence (Holm's method)."""
    tested = [k for k, row in enumerate(rows) if row.verdict == "not tested" and math.isfinite(row.chance)]
    order = sorted(tested, key=lambda k: rows[k].chance)
    judged = list(rows)
    is_beyond = True
    for rank, k in enumerate(order):
        row = rows[k]
        is_beyond = is_beyond and row.chance <= (1.0 - confidence) / (len(order) - rank)
        if not is_beyond:
            judged[k] = replace(row, verdict="same")
        else:
            is_large = abs(row.difference) > row.tolerance or row.quantity.endswith("distribution")
            judged[k] = replace(row, verdict="differs" if is_large else "within tolerance")
    for k, row in enumerate(judged):
        if row.verdict == "not tested" and row.note == _NO_TEST and abs(row.difference) <= row.tolerance:
            judged[k] = replace(row, verdict="within tolerance")
    return judged
