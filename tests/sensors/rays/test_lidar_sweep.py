"""A lidar that sweeps: each ray has its own time and its own pose of sensor and targets."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import numpy.typing as npt
import pytest
from lidar_sweep_worlds import ANGULAR, LINEAR, POSE, SWEEP, WALL, fan, flyer, launch, target, world
from sensor_worlds import sensor

import simkit
from simkit.pose import Pose, quat_from_rpy

Vector = npt.NDArray[np.float64]


def turned(angular: tuple[float, ...], time: float) -> Vector:
    """Return the rotation matrix after a constant rotation, by Rodrigues' formula."""
    speed = math.sqrt(sum(part * part for part in angular))
    x, y, z = (part / speed for part in angular)
    cross = np.array(((0, -z, y), (z, 0, -x), (-y, x, 0)))
    angle = speed * time
    return np.eye(3) + math.sin(angle) * cross + (1 - math.cos(angle)) * cross @ cross


class Motion:
    """Motion with a constant velocity from a pose."""

    def __init__(self, pose: Pose, linear: tuple[float, ...], angular: tuple[float, ...]) -> None:
        self.pose, self.linear, self.angular = pose, np.array(linear), angular

    def at(self, time: float) -> tuple[Vector, Vector]:
        return self.pose.position + self.linear * time, self.pose.matrix @ turned(self.angular, time)


def distance_to_box(origin: Vector, direction: Vector, half: Vector) -> float:
    near = (-half * np.sign(direction) - origin) / direction
    far = (half * np.sign(direction) - origin) / direction
    return float(near.max()) if near.max() <= far.min() and near.max() > 0 else math.inf


def distance_to_ball(origin: Vector, direction: Vector, radius: float) -> float:
    along = -float(origin @ direction)
    gap = radius * radius - float(origin @ origin) + along * along
    return along - math.sqrt(gap) if gap >= 0 and along > 0 else math.inf


def expected(
    directions: Vector,
    times: Vector,
    sensor_at: Callable[[float], tuple[Vector, Vector]],
    targets: list[tuple[Callable[[float], tuple[Vector, Vector]], Callable[[Vector, Vector], float]]],
    offset: Pose,
) -> Vector:
    """Return the ranges by a computation of each ray alone, from the motions of sensor and targets."""
    ranges = []
    for direction, time in zip(directions, times, strict=True):
        position, rotation = sensor_at(time)
        origin, ray = position + rotation @ offset.position, rotation @ offset.matrix @ direction
        found = []
        for target_at, distance in targets:
            place, turn = target_at(time)
            found.append(distance(turn.T @ (origin - place), turn.T @ ray))
        ranges.append(min(found))
    return np.array(ranges)


def still(pose: Pose) -> Callable[[float], tuple[Vector, Vector]]:
    return lambda time: (pose.position, pose.matrix)


@pytest.mark.parametrize(
    ("kind", "columns", "layers"),
    [("lidar", 90, 1), ("gpu_lidar", 60, 1), ("ray", 40, 3), ("gpu_ray", 40, 2), ("lidar", 180, 12)],
)
def test_ranges_of_a_moving_sensor_and_moving_targets_agree_with_a_hand_computation(
    kind: str, columns: int, layers: int
) -> None:
    lidar = sensor(kind, fan(columns, layers, kind), rate=10, pose=POSE, extra=SWEEP)
    crate = target("crate", "<box><size>0.8 1.2 1.6</size></box>", "-1.5 1.8 1.2 0.3 0.2 0.1")
    ball = target("ball", "<sphere><radius>0.6</radius></sphere>", "-1 -2.5 1.3 0 0 0")
    with simkit.load(world(flyer(lidar), WALL, crate, ball)) as sim:
        motions = {}
        velocities = {
            "m": (LINEAR, ANGULAR),
            "crate": ((0.7, -0.3, 0.1), (1.0, 2.0, -1.5)),
            "ball": ((-0.4, 0.9, 0.0), (0.0, 0.0, 1.0)),
        }
        for name, velocity in velocities.items():
            motions[name] = Motion(sim.model(name).link("l").pose, *velocity)
            launch(sim, name, *velocity)
        arrivals = []
        swept = sim.sensor("m::l::s")
        sim.subscribe(swept.topic, callback=lambda m: arrivals.append((sim.time, m)))
        sim.run(0.31)
        last = math.ceil(0.1 * (columns - 1) / columns / 0.002) * 0.002
        assert [time for time, _ in arrivals] == pytest.approx([0.002 + last, 0.1 + last, 0.2 + last])
        message = arrivals[-1][1]
        stamp = message.header.stamp.sec + message.header.stamp.nanosec * 1e-9
        assert stamp == pytest.approx(0.2, abs=1e-12)
        times = swept.ray_times
        assert message.time_increment == pytest.approx(0.1 / columns, rel=1e-6)
        assert np.allclose(times[:columns], 0.1 / columns * np.arange(columns), rtol=0, atol=1e-9)
        reading = swept._true_reading()
        half = np.array((0.4, 0.6, 0.8))
        ranges = expected(
            swept._directions,
            stamp + times,
            motions["m"].at,
            [
                (still(_wall()), _to_wall),
                (motions["crate"].at, lambda o, d: distance_to_box(o, d, half)),
                (motions["ball"].at, lambda o, d: distance_to_ball(o, d, 0.6)),
            ],
            _pose(POSE),
        )
        ranges[ranges > 20] = np.inf
        near = np.isfinite(ranges)
        assert 0.2 < near.mean() < 1.0
        assert np.array_equal(np.isfinite(reading.ranges), near)
        assert np.abs(reading.ranges[near] - ranges[near]).max() < 1e-5
        poses = reading.sweep.sensor_poses()
        for i in range(0, len(times), 7):
            position, rotation = motions["m"].at(stamp + times[i])
            offset = _pose(POSE)
            assert np.abs(poses.positions[:, i] - position - rotation @ offset.position).max() < 1e-9
            found = Pose(poses.positions[:, i], poses.quaternions[:, i]).matrix
            assert np.abs(found - rotation @ offset.matrix).max() < 1e-9


def _pose(text: str) -> Pose:
    x, y, z, roll, pitch, yaw = map(float, text.split())
    return Pose((x, y, z), quat_from_rpy(roll, pitch, yaw))


def _wall() -> Pose:
    return _pose("4 0 0 0 0 0.2")


def _to_wall(origin: Vector, direction: Vector) -> float:
    return distance_to_box(origin, direction, np.array((0.1, 15.0, 15.0)))
