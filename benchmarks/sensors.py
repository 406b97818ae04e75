"""Sensors that are read: the IMU's share of stepping, and a laser scan beside raw `mj_multiRay`.

python benchmarks/sensors.py [--world NAME] [--rounds N]
"""

from __future__ import annotations

import mujoco
import numpy as np
from measure import arguments, median_times, report

import simkit

STEPS = 2000
RAYS = 360


def imu(world: str, rounds: int) -> None:
    """Stepping with the IMU read, beside bare stepping."""
    with simkit.load(world) as sim:
        sim.run(1.0)
        sim.subscribe("/imu", keep=1)
        model, data = sim.mj_model, mujoco.MjData(sim.mj_model)
        data.qpos[:], data.qvel[:] = sim.mj_data.qpos, sim.mj_data.qvel
        sides = {"ours": lambda: sim.step(STEPS), "bare": lambda: mujoco.mj_step(model, data, STEPS)}
        times = median_times(sides, rounds)
    report("one step, IMU read", times["ours"] / STEPS, times["bare"] / STEPS, 1.10)


def scan(world: str, rounds: int) -> None:
    """What a scan adds to a run (the same run without a reader taken off), beside its rays alone."""
    seconds = 2.0
    with simkit.load(world) as read, simkit.load(world) as unread:
        lidar = next(s for s in read.sensors.values() if s.kind in ("lidar", "ray"))
        read.subscribe(lidar.topic, keep=1)
        for sim in (read, unread):
            sim.run(1.0)
        model, data = read.mj_model, read.mj_data
        origin = np.array(lidar.pose.position, dtype=np.float64)
        angles = np.linspace(0, 6.28, RAYS)
        rays = np.stack([np.cos(angles), np.sin(angles), np.zeros(RAYS)], axis=1).ravel()
        groups = np.array([0, 0, 0, 1, 1, 0], dtype=np.uint8)
        geoms, distances = np.zeros(RAYS, dtype=np.int32), np.zeros(RAYS)

        def bare() -> None:
            for _ in range(round(seconds * lidar.update_rate)):
                mujoco.mj_multiRay(model, data, origin, rays, groups, 1, -1, geoms, distances, None, RAYS, 3.5)

        sides = {"read": lambda: read.run(seconds), "unread": lambda: unread.run(seconds), "bare": bare}
        times = median_times(sides, rounds)
        count = seconds * lidar.update_rate
    report("one scan of 360 rays", (times["read"] - times["unread"]) / count, times["bare"] / count, 1.20)


def main() -> None:
    args = arguments(__doc__, rounds=9)
    imu(args.world, args.rounds)
    scan(args.world, args.rounds)


if __name__ == "__main__":
    main()
