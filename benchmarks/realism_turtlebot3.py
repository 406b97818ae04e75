"""TurtleBot3 Burger with the data sheets of its devices beside the ideal robot."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
from realism_rows import Probe

import simkit

WALLS = """<sdf version="1.9"><world name="w"><physics type="ode"><max_step_size>0.001</max_step_size></physics>
  <model name="floor"><static>true</static><link name="l"><collision name="c"><geometry><plane><normal>0 0 1</normal>
    <size>20 20</size></plane></geometry></collision></link></model>
  <model name="ring"><static>true</static><link name="l">{boxes}</link></model></world></sdf>"""
ROBOT, LIDAR, IMU = "turtlebot3_burger", "turtlebot3_burger::base_scan::lds", "turtlebot3_burger::imu_link::imu"


def world() -> str:
    """Return a room with walls 0.4 m and 2 m from the scanner, which is 0.032 m behind the middle of the robot."""
    shapes = (
        ("near", "0.418 0 0.5", "0.1 0.3 1"),
        ("far", "-2.082 0 0.5", "0.1 3 1"),
        ("left", "0 3.05 0.5", "4 0.1 1"),
    )
    boxes = "".join(
        f'<collision name="{name}"><pose>{place} 0 0 0</pose>'
        f"<geometry><box><size>{size}</size></box></geometry></collision>"
        for name, place, size in shapes
    )
    return WALLS.format(boxes=boxes)


def measure(realism: str, duration: float = 20.0) -> dict[str, Any]:
    """Return the values of the rows."""
    with simkit.load(world(), spawn=[f"{ROBOT}:0,0,0"], realism=realism) as sim:
        sim.run(1.0)
        scans = Probe(sim, sim.sensor(LIDAR).topic, lambda m: np.array(m.ranges))
        imu = Probe(sim, sim.sensor(IMU).topic, lambda m: (m.angular_velocity.z, m.linear_acceleration.z))
        sim.run(duration)
        truth, ranges = np.array(sim.sensor(LIDAR).truth.ranges), np.array(scans.kept)
        last, motion = scans.last, np.array(imu.kept)
    near, far = (truth < 0.45), (truth > 1.9) & (truth < 2.1)
    errors = ranges - np.where(np.isfinite(truth), truth, 0.0)
    root = math.sqrt(imu.rate)
    missing = ranges[:, ~np.isfinite(truth)]
    return {
        "rate": scans.rate, "rays": len(truth), "increment": 1e3 * last.time_increment, "latency": scans.latency,
        "near": 1e3 * float(errors[:, near].std()), "far": 1e3 * float(errors[:, far].std()),
        "inside": 100 * float((np.abs(errors[:, far]) < 0.035 * truth[far]).mean()),
        "no_return": float(missing.flat[0]) if missing.size else math.nan,
        "gyro": math.degrees(float(motion[:, 0].std()) / root),
        "force": 1e6 * float(motion[:, 1].std()) / root / 9.80665,
        "gravity": 100 * (float(motion[:, 1].mean()) / 9.8 - 1),
    }  # fmt: skip


ROWS = (
    ("scan rate [Hz]", "5 ± 0.17", "rate"),
    ("rays of a scan", "360", "rays"),
    ("time from ray to ray [ms]", "0.556 (1.8 kHz)", "increment"),
    ("arrival after the stamp [ms]", "200, one turn", "latency"),
    ("σ of the range at 0.4 m [mm]", "precision ±10 mm", "near"),
    ("σ of the range at 2 m [mm]", "precision ±70 mm (3.5 %)", "far"),
    ("ranges within ±3.5 % at 2 m [%]", "most", "inside"),
    ("range of a ray without a return [m]", "0 (driver)", "no_return"),
    ("noise density of the gyroscope [°/s/√Hz]", "0.01", "gyro"),
    ("noise density of the accelerometer [µg/√Hz]", "300", "force"),
    ("error of gravity [%]", "scale ±3 %", "gravity"),
)


def table() -> Iterator[str]:
    """Yield the lines of the table."""
    ideal, real = measure("ideal"), measure("datasheet")
    yield "| row | data sheet | simkit, ideal | simkit, datasheet |"
    yield "|---|---|---|---|"
    for name, sheet, key in ROWS:
        yield f"| {name} | {sheet} | {ideal[key]:.4g} | {real[key]:.4g} |"
