"""Statistics of bags with known rate, gaps, latency, bias and noise are measured back."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from bags import depth_image, imu, number, odometry, scan, velocity, write_bag

import simkit

RATE = 100.0


def times(count: int, rate: float = RATE) -> np.ndarray:
    return np.arange(count) / rate


def test_rate_gaps_and_latency_of_a_bag_are_measured_back(tmp_path: Path) -> None:
    random = np.random.default_rng(1)
    kept = random.random(4000) > 0.05
    kept[1000:1034] = False  # a gap of 34 messages
    kept[[0, 999, 1034]] = True
    late = random.gamma(4.0, 0.01, 4000)
    entries = [("/imu", t + d, imu(t)) for t, d, k in zip(times(4000), late, kept, strict=True) if k]
    table = simkit.compare(write_bag(tmp_path / "a.mcap", entries))
    assert table.row("/imu", "messages").a == kept.sum()
    assert table.row("/imu", "latency").a == pytest.approx(0.04, rel=0.03)
    low, high = table.row("/imu", "latency").interval
    assert low < late[kept].mean() < high


def test_missed_messages_are_counted(tmp_path: Path) -> None:
    random = np.random.default_rng(2)
    kept = random.random(4000) > 0.05
    kept[1000:1034] = False
    kept[[0, 999, 1034, 3999]] = True
    entries = [("/imu", t, imu(t)) for t, k in zip(times(4000), kept, strict=True) if k]
    table = simkit.compare(write_bag(tmp_path / "a.mcap", entries))
    assert table.row("/imu", "longest gap").a == 34.0
    assert table.row("/imu", "missed share").a == pytest.approx(1.0 - kept.mean(), abs=1e-4)
    assert table.row("/imu", "rate").a == pytest.approx(RATE * kept.mean(), rel=0.002)


def test_bias_and_white_noise_of_an_imu_are_measured_back(tmp_path: Path) -> None:
    random = np.random.default_rng(3)
    sides = []
    for bias, sigma in ((0.0, 0.002), (0.0005, 0.003)):
        gyro = random.normal(bias, sigma, (6000, 3))
        sides.append([("/imu", t, imu(t, g)) for t, g in zip(times(6000), gyro, strict=True)])
    paths = [write_bag(tmp_path / f"{k}.mcap", entries) for k, entries in enumerate(sides)]
    table = simkit.compare(*paths)
    noise = table.row("/imu", "noise of angular_velocity.x")
    assert (noise.a, noise.b) == pytest.approx((0.002, 0.003), rel=0.04)
    assert noise.verdict == "differs" and noise.interval[0] < 0.001 < noise.interval[1]
    bias_row = table.row("/imu", "angular_velocity.x")
    assert bias_row.verdict == "differs" and bias_row.interval[0] < 0.0005 < bias_row.interval[1]
    walk = table.row("/imu", "angle random walk of angular_velocity.y")
    assert (walk.a, walk.b) == pytest.approx((0.002 / math.sqrt(RATE), 0.003 / math.sqrt(RATE)), rel=0.04)
    assert table.row("/imu", "rate").verdict == "same"


def test_the_bias_instability_of_a_flicker_noise_is_measured_back(tmp_path: Path) -> None:
    random = np.random.default_rng(4)
    count, level = 20_000, 0.01
    frequencies = np.fft.rfftfreq(count, 1.0 / RATE)
    spectrum = np.zeros(len(frequencies), complex)
    # flicker noise of bias instability B has the two-sided power density B² / (2 pi f) (IEEE Std 952)
    amplitude = level * np.sqrt(1.0 / (2.0 * math.pi * frequencies[1:]) * count * RATE)
    parts = random.normal(size=(2, len(frequencies) - 1))
    spectrum[1:] = amplitude * (parts[0] + 1j * parts[1])
    gyro = np.fft.irfft(spectrum / math.sqrt(2.0), count)
    entries = [("/imu", t, imu(t, (g, 0.0, 0.0))) for t, g in zip(times(count), gyro, strict=True)]
    row = simkit.compare(write_bag(tmp_path / "a.mcap", entries)).row("/imu", "bias instability of angular_velocity.x")
    assert row.a == pytest.approx(level, rel=0.25)


def test_the_noise_of_a_scan_is_measured_by_range(tmp_path: Path) -> None:
    random = np.random.default_rng(5)
    truth = np.repeat([0.8, 2.5, 6.0], 100)
    entries = []
    for t in times(100, 10.0):
        ranges = truth + random.normal(0.0, 0.002 * truth)
        ranges[random.random(300) < 0.25] = np.inf
        entries.append(("/scan", t, scan(t, ranges)))
    table = simkit.compare(write_bag(tmp_path / "a.mcap", entries))
    for name, distance in (("0.5 to 1", 0.8), ("2 to 3", 2.5), ("5 to 8", 6.0)):
        assert table.row("/scan", f"noise at {name} m").a == pytest.approx(0.002 * distance, rel=0.1)
    valid = table.row("/scan", "valid share")
    assert valid.a == pytest.approx(0.75, abs=0.01) and valid.interval[0] < 0.75 < valid.interval[1]


def test_scale_error_and_valid_pixels_of_a_depth_camera_are_found(tmp_path: Path) -> None:
    random = np.random.default_rng(6)
    truth = np.linspace(0.7, 4.0, 48 * 64).reshape(48, 64)
    paths = []
    for name, scale, share in (("a", 1.0, 1.0), ("b", 0.988, 0.4)):
        entries = []
        for t in times(40, 10.0):
            depths = scale * truth + random.normal(0.0, 0.003, truth.shape)
            depths[random.random(truth.shape) > share] = np.nan
            entries.append(("/depth", t, depth_image(t, depths)))
        paths.append(write_bag(tmp_path / f"{name}.mcap", entries))
    table = simkit.compare(*paths)
    scale_row = table.row("/depth", "scale of depths")
    assert scale_row.verdict == "differs" and scale_row.difference == pytest.approx(-0.012, abs=2e-4)
    valid = table.row("/depth", "valid share")
    assert (valid.a, valid.b) == pytest.approx((1.0, 0.4), abs=0.01) and valid.verdict == "differs"
    assert table.row("/depth", "noise at 1 to 2 m").a == pytest.approx(0.003, rel=0.05)


def test_the_peak_of_a_vibration_is_found(tmp_path: Path) -> None:
    random = np.random.default_rng(7)
    at = times(3000)
    paths = []
    for name, frequency in (("a", 12.0), ("b", 17.0)):
        values = 0.5 * np.sin(2.0 * math.pi * frequency * at) + random.normal(0.0, 0.1, len(at))
        entries = [("/imu", t, imu(t, (0.0, 0.0, 0.0), (v, 0.0, 9.8))) for t, v in zip(at, values, strict=True)]
        paths.append(write_bag(tmp_path / f"{name}.mcap", entries))
    row = simkit.compare(*paths).row("/imu", "peak of linear_acceleration.x")
    assert (row.a, row.b) == pytest.approx((12.0, 17.0), abs=0.5) and row.verdict == "differs"


def test_speeds_by_direction_and_the_delay_of_a_base_are_measured(tmp_path: Path) -> None:
    random = np.random.default_rng(8)
    delay = 0.15
    commanded = np.repeat([0.0, 0.1, 0.0, -0.1, 0.0], 4 * 50)
    reached = np.where(commanded > 0.0, 0.0957, np.where(commanded < 0.0, -0.0727, 0.0))
    at = times(1000, 50.0)
    shift = round(delay * 50.0)
    actual = np.concatenate((np.zeros(shift), reached[:-shift]))
    entries = [("/cmd_vel", t, velocity(c)) for t, c in zip(at[::5], commanded[::5], strict=True)]
    x = np.cumsum(actual) / 50.0
    noisy = actual + random.normal(0.0, 0.002, 1000)
    entries += [("/odom", t, odometry(t, p, 0.0, v, 0.0)) for t, p, v in zip(at, x, noisy, strict=True)]
    table = simkit.compare(write_bag(tmp_path / "a.mcap", entries))
    forward = table.row("/odom", "speed at /cmd_vel 0.1 m/s")
    backward = table.row("/odom", "speed at /cmd_vel -0.1 m/s")
    assert forward.a == pytest.approx(0.0957, abs=0.0005) and forward.interval[0] < 0.0957 < forward.interval[1]
    assert backward.a == pytest.approx(-0.0727, abs=0.0005)
    assert table.row("/odom", "delay after /cmd_vel linear").a == pytest.approx(delay, abs=0.021)


def test_a_wheel_that_drifts_is_found_in_the_motion_of_its_pose(tmp_path: Path) -> None:
    random = np.random.default_rng(9)
    at = times(1000, 50.0)
    paths = []
    for name, turn in (("a", 0.0), ("b", 0.01)):
        yaws = np.cumsum(turn + random.normal(0.0, 0.02, 1000)) / 50.0
        entries = [("/odom", t, odometry(t, 0.2 * t, y, 0.2, turn)) for t, y in zip(at, yaws, strict=True)]
        paths.append(write_bag(tmp_path / f"{name}.mcap", entries))
    row = simkit.compare(*paths).row("/odom", "yaw rate of pose.pose")
    assert row.verdict == "differs" and row.interval[0] < 0.01 < row.interval[1]


def test_any_number_is_compared(tmp_path: Path) -> None:
    random = np.random.default_rng(10)
    paths = []
    for name, mean in (("a", 11.8), ("b", 11.5)):
        entries = [("/voltage", t, number(mean + random.normal(0.0, 0.1))) for t in times(300, 10.0)]
        paths.append(write_bag(tmp_path / f"{name}.mcap", entries))
    row = simkit.compare(*paths).row("/voltage", "data")
    assert row.verdict == "differs" and row.difference == pytest.approx(-0.3, abs=0.03)
