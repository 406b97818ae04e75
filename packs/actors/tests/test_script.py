"""Poses of an actor over time: Gazebo's splines through waypoints, delay, loop, several trajectories."""

from __future__ import annotations

import numpy as np
import pytest

from simkit import Pose
from simkit.scene import SceneActor, Trajectory, Waypoint
from simkit_actors.plugins.script import Script


def trajectory(*points: tuple[float, float, float, float], tension: float = 0.0, number: int = 0) -> Trajectory:
    """Return a trajectory with waypoints (time, x, y, yaw)."""
    found = tuple(Waypoint(t, Pose.from_rpy(x, y, 0, 0, 0, yaw)) for t, x, y, yaw in points)
    return Trajectory(number, "walk", found, tension)


def script(*ways: Trajectory, loop: bool = True, delay: float = 0.0, base: Pose | None = None) -> Script:
    return Script(SceneActor("anna", base or Pose(), trajectories=ways, loop=loop, delay_start=delay))


def position_at(found: Script, time: float) -> tuple[float, float, float]:
    pose = found.pose(time)
    return round(float(pose.position[0]), 6), round(float(pose.position[1]), 6), round(float(pose.rpy[2]), 6)


STRAIGHT = trajectory((0, 0, 0, 0), (2, 2, 0, 0), (4, 4, 0, 0))


def test_the_actor_is_at_its_waypoints_at_their_times() -> None:
    bent = script(trajectory((0, 0, 0, 0), (1, 1, 1, 0.5), (3, 2, 0, 1.0)))
    assert [position_at(bent, t) for t in (0, 1, 2.9999999)] == [(0, 0, 0), (1, 1, 0.5), (2, 0, 1.0)]


def test_the_actor_follows_the_cubic_spline_of_gazebo_between_waypoints() -> None:
    # tangents: half the way between the neighbours, at the ends half the way to the next
    t = 0.5
    expected = (t**3 - 2 * t**2 + t) * 1.0 + (3 * t**2 - 2 * t**3) * 2.0 + (t**3 - t**2) * 2.0
    assert position_at(script(STRAIGHT), 1.0)[0] == pytest.approx(expected, abs=1e-6)


def test_a_tension_of_one_stops_at_every_waypoint_and_never_overshoots() -> None:
    there_and_back = script(trajectory((0, 0, 0, 0), (2, 2, 0, 0), (3, 2, 0, 3), (5, 0, 0, 3), tension=1.0))
    xs = [position_at(there_and_back, t)[0] for t in np.arange(0.0, 5.0, 0.05)]
    assert min(xs) >= 0.0
    assert max(xs) <= 2.0
    assert position_at(there_and_back, 1.0)[0] == pytest.approx(1.0)


def test_a_rotation_takes_the_shorter_direction() -> None:
    turning = script(trajectory((0, 0, 0, 3.0), (1, 0, 0, -3.0)))
    assert abs(position_at(turning, 0.5)[2]) == pytest.approx(np.pi, abs=1e-5)


def test_the_script_starts_after_its_delay_and_loops() -> None:
    late = script(STRAIGHT, delay=3.0)
    assert position_at(late, 2.9) == (0, 0, 0)
    assert position_at(late, 5.0) == (2, 0, 0)
    assert position_at(late, 3.0 + 4.0 + 2.0) == (2, 0, 0)


def test_without_a_loop_the_actor_stays_at_the_end() -> None:
    once = script(STRAIGHT, loop=False)
    assert position_at(once, 4.0) == position_at(once, 99.0) == (4, 0, 0)
    assert once.at(99.0)[2]  # it rests


def test_trajectories_play_one_after_the_other() -> None:
    two = script(trajectory((0, 0, 0, 0), (2, 2, 0, 0)), trajectory((0, 5, 5, 0), (3, 8, 5, 0), number=1))
    assert two.length == 5.0
    assert position_at(two, 2.0) == (5, 5, 0)
    assert position_at(two, 6.0) == position_at(two, 1.0)


def test_waypoints_are_relative_to_the_pose_of_the_actor() -> None:
    moved = script(STRAIGHT, base=Pose.from_rpy(1, 2, 0, 0, 0, np.pi / 2))
    assert position_at(moved, 2.0) == pytest.approx((1, 4, np.pi / 2))


@pytest.mark.parametrize(
    "points", [[(0, 1, 0, 0)], [(0, 1, 0, 0), (0, 2, 0, 0)], [(2, 1, 0, 0), (2, 1, 0, 0), (3, 1, 0, 0)]]
)
def test_an_incomplete_script_is_followed_as_far_as_possible(points: list[tuple[float, float, float, float]]) -> None:
    found = script(trajectory(*points))
    for time in (0.0, 1.0, 2.0, 5.0):
        assert np.isfinite(found.pose(time).position).all()
