"""Statistics of noise: only differences that chance does not explain are reported."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from made_up import IMU, record, stream, times

from simkit.run_spec import Tolerance
from simkit.testing.golden.compare.runs import compare
from simkit.testing.run_record.noise_statistics import (
    NoiseStatistics,
    detectable_ratio,
    noise_statistics,
    statistic_differences,
)

PERIOD = 0.005


def sample(seed: int, count: int = 6000, kind: str = "normal") -> Any:
    rng = np.random.default_rng(seed)
    if kind == "uniform":
        return rng.uniform(-1.0, 1.0, count) * np.sqrt(3.0)
    if kind == "two places":
        return (np.where(rng.random(count) < 0.5, -3.0, 3.0) + rng.standard_normal(count)) / np.sqrt(10.0)
    if kind == "quantised":
        return np.round(rng.standard_normal(count) * 2.0) / 2.0
    if kind == "heavy":
        return rng.standard_t(4, count)
    if kind == "slow":
        from scipy.signal import lfilter

        return lfilter([1.0], [1.0, -0.98], rng.standard_normal(count))
    return rng.standard_normal(count)


def test_the_numbers_are_those_of_the_noise() -> None:
    found = noise_statistics(0.02 * sample(0) + 0.001, PERIOD)
    assert found.count == 6000
    assert found.mean[0] == pytest.approx(0.001, abs=4 * 0.02 / np.sqrt(6000))
    assert found.deviation[0] == pytest.approx(0.02, rel=4 / np.sqrt(2 * 6000))
    assert found.kurtosis[0] == pytest.approx(3.0, abs=0.3)
    assert found.independent[0] > 0.8 * 6000
    middle = found.quantiles.shape[1] // 2
    assert found.quantiles[0, middle] == pytest.approx(0.001, abs=2e-3)
    # white noise averages as one by the root of the time; 15 %: 190 averages of 32 samples
    assert found.allan[0, 5] == pytest.approx(0.02 / np.sqrt(32), rel=0.15)


@pytest.mark.parametrize("kind", ["normal", "uniform", "quantised", "heavy", "slow"])
def test_two_samples_of_the_same_noise_are_equal(kind: str) -> None:
    found = [noise_statistics(sample(seed, 2000, kind), PERIOD) for seed in range(24)]
    for a in found[::2]:
        for b in found[1::2]:
            assert not statistic_differences(a, b)


def test_twenty_per_cent_more_noise_is_detected_in_thirty_seconds_at_100_hz() -> None:
    seen = [
        statistic_differences(
            noise_statistics(sample(s, 3000), PERIOD), noise_statistics(1.2 * sample(99 + s, 3000), PERIOD)
        )
        for s in range(20)
    ]
    assert all(found and found[0].what == "deviation" for found in seen)
    assert detectable_ratio(3000) < 1.2 < detectable_ratio(2000)


def test_a_shift_of_the_mean_beyond_seven_standard_errors_is_detected() -> None:
    golden, run = noise_statistics(sample(0), PERIOD), noise_statistics(sample(1) + 0.2, PERIOD)
    assert [d.what for d in statistic_differences(golden, run)] == ["mean"]
    assert not statistic_differences(golden, run, absolute=0.25)
    assert not statistic_differences(golden, noise_statistics(sample(1) + 0.02, PERIOD))


def test_another_shape_with_the_same_mean_and_deviation_is_seen() -> None:
    found = statistic_differences(
        noise_statistics(sample(0), PERIOD), noise_statistics(sample(1, kind="two places"), PERIOD)
    )
    assert [d.what for d in found] == ["distribution"]


def test_correlated_noise_is_detected_by_its_allan_deviation() -> None:
    slow = sample(1, kind="slow")
    found = statistic_differences(noise_statistics(sample(0), PERIOD), noise_statistics(slow / slow.std(), PERIOD))
    assert "allan" in [d.what for d in found]


def test_missing_or_new_noise_is_detected() -> None:
    nothing, some = noise_statistics(np.zeros(100), PERIOD), noise_statistics(sample(0, 100), PERIOD)
    assert [d.what for d in statistic_differences(some, nothing)] == ["deviation"]
    assert [d.what for d in statistic_differences(nothing, some)][:1] == ["deviation"]
    assert not statistic_differences(nothing, nothing)


def test_few_samples_cause_no_false_alarm() -> None:
    for count in (0, 1, 2, 7, 8, 20):
        a, b = noise_statistics(sample(0, count), PERIOD), noise_statistics(sample(1, count), PERIOD)
        assert isinstance(a, NoiseStatistics) and a.count == count and not statistic_differences(a, b)
    assert [
        d.what
        for d in statistic_differences(noise_statistics(sample(0, 2), PERIOD), noise_statistics(sample(0, 500), PERIOD))
    ] == ["count"]


def test_rays_are_pooled_and_infinite_values_left_out() -> None:
    values = sample(0, 3600).reshape(10, 360)
    values[:, 7] = np.nan
    values[3, 9] = np.inf
    found = noise_statistics(values, 0.2)
    assert found.mean.shape == (1,) and found.count == 3600 - 10 - 1 and found.allan.shape == (1, 0)


def test_components_are_compared_separately() -> None:
    golden = noise_statistics(np.stack([sample(0), sample(1)], axis=1), PERIOD)
    run = noise_statistics(np.stack([sample(2), 1.5 * sample(3)], axis=1), PERIOD)
    assert [(d.what, d.component) for d in statistic_differences(golden, run)] == [("deviation", 1)]


def noisy(seed: int, scale: float = 0.01) -> Any:
    found = stream("/imu", IMU, times(6000, 200.0), {"header.stamp": times(6000, 200.0)}, {"seed": [str(seed)] * 6000})
    found.words = {}
    found.statistics = {"linear_acceleration.x": noise_statistics(scale * sample(seed), PERIOD)}
    return found


def test_streams_with_statistics_are_compared_by_them_on_every_machine() -> None:
    statistics = (Tolerance("/imu", statistics=True),)
    for exact in (True, False):
        same = compare(record(noisy(0)), record(noisy(1), tolerances=statistics), exact=exact)
        assert same.passed and (not exact or "bits differ" in same.notes[0])
        (found,) = compare(record(noisy(0)), record(noisy(1, 0.012), tolerances=statistics), exact=exact).differences
        assert found.kind == "statistics" and found.unit == "m/s²" and found.size == pytest.approx(0.002, rel=0.2)
        assert found.words.startswith("/imu.linear_acceleration.x: the noise's deviation 0.0")
        assert "m/s² (+" in found.words and "in 6000 samples" in found.words and "by chance" in found.allowed
