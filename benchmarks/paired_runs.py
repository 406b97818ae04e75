"""Measure how many runs paired and independent comparisons need for the same confidence, in three closed loops.

    python benchmarks/paired_runs.py [PAIRS]

All run in `turtlebot3_world`, with the noise of the robot's lidar (10 mm):

- `distance_keeper` keeps 0.8 m to the wall behind it, with a gain of 0.6 or 0.8; metric: RMS error of the
  true distance [mm];
- `goal_seeker` drives 1.5 m to a goal, from a start that the seed draws, with a turning gain of 0.8 or 1.0;
  metric: time [s];
- `stopper` backs towards that wall and stops at 0.3 m, seen in the last scan or in the mean of two;
  metric: true distance [mm].
"""

from __future__ import annotations

import math
import sys
from collections import deque
from collections.abc import Callable

import numpy as np

import simkit
from simkit_identification.comparison.paired_runs import paired_row

WALL = -2.538  # [m] x of the wall behind the robot


def distance_keeper(seed: int, gain: float) -> float:
    errors = []
    with simkit.load("turtlebot3_world", seed=seed) as sim:
        scans = sim.subscribe("/scan", keep=1)
        for step in range(100):
            sim.run(0.2)
            distance = float(scans.latest.ranges[180])
            sim.publish("/cmd_vel", {"linear": {"x": gain * (0.8 - distance)}})
            if step >= 25:
                errors.append(float(sim.models["turtlebot3"].pose.position[0]) - WALL - 0.8)
    return 1000.0 * math.sqrt(float(np.mean(np.square(errors))))


def goal_seeker(seed: int, gain: float) -> float:
    random = np.random.default_rng(seed)
    with simkit.load("turtlebot3_world", seed=seed) as sim:
        robot = sim.models["turtlebot3"]
        dx, dy, yaw = random.uniform(-0.15, 0.15), random.uniform(-0.15, 0.15), random.uniform(-1.2, 1.2)
        robot.set_pose(simkit.Pose.from_rpy(-2.0 + dx, -0.5 + dy, 0.0, 0.0, 0.0, yaw))
        while sim.time < 60.0:
            x, y, _ = robot.pose.position
            if x > -0.5:
                break
            error = math.remainder(math.atan2(-0.5 - y, -0.3 - x) - float(robot.pose.rpy[2]), 2.0 * math.pi)
            sim.publish("/cmd_vel", {"linear": {"x": 0.15 * max(0.0, math.cos(error))}, "angular": {"z": gain * error}})
            sim.run(0.1)
        return float(sim.time)


def stopper(seed: int, scans_averaged: int) -> float:
    with simkit.load("turtlebot3_world", seed=seed) as sim:
        scans = sim.subscribe("/scan", keep=1)
        seen: deque[float] = deque(maxlen=scans_averaged)
        sim.run(0.2)
        while not seen or np.mean(seen) > 0.3:
            sim.publish("/cmd_vel", {"linear": {"x": -0.04}})
            sim.run(0.2)
            seen.append(float(scans.latest.ranges[180]))
        return 1000.0 * (float(sim.models["turtlebot3"].pose.position[0]) - WALL)


def compare(name: str, run: Callable[[int, float], float], a: float, b: float, pairs: int) -> None:
    values = np.array([(run(seed, a), run(seed, b)) for seed in range(pairs)])
    row = paired_row(name, values[:, 0], values[:, 1])
    low, high = row.interval
    print(
        f"{name}: a {row.a:.4g}, b {row.b:.4g}, b - a {row.difference:+.3g}; paired ±{(high - low) / 2:.3g}, "
        f"independent ±{(row.unpaired[1] - row.unpaired[0]) / 2:.3g}; correlation {row.correlation:.2f}; "
        f"independent runs: {row.saving:.2g} × as many"
    )


if __name__ == "__main__":
    number = int(sys.argv[1]) if len(sys.argv) > 1 else 60
    compare("distance_keeper", distance_keeper, 0.6, 0.8, number)  # type: ignore[arg-type]
    compare("goal_seeker", goal_seeker, 0.8, 1.0, number)  # type: ignore[arg-type]
    compare("stopper", stopper, 1, 2, number)  # type: ignore[arg-type]
