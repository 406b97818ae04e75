"""Simulated time is an exact grid."""

from fractions import Fraction

import pytest

from simkit.runtime.engine.simulated_time import Clock, exact_rate


def test_thirty_hertz_at_a_millisecond_gives_thirty_samples_in_every_second():
    clock = Clock(0.001)
    grid = clock.grid(30.0)
    assert grid is not None
    ticks = [grid.tick(k) for k in range(1, 3001)]
    assert ticks[:3] == [34, 67, 100]
    for second in range(100):
        assert sum(second * 1000 < t <= (second + 1) * 1000 for t in ticks) == 30


@pytest.mark.parametrize("rate", [200.0, 62.5, 30.0, 7.0, 0.3])
def test_next_and_index_agree_on_the_ticks(rate):
    grid = Clock(0.002).grid(rate)
    assert grid is not None
    tick, walked = 0, []
    for _ in range(50):
        tick = grid.next(tick)
        walked.append(tick)
    assert walked == [grid.tick(k) for k in range(1, 51)]
    assert [grid.index(t) for t in walked] == list(range(1, 51))
    assert grid.index(walked[7] - 1) == 7


def test_a_sensor_is_due_after_the_first_step_and_then_on_its_grid():
    grid = Clock(0.001).grid(30.0, from_start=True)
    ticks, tick = [], 0
    for _ in range(5):
        tick = grid.next(tick)
        ticks.append(tick)
    assert ticks == [1, 34, 67, 100, 134]


def test_a_rate_at_or_above_the_step_rate_means_every_step():
    assert Clock(0.001).grid(1000.0) is None
    assert Clock(0.001).grid(5000.0) is None
    assert Clock(0.001).grid(0.0) is None


def test_a_rate_is_the_decimal_as_written_or_the_fraction_that_it_was_computed_from():
    assert exact_rate(7.3) == Fraction(73, 10)
    assert exact_rate(1 / 3) == Fraction(1, 3)
    assert exact_rate(0.333) == Fraction(333, 1000)
    assert exact_rate(30000 / 1001) == Fraction(30000, 1001)
    assert exact_rate(1e-9) == Fraction(1, 10**9)
    assert exact_rate(1e12) == 10**12
    assert Clock(0.001).grid(1 / 3).tick(5) == 15000


def test_time_does_not_drift_over_hours():
    clock = Clock(0.001)
    assert clock.time_ns(3_600_000_000) == 3_600_000_000_000_000
    assert clock.time(3600) == 3.6
    assert Clock(1 / 240).time_ns(240) == pytest.approx(1e9, abs=1)
