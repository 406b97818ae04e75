"""Two samples of the same noise seldom count as different, whether the noise is white or correlated."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest

from simkit_identification.measures import signals
from simkit_identification.measures.context import Context
from simkit_identification.measures.measure import Measure, compare_measures
from simkit_identification.measures.recording import Signal, SignalRecording, Stream


def measured(values: np.ndarray, rate: float) -> dict[str, Measure]:
    at = np.arange(len(values)) / rate
    stream = Stream("/x", "std_msgs/msg/Float64", at, np.full(len(at), np.nan))
    stream.signals["data"] = Signal("data", "", at, values)
    context = Context(SignalRecording("bag", len(at) / rate, {}), len(at) / rate, None)
    return {measure.quantity: measure for measure in signals.values(stream, context)}


def noise(random: np.random.Generator, kind: str, count: int) -> np.ndarray:
    steps = random.normal(0.0, 0.1, count)
    if kind == "white":
        return steps
    memory = 1.0 if kind == "random walk" else 0.95
    values = np.zeros(count)
    for k in range(1, count):
        values[k] = memory * values[k - 1] + steps[k]
    return values


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["white", "correlated", "random walk"])
def test_the_chance_of_a_false_alarm_is_that_of_the_confidence(kind: str) -> None:
    """200 pairs: at a true chance of 5 %, more than 18 alarms have a chance of 1 %."""
    random = np.random.default_rng(11)
    alarms: Counter[str] = Counter()
    for _ in range(200):
        a, b = (measured(noise(random, kind, 1000), 50.0) for _ in range(2))
        for quantity in a.keys() & b.keys():
            alarms[quantity] += compare_measures(a[quantity], b[quantity], 0.95).chance < 0.05
    assert max(alarms.values()) <= 18, alarms
