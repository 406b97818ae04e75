"""Two artificial runs and their comparison."""

from __future__ import annotations

from typing import Any

import numpy as np

from simkit.run_spec import Check, RunSpec
from simkit.testing.conditions import CheckResult
from simkit.testing.golden.compare.difference import Cause, Comparison, Difference, Explanation, Verdict
from simkit.testing.run_record.noise_statistics import NoiseStatistics
from simkit.testing.run_record.record import Column, Pictures, RunRecord, States, Stream

SCAN, ODOM, IMU, CAMERA, DEPTH = "/scan", "/odom", "/imu", "/camera/image", "/camera/depth"


def record(shift: float = 0.0, *, seconds: float = 4.0, extra: int = 0) -> RunRecord:
    """Return a run in which all values differ by `shift` from 2 s on."""
    streams = {
        s.topic: s for s in (_scan(shift, seconds), _odom(shift, seconds + extra), _imu(shift), *_cameras(shift))
    }
    ticks = np.arange(0, 4001, 500)
    values = np.outer(ticks * 1e-3, (1.0, 0.5)) + shift * (ticks[:, None] >= 2000)
    empty = np.zeros((len(ticks), 0))
    states = States(
        1e-3,
        np.zeros(4000, np.uint8),
        np.zeros(4000, np.uint8),
        ticks,
        ["cart x", "wheel position"],
        values,
        [],
        empty,
        "ab",
    )
    scenario = RunSpec("worlds/drive.sdf", 4.0, 3, overrides=("model::link.mass=2",))
    printed = {"simkit": "0.9", "mujoco": "4.0.0" if not shift else "4.0.1"}
    return RunRecord(scenario, printed, streams, states, diagnostics={"SK-SDF-001": 1 + (shift != 0)})


def difference(topic: str, field: str, kind: Any, words: str, **more: Any) -> Difference:
    return Difference(
        topic, field, kind, more.pop("time", 2.0), more.pop("size", 0.012), more.pop("unit", "m"), words, **more
    )


def failing() -> Verdict:
    """Return a verdict with every kind of difference."""
    found = [
        difference(
            SCAN, "ranges", "value", "/scan.ranges: 14 of 360 rays +12 mm from t = 2.00 s", allowed="1 mm", index=20
        ),
        difference("", "", "state", "wheel position differs from tick 2000", unit="rad"),
        difference(ODOM, "pose.pose.position.x", "value", "/odom.pose.pose.position.x: +12 mm from t = 2.00 s"),
        difference(IMU, "linear_acceleration", "statistics", "/imu: deviation 0.01 → 0.012 m/s²", unit="m/s²"),
        difference(CAMERA, "data", "picture", "/camera/image: 3 % of pixels differ", unit=""),
        difference(DEPTH, "data", "picture", "/camera/depth: +12 mm", unit="m"),
        difference(ODOM, "", "count", "/odom: 50 Hz became 51 Hz: 200 messages became 204"),
        difference("/gone", "", "missing", "/gone: no longer published", time=float("nan")),
    ]
    causes = [
        Cause(
            "model", "wheel::collision: radius 0.033 → 0.0333 m", "wheel/radius", 0.033, 0.0333, "model.sdf:123", True
        ),
        Cause("version", "mujoco 4.0.0 → 4.0.1", "mujoco", "4.0.0", "4.0.1", proven=False),
    ]
    comparison = Comparison("tolerant", found, ["/imu: less than 1e-9 apart"], {"mujoco": ("4.0.0", "4.0.1")}, 5, 900)
    check = CheckResult(
        Check("goal", expression="pose('cart').x > 2", hint="drive on"), False, "it was 1.9 at most", 4.0
    )
    explanation = Explanation(causes, 2000, 2.0, "wheel position")
    return Verdict("drive", record(), record(0.012, extra=1), comparison, explanation, (check,), 1.5)


def passing(name: str = "stand") -> Verdict:
    return Verdict(name, record(), record(), Comparison("exact", topics=5, messages=900), elapsed=0.5)


def _times(rate: float, seconds: float) -> Any:
    return (np.arange(0.0, seconds, 1.0 / rate) * 1e9).round().astype(np.int64)


def _scan(shift: float, seconds: float) -> Stream:
    times = _times(10.0, seconds)
    ranges = np.tile(2.0 + np.sin(np.linspace(0, 20, 360)), (len(times), 1))
    ranges[:, 100:120] = np.inf
    ranges[times >= 2e9, 30:44] += shift
    return Stream(SCAN, "sensor_msgs/msg/LaserScan", times, {"ranges": Column(ranges)})


def _odom(shift: float, seconds: float) -> Stream:
    times = _times(50.0, seconds)
    x = 0.22 * times * 1e-9 + shift * (times >= 2e9)
    return Stream(ODOM, "nav_msgs/msg/Odometry", times, {"pose.pose.position.x": Column(x)})


def _imu(shift: float) -> Stream:
    deviation = 0.01 + shift / 6
    quantiles = np.tile(np.linspace(-3, 3, 65) * deviation, (3, 1))
    taus = np.array([0.01, 0.1, 1.0])
    statistics = NoiseStatistics(
        800, np.zeros(3), np.full(3, deviation), quantiles, taus, np.tile(deviation / np.sqrt(taus), (3, 1))
    )
    return Stream(IMU, "sensor_msgs/msg/Imu", _times(200.0, 4.0), statistics={"linear_acceleration": statistics})


def _cameras(shift: float) -> list[Stream]:
    times = _times(5.0, 4.0)
    colours = np.full((len(times), 30, 40, 3), (200, 40, 40), np.uint8)
    depths = np.full((len(times), 30, 40), 3.0, np.float32)
    depths[:, :5] = np.inf
    tiles = np.zeros((len(times), 2, 3), np.uint32)
    if shift:
        colours[10:, 10:20, 5:15] = (40, 40, 220)
        depths[10:, 10:20, 5:15] += np.float32(shift)
        tiles[10:, 0, 0] = 1
    return [
        Stream(CAMERA, "sensor_msgs/msg/Image", times, pictures=Pictures(colours, (240, 320), "rgb8", tiles)),
        Stream(DEPTH, "sensor_msgs/msg/Image", times, pictures=Pictures(depths, (240, 320), "32FC1", tiles)),
    ]
